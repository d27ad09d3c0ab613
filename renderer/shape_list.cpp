#include "renderer/shape_list.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <optional>
#include <set>
#include <utility>

#include "geometry/angle.h"
#include "geometry/faceted_quadric.h"
#include "geometry/mesh_file.h"
#include "geometry/mesh_source.h"
#include "geometry/patch_surface.h"
#include "geometry/subdivision_patches.h"
#include "geometry/subdivision_surface.h"
#include "geometry/terrain.h"
#include "geometry/tessellation.h"
#include "geometry/tree.h"
#include "geometry/triangulation.h"
#include "geometry/vertex_normals.h"
#include "renderer/camera.h"
#include "renderer/groups.h"
#include "renderer/mesh_transform.h"
#include "renderer/patch_shape.h"
#include "renderer/scatter.h"
#include "renderer/scene_fields.h"
#include "renderer/shape_shading.h"
#include "renderer/unseen_surface.h"

namespace raytree {

void require(bool holds, const char* message, const SourceLocation& where) {
  if (!holds) throw Error(ErrorKind::bad_input, where, message);
}

void check_transform(const Matrix44d& m, const SourceLocation& where) {
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column)
      require(std::isfinite(m[row][column]), "the transform holds a number that is not finite", where);
}

bool is_within_reach(const Vec3d& v) {
  // Embree's arithmetic holds up to such coordinates (the catalogue of its failures: distances go wrong from 1e15 on).
  constexpr double kLargestCoordinate = 1e12;
  // NaN fails every comparison.
  return std::abs(v.x) <= kLargestCoordinate && std::abs(v.y) <= kLargestCoordinate &&
         std::abs(v.z) <= kLargestCoordinate;
}

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

namespace {

/// The unit normal of a plane or disc as its description has it, in the world.
Vec3d checked_normal(const Vec3d& normal, const Matrix44d& transform, const SourceLocation& where) {
  Vec3d world = transformed_vector(normal, transform.inverse().transposed());
  const double length = world.length();
  require(length > 0 && std::isfinite(length), "a normal needs a direction, and numbers that are finite", where);
  return world / length;
}

void count_faces(const PolygonMesh& mesh, ShapeSummary& summary) {
  if (mesh.all_triangles()) {
    summary.faces_by_size[0] = mesh.face_count();
    return;
  }
  for (const std::uint32_t size : mesh.face_sizes) ++summary.faces_by_size[size == 3 ? 0 : size == 4 ? 1 : 2];
}

/// The normals that the mesh's key `normals` asks for; `flat` alone has been taken for a way of shading.
void apply_normal_source(PolygonMesh& mesh, const MeshShape& shape, const SourceLocation& where, Warnings& warnings) {
  const bool from_file = shape.normals == NormalSource::file && !mesh.normals.empty();
  if (from_file) {
    if (const std::int64_t replaced = normalize_vertex_normals(mesh); replaced > 0)
      warnings.push_back({where, "normals of no length replaced by their face's", replaced});
    return;
  }
  mesh.normals = {};
  mesh.normal_corners = {};
  compute_vertex_normals(mesh, shape.crease_angle * kDegree);
}

/// Fills the assembly of one list of shapes.
class Assembler {
 public:
  Assembler(const SceneDescription& scene, MeshMaterials& mesh_materials, const ListPlaces& places,
            const PrepareOptions& options, Warnings& warnings)
      : scene_(scene), mesh_materials_(mesh_materials), places_(places), options_(options), warnings_(warnings) {}

  ShapeList assembly;

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
    check_shading(shape);
    method_ = shading_of(shape, settings());
    std::visit([&](auto& kind) { add_kind(kind, shape, id, summary); }, shape.kind);
    if (!summary.bounds.isInfinite() && !summary.bounds.isEmpty())
      require(is_within_reach(summary.bounds.min) && is_within_reach(summary.bounds.max),
              "the shape reaches further than 1e12 units from the origin", shape.where);
  }

  const FacetSettings& settings() const { return scene_.render.facets; }

