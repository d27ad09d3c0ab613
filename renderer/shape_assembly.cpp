#include "renderer/shape_assembly.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <numbers>
#include <utility>

#include "geometry/instance_transform.h"
#include "geometry/mesh_file.h"
#include "geometry/sphere_flake.h"
#include "geometry/terrain.h"
#include "geometry/tree.h"
#include "geometry/triangulation.h"
#include "geometry/vertex_normals.h"
#include "renderer/groups.h"
#include "renderer/scatter.h"

namespace raytree {
namespace {

constexpr std::size_t kGrain = 65536;

template <class Function>
void for_each_index(std::size_t count, Function&& function) {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, kGrain), [&](const auto& range) {
    for (std::size_t i = range.begin(); i != range.end(); ++i) function(i);
  });
}

Vec3d transformed_point(const Vec3d& point, const Matrix44d& m) { return point * m; }

Vec3d transformed_vector(const Vec3d& vector, const Matrix44d& m) {
  Vec3d result;
  m.multDirMatrix(vector, result);
  return result;
}

/// Normals go by the inverse transpose of the linear part.
Vec3d transformed_normal(const Vec3d& normal, const Matrix44d& inverse_transpose) {
  return unit(transformed_vector(normal, inverse_transpose));
}

/// Embree's arithmetic holds up to such coordinates (the catalogue of its failures: distances go wrong from 1e15 on).
constexpr double kLargestCoordinate = 1e12;

bool is_within_reach(const Vec3d& v) {
  // NaN fails every comparison.
  return std::abs(v.x) <= kLargestCoordinate && std::abs(v.y) <= kLargestCoordinate &&
         std::abs(v.z) <= kLargestCoordinate;
}

void require(bool holds, const char* message, const SourceLocation& where) {
  if (!holds) throw Error(ErrorKind::bad_input, where, message);
}

void check_transform(const Matrix44d& m, const SourceLocation& where) {
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column)
      require(std::isfinite(m[row][column]), "the transform holds a number that is not finite", where);
}

/// The unit normal of a plane or disc as its description has it, in the world.
Vec3d checked_normal(const Vec3d& normal, const Matrix44d& transform, const SourceLocation& where) {
  Vec3d world = transformed_vector(normal, transform.inverse().transposed());
  const double length = world.length();
  require(length > 0 && std::isfinite(length), "a normal needs a direction, and numbers that are finite", where);
  return world / length;
}

bool mirrors(const Matrix44d& m) { return m.determinant() < 0; }

/// The factor of a transform that scales all directions alike; throws for any other.
double uniform_scale(const Matrix44d& m, const std::string& kind, const SourceLocation& where) {
  const Vec3d x(m[0][0], m[0][1], m[0][2]), y(m[1][0], m[1][1], m[1][2]), z(m[2][0], m[2][1], m[2][2]);
  const double scale = x.length();
  const double tolerance = 1e-9 * scale * scale;
  const bool uniform = std::abs(x.dot(x) - y.dot(y)) <= tolerance && std::abs(x.dot(x) - z.dot(z)) <= tolerance &&
                       std::abs(x.dot(y)) <= tolerance && std::abs(x.dot(z)) <= tolerance &&
                       std::abs(y.dot(z)) <= tolerance;
  if (!uniform || !(scale > 0))
    throw Error(ErrorKind::bad_input, where, kind + " takes a transform with one scale for all axes");
  return scale;
}

void transform_mesh(TriangleMesh& mesh, const Matrix44d& m) {
  if (m == Matrix44d()) return;
  mesh.origin = transformed_point(mesh.origin, m);
  for_each_index(mesh.positions.size(),
                 [&](std::size_t i) { mesh.positions[i] = Vec3f(transformed_vector(Vec3d(mesh.positions[i]), m)); });
  const Matrix44d inverse_transpose = m.inverse().transposed();
  for_each_index(mesh.normals.size(), [&](std::size_t i) {
    mesh.normals[i] = Vec3f(transformed_normal(Vec3d(mesh.normals[i]), inverse_transpose));
  });
  if (!mirrors(m)) return;
  // A mirrored triangle is wound the other way round.
  const auto reverse = [](Buffer<std::uint32_t>& corners) {
    for_each_index(corners.size() / 3, [&](std::size_t i) { std::swap(corners[3 * i + 1], corners[3 * i + 2]); });
  };
  // Arrays indexed per position are reversed with the corners.
  reverse(mesh.corners);
  reverse(mesh.normal_corners);
  reverse(mesh.texture_corners);
}

