// Overlapping media: which of them a ray is in, and what a surface separates, by priority (Schmidt and Budge 2002,
// "Simple Nested Dielectrics in Ray Traced Images"). Used only where some material sets a priority; else a surface
// separates its own inside from empty space, and nobody needs to know where a ray is.
#pragma once

#include <compare>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "geometry/shape_set.h"
#include "renderer/scene.h"

namespace raytree {

/// What a ray can be inside of: a shape, or one of a group's in one instance; where a mesh has several materials, one
/// of them.
struct Solid {
  std::uint32_t object = 0;  ///< see FirstHit::object, less one
  ShapeId shape = 0;
  std::uint32_t material = 0;  ///< index into the scene's

  auto operator<=>(const Solid&) const = default;
};

inline Solid solid_at(const Scene& scene, const Hit& hit) {
  const ShapeId shape = scene.shapes->shape_of(hit.geometry, hit.primitive, hit.instance);
  const std::uint32_t object = hit.instance == kNoInstance ? shape : scene.shapes->instances[hit.instance].object;
  return {object, shape, scene.material_at(hit)};
}

/// A set of solids that a ray is inside of, by its number in a MediaTable. 0: of none.
using MediaId = std::uint16_t;
inline constexpr MediaId kNoMedia = 0;

/// What a surface separates.
struct MediaBoundary {
  MediaId before = kNoMedia, after = kNoMedia;
  float relative_index = 1;  ///< of the medium behind it over that before it; of a thin sheet, over what surrounds it
  bool passes = false;       ///< the same medium on both sides: the ray goes on as if nothing was there
};

/// The sets that the rays of a batch of samples are in. At most 65,535: a ray that enters or leaves a solid beyond that
/// keeps the set that it has. Which numbers sets get, and so what happens then, depends on the batch alone.
class MediaTable {
 public:
  /// `scene` must outlive it.
  explicit MediaTable(const Scene& scene);

  /// Forgets all sets but the empty one.
  void clear();

  /// The set of `solids`, in the order in which they were entered.
  MediaId set_of(std::span<const Solid> solids);

  /// A ray in `now` meets `solid`, from its inside if `leaving`. Entering a solid that the ray is in, or leaving one
  /// twice, is what a shared edge does that is hit on both sides: the first has no effect; a ray that leaves a solid
  /// without having entered it was in it all along.
  MediaBoundary boundary(MediaId now, const Solid& solid, bool leaving);

  /// The medium of the highest priority, of equal ones that entered last; null: empty space.
  const Material* medium(MediaId set) const { return sets_[set].medium; }
  float index(MediaId set) const { return sets_[set].medium != nullptr ? sets_[set].medium->index : 1.0f; }
  /// What is left of light after `distance` in the set's medium; infinity: of what leaves the scene.
  Rgb transmitted(MediaId set, float distance) const;
  bool absorbs(MediaId set) const { return sets_[set].medium != nullptr && sets_[set].medium->absorbs; }

 private:
  struct Set {
    std::vector<Solid> solids;  ///< in the order in which they were entered
    const Material* medium = nullptr;
  };
  struct Crossing {
    Solid solid;
    MediaId now;
    bool leaving;
    auto operator<=>(const Crossing&) const = default;
  };
  const Material& material_of(const Solid& solid) const { return scene_.materials[solid.material]; }
  MediaId entered(MediaId now, const Solid& solid);
  MediaId left(MediaId now, const Solid& solid);

  const Scene& scene_;
  std::vector<Set> sets_;
  std::map<std::vector<Solid>, MediaId> numbers_;
  std::map<Crossing, MediaBoundary> known_;
};

/// The solids with an inside that `origin` lies in, in the order in which they would have been entered, as a ray from
/// there along unit `direction` tells that leaves some of them without having entered; planes are judged by their side.
std::vector<Solid> solids_around(const Scene& scene, const Vec3f& origin, const Vec3f& direction);

/// The same as three rays tell, of which two must agree: a single one is wrong where it meets two surfaces in one
/// place, as a view along a plane of symmetry does. `forward`: unit.
std::vector<Solid> solids_around_eye(const Scene& scene, const Vec3f& eye, const Vec3f& forward);

}  // namespace raytree
