// The scene's shapes and groups, each list assembled by shape_list.h, come together: nesting resolved, instances made,
// everything moved into scene space.
#include "renderer/shape_assembly.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "geometry/instance_transform.h"
#include "renderer/groups.h"
#include "renderer/shape_list.h"

namespace raytree {
namespace {

/// Where scene space begins: at the world's origin, unless the scene lies further from it than it is wide; then float
/// would lose digits, and its center serves.
Vec3d scene_origin(const Bounds3d& bounds) {
  if (bounds.isEmpty()) return {0, 0, 0};
  const Vec3d center = bounds.center(), size = bounds.size();
  const auto largest = [](const Vec3d& v) { return std::max(std::abs(v.x), std::max(std::abs(v.y), std::abs(v.z))); };
  return largest(center) > largest(size) ? center : Vec3d(0, 0, 0);
}
Bounds3d transformed_bounds(const Bounds3d& box, const Matrix44d& m) {
  Bounds3d result;
  for (int corner = 0; corner < 8; ++corner)
    result.extendBy(transformed_point(
        {corner & 1 ? box.max.x : box.min.x, corner & 2 ? box.max.y : box.min.y, corner & 4 ? box.max.z : box.min.z},
        m));
  return result;
}

constexpr const char* kTooManyInstances =
    "the groups within groups of this scene come to more than 50 million instances";

/// A group in a space of its own.
struct GroupAssembly {
  BoundedShapes shapes;
  std::vector<ShapeList::Use> uses;
  Bounds3d bounds;  ///< of its own shapes, in the group's coordinates
  bool has_shapes = false, has_round = false;
  std::uint64_t uses_in_all = 0;  ///< that one use of it comes to, itself included
  std::uint64_t triangles = 0, spheres = 0;
};

/// The groups that shapes use, directly or through others, assembled; and their uses, nesting resolved.
class GroupAssembler {
 public:
  GroupAssembler(SceneDescription& description, MeshMaterials& mesh_materials, const PrepareOptions& options,
                 Warnings& warnings)
      : description_(description),
        mesh_materials_(mesh_materials),
        options_(options),
        warnings_(warnings),
        groups_(description.groups.size()) {
    ShapeId first = static_cast<ShapeId>(description.shapes.size());
    for (const GroupDescription& group : description.groups) {
      first_shapes_.push_back(first);
      first += static_cast<ShapeId>(group.shapes.size());
    }
    summaries_.resize(groups_.size());
    done_.resize(groups_.size(), false);
  }

  /// Assembles what the scene's own shapes use, `uses`, directly or through groups: each group after all that use it,
  /// so that its curved shapes know where they stand. Cycles must have been refused. `uses` must outlive the assembler.
  void assemble(const std::vector<ShapeList::Use>& uses) {
    scene_uses_ = &uses;
    std::vector<bool> reached(groups_.size(), false);
    const auto reach = [&](const std::vector<ShapeList::Use>& list) {
      for (const ShapeList::Use& use : list) reached[use.group] = true;
    };
    reach(uses);
    const std::vector<std::uint32_t> order = users_first();
    for (const std::uint32_t index : order) {
      if (!reached[index]) continue;
      assemble(index);
      reach(groups_[index].uses);
    }
    for (auto index = order.rbegin(); index != order.rend(); ++index) {
      GroupAssembly& group = groups_[*index];
      group.uses_in_all = group.has_shapes ? 1 : 0;
      for (const ShapeList::Use& use : group.uses)
        group.uses_in_all = std::min(group.uses_in_all + groups_[use.group].uses_in_all, 2 * kMostInstances);
    }
  }

  /// Calls function(group index, transform) for each group with shapes that `use` comes to.
  template <class Function>
  void for_each(const ShapeList::Use& use, Function&& function) const {
    resolve(use.group, use.transform, function);
  }

  const GroupAssembly& operator[](std::size_t i) const { return groups_[i]; }

  /// How many uses with shapes `use` comes to, all others of the scene being `before`.
  std::uint64_t checked_count(const ShapeList::Use& use, std::uint64_t before, const SourceLocation& where) const {
    const std::uint64_t count = groups_[use.group].uses_in_all;
    require(count <= kMostInstances && before + count <= kMostInstances, kTooManyInstances, where);
    return count;
  }

