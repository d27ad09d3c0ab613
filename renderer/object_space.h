// The spaces that shapes are described in, before their own transform and before those of instances: what patterns and
// bumps that are carried with their shape are measured in. Looked at where a material has such a pattern and some shape
// that shows it is moved; all others are what they are in scene space.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "geometry/instance_transform.h"
#include "geometry/shape_set.h"
#include "renderer/footprint.h"
#include "renderer/scene_description.h"

namespace raytree {

class Scene;

/// The way from scene space to the own space of the shape that a hit lies on, and back. Lives no longer than the
/// ObjectSpaces that it is of.
class ObjectFrame {
 public:
  /// `shape` takes the shape's own space to that of its list; `instance` (null: none) the list's, a group's, to scene
  /// space.
  ObjectFrame(const InstanceTransform& shape, const Instance* instance);

  /// From scene space to the shape's own.
  Vec3d point(const Vec3f& position) const;
  Vec3d normal(const Vec3d& scene_normal) const;  ///< of any length
  Footprint footprint(const Footprint& covered) const;
  /// From the shape's own space back, by the inverse transpose; of any length. The outside stays outside, mirrored or
  /// not.
  Vec3d scene_normal(const Vec3d& normal) const;

 private:
  Vec3d vector(const Vec3d& v) const;

  const InstanceTransform& shape_;
  std::optional<InstanceTransform> instance_;
};

/// Where a solid pattern or a bump begins, and in which space.
class SolidOrigin {
 public:
  SolidOrigin() = default;
  /// `offset`: in that space. `scene_origin`: see ShapeSet::origin.
  SolidOrigin(SolidSpace space, const Vec3d& offset, const Vec3d& scene_origin)
      : follows_object_(space == SolidSpace::object), offset_(offset), scene_offset_(offset - scene_origin) {}

  bool follows_object() const { return follows_object_; }
  /// The frame of the hit's shape, or null where places are measured in scene space: it has none, or the pattern lies
  /// in the world.
  const ObjectFrame* frame(const ObjectFrame* of_hit) const { return follows_object_ ? of_hit : nullptr; }
  /// From the origin to a position in scene space, in double, so that patterns keep their digits far from the world's
  /// origin.
  Vec3d to(const Vec3f& position, const ObjectFrame* of_hit) const {
    const ObjectFrame* own = frame(of_hit);
    return own != nullptr ? own->point(position) - offset_ : Vec3d(position) - scene_offset_;
  }
  /// What a sample covers, in the space that places are measured in.
  Footprint window(const Footprint& covered, const ObjectFrame* of_hit) const {
    const ObjectFrame* own = frame(of_hit);
    return own != nullptr ? own->footprint(covered) : covered;
  }

 private:
  bool follows_object_ = false;
  Vec3d offset_{0, 0, 0}, scene_offset_{0, 0, 0};
};

/// A transform whose determinant is so much smaller than the products that it is made of flattens what it moves: its
/// inverse in double has an error above 2^-53 * 8 * kMostFlattening = 2^-20, and patterns would lose their place.
inline constexpr double kMostFlattening = 0x1p30;

/// The own spaces of a scene's shapes.
class ObjectSpaces {
 public:
  /// None: every shape's own space is the world.
  ObjectSpaces() = default;

  /// True where no shape that shows a pattern of its own space is moved.
  bool empty() const { return transforms_.empty(); }

  /// Of what `hit` lies on; nothing where its own space is the world. For hits on shapes whose material
  /// follows_objects.
  std::optional<ObjectFrame> at(const ShapeSet& shapes, const Hit& hit) const {
    const std::uint32_t index = transform_of_[shapes.shape_of(hit.geometry, hit.primitive, hit.instance)];
    if (index == kWorld) return std::nullopt;
    return ObjectFrame(transforms_[index], hit.instance == kNoInstance ? nullptr : &shapes.instances[hit.instance]);
  }

  friend ObjectSpaces find_object_spaces(const Scene& scene);

 private:
  static constexpr std::uint32_t kWorld = 0xffffffffu;

  std::vector<std::uint32_t> transform_of_;    ///< [shape] -> index into transforms_, or kWorld
  std::vector<InstanceTransform> transforms_;  ///< own space to that of the list
};

/// The own spaces of shapes that are moved and show a material which follows objects. The scene has its description,
/// shapes and materials. Throws Error (bad_input), naming the shape, where a transform cannot be undone.
ObjectSpaces find_object_spaces(const Scene& scene);

}  // namespace raytree
