#include "benchmarks/crack_rays.h"

#include <Imath/ImathBox.h>

#include <algorithm>
#include <optional>
#include <random>
#include <unordered_map>
#include <vector>

#include "geometry/open_edges.h"

namespace raytree::benchmarks {
namespace {

constexpr double kCornerShare = 1.0 / 16;  ///< of an edge, at either end, that is not aimed at
/// Sine of the least angle between ray and facets. A facet's distance along the ray is off by the rounding of its
/// coordinates, some 2^-22 of them, over this.
constexpr double kLeastSine = 0.01;
/// Of the distance to the edge: 2^-22 / kLeastSine is 2.4e-5.
constexpr double kDistanceRounding = 1e-4;

/// An edge that is aimed at: whose it is, and the triangle beyond.
struct AimedEdge {
  std::size_t triangle = 0, corner = 0;  ///< from corner to the next
  std::optional<std::size_t> beyond;
};

std::uint64_t directed_key(std::uint32_t a, std::uint32_t b) { return std::uint64_t(a) << 32 | b; }

/// Unit; zero of a triangle without area.
Vec3d normal_of(const TriangleMesh& mesh, std::size_t triangle) {
  const auto corner = [&](std::size_t k) { return Vec3d(mesh.positions[mesh.corners[3 * triangle + k]]); };
  const Vec3d across = (corner(1) - corner(0)).cross(corner(2) - corner(0));
  const double length = across.length();
  return length > 0 ? across / length : Vec3d(0);
}

/// Random ones of a mesh.
std::vector<AimedEdge> random_edges(const TriangleMesh& mesh, std::size_t count, std::mt19937_64& random) {
  std::vector<AimedEdge> edges(count);
  // The triangle beyond, by the directed edge as that has it.
  std::unordered_map<std::uint64_t, std::optional<std::size_t>> beyond;
  beyond.reserve(count);
  const auto key_beyond = [&](const AimedEdge& edge) {
    const std::uint32_t* const c = &mesh.corners[3 * edge.triangle];
    return directed_key(c[(edge.corner + 1) % 3], c[edge.corner]);
  };
  for (AimedEdge& edge : edges) {
    edge.triangle = random() % mesh.triangle_count(), edge.corner = random() % 3;
    beyond.try_emplace(key_beyond(edge));
  }
  for (std::size_t triangle = 0; triangle < mesh.triangle_count(); ++triangle)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t* const c = &mesh.corners[3 * triangle];
      if (const auto found = beyond.find(directed_key(c[k], c[(k + 1) % 3])); found != beyond.end())
        found->second = triangle;
    }
  for (AimedEdge& edge : edges) edge.beyond = beyond.at(key_beyond(edge));
  return edges;
}

class CrackRays {
 public:
  CrackRays(const RayIntersector& tracer, CrackCount& count) : tracer_(tracer), count_(count) {}
  ~CrackRays() { shoot(); }
  CrackRays(const CrackRays&) = delete;
  CrackRays& operator=(const CrackRays&) = delete;

  void add(const Vec3f& from, const Vec3f& direction, double distance) {
    rays_.push(from, direction, kInfinity);
    distances_.push_back(distance);
    if (rays_.size == kBatchSize) shoot();
  }

 private:
  void shoot() {
    if (rays_.size == 0) return;
    tracer_.intersect(rays_, Coherence::incoherent, hits_);
    for (std::size_t i = 0; i < rays_.size; ++i)
      count_.cracks +=
          hits_.geometry[i] == kNoGeometry || !(hits_.distance[i] <= distances_[i] * (1 + kDistanceRounding));
    count_.rays += rays_.size;
    rays_.size = 0;
    distances_.clear();
  }

  const RayIntersector& tracer_;
  CrackCount& count_;
  RayBatch rays_{kBatchSize};
  HitBatch hits_{kBatchSize};
  std::vector<double> distances_;
};

}  // namespace

CrackCount count_cracks(const ShapeSet& shapes, const RayIntersector& tracer, const Vec3f& eye, std::size_t rays,
                        std::uint64_t seed) {
  CrackCount count;
  std::size_t triangles = 0;
  Imath::Box3f bounds;
  for (const MeshEntry& entry : shapes.meshes) {
    triangles += entry.mesh.triangle_count();
    for (const Vec3f& p : entry.mesh.positions) bounds.extendBy(p);
  }
  if (triangles == 0) return count;
  std::mt19937_64 random(seed);
  const auto share = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  const Vec3d center(bounds.center()), extent(bounds.size());
  CrackRays shots(tracer, count);
  for (const MeshEntry& entry : shapes.meshes) {
    const TriangleMesh& mesh = entry.mesh;
    if (mesh.corners.empty()) continue;
    const auto of_mesh = static_cast<std::size_t>(static_cast<double>(rays) *
                                                  (static_cast<double>(mesh.triangle_count()) / double(triangles)));
    bool from_eye = false;
    for (const AimedEdge& edge : random_edges(mesh, of_mesh, random)) {
      if (!edge.beyond) continue;
      const std::uint32_t* const c = &mesh.corners[3 * edge.triangle];
      const Vec3d a(mesh.positions[c[edge.corner]]), b(mesh.positions[c[(edge.corner + 1) % 3]]);
      const Vec3d at = a + (b - a) * (kCornerShare + (1 - 2 * kCornerShare) * share());
      from_eye = !from_eye;
      const Vec3f from = from_eye ? eye
                                  : Vec3f(center + Vec3d(extent.x * (2 * share() - 1), extent.y * (2 * share() - 1),
                                                         extent.z * (2 * share() - 1)));
      const Vec3d toward = at - Vec3d(from);
      const double distance = toward.length();
      if (!(distance > 0)) continue;
      const Vec3d direction = toward / distance;
      const double one = normal_of(mesh, edge.triangle).dot(direction),
                   other = normal_of(mesh, *edge.beyond).dot(direction);
      if (!(std::min(one, other) > kLeastSine || std::max(one, other) < -kLeastSine)) continue;
      shots.add(from, Vec3f(direction), distance);
    }
  }
  return count;
}

std::int64_t open_edges(const ShapeSet& shapes) {
  std::int64_t count = 0;
  for (const MeshEntry& entry : shapes.meshes) count += count_open_edges(entry.mesh);
  return count;
}

}  // namespace raytree::benchmarks