  void hand_over(ShapeSet& shapes, SceneSummary& summary) {
    for (std::size_t i = 0; i < groups_.size(); ++i) {
      shapes.groups.push_back(std::move(groups_[i].shapes));
      if (!done_[i]) continue;
      summaries_[i].name = description_.groups[i].name;
      summary.groups.push_back(std::move(summaries_[i]));
    }
  }
  void count_use(std::uint32_t group) { ++summaries_[group].instances; }

 private:
  void assemble(std::uint32_t index) {
    done_[index] = true;
    GroupAssembly& group = groups_[index];
    std::vector<ShapeSummary>& shapes = summaries_[index].shapes;
    const ListPlaces places = [&](const std::function<void(const Matrix44d&)>& function) {
      std::uint64_t count = 0;  // groups in groups may come to more than anyone can wait for
      for_each_place(index, [&](const Matrix44d& place) {
        require(++count <= kMostInstances, kTooManyInstances, description_.groups[index].where);
        function(place);
      });
    };
    ShapeList list = assemble_list(description_.groups[index].shapes, first_shapes_[index], description_,
                                   mesh_materials_, places, options_, warnings_, shapes);
    for (std::size_t i = 0; i < shapes.size(); ++i) {
      shapes[i].id = 0;
      shapes[i].material = description_.groups[index].shapes[i].material;
      group.bounds.extendBy(shapes[i].bounds);
      group.triangles += shapes[i].triangles;
      group.spheres += shapes[i].spheres;
    }
    group.has_round = list.has_round();
    group.has_shapes = list.has_shapes();
    move_to_space(list, scene_origin(group.bounds), group.shapes);
    group.uses = std::move(list.uses);
  }

  /// All groups, each before those that it uses.
  std::vector<std::uint32_t> users_first() const {
    std::vector<std::uint32_t> order;
    std::vector<bool> seen(groups_.size(), false);
    const std::function<void(std::uint32_t)> visit = [&](std::uint32_t index) {
      if (seen[index]) return;
      seen[index] = true;
      for (const ShapeDescription& shape : description_.groups[index].shapes)
        if (const std::string& used = group_used_by(shape); !used.empty()) visit(group_index(description_, used));
      order.push_back(index);
    };
    for (std::uint32_t i = 0; i < groups_.size(); ++i) visit(i);
    std::reverse(order.begin(), order.end());
    return order;
  }

  /// Calls function(transform to the world) for each use of a group whose users are assembled.
  void for_each_place(std::uint32_t group, const std::function<void(const Matrix44d&)>& function) const {
    for (const ShapeList::Use& use : *scene_uses_)
      if (use.group == group) function(use.transform);
    for (std::uint32_t i = 0; i < groups_.size(); ++i)
      for (const ShapeList::Use& use : groups_[i].uses)
        if (use.group == group) for_each_place(i, [&](const Matrix44d& place) { function(use.transform * place); });
  }

  template <class Function>
  void resolve(std::uint32_t index, const Matrix44d& transform, Function& function) const {
    const GroupAssembly& group = groups_[index];
    if (group.has_shapes) function(index, transform);
    for (const ShapeList::Use& use : group.uses)
      if (groups_[use.group].uses_in_all > 0) resolve(use.group, use.transform * transform, function);
  }