  void add_mesh(TriangleMesh&& mesh, const ShapeDescription& shape, ShapeId id, ShapeSummary& summary,
                std::unique_ptr<FacetRecord> record, std::unique_ptr<MeshSource> source = nullptr) {
    transform_mesh(mesh, shape.transform);
    if (record) finish_record(mesh, shape, method_, settings(), *record);
    summary.shading = enum_name(method_);
    summary.triangles = mesh.triangle_count();
    PolygonMesh view;  // bounds() asks for positions and origin alone
    view.origin = mesh.origin;
    view.positions.swap(mesh.positions);
    summary.bounds = bounds(view);
    view.positions.swap(mesh.positions);
    assembly.meshes.push_back({std::move(mesh), id, {}, std::move(record), std::move(source)});
  }

  /// Triangles that a generator made, with the normals of what they stand for.
  void add_triangles(TriangleMesh&& mesh, const ShapeDescription& shape, ShapeId id, ShapeSummary& summary) {
    set_vertex_normals(mesh, shape, method_);
    add_mesh(std::move(mesh), shape, id, summary, begin_record(shape, method_, settings()));
  }

  /// Polygons with their normals set. `surface`: what they stand for; null: not known, or not wanted.
  void add_polygons(PolygonMesh&& mesh, const ShapeDescription& shape, ShapeId id, ShapeSummary& summary,
                    std::unique_ptr<TrueSurface> surface = nullptr) {
    std::unique_ptr<FacetRecord> record = begin_record(shape, method_, settings());
    if (record) {
      record->surface = std::move(surface);
      if (record->interpolation != FacetInterpolation::barycentric) note_polygons(mesh, *record);
    }
    std::unique_ptr<MeshSource> source;
    if (options_.keeps_sources() && !mesh.all_triangles()) {
      source = std::make_unique<MeshSource>();
      note_polygons(mesh, *source);
      source->reversed = mirrors(shape.transform);
    }
    add_mesh(triangulate(std::move(mesh), shape.where, warnings_), shape, id, summary, std::move(record),
             std::move(source));
  }

  /// A round shape cut in facets.
  template <class MakeSurface>
  void add_faceted(PolygonMesh&& mesh, const ShapeDescription& shape, ShapeId id, ShapeSummary& summary,
                   const MakeSurface& make_surface) {
    count_faces(mesh, summary);
    std::unique_ptr<TrueSurface> surface = method_ == ShadingMethod::limit ? make_surface(mesh) : nullptr;
    set_vertex_normals(mesh, shape, method_, true);
    add_polygons(std::move(mesh), shape, id, summary, std::move(surface));
  }

  /// What every curved shape becomes; `surface` lies in the shape's space. `patches`: what it is made of, relative to
  /// its origin, where that is to be kept and known. `hull`: a box about it, in the shape's space.
  void add_surface(std::shared_ptr<const ParametricSurface> surface, std::vector<LimitPatch>&& patches,
                   const Bounds3d& hull, const ShapeDescription& shape, ShapeId id, ShapeSummary& summary) {
    const SurfaceTessellation tessellation(scene_, chosen_camera(scene_, options_.camera),
                                           options_.measure_tessellation);
    // What instances share is made for all of them: a use must keep its object's id wherever the camera looks.
    if (!places_ && !rays_leave_hits(scene_, shape) && tessellation.is_outside_frame(hull, shape)) {
      leave_out(*surface, hull, shape, summary);
      return;
    }
    begin_phase("tessellating " + shape.name);
    FacetParameters parameters;
    const bool by_surface = method_ == ShadingMethod::limit, keeps = !patches.empty();
    TriangleMesh mesh =
        tessellation.make(*surface, shape, places_, summary, warnings_, by_surface || keeps ? &parameters : nullptr);
    std::unique_ptr<MeshSource> source;
    if (keeps) {
      source = std::make_unique<MeshSource>();
      source->patches = std::move(patches);
      source->parameters = parameters;
      source->reversed = mirrors(shape.transform);
      Matrix44d from_origin;
      from_origin.setTranslation(surface->origin());
      move_patches(*source, from_origin * shape.transform);
    }
    set_vertex_normals(mesh, shape, method_);
    std::unique_ptr<FacetRecord> record = begin_record(shape, method_, settings());
    if (by_surface) {
      record->surface = true_surface(std::move(surface), std::move(parameters));
      record->reversed = mirrors(shape.transform);
    }
    MeshSource* const kept = source.get();
    add_mesh(std::move(mesh), shape, id, summary, std::move(record), std::move(source));
    if (kept != nullptr) kept->pixel = tessellation.pixel_size(places_, summary.bounds);
  }