/// A list of shapes in the space of the world or of its group, in double, until that space's origin is known.
struct Assembly {
  std::vector<MeshEntry> meshes;
  struct WorldSphere {
    Vec3d center;
    double radius;
    ShapeId shape;
  };
  std::vector<WorldSphere> spheres;
  struct Flake {
    SphereArrays arrays;
    Matrix44d transform;
    double scale;
    ShapeId shape;
  };
  std::vector<Flake> flakes;
  struct WorldDisc {
    Vec3d center, normal;
    double radius;
    ShapeId shape;
  };
  std::vector<WorldDisc> discs;
  std::vector<Plane> planes;
  struct Use {
    std::uint32_t group;
    Matrix44d transform;
    ShapeId shape;
  };
  std::vector<Use> uses;  ///< of groups; those of one shape stand together

  bool has_round() const { return !spheres.empty() || !flakes.empty() || !discs.empty(); }
  bool has_shapes() const { return has_round() || !meshes.empty(); }
};

void count_faces(const PolygonMesh& mesh, ShapeSummary& summary) {
  if (mesh.all_triangles()) {
    summary.faces_by_size[0] = mesh.face_count();
    return;
  }
  for (const std::uint32_t size : mesh.face_sizes) ++summary.faces_by_size[size == 3 ? 0 : size == 4 ? 1 : 2];
}

void apply_normal_source(PolygonMesh& mesh, const MeshShape& shape, const SourceLocation& where, Warnings& warnings) {
  const bool from_file = shape.normals == NormalSource::file && !mesh.normals.empty();
  if (from_file) {
    if (const std::int64_t replaced = normalize_vertex_normals(mesh); replaced > 0)
      warnings.push_back({where, "normals of no length replaced by their face's", replaced});
    return;
  }
  mesh.normals = {};
  mesh.normal_corners = {};
  if (shape.normals != NormalSource::flat) compute_vertex_normals(mesh, shape.crease_angle * std::numbers::pi / 180);
}

/// Fills the assembly of one list of shapes.
class Assembler {
 public:
  Assembler(const SceneDescription& scene, const PrepareOptions& options, Warnings& warnings)
      : scene_(scene), options_(options), warnings_(warnings) {}

  Assembly assembly;

  /// The list's shapes are ShapeId `first` and following ones.
  void add_all(std::vector<ShapeDescription>& shapes, ShapeId first, std::vector<ShapeSummary>& summaries) {
    summaries.resize(shapes.size());
    // What is scattered needs the ground that it stands on.
    for (const bool scatters : {false, true})
      for (std::size_t i = 0; i < shapes.size(); ++i) {
        if (std::holds_alternative<ScatterShape>(shapes[i].kind) != scatters) continue;
        if (options_.stop != nullptr && options_.stop->load()) throw Error(ErrorKind::failure, {}, "interrupted");
        list_ = &shapes, first_ = first;
        add(shapes[i], first + static_cast<ShapeId>(i), summaries[i]);
      }
  }

 private:
  void add(ShapeDescription& shape, ShapeId id, ShapeSummary& summary) {
    summary.name = shape.name;
    summary.id = id + 1;
    check_transform(shape.transform, shape.where);
    std::visit([&](auto& kind) { add_kind(kind, shape, id, summary); }, shape.kind);
    if (!summary.bounds.isInfinite() && !summary.bounds.isEmpty())
      require(is_within_reach(summary.bounds.min) && is_within_reach(summary.bounds.max),
              "the shape reaches further than 1e12 units from the origin", shape.where);
  }

