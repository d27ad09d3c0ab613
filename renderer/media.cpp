#include "renderer/media.h"

#include <algorithm>
#include <limits>

#include "renderer/hit_surface.h"

namespace raytree {
namespace {

constexpr std::size_t kMostSets = std::size_t(std::numeric_limits<MediaId>::max()) + 1;

/// Surfaces that solids_around() looks through at most.
constexpr int kMostSurfaces = 1024;

}  // namespace

MediaTable::MediaTable(const Scene& scene) : scene_(scene) { clear(); }

void MediaTable::clear() {
  sets_.assign(1, Set());
  numbers_.clear();
  numbers_.emplace(std::vector<Solid>(), kNoMedia);
  known_.clear();
}

MediaId MediaTable::set_of(std::span<const Solid> solids) {
  std::vector<Solid> key(solids.begin(), solids.end());
  if (const auto found = numbers_.find(key); found != numbers_.end()) return found->second;
  if (sets_.size() == kMostSets) return kNoMedia;
  Set set;
  for (const Solid& solid : key) {
    const Material& material = material_of(solid);
    if (set.medium == nullptr || material.priority >= set.medium->priority) set.medium = &material;
  }
  set.solids = key;
  const auto id = static_cast<MediaId>(sets_.size());
  sets_.push_back(std::move(set));
  numbers_.emplace(std::move(key), id);
  return id;
}

MediaId MediaTable::entered(MediaId now, const Solid& solid) {
  std::vector<Solid> solids = sets_[now].solids;
  if (std::find(solids.begin(), solids.end(), solid) != solids.end()) return now;
  solids.push_back(solid);
  const MediaId id = set_of(solids);
  return id == kNoMedia ? now : id;
}

MediaId MediaTable::left(MediaId now, const Solid& solid) {
  std::vector<Solid> solids = sets_[now].solids;
  solids.erase(std::remove(solids.begin(), solids.end(), solid), solids.end());
  const MediaId id = set_of(solids);
  return id == kNoMedia && !solids.empty() ? now : id;
}

MediaBoundary MediaTable::boundary(MediaId now, const Solid& solid, bool leaving) {
  const Crossing key{solid, now, leaving};
  if (const auto found = known_.find(key); found != known_.end()) return found->second;
  const Material& material = material_of(solid);
  MediaBoundary result;
  result.before = result.after = now;
  if (material.has_inside) {
    result.before = leaving ? entered(now, solid) : now;
    result.after = leaving ? left(now, solid) : entered(now, solid);
    // Two solids of one material are one medium where they overlap.
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

std::vector<Solid> solids_around(const Scene& scene, const Vec3f& origin, const Vec3f& direction) {
  const ShapeSet& shapes = *scene.shapes;
  const auto holds = [](const std::vector<Solid>& list, const Solid& solid) {
    return std::find(list.begin(), list.end(), solid) != list.end();
  };
  // The solid that is left first was entered last.
  std::vector<Solid> entered, left;
  RayBatch ray(1);
  HitBatch hits(1);
  ray.size = 1;
  Vec3f from = origin;
  for (int surface = 0; surface < kMostSurfaces; ++surface) {
    ray.set(0, from, direction, std::numeric_limits<float>::infinity());
    scene.intersector->intersect(ray, Coherence::incoherent, hits);
    const Hit hit = hits[0];
    if (hit.geometry == kNoGeometry) break;
    const SurfacePoint point = hit_surface(scene, from, direction, hit);
    const bool leaving = direction.dot(point.geometric_normal) > 0;
    from = offset_origin(point, leaving ? point.geometric_normal : -point.geometric_normal);
    const Solid solid = solid_at(scene, hit);
    if (!scene.materials[solid.material].has_inside || hit.geometry == kPlaneGeometry) continue;
    if (!leaving) {
      if (!holds(entered, solid)) entered.push_back(solid);
    } else if (holds(entered, solid)) {
      entered.erase(std::find(entered.begin(), entered.end(), solid));
    } else if (!holds(left, solid)) {
      left.push_back(solid);
    }
  }
  // What lies behind a plane has no end: planes come first.
  for (auto plane = shapes.planes.rbegin(); plane != shapes.planes.rend(); ++plane) {
    const std::uint32_t material = scene.shape_materials[plane->shape];
    if (scene.materials[material].has_inside && (Vec3d(origin) - plane->point).dot(plane->normal) < 0)
      left.push_back({plane->shape, plane->shape, material});
  }
  std::reverse(left.begin(), left.end());
  return left;
}

std::vector<Solid> solids_around_eye(const Scene& scene, const Vec3f& eye, const Vec3f& forward) {
  // Off the line of sight by about 20 degrees, in directions that have nothing to do with a scene's axes.
  const std::vector<Solid> told[3] = {solids_around(scene, eye, forward),
                                      solids_around(scene, eye, unit(forward + Vec3f(0.223f, 0.179f, -0.247f))),
                                      solids_around(scene, eye, unit(forward + Vec3f(-0.191f, 0.253f, 0.207f)))};
  std::vector<Solid> around;
  for (const std::vector<Solid>& list : told)
    for (const Solid& solid : list) {
      const auto holds = [&](const std::vector<Solid>& other) {
        return std::find(other.begin(), other.end(), solid) != other.end();
      };
      if (!holds(around) && std::count_if(std::begin(told), std::end(told), holds) >= 2) around.push_back(solid);
    }
  return around;
}

}  // namespace raytree