  SceneDescription& description_;
  MeshMaterials& mesh_materials_;
  const PrepareOptions& options_;
  Warnings& warnings_;
  std::vector<GroupAssembly> groups_;
  std::vector<GroupSummary> summaries_;
  std::vector<ShapeId> first_shapes_;
  std::vector<bool> done_;
  const std::vector<ShapeList::Use>* scene_uses_ = nullptr;
};

/// `transform` takes the group's own space to scene space.
Instance make_instance(const Matrix44d& transform, const GroupAssembly& group, const std::string& group_name,
                       const SourceLocation& where) {
  Instance instance;
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 3; ++column)
      instance.to_scene[row][column] = static_cast<float>(transform[row][column]);
  const InstanceTransform single(instance);
  const double determinant = std::abs(single.determinant());
  const auto refuse = [&](const char* does, const char* how) {
    throw Error(ErrorKind::bad_input, where,
                std::string("the instance ") + does + " the group \"" + group_name + "\" " + how);
  };
  // NaN fails the comparisons.
  if (!(determinant >= kLeastDeterminant && determinant <= kMostDeterminant))
    refuse("scales", "by less than 1e-10 or more than 1e10");
  if (!(single.cancellation() <= kMostCancellation)) refuse("flattens", "so much that single precision cannot undo it");
  if (group.has_round)
    uniform_scale(transform, "an instance of the group \"" + group_name + "\", which holds spheres, discs or cones,",
                  where);
  return instance;
}

/// The instances of the scene and what they add to the bounds of their shapes, in world space.
void bound_instances(const ShapeList& assembly, const GroupAssembler& groups, const SceneDescription& description,
                     SceneSummary& summary) {
  for (const ShapeList::Use& use : assembly.uses) {
    ShapeSummary& shape = summary.shapes[use.shape];
    const SourceLocation& where = description.shapes[use.shape].where;
    summary.instances += groups.checked_count(use, summary.instances, where);
    groups.for_each(use, [&](std::uint32_t index, const Matrix44d& transform) {
      check_transform(transform, where);
      const GroupAssembly& group = groups[index];
      shape.bounds.extendBy(transformed_bounds(group.bounds, transform));
      ++shape.instances;
      shape.instanced_triangles += group.triangles;
      shape.instanced_spheres += group.spheres;
    });
    if (!shape.bounds.isEmpty())
      require(is_within_reach(shape.bounds.min) && is_within_reach(shape.bounds.max),
              "the instance reaches further than 1e12 units from the origin", where);
  }
}

void make_instances(const ShapeList& assembly, GroupAssembler& groups, const SceneDescription& description,
                    ShapeSet& shapes, SceneSummary& summary) {
  shapes.instances.reserve(summary.instances);
  auto next_object = static_cast<std::uint32_t>(description.shapes.size());
  Matrix44d to_scene;
  to_scene.setTranslation(-shapes.origin);
  std::vector<bool> seen(description.shapes.size(), false);
  for (const ShapeList::Use& use : assembly.uses)
    groups.for_each(use, [&](std::uint32_t index, const Matrix44d& transform) {
      Matrix44d from_origin;
      from_origin.setTranslation(groups[index].shapes.origin);
      Instance instance = make_instance(from_origin * transform * to_scene, groups[index],
                                        description.groups[index].name, description.shapes[use.shape].where);
      instance.group = index;
      instance.shape = use.shape;
      // The first use of a shape is the object of that shape's id; further ones follow all shapes.
      instance.object = seen[use.shape] ? next_object++ : use.shape;
      if (seen[use.shape] && summary.shapes[use.shape].first_extra_id == 0)
        summary.shapes[use.shape].first_extra_id = instance.object + 1;
      seen[use.shape] = true;
      shapes.instances.push_back(instance);
      groups.count_use(index);
    });
}

}  // namespace

ShapeSet assemble_shapes(SceneDescription& description, const Vec3d& eye, const PrepareOptions& options,
                         SceneSummary& summary, Warnings& warnings) {
  check_groups(description, [](const GroupDescription*, const ShapeDescription& shape, const std::string& message) {
    throw Error(ErrorKind::bad_input, shape.where, message);
  });
  MeshMaterials mesh_materials(description, warnings);
  ShapeList assembly =
      assemble_list(description.shapes, 0, description, mesh_materials, {}, options, warnings, summary.shapes);
  // Uses in the order of the shapes, whichever kind came first.
  std::stable_sort(assembly.uses.begin(), assembly.uses.end(),
                   [](const ShapeList::Use& a, const ShapeList::Use& b) { return a.shape < b.shape; });
  GroupAssembler groups(description, mesh_materials, options, warnings);
  groups.assemble(assembly.uses);
  bound_instances(assembly, groups, description, summary);
  for (const ShapeSummary& shape : summary.shapes)
    if (!shape.bounds.isInfinite()) summary.bounds.extendBy(shape.bounds);

  ShapeSet shapes;
  Bounds3d place = summary.bounds;
  if (place.isEmpty() && !assembly.planes.empty()) {
    // Planes have no bounds; where they are seen is where they are given and where the eye is.
    place.extendBy(eye);
    for (const Plane& plane : assembly.planes) place.extendBy(plane.point);
  }
  move_to_space(assembly, scene_origin(place), shapes);
  shapes.planes = std::move(assembly.planes);
  for (Plane& plane : shapes.planes) plane.point -= shapes.origin;
  make_instances(assembly, groups, description, shapes, summary);
  groups.hand_over(shapes, summary);
  summary.array_bytes = memory_bytes(shapes);
  return shapes;
}

}  // namespace raytree