  void add_mesh(TriangleMesh&& mesh, const ShapeDescription& shape, ShapeId id, ShapeSummary& summary) {
    transform_mesh(mesh, shape.transform);
    summary.triangles = mesh.triangle_count();
    PolygonMesh view;  // bounds() asks for positions and origin alone
    view.origin = mesh.origin;
    view.positions.swap(mesh.positions);
    summary.bounds = bounds(view);
    view.positions.swap(mesh.positions);
    assembly.meshes.push_back({std::move(mesh), id});
  }

  void add_kind(MeshShape& kind, const ShapeDescription& shape, ShapeId id, ShapeSummary& summary) {
    summary.kind = "mesh";
    std::shared_ptr<PolygonMesh> mesh = std::move(kind.mesh);
    if (!mesh) {
      const std::filesystem::path path = std::filesystem::path(scene_.folder) / kind.file;
      begin_phase("reading " + kind.file);
      try {
        mesh = std::make_shared<PolygonMesh>(read_mesh_file(path.string(), warnings_));
      } catch (const Error& error) {
        // A file that cannot be had is the scene's mistake: say where the scene names it.
        if (std::filesystem::exists(path) || shape.where.file.empty()) throw;
        throw Error(error.kind(), shape.where, error.what());
      }
    }
    begin_phase("preparing " + shape.name);
    count_faces(*mesh, summary);
    apply_normal_source(*mesh, kind, shape.where, warnings_);
    add_mesh(triangulate(std::move(*mesh), shape.where, warnings_), shape, id, summary);
  }

  void add_kind(TerrainShape& kind, const ShapeDescription& shape, ShapeId id, ShapeSummary& summary) {
    summary.kind = "terrain";
    begin_phase("generating " + shape.name);
    TriangleMesh mesh = make_terrain({kind.triangles, kind.size, kind.height, kind.roughness, kind.seed});
    summary.faces_by_size[0] = mesh.triangle_count();
    add_mesh(std::move(mesh), shape, id, summary);
  }

  void add_kind(SphereShape& kind, const ShapeDescription& shape, ShapeId id, ShapeSummary& summary) {
    summary.kind = "sphere";
    summary.spheres = 1;
    const Vec3d center = transformed_point(kind.center, shape.transform);
    const double radius = kind.radius * uniform_scale(shape.transform, "a sphere", shape.where);
    require(radius > 0, "a radius must be larger than 0", shape.where);
    summary.bounds = {center - Vec3d(radius), center + Vec3d(radius)};
    assembly.spheres.push_back({center, radius, id});
  }

  void add_kind(SphereFlakeShape& kind, const ShapeDescription& shape, ShapeId id, ShapeSummary& summary) {
    summary.kind = "sphere_flake";
    begin_phase("generating " + shape.name);
    const SphereFlakeParameters parameters{kind.levels, kind.center, kind.radius};
    Assembly::Flake flake{make_sphere_flake(parameters), shape.transform,
                          uniform_scale(shape.transform, "a sphere flake", shape.where), id};
    summary.spheres = flake.arrays.sphere_count();
    for (std::size_t i = 0; i < flake.arrays.sphere_count(); ++i) {
      const Vec3d center = transformed_point(flake.arrays.origin + Vec3d(flake.arrays.centers[i]), shape.transform);
      const Vec3d reach(flake.arrays.radii[i] * flake.scale);
      summary.bounds.extendBy(center - reach);
      summary.bounds.extendBy(center + reach);
    }
    assembly.flakes.push_back(std::move(flake));
  }

  void add_kind(PlaneShape& kind, const ShapeDescription& shape, ShapeId id, ShapeSummary& summary) {
    summary.kind = "plane";
    const Vec3d normal = checked_normal(kind.normal, shape.transform, shape.where);
    summary.bounds.makeInfinite();
    require(is_within_reach(transformed_point(kind.point, shape.transform)),
            "the plane lies further than 1e12 units from the origin", shape.where);
    assembly.planes.push_back({transformed_point(kind.point, shape.transform), normal, id});
  }