  /// Makes nothing of a curved shape that no ray can meet. Its bounds stay near what they would be, for they tell where
  /// scene space begins.
  void leave_out(const ParametricSurface& surface, const Bounds3d& hull, const ShapeDescription& shape,
                 ShapeSummary& summary) const {
    TessellationSummary& record = summary.tessellation.emplace();
    for (std::size_t face = 0; face < surface.face_count(); ++face) record.faces += !surface.sides(face).empty();
    record.unseen = true;
    summary.shading = enum_name(method_);
    for (int i = 0; i < 8; ++i)
      summary.bounds.extendBy(transformed_point(
          {i & 1 ? hull.max.x : hull.min.x, i & 2 ? hull.max.y : hull.min.y, i & 4 ? hull.max.z : hull.min.z},
          shape.transform));
  }

  void add_kind(MeshShape& kind, const ShapeDescription& shape, ShapeId id, ShapeSummary& summary) {
    summary.kind = "mesh";
    std::shared_ptr<PolygonMesh> mesh = std::move(kind.mesh);
    const std::filesystem::path path = std::filesystem::path(scene_.folder) / kind.file;
    if (!mesh) {
      begin_phase("reading " + kind.file);
      try {
        mesh = std::make_shared<PolygonMesh>(read_mesh_file(path.string(), warnings_));
      } catch (const Error& error) {
        if (shape.where.file.empty()) throw;
        // A file that cannot be had is the scene's mistake; of one that is damaged the scene's place comes second.
        if (std::filesystem::exists(path)) throw named_by(error, shape.where);
        throw Error(error.kind(), shape.where, error.what());
      }
    }
    begin_phase("preparing " + shape.name);
    // It is taken apart below: who holds it beside this description keeps theirs.
    if (mesh.use_count() > 1) mesh = std::make_shared<PolygonMesh>(*mesh);
    count_faces(*mesh, summary);
    std::vector<std::optional<std::uint32_t>> group_materials;
    if (shape.material.empty()) group_materials = mesh_materials_.of_groups(*mesh, path.string());
    const std::vector<FaceGroup> groups = std::move(mesh->groups);
    if (kind.subdivision) {
      add_subdivided(*mesh, kind, shape, id, summary);
    } else {
      if (mesh->subdivision)
        warnings_.push_back(
            {shape.where,
             "subdivision tags not used, the polygons themselves are drawn; the shape's key subdivision "
             "(\"subdivision\": {}) makes a smooth surface of them"});
      if (method_ != ShadingMethod::flat && !shape.smoothing) apply_normal_source(*mesh, kind, shape.where, warnings_);
      set_vertex_normals(*mesh, shape, method_, false);
      add_polygons(std::move(*mesh), shape, id, summary);
    }
    const bool made = !(summary.tessellation && summary.tessellation->unseen);
    if (made) tag_materials(groups, group_materials, assembly.meshes.back(), summary);
  }

  void add_kind(PatchesShape& kind, const ShapeDescription& shape, ShapeId id, ShapeSummary& summary) {
    summary.kind = "patches";
    begin_phase("preparing " + shape.name);
    std::vector<SurfacePatch> patches = surface_patches(kind, scene_.folder, shape.where, warnings_);
    const Bounds3d hull = hull_bounds(patches);
    const auto surface =
        std::make_shared<PatchSurface>(std::move(patches), surface_options(kind), shape.where, warnings_);
    summary.faces_by_size[1] = static_cast<std::int64_t>(surface->face_count());
    add_surface(surface, options_.keeps_sources() ? surface->limit_patches() : std::vector<LimitPatch>(), hull, shape,
                id, summary);
  }

  void add_subdivided(const PolygonMesh& mesh, const MeshShape& kind, const ShapeDescription& shape, ShapeId id,
                      ShapeSummary& summary) {
    const SubdivisionRules rules = joined(mesh.subdivision.value_or(SubdivisionRules{}), *kind.subdivision);
    std::vector<LimitPatch> patches;
    if (options_.keeps_sources()) patches = subdivision_patches(mesh, rules, shape.where);
    add_surface(make_subdivision_surface(mesh, rules, shape.where, warnings_), std::move(patches), hull_bounds(mesh),
                shape, id, summary);
  }

