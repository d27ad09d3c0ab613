// The prepared scene: shapes in tracing form, the intersector built over them, materials and lights resolved.
// Immutable once made; every thread reads it.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "geometry/error.h"
#include "geometry/ray_intersector.h"
#include "geometry/shape_set.h"
#include "geometry/sphere_bounded_intersector.h"
#include "geometry/tessellation_error.h"
#include "renderer/background.h"
#include "renderer/camera.h"
#include "renderer/light.h"
#include "renderer/material.h"
#include "renderer/object_space.h"
#include "renderer/radiance_bound.h"
#include "renderer/scene_description.h"
#include "renderer/small_objects.h"

namespace raytree {

/// What a curved shape became.
struct TessellationSummary {
  std::uint64_t faces = 0;  ///< of the surface
  std::uint64_t triangles = 0;
  std::uint64_t bytes = 0;                    ///< of the arrays that tracing and shading read
  std::uint64_t coarse_faces = 0;             ///< that may be off by more than the tolerance
  bool unseen = false;                        ///< nothing was made: no ray can meet it (unseen_surface.h)
  std::optional<double> tolerance;            ///< pixels, that the rates were found for; none: they were given
  std::optional<TessellationError> measured;  ///< when PrepareOptions::measure_tessellation asked for it
};

/// What stands in a scene, for `info` and for statistics.
struct ShapeSummary {
  std::string name;
  std::string kind;                         ///< "mesh", "sphere", ...
  std::string material;                     ///< empty: the default one, or the mesh file's
  std::vector<std::string> file_materials;  ///< that a mesh's file names, where they serve
  std::string shading;                      ///< of its facets, "phong"; empty: it has none
  std::uint32_t id = 0;                     ///< as in the object_id channel
  std::uint64_t triangles = 0;              ///< handed to the intersector
  std::uint64_t spheres = 0;
  std::uint64_t faces_by_size[3] = {0, 0, 0};  ///< triangles, quads, larger, as the file has them
  /// Uses of groups that shape comes to, nesting resolved. Their ids: `id` for the first, first_extra_id and following
  /// ones for the others.
  std::uint64_t instances = 0;
  std::uint32_t first_extra_id = 0;
  std::uint64_t instanced_triangles = 0, instanced_spheres = 0;  ///< of all its uses together
  std::optional<TessellationSummary> tessellation;               ///< of a curved shape
  Bounds3d bounds;  ///< world space (of a group's shape: the group's); infinite for planes
};

/// A group that is used.
struct GroupSummary {
  std::string name;
  std::vector<ShapeSummary> shapes;  ///< ids are 0
  std::uint64_t instances = 0;       ///< of its own shapes, nesting resolved
};

struct SceneSummary {
  std::vector<ShapeSummary> shapes;
  std::vector<GroupSummary> groups;
  std::uint64_t instances = 0;  ///< as the intersector holds them
  std::vector<std::string> materials_in_use;
  std::vector<std::string>
      features;                   ///< parts of the renderer that this scene switches on, e.g. "reflection", "fresnel"
  Bounds3d bounds;                ///< of what is finite
  std::uint64_t array_bytes = 0;  ///< vertex, index and sphere arrays
  std::uint64_t intersector_bytes = 0;  ///< estimated before the build, measured after it
  std::string hierarchy;                ///< what the tracer builds, and why
};

/// What traces the rays.
enum class Tracer : std::uint8_t {
  embree,
  spheres  ///< the reference, sphere_bounded_intersector.h
};

struct PrepareOptions {
  std::string camera;                       ///< name; empty: the first one
  int threads = 0;                          ///< that the intersector may use; 0: all of the arena
  const std::atomic<bool>* stop = nullptr;  ///< checked while building
  bool build = true;                        ///< false: assemble only, no intersector (for `info`)
  std::string hierarchy;                    ///< see hierarchy_named(); empty: chosen by cost
  std::uint64_t memory_allowed = 0;         ///< bytes, of arrays and hierarchy together; 0: any
  bool watertight = true;                   ///< see EmbreeOptions::robust
  bool measure_tessellation = false;        ///< compare every facet with its limit surface
  Tracer tracer = Tracer::embree;
  SphereBoundedOptions spheres;  ///< of Tracer::spheres, but for `stop`
  /// Keep what meshes were made of (MeshEntry::source), for who builds a SphereBoundedIntersector over the scene's
  /// shapes; Tracer::spheres does anyway.
  bool keep_sources = false;

