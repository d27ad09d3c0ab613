#include "geometry/plane_intersection.h"

#include <algorithm>

namespace raytree {

void intersect_planes(const std::vector<Plane>& planes, const RayBatch& rays, PlaneHits& hits) noexcept {
  const std::size_t padded = rays.size + kBatchPadding;
  if (hits.plane.size() < padded) {
    hits.plane.resize(padded);
    hits.distance.resize(padded);
  }
  std::fill_n(hits.plane.begin(), rays.size, kNoPlane);
  std::copy_n(rays.max_distance, rays.size, hits.distance.begin());
  for (std::size_t p = 0; p < planes.size(); ++p)
    for (std::size_t i = 0; i < rays.size; ++i) {
      const float distance = plane_distance(planes[p], rays.origin(i), rays.direction(i));
      const bool nearer = distance >= 0 && distance < hits.distance[i];
      hits.distance[i] = nearer ? distance : hits.distance[i];
      hits.plane[i] = nearer ? static_cast<std::uint32_t>(p) : hits.plane[i];
    }
}

}  // namespace raytree