  /// Gives each triangle the material of its face's group.
  void tag_materials(const std::vector<FaceGroup>& groups,
                     const std::vector<std::optional<std::uint32_t>>& group_materials, MeshEntry& entry,
                     ShapeSummary& summary) const {
    std::set<std::uint32_t> used;
    for (const std::optional<std::uint32_t>& material : group_materials)
      if (material) used.insert(*material);
    if (used.empty()) return;
    for (const std::uint32_t material : used) summary.file_materials.push_back(scene_.materials[material].name);
    const TriangleMesh& mesh = entry.mesh;
    entry.triangle_tags.assign(mesh.triangle_count(), kNoTag);
    std::size_t triangle = 0;
    const auto face_of = [&](std::size_t i) {
      return mesh.triangle_faces.empty() ? static_cast<std::uint32_t>(i) : mesh.triangle_faces[i];
    };
    // Groups are runs of faces in order, and triangles are in the order of their faces.
    for (std::size_t g = 0; g < groups.size(); ++g) {
      while (triangle < mesh.triangle_count() && face_of(triangle) < groups[g].first_face) ++triangle;
      const std::uint64_t end = std::uint64_t(groups[g].first_face) + groups[g].face_count;
      for (; triangle < mesh.triangle_count() && face_of(triangle) < end; ++triangle)
        if (group_materials[g]) entry.triangle_tags[triangle] = *group_materials[g];
    }
  }

  void add_kind(TerrainShape& kind, const ShapeDescription& shape, ShapeId id, ShapeSummary& summary) {
    summary.kind = "terrain";
    begin_phase("generating " + shape.name);
    TriangleMesh mesh = make_terrain({kind.triangles, kind.size, kind.height, kind.roughness, kind.seed});
    summary.faces_by_size[0] = mesh.triangle_count();
    add_triangles(std::move(mesh), shape, id, summary);
  }

  /// Whether a round shape is to be cut in facets.
  static bool has_facets(int sides, const SourceLocation& where) {
    require(sides == 0 || sides >= 3, "sides must be at least 3, or 0 for the exact shape", where);
    return sides > 0;
  }