  void add_kind(DiscShape& kind, const ShapeDescription& shape, ShapeId id, ShapeSummary& summary) {
    summary.kind = "disc";
    const double scale = uniform_scale(shape.transform, "a disc", shape.where);
    const Vec3d center = transformed_point(kind.center, shape.transform);
    const Vec3d normal = checked_normal(kind.normal, shape.transform, shape.where);
    const double radius = kind.radius * scale;
    require(radius > 0, "a radius must be larger than 0", shape.where);
    const auto reach = [&](double n) { return radius * std::sqrt(std::max(0.0, 1 - n * n)); };
    const Vec3d half(reach(normal.x), reach(normal.y), reach(normal.z));
    summary.bounds = {center - half, center + half};
    assembly.discs.push_back({center, normal, radius, id});
  }

  void add_kind(TreeShape& kind, const ShapeDescription& shape, ShapeId id, ShapeSummary& summary) {
    summary.kind = "tree";
    begin_phase("growing " + shape.name);
    const TreeParameters parameters{kind.species == TreeSpecies::conifer ? TreeForm::conifer : TreeForm::broadleaf,
                                    kind.height, kind.leaves, kind.leaf_size, kind.seed};
    TriangleMesh mesh = kind.part == TreePart::wood ? make_tree_wood(parameters) : make_tree_leaves(parameters);
    summary.faces_by_size[0] = mesh.triangle_count();
    add_mesh(std::move(mesh), shape, id, summary);
  }

  void add_kind(InstanceShape& kind, const ShapeDescription& shape, ShapeId id, ShapeSummary& summary) {
    summary.kind = "instance";
    assembly.uses.push_back({group_index(scene_, kind.group), shape.transform, id});
  }

  void add_kind(ScatterShape& kind, const ShapeDescription& shape, ShapeId id, ShapeSummary& summary) {
    summary.kind = "scatter";
    begin_phase("placing " + shape.name);
    std::size_t ground = 0;
    while ((*list_)[ground].name != kind.terrain || !std::holds_alternative<TerrainShape>((*list_)[ground].kind))
      ++ground;
    const auto entry = std::find_if(assembly.meshes.begin(), assembly.meshes.end(),
                                    [&](const MeshEntry& mesh) { return mesh.shape == first_ + ground; });
    const std::uint32_t group = group_index(scene_, kind.group);
    const TerrainGrid grid = terrain_grid(std::get<TerrainShape>((*list_)[ground].kind).triangles);
    const std::vector<Matrix44d> places = scattered(kind, entry->mesh, grid);
    if (static_cast<std::int64_t>(places.size()) < kind.count)
      warnings_.push_back({shape.where, "the terrain has no more places that suit: fewer uses than asked for",
                           kind.count - static_cast<std::int64_t>(places.size())});
    for (const Matrix44d& place : places) assembly.uses.push_back({group, place * shape.transform, id});
  }

  void begin_phase(const std::string& text) const {
    if (options_.on_phase) options_.on_phase(text);
  }

  const std::vector<ShapeDescription>* list_ = nullptr;  ///< under way
  ShapeId first_ = 0;
  const SceneDescription& scene_;
  const PrepareOptions& options_;
  Warnings& warnings_;
};

/// Where scene space begins: at the world's origin, unless the scene lies further from it than it is wide; then float
/// would lose digits, and its center serves.
Vec3d scene_origin(const Bounds3d& bounds) {
  if (bounds.isEmpty()) return {0, 0, 0};
  const Vec3d center = bounds.center(), size = bounds.size();
  const auto largest = [](const Vec3d& v) { return std::max(std::abs(v.x), std::max(std::abs(v.y), std::abs(v.z))); };
  return largest(center) > largest(size) ? center : Vec3d(0, 0, 0);
}

