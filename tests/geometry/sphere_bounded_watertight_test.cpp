// No ray slips between the faces of a closed mesh, aimed at their very corners and edges: from one origin, from random
// ones, along the axes; for triangles, flat n-gons and n-gons that are not flat.
#include <gtest/gtest.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include "geometry/angle.h"
#include "geometry/faceted_quadric.h"
#include "geometry/newell.h"
#include "geometry/ray_batch.h"
#include "geometry/sphere_bounded_intersector.h"
#include "tests/geometry/reference_shapes.h"
#include "tests/geometry/subdivision_cages.h"

namespace raytree {
namespace {

using namespace test;

/// A convex mesh about the origin, symmetric to the three planes of the axes.
struct ClosedMesh {
  const char* name;
  PolygonMesh mesh;
  bool round;  ///< no face holds a direction of the axes
};

PolygonMesh ball(int sides) {
  PolygonMesh mesh = faceted_sphere({0, 0, 0}, 1, sides, sides / 2);
  mesh.normals = {}, mesh.normal_corners = {};
  return mesh;
}

PolygonMesh triangulated(PolygonMesh mesh) {
  Warnings warnings;
  TriangleMesh triangles = triangulate(std::move(mesh), {}, warnings);
  PolygonMesh result;
  result.positions = std::move(triangles.positions);
  result.corners = std::move(triangles.corners);
  return result;
}

/// A prism of 2 n-gons and n quads.
PolygonMesh prism(int n) {
  PolygonMesh mesh;
  for (int end = 0; end < 2; ++end)
    for (int i = 0; i < n; ++i) {
      const double a = 2 * kPi * (i + 0.5) / n;
      mesh.positions.push_back(Vec3f(Vec3d(std::cos(a), std::sin(a), end == 0 ? -0.5 : 0.5)));
    }
  const auto size = static_cast<std::uint32_t>(n);
  for (std::uint32_t i = 0; i < size; ++i) add_face(mesh, {i, (i + 1) % size, size + (i + 1) % size, size + i});
  mesh.face_sizes.push_back(size);
  for (std::uint32_t i = 0; i < size; ++i) mesh.corners.push_back(size - 1 - i);
  mesh.face_sizes.push_back(size);
  for (std::uint32_t i = 0; i < size; ++i) mesh.corners.push_back(size + i);
  return mesh;
}

/// Corners moved along their radius by up to a tenth: quads and n-gons are flat no more, triangles always are.
PolygonMesh dented(PolygonMesh mesh) {
  for (std::size_t i = 0; i < mesh.positions.size(); ++i)
    mesh.positions[i] *= 1 - 0.1f * static_cast<float>((7 * i) % 5) / 5;
  return mesh;
}

std::vector<ClosedMesh> closed_meshes() {
  std::vector<ClosedMesh> meshes;
  meshes.push_back({"quads of a ball", ball(24), true});
  meshes.push_back({"triangles of a ball", triangulated(ball(24)), true});
  meshes.push_back({"cube", cube_cage(), false});
  meshes.push_back({"prism of 12-gons", prism(12), false});
  return meshes;
}

/// Rays of one kind at one mesh, and how many of them find nothing.
class Aim {
 public:
  explicit Aim(const PolygonMesh& mesh) : mesh_(mesh), shapes_(polygon_shapes(mesh)), tracer_(shapes_, {}) {
    std::size_t first = 0;
    for (std::size_t face = 0; face < mesh.face_count(); ++face) {
      const std::size_t size = mesh.all_triangles() ? 3 : mesh.face_sizes[face];
      for (std::size_t i = 0; i < size; ++i)
        edges_.emplace_back(mesh.corners[first + i], mesh.corners[first + (i + 1) % size]);
      first += size;
    }
  }

  /// A corner, or a place on an edge as near to it as single precision has one.
  Vec3f target(Random& random) const {
    const auto [a, b] = edges_[random.below(edges_.size())];
    if (random.below(2) == 0) return mesh_.positions[a];
    const double t = random.below(4) == 0 ? 0.5 : random.uniform(0, 1);
    return Vec3f(Vec3d(mesh_.positions[a]) * (1 - t) + Vec3d(mesh_.positions[b]) * t);
  }

