#include "benchmarks/stability/faceted_circle.h"

#include <algorithm>
#include <cmath>

#include "geometry/angle.h"

namespace raytree::benchmarks::facets {

FacetedCircle::FacetedCircle(int sides, double turned_degrees) {
  for (int i = 0; i < sides; ++i) {
    const double angle = (90 + turned_degrees) * kDegree + 2 * kPi * i / sides;
    corners_.push_back({std::sin(angle), std::cos(angle)});
  }
}

double FacetedCircle::light(ShadingMethod method, double x, double exponent) const {
  const auto of_cosine = [&](double cosine) { return cosine > 0 ? std::pow(cosine, exponent) : 0; };
  if (corners_.empty()) return std::abs(x) < 1 ? of_cosine(std::sqrt(1 - x * x)) : 0;
  for (std::size_t i = 0; i < corners_.size(); ++i) {
    const Corner &a = corners_[i], &b = corners_[(i + 1) % corners_.size()];
    // Facets that face the viewer run from left to right, and no two lie one before the other.
    if (b.x <= a.x || x < a.x || x > b.x) continue;
    const double share = (x - a.x) / (b.x - a.x);
    if (method == ShadingMethod::gouraud) return (1 - share) * of_cosine(a.z) + share * of_cosine(b.z);
    if (method == ShadingMethod::flat) return of_cosine((b.x - a.x) / std::hypot(b.x - a.x, b.z - a.z));
    const double z = a.z + share * (b.z - a.z);
    return of_cosine(z / std::hypot(x, z));
  }
  return 0;
}

std::vector<double> pixel_centers(int width, double pixel) {
  std::vector<double> centers;
  for (int i = 0; i < width; ++i) centers.push_back((i + 0.5 - width / 2.0) * pixel);
  return centers;
}

}  // namespace raytree::benchmarks::facets