/// Moves all but planes to a space that begins at `origin`.
void move_to_space(Assembly& assembly, const Vec3d& origin, BoundedShapes& shapes) {
  for (MeshEntry& entry : assembly.meshes) {
    const Vec3d shift = entry.mesh.origin - origin;
    if (shift != Vec3d(0, 0, 0))
      for_each_index(entry.mesh.positions.size(),
                     [&](std::size_t i) { entry.mesh.positions[i] = Vec3f(Vec3d(entry.mesh.positions[i]) + shift); });
    entry.mesh.origin = {0, 0, 0};
  }
  shapes.meshes = std::move(assembly.meshes);

  SphereArray& spheres = shapes.spheres;
  const auto add_sphere = [&](const Vec3d& center, double radius, ShapeId shape) {
    const Vec3f c(center - origin);
    spheres.center_radius.push_back({c.x, c.y, c.z, static_cast<float>(radius)});
    spheres.shape.push_back(shape);
  };
  std::size_t count = assembly.spheres.size();
  for (const auto& flake : assembly.flakes) count += flake.arrays.sphere_count();
  spheres.center_radius.reserve(count);
  spheres.shape.reserve(count);
  for (const auto& sphere : assembly.spheres) add_sphere(sphere.center, sphere.radius, sphere.shape);
  for (const auto& flake : assembly.flakes)
    for (std::size_t i = 0; i < flake.arrays.sphere_count(); ++i)
      add_sphere(transformed_point(flake.arrays.origin + Vec3d(flake.arrays.centers[i]), flake.transform),
                 flake.arrays.radii[i] * flake.scale, flake.shape);

  for (const auto& disc : assembly.discs) {
    const Vec3f c(disc.center - origin);
    shapes.discs.center_radius.push_back({c.x, c.y, c.z, static_cast<float>(disc.radius)});
    shapes.discs.normal.push_back(Vec3f(disc.normal));
    shapes.discs.shape.push_back(disc.shape);
  }
}

Bounds3d transformed_bounds(const Bounds3d& box, const Matrix44d& m) {
  Bounds3d result;
  for (int corner = 0; corner < 8; ++corner)
    result.extendBy(transformed_point(
        {corner & 1 ? box.max.x : box.min.x, corner & 2 ? box.max.y : box.min.y, corner & 4 ? box.max.z : box.min.z},
        m));
  return result;
}

/// A group in a space of its own.
struct GroupAssembly {
  BoundedShapes shapes;
  std::vector<Assembly::Use> uses;
  Bounds3d bounds;  ///< of its own shapes, in the group's coordinates
  Vec3d origin;     ///< where its shapes' space begins, in the group's coordinates
  bool has_shapes = false, has_round = false;
  std::uint64_t uses_in_all = 0;  ///< that one use of it comes to, itself included
  std::uint64_t triangles = 0, spheres = 0;
};

/// The groups that shapes use, directly or through others, assembled; and their uses, nesting resolved.
class GroupAssembler {
 public:
  GroupAssembler(SceneDescription& description, const PrepareOptions& options, Warnings& warnings)
      : description_(description), options_(options), warnings_(warnings), groups_(description.groups.size()) {
    ShapeId first = static_cast<ShapeId>(description.shapes.size());
    for (const GroupDescription& group : description.groups) {
      first_shapes_.push_back(first);
      first += static_cast<ShapeId>(group.shapes.size());
    }
    summaries_.resize(groups_.size());
    done_.resize(groups_.size(), false);
  }

  /// Assembles what `uses` refer to. Cycles must have been refused.
  void assemble(const std::vector<Assembly::Use>& uses) {
    for (const Assembly::Use& use : uses)
      if (!done_[use.group]) assemble(use.group);
  }

  /// Calls function(group index, transform) for each group with shapes that `use` comes to.
  template <class Function>
  void for_each(const Assembly::Use& use, Function&& function) const {
    resolve(use.group, use.transform, function);
  }

  const GroupAssembly& operator[](std::size_t i) const { return groups_[i]; }

