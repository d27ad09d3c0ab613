// One list of shapes, the scene's or a group's: files read, generators run, normals and triangles made, everything
// transformed; in double, until it is known where the space begins that it goes to.
#pragma once

#include <string>
#include <vector>

#include "geometry/error.h"
#include "geometry/shape_set.h"
#include "geometry/sphere_flake.h"
#include "renderer/mesh_materials.h"
#include "renderer/scene.h"
#include "renderer/scene_description.h"
#include "renderer/surface_tessellation.h"

namespace raytree {

/// A list of shapes in the space of the world or of its group, in double, until that space's origin is known.
struct ShapeList {
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
  struct WorldCone {
    Cone cone;
    ShapeId shape;
  };
  std::vector<WorldCone> cones;
  std::vector<Plane> planes;
  struct Use {
    std::uint32_t group;
    Matrix44d transform;
    ShapeId shape;
  };
  std::vector<Use> uses;  ///< of groups; those of one shape stand together

  bool has_round() const { return !spheres.empty() || !flakes.empty() || !discs.empty() || !cones.empty(); }
  bool has_shapes() const { return has_round() || !meshes.empty(); }
};

/// Assembles `shapes`, which are ShapeId `first` and following ones, and consumes their meshes; `scene` is what they
/// belong to, `places` where the list stands in the world. Throws Error (bad_input).
ShapeList assemble_list(std::vector<ShapeDescription>& shapes, ShapeId first, const SceneDescription& scene,
                        MeshMaterials& mesh_materials, const ListPlaces& places, const PrepareOptions& options,
                        Warnings& warnings, std::vector<ShapeSummary>& summaries);

/// Moves all but planes and uses to a space that begins at `origin`.
void move_to_space(ShapeList& list, const Vec3d& origin, BoundedShapes& shapes);

// --- checks of places and transforms ------------------------------------------------------------------------

/// Throws Error (bad_input) unless `holds`.
void require(bool holds, const char* message, const SourceLocation& where);

/// Whether a place lies where the tracer's arithmetic holds; false for what is not finite.
bool is_within_reach(const Vec3d& v);

/// Throws for numbers that are not finite.
void check_transform(const Matrix44d& m, const SourceLocation& where);

/// The factor of a transform that scales all directions alike; throws for any other. `kind`: what takes it, "a sphere".
double uniform_scale(const Matrix44d& m, const std::string& kind, const SourceLocation& where);

inline Vec3d transformed_point(const Vec3d& point, const Matrix44d& m) { return point * m; }

}  // namespace raytree