  void add_kind(SphereShape& kind, const ShapeDescription& shape, ShapeId id, ShapeSummary& summary) {
    summary.kind = "sphere";
    if (has_facets(kind.sides, shape.where)) {
      require(kind.radius > 0, "a radius must be larger than 0", shape.where);
      require(kind.stacks != 1, "stacks must be at least 2, or 0 for half of the sides", shape.where);
      const int stacks = kind.stacks > 0 ? kind.stacks : std::max(2, kind.sides / 2);
      add_faceted(faceted_sphere(kind.center, kind.radius, kind.sides, stacks), shape, id, summary, true_sphere);
      return;
    }
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
    ShapeList::Flake flake{make_sphere_flake(parameters), shape.transform,
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
    if (has_facets(kind.sides, shape.where)) {
      require(kind.radius > 0 && kind.normal.length() > 0, "a disc needs a radius and a normal", shape.where);
      add_faceted(faceted_disc(kind.center, kind.normal, kind.radius, kind.sides), shape, id, summary,
                  [](const PolygonMesh&) { return std::unique_ptr<TrueSurface>(); });
      return;
    }
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

  static void check_cone(const Cone& cone, const SourceLocation& where) {
    require(cone.base_radius >= 0 && cone.apex_radius >= 0 && cone.base_radius + cone.apex_radius > 0,
            "a cone needs radii that are not negative, and one that is larger than 0", where);
    require((cone.apex - cone.base).length() > 0, "a cone's base and apex must lie apart", where);
  }

  void add_kind(ConeShape& kind, const ShapeDescription& shape, ShapeId id, ShapeSummary& summary) {
    summary.kind = "cone";
    if (has_facets(kind.sides, shape.where)) {
      const Cone cone{kind.base, kind.apex, kind.base_radius, kind.apex_radius};
      check_cone(cone, shape.where);
      add_faceted(faceted_cone(cone, kind.sides, kind.stacks), shape, id, summary,
                  [&](const PolygonMesh& mesh) { return true_cone(mesh, cone); });
      return;
    }
    const double scale = uniform_scale(shape.transform, "a cone", shape.where);
    const Cone cone{transformed_point(kind.base, shape.transform), transformed_point(kind.apex, shape.transform),
                    kind.base_radius * scale, kind.apex_radius * scale};
    check_cone(cone, shape.where);
    summary.bounds = bounds(cone);
    assembly.cones.push_back({cone, id});
  }

  void add_kind(TreeShape& kind, const ShapeDescription& shape, ShapeId id, ShapeSummary& summary) {
    summary.kind = "tree";
    begin_phase("growing " + shape.name);
    const TreeParameters parameters{kind.species == TreeSpecies::conifer ? TreeForm::conifer : TreeForm::broadleaf,
                                    kind.height, kind.leaves, kind.leaf_size, kind.seed};
    TriangleMesh mesh = kind.part == TreePart::wood ? make_tree_wood(parameters) : make_tree_leaves(parameters);
    summary.faces_by_size[0] = mesh.triangle_count();
    add_triangles(std::move(mesh), shape, id, summary);
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
  ShadingMethod method_ = ShadingMethod::phong;  ///< of the shape under way
  const SceneDescription& scene_;
  MeshMaterials& mesh_materials_;
  const ListPlaces& places_;
  const PrepareOptions& options_;
  Warnings& warnings_;
};

}  // namespace

ShapeList assemble_list(std::vector<ShapeDescription>& shapes, ShapeId first, const SceneDescription& scene,
                        MeshMaterials& mesh_materials, const ListPlaces& places, const PrepareOptions& options,
                        Warnings& warnings, std::vector<ShapeSummary>& summaries) {
  Assembler assembler(scene, mesh_materials, places, options, warnings);
  assembler.add_all(shapes, first, summaries);
  return std::move(assembler.assembly);
}

void move_to_space(ShapeList& list, const Vec3d& origin, BoundedShapes& shapes) {
  shapes.origin = origin;
  for (MeshEntry& entry : list.meshes) {
    const Vec3d shift = entry.mesh.origin - origin;
    if (shift != Vec3d(0, 0, 0))
      for_each_index(entry.mesh.positions.size(),
                     [&](std::size_t i) { entry.mesh.positions[i] = Vec3f(Vec3d(entry.mesh.positions[i]) + shift); });
    entry.mesh.origin = {0, 0, 0};
    if (entry.source && entry.source->curved()) {
      auto moved = std::make_shared<MeshSource>(*entry.source);
      Matrix44d to_space;
      to_space.setTranslation(-origin);
      move_patches(*moved, to_space);
      moved->pixel.from_eye = to_space.inverse() * moved->pixel.from_eye;
      entry.source = std::move(moved);
    }
  }
  shapes.meshes = std::move(list.meshes);

  SphereArray& spheres = shapes.spheres;
  const auto add_sphere = [&](const Vec3d& center, double radius, ShapeId shape) {
    const Vec3f c(center - origin);
    spheres.center_radius.push_back({c.x, c.y, c.z, static_cast<float>(radius)});
    spheres.shape.push_back(shape);
  };
  std::size_t count = list.spheres.size();
  for (const auto& flake : list.flakes) count += flake.arrays.sphere_count();
  spheres.center_radius.reserve(count);
  spheres.shape.reserve(count);
  for (const auto& sphere : list.spheres) add_sphere(sphere.center, sphere.radius, sphere.shape);
  for (const auto& flake : list.flakes)
    for (std::size_t i = 0; i < flake.arrays.sphere_count(); ++i)
      add_sphere(transformed_point(flake.arrays.origin + Vec3d(flake.arrays.centers[i]), flake.transform),
                 flake.arrays.radii[i] * flake.scale, flake.shape);

  for (const auto& disc : list.discs) {
    const Vec3f c(disc.center - origin);
    shapes.discs.center_radius.push_back({c.x, c.y, c.z, static_cast<float>(disc.radius)});
    shapes.discs.normal.push_back(Vec3f(disc.normal));
    shapes.discs.shape.push_back(disc.shape);
  }
  for (const auto& [cone, shape] : list.cones) {
    const Vec3f base(cone.base - origin), apex(cone.apex - origin);
    shapes.cones.base_radius.push_back({base.x, base.y, base.z, static_cast<float>(cone.base_radius)});
    shapes.cones.apex_radius.push_back({apex.x, apex.y, apex.z, static_cast<float>(cone.apex_radius)});
    shapes.cones.shape.push_back(shape);
  }
}

}  // namespace raytree
