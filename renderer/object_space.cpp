#include "renderer/object_space.h"

#include <algorithm>
#include <cmath>

#include "geometry/error.h"
#include "renderer/groups.h"
#include "renderer/scene.h"

namespace raytree {
namespace {

/// Own space to that of a list which begins at `list_origin`.
InstanceTransform own_to_list(const Matrix44d& m, const Vec3d& list_origin) {
  const auto row = [&](int i) { return Vec3d(m[i][0], m[i][1], m[i][2]); };
  return {row(0), row(1), row(2), row(3) - list_origin};
}

}  // namespace

ObjectFrame::ObjectFrame(const InstanceTransform& shape, const Instance* instance) : shape_(shape) {
  if (instance != nullptr) instance_.emplace(*instance);
}

Vec3d ObjectFrame::point(const Vec3f& position) const {
  const Vec3d p(position);
  return shape_.point_inside(instance_ ? instance_->point_inside(p) : p);
}

Vec3d ObjectFrame::vector(const Vec3d& v) const {
  return shape_.vector_inside(instance_ ? instance_->vector_inside(v) : v);
}

Vec3d ObjectFrame::normal(const Vec3d& scene_normal) const {
  return shape_.normal_inside(instance_ ? instance_->normal_inside(scene_normal) : scene_normal);
}

Footprint ObjectFrame::footprint(const Footprint& covered) const {
  return {Vec3f(vector(Vec3d(covered.edge))), Vec3f(vector(Vec3d(covered.other_edge))), covered.leaves_edges};
}

Vec3d ObjectFrame::scene_normal(const Vec3d& normal) const {
  const Vec3d in_list = shape_.normal(normal);
  return instance_ ? instance_->normal(in_list) : in_list;
}

ObjectSpaces find_object_spaces(const Scene& scene) {
  ObjectSpaces spaces;
  const auto follows = [&](std::uint32_t material) { return scene.materials[material].follows_objects; };
  if (std::none_of(scene.materials.begin(), scene.materials.end(), [](const Material& m) { return m.follows_objects; }))
    return spaces;

  const ShapeSet& set = *scene.shapes;
  std::vector<bool> shows(scene.shape_materials.size());  // [shape] a material that follows objects
  for (std::size_t i = 0; i < shows.size(); ++i)
    shows[i] = scene.shape_materials[i] != kOwnMaterials && follows(scene.shape_materials[i]);
  const auto note_tags = [&](const BoundedShapes& list) {
    for (const MeshEntry& entry : list.meshes)
      if (!shows[entry.shape])
        shows[entry.shape] = std::any_of(entry.triangle_tags.begin(), entry.triangle_tags.end(),
                                         [&](std::uint32_t tag) { return tag != kNoTag && follows(tag); });
  };
  note_tags(set);
  for (const BoundedShapes& group : set.groups) note_tags(group);
  std::vector<bool> all_show(set.groups.size());  // [group] some instance gives its shapes such a material
  for (const Instance& instance : set.instances)
    if (shows[instance.shape]) all_show[instance.group] = true;

  const auto add = [&](const ShapeDescription& shape, const BoundedShapes& list, bool is_moved, bool is_overridden) {
    const std::size_t id = spaces.transform_of_.size();
    spaces.transform_of_.push_back(ObjectSpaces::kWorld);
    if (!is_moved || !group_used_by(shape).empty() || !(shows[id] || is_overridden)) return;
    const InstanceTransform transform = own_to_list(shape.transform, list.origin);
    // NaN, of a determinant made of nothing, fails the comparison.
    if (!std::isnormal(transform.determinant()) || !(transform.cancellation() <= kMostFlattening))
      throw Error(ErrorKind::bad_input, shape.where,
                  "the transform flattens the shape, and nothing is left of the space that its pattern or bump lies "
                  "in; with \"space\": \"world\" they lie in the world");
    spaces.transform_of_.back() = static_cast<std::uint32_t>(spaces.transforms_.size());
    spaces.transforms_.push_back(transform);
  };
  for (const ShapeDescription& shape : scene.description.shapes) add(shape, set, shape.transform != Matrix44d(), false);
  for (std::size_t i = 0; i < set.groups.size(); ++i)
    for (const ShapeDescription& shape : scene.description.groups[i].shapes)
      add(shape, set.groups[i], !set.groups[i].empty(), all_show[i]);
  return spaces;
}

}  // namespace raytree