  /// From inside: every ray must leave. `kind` 0: from the middle; 1: from anywhere inside; 2: along an axis.
  bool misses(int kind, Random& random) const {
    Vec3d to(target(random)), from(0, 0, 0);
    if (kind == 1) from = Vec3d(Vec3f(random.in_cube(0.3)));
    // With one coordinate 0 a place of a corner lies inside: the mesh is round and symmetric.
    if (kind == 2) {
      to = Vec3d(mesh_.positions[edges_[random.below(edges_.size())].first]);
      from = to;
      const int axis = static_cast<int>(random.below(3));
      if (std::abs(to[axis]) < 0.05) return false;  // on that plane, or as close as rounding left it
      from[axis] = 0;
    }
    Vec3d direction = to - from;
    if (random.below(2) == 0) direction = Vec3d(Vec3f(direction.normalized()));  // as a batch has it
    const ReferenceHit hit = tracer_.nearest(from, direction, kInfinity);
    if (!hit.hit()) return true;
    // Within what the corners' own float coordinates and the aim are off by.
    const Vec3d place = from + direction * hit.distance;
    EXPECT_LT((place - to).length(), 1e-5) << kind;
    return false;
  }

  std::size_t missed(int kind, std::size_t rays) const {
    constexpr std::size_t kBlock = 4096;
    return tbb::parallel_reduce(
        tbb::blocked_range<std::size_t>(0, (rays + kBlock - 1) / kBlock), std::size_t(0),
        [&](const auto& range, std::size_t sum) {
          for (std::size_t block = range.begin(); block != range.end(); ++block) {
            Random random(1980 + block);
            for (std::size_t i = 0; i < kBlock; ++i) sum += misses(kind, random);
          }
          return sum;
        },
        std::plus<>());
  }

 private:
  PolygonMesh mesh_;
  ShapeSet shapes_;
  SphereBoundedIntersector tracer_;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges_;
};

void expect_no_miss(std::size_t rays_each) {
  for (const ClosedMesh& closed : closed_meshes()) {
    SCOPED_TRACE(closed.name);
    const Aim aim(closed.mesh);
    for (int kind = 0; kind < (closed.round ? 3 : 2); ++kind)
      EXPECT_EQ(aim.missed(kind, rays_each), 0u) << "kind " << kind;
  }
}

TEST(SphereBoundedWatertight, NoRayAtCornersAndEdgesMisses) { expect_no_miss(8192); }

/// Ten pairs of a mesh and a kind of origins: 10 million rays in all.
TEST(SphereBoundedWatertight, NoneOfTenMillionRaysMisses) { expect_no_miss(1003520); }

/// What holds of n-gons that are not flat: no ray from inside slips out, either, though where it is found is a matter
/// of each face's own plane.
TEST(SphereBoundedWatertight, NoRayMissesPolygonsThatAreNotFlat) {
  for (const PolygonMesh& mesh : {dented(ball(24)), dented(prism(12)), dented(cube_cage())}) {
    const ShapeSet shapes = polygon_shapes(mesh);
    const SphereBoundedIntersector tracer(shapes, {});
    for (const Vec3f& corner : mesh.positions) {
      const Vec3d to(corner);
      const ReferenceHit hit = tracer.nearest({0, 0, 0}, to, kInfinity);
      ASSERT_TRUE(hit.hit());
      EXPECT_NEAR(hit.distance, 1, 0.11);
    }
  }
}

/// From outside: where all faces about a corner look at the origin, a ray at that corner meets one of them there.
TEST(SphereBoundedWatertight, CornersAreMetFromOutside) {
  Random random(7);
  for (const ClosedMesh& closed : closed_meshes()) {
    SCOPED_TRACE(closed.name);
    const ShapeSet shapes = polygon_shapes(closed.mesh);
    const SphereBoundedIntersector tracer(shapes, {});
    std::size_t met = 0;
    for (int view = 0; view < 200; ++view) {
      const Vec3d from = Vec3d(Vec3f(random.direction() * random.uniform(2, 2000)));
      std::vector<bool> looks(closed.mesh.positions.size(), true);
      std::size_t first = 0;
      for (std::size_t face = 0; face < closed.mesh.face_count(); ++face) {
        const std::size_t size = closed.mesh.all_triangles() ? 3 : closed.mesh.face_sizes[face];
        const std::uint32_t* corners = &closed.mesh.corners[first];
        const Vec3d normal = newell_normal(closed.mesh.positions.data(), corners, size).normalized();
        if (!(normal.dot((from - Vec3d(closed.mesh.positions[corners[0]])).normalized()) > 1e-3))
          for (std::size_t i = 0; i < size; ++i) looks[corners[i]] = false;
        first += size;
      }
      for (std::size_t i = 0; i < looks.size(); ++i) {
        if (!looks[i]) continue;
        const Vec3d to(closed.mesh.positions[i]);
        const ReferenceHit hit = tracer.nearest(from, to - from, kInfinity);
        ASSERT_TRUE(hit.hit());
        // The corner lies in its faces' planes to rounding; 1e-3 is the least slope.
        EXPECT_NEAR(hit.distance, 1, 1e-6);
        ++met;
      }
    }
    EXPECT_GT(met, 150u);
  }
}

}  // namespace
}  // namespace raytree
