#include "renderer/media.h"

#include <algorithm>
#include <limits>

#include "geometry/surface.h"

namespace raytree {
namespace {

constexpr std::size_t kMostSets = std::size_t(std::numeric_limits<MediaId>::max()) + 1;

/// Surfaces that shapes_around() looks through at most.
constexpr int kMostSurfaces = 1024;

}  // namespace

MediaTable::MediaTable(const Scene& scene) : scene_(scene) { clear(); }

void MediaTable::clear() {
  sets_.assign(1, Set());
  numbers_.clear();
  numbers_.emplace(std::vector<ShapeId>(), kNoMedia);
  known_.clear();
}

const Material& MediaTable::material_of(ShapeId shape) const { return scene_.materials[scene_.shape_materials[shape]]; }

MediaId MediaTable::set_of(std::span<const ShapeId> shapes) {
  std::vector<ShapeId> key(shapes.begin(), shapes.end());
  if (const auto found = numbers_.find(key); found != numbers_.end()) return found->second;
  if (sets_.size() == kMostSets) return kNoMedia;
  Set set;
  for (const ShapeId shape : key) {
    const Material& material = material_of(shape);
    if (set.medium == nullptr || material.priority >= set.medium->priority) set.medium = &material;
  }
  set.shapes = key;
  const auto id = static_cast<MediaId>(sets_.size());
  sets_.push_back(std::move(set));
  numbers_.emplace(std::move(key), id);
  return id;
}

MediaId MediaTable::entered(MediaId now, ShapeId shape) {
  std::vector<ShapeId> shapes = sets_[now].shapes;
  if (std::find(shapes.begin(), shapes.end(), shape) != shapes.end()) return now;
  shapes.push_back(shape);
  const MediaId id = set_of(shapes);
  return id == kNoMedia ? now : id;
}

MediaId MediaTable::left(MediaId now, ShapeId shape) {
  std::vector<ShapeId> shapes = sets_[now].shapes;
  shapes.erase(std::remove(shapes.begin(), shapes.end(), shape), shapes.end());
  const MediaId id = set_of(shapes);
  return id == kNoMedia && !shapes.empty() ? now : id;
}

MediaBoundary MediaTable::boundary(MediaId now, ShapeId shape, bool leaving) {
  const std::uint64_t key = std::uint64_t(shape) << 17 | std::uint64_t(now) << 1 | std::uint64_t(leaving);
  if (const auto found = known_.find(key); found != known_.end()) return found->second;
  const Material& material = material_of(shape);
  MediaBoundary result;
  result.before = result.after = now;
  if (material.has_inside) {
    result.before = leaving ? entered(now, shape) : now;
    result.after = leaving ? left(now, shape) : entered(now, shape);
    // Two shapes of one material are one medium where they overlap.
    result.passes = medium(result.before) == medium(result.after);
    result.relative_index = index(result.after) / index(result.before);
  } else {
    result.relative_index = material.index / index(now);
  }
  known_.emplace(key, result);
  return result;
}

Rgb MediaTable::transmitted(MediaId set, float distance) const {
  if (!absorbs(set)) return Rgb(1);
  const Rgb& a = sets_[set].medium->absorption;
  if (distance <= std::numeric_limits<float>::max()) return transmitted_share(a, distance);
  return {a.r > 0 ? 0.0f : 1.0f, a.g > 0 ? 0.0f : 1.0f, a.b > 0 ? 0.0f : 1.0f};
}

std::vector<ShapeId> shapes_around(const Scene& scene, const Vec3f& origin, const Vec3f& direction) {
  const ShapeSet& shapes = *scene.shapes;
  const auto has_inside = [&](ShapeId shape) { return scene.materials[scene.shape_materials[shape]].has_inside; };
  const auto holds = [](const std::vector<ShapeId>& list, ShapeId shape) {
    return std::find(list.begin(), list.end(), shape) != list.end();
  };
  // The shape that is left first was entered last.
  std::vector<ShapeId> entered, left;
  RayBatch ray(1);
  HitBatch hits(1);
  ray.size = 1;
  Vec3f from = origin;
  for (int surface = 0; surface < kMostSurfaces; ++surface) {
    ray.set(0, from, direction, std::numeric_limits<float>::infinity());
    scene.intersector->intersect(ray, Coherence::incoherent, hits);
    const Hit hit = hits[0];
    if (hit.geometry == kNoGeometry) break;
    const SurfacePoint point = surface_at(shapes, from, direction, hit, false);
    const bool leaving = direction.dot(point.geometric_normal) > 0;
    from = offset_origin(point, leaving ? point.geometric_normal : -point.geometric_normal);
    const ShapeId shape = shapes.shape_of(hit.geometry, hit.primitive);
    if (!has_inside(shape) || hit.geometry == kPlaneGeometry) continue;
    if (!leaving) {
      if (!holds(entered, shape)) entered.push_back(shape);
    } else if (holds(entered, shape)) {
      entered.erase(std::find(entered.begin(), entered.end(), shape));
    } else if (!holds(left, shape)) {
      left.push_back(shape);
    }
  }
  // What lies behind a plane has no end: planes come first.
  for (auto plane = shapes.planes.rbegin(); plane != shapes.planes.rend(); ++plane)
    if (has_inside(plane->shape) && (Vec3d(origin) - plane->point).dot(plane->normal) < 0) left.push_back(plane->shape);
  std::reverse(left.begin(), left.end());
  return left;
}

}  // namespace raytree