  /// How many uses with shapes `use` comes to, all others of the scene being `before`.
  std::uint64_t checked_count(const Assembly::Use& use, std::uint64_t before, const SourceLocation& where) const {
    const std::uint64_t count = groups_[use.group].uses_in_all;
    require(count <= kMostInstances && before + count <= kMostInstances,
            "the groups within groups of this scene come to more than 50 million instances", where);
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
    Assembler assembler(description_, options_, warnings_);
    std::vector<ShapeSummary>& shapes = summaries_[index].shapes;
    assembler.add_all(description_.groups[index].shapes, first_shapes_[index], shapes);
    for (std::size_t i = 0; i < shapes.size(); ++i) {
      shapes[i].id = 0;
      shapes[i].material = description_.groups[index].shapes[i].material;
      group.bounds.extendBy(shapes[i].bounds);
      group.triangles += shapes[i].triangles;
      group.spheres += shapes[i].spheres;
    }
    group.has_round = assembler.assembly.has_round();
    group.has_shapes = assembler.assembly.has_shapes();
    group.origin = scene_origin(group.bounds);
    move_to_space(assembler.assembly, group.origin, group.shapes);
    group.uses = std::move(assembler.assembly.uses);
    assemble(group.uses);
    group.uses_in_all = group.has_shapes ? 1 : 0;
    for (const Assembly::Use& use : group.uses)
      group.uses_in_all = std::min(group.uses_in_all + groups_[use.group].uses_in_all, 2 * kMostInstances);
  }

  template <class Function>
  void resolve(std::uint32_t index, const Matrix44d& transform, Function& function) const {
    const GroupAssembly& group = groups_[index];
    if (group.has_shapes) function(index, transform);
    for (const Assembly::Use& use : group.uses)
      if (groups_[use.group].uses_in_all > 0) resolve(use.group, use.transform * transform, function);
  }

  SceneDescription& description_;
  const PrepareOptions& options_;
  Warnings& warnings_;
  std::vector<GroupAssembly> groups_;
  std::vector<GroupSummary> summaries_;
  std::vector<ShapeId> first_shapes_;
  std::vector<bool> done_;
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
    uniform_scale(transform, "an instance of the group \"" + group_name + "\", which holds spheres or discs,", where);
  return instance;
}

/// The instances of the scene and what they add to the bounds of their shapes, in world space.
void bound_instances(const Assembly& assembly, const GroupAssembler& groups, const SceneDescription& description,
                     SceneSummary& summary) {
  for (const Assembly::Use& use : assembly.uses) {
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

void make_instances(const Assembly& assembly, GroupAssembler& groups, const SceneDescription& description,
                    ShapeSet& shapes, SceneSummary& summary) {
  shapes.instances.reserve(summary.instances);
  auto next_object = static_cast<std::uint32_t>(description.shapes.size());
  Matrix44d to_scene;
  to_scene.setTranslation(-shapes.origin);
  std::vector<bool> seen(description.shapes.size(), false);
  for (const Assembly::Use& use : assembly.uses)
    groups.for_each(use, [&](std::uint32_t index, const Matrix44d& transform) {
      Matrix44d from_origin;
      from_origin.setTranslation(groups[index].origin);
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
  Assembler assembler(description, options, warnings);
  Assembly& assembly = assembler.assembly;
  assembler.add_all(description.shapes, 0, summary.shapes);
  // Uses in the order of the shapes, whichever kind came first.
  std::stable_sort(assembly.uses.begin(), assembly.uses.end(),
                   [](const Assembly::Use& a, const Assembly::Use& b) { return a.shape < b.shape; });
  GroupAssembler groups(description, options, warnings);
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
  shapes.origin = scene_origin(place);
  move_to_space(assembly, shapes.origin, shapes);
  shapes.planes = std::move(assembly.planes);
  for (Plane& plane : shapes.planes) plane.point -= shapes.origin;
  make_instances(assembly, groups, description, shapes, summary);
  groups.hand_over(shapes, summary);
  summary.array_bytes = memory_bytes(shapes);
  return shapes;
}

}  // namespace raytree