  bool keeps_sources() const { return keep_sources || tracer == Tracer::spheres; }
  /// Told what begins, in a few words ("reading dragon.ply", "building over 871306 triangles"); from prepare()'s
  /// thread.
  std::function<void(const std::string&)> on_phase;
};

struct PhaseSeconds {
  double load = 0;   ///< reading mesh files, generating shapes, normals, triangulation
  double build = 0;  ///< the intersector's own build
};

/// How hits on a shape's facets are shaded.
struct ShapeShading {
  ShadingMethod method = ShadingMethod::phong;
  float inverse_half_distance = 0;  ///< see ShapeDescription::half_distance; 0: the shade does not fall
};

/// Stands for the material of an instance whose shapes keep their own.
inline constexpr std::uint32_t kOwnMaterials = 0xffffffffu;

class Scene {
 public:
  Scene();
  ~Scene();
  Scene(Scene&&) noexcept;
  Scene& operator=(Scene&&) noexcept;

  SceneDescription description;  ///< as given, meshes consumed
  SceneSummary summary;
  PhaseSeconds seconds;
  std::unique_ptr<const ShapeSet> shapes;
  std::unique_ptr<const RayIntersector> intersector;  ///< null when PrepareOptions::build was false
  std::vector<Material> materials;
  std::vector<std::uint32_t> shape_materials;  ///< [shape] -> index into materials, or kOwnMaterials
  std::vector<ShapeShading> shape_shading;     ///< [shape]
  ObjectSpaces object_spaces;                  ///< that patterns and bumps follow
  std::vector<Light> lights;
  BackgroundLight background;
  Rgb ambient;
  Camera camera;
  RadianceBound bound;
  bool transparent_shadows = false;  ///< light is to be followed through what transmits, and something does
  bool tracks_media = false;         ///< overlapping media are told apart by priority, and some material sets one
  bool rough_surfaces = false;       ///< some material in use perturbs normals
  bool shades_facets = false;        ///< some mesh has a FacetRecord
  /// Larger than 0: hits lie on what meshes were made of (true_surfaces.h), found to spheres of so many pixels.
  double sphere_pixels = 0;
  SmallObjects small_objects;  ///< as the camera sees them; none unless the anti-aliasing asks for them

  /// Index into materials of what a hit shows: the instance's, or else the triangle's own, or else the shape's.
  std::uint32_t material_at(const Hit& hit) const {
    if (hit.instance == kNoInstance)
      return own_material(*shapes, shapes->shape_of(hit.geometry, hit.primitive), hit.geometry, hit.primitive);
    const Instance& instance = shapes->instances[hit.instance];
    const std::uint32_t all = shape_materials[instance.shape];
    if (all != kOwnMaterials) return all;
    const BoundedShapes& group = shapes->groups[instance.group];
    return own_material(group, group.bounded_shape_of(hit.geometry, hit.primitive), hit.geometry, hit.primitive);
  }

  /// What patterns and bumps that follow their object go by at a hit that shows `material`: nothing where they lie in
  /// the world, or it is the object's own space.
  std::optional<ObjectFrame> frame_at(const Hit& hit, const Material& material) const {
    if (!((kFeatures.patterns || kFeatures.bumps) && material.follows_objects)) return std::nullopt;
    return object_spaces.at(*shapes, hit);
  }

  /// The same of a hit on `shape` of `list`, where no instance says otherwise.
  std::uint32_t own_material(const BoundedShapes& list, ShapeId shape, GeometryId geometry,
                             std::uint32_t primitive) const {
    const std::uint32_t tag = list.tag_of(geometry, primitive);
    return tag != kNoTag ? tag : shape_materials[shape];
  }
};

/// Loads mesh files, generates and transforms shapes, builds the intersector. Throws Error; what was odd is added to
/// warnings. A run that `stop` ended throws Error (failure) "interrupted".
Scene prepare(SceneDescription description, const PrepareOptions& options, Warnings& warnings);

}  // namespace raytree
