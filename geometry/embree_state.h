// What EmbreeIntersector holds; shared with the bare replay, which calls Embree on the same scene.
#pragma once

#include <atomic>
#include <functional>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "geometry/embree_api.h"
#include "geometry/embree_intersector.h"
#include "geometry/few_shapes.h"
#include "geometry/lattice_grids.h"
#include "geometry/quad_pairs.h"

namespace raytree {

namespace embree {

/// What holds all that Embree holds, enlarged by what rounding may take from a test of it. Empty (least above most):
/// nothing.
struct SceneBounds {
  float least[3], most[3];

  bool hold(float x, float y, float z) const {
    return (x >= least[0]) & (x <= most[0]) & (y >= least[1]) & (y <= most[1]) & (z >= least[2]) & (z <= most[2]);
  }
};

/// What goes into a scene otherwise than the renderer has it; for benchmarks.
struct SceneParts {
  /// Kind of geometry that meshes become, and what sets a mesh's buffers; no function: triangles that share its arrays.
  RTCGeometryType mesh_type = RTC_GEOMETRY_TYPE_TRIANGLE;
  std::function<void(RTCGeometry, const TriangleMesh&)> set_mesh;
  /// Attaches more to the top scene, with ids from the given one on.
  std::function<void(RTCDevice, RTCScene, GeometryId)> add;
  std::string isa;  ///< BenchSceneOptions::isa
};

/// Has a quad geometry share a mesh's positions and the list of its quads.
void share_quads(RTCGeometry geometry, const TriangleMesh& mesh, const QuadList& quads);

/// Has a grid geometry share points and grids over them; whatever reads 16 bytes at a point may do so at the last one.
void share_grids(RTCGeometry geometry, std::span<const Vec3f> points, std::span<const LatticeGrid> grids);

/// What the meshes of a scene or group become in place of triangles; empty: not that.
struct MeshForms {
  std::vector<QuadList> quads;
  std::vector<MeshGrids> grids;

  MeshForms() = default;
  MeshForms(const BoundedShapes& shapes, EmbreeOptions::Primitives primitives);
  std::size_t memory_bytes() const;
};

}  // namespace embree

struct EmbreeIntersector::State {
  const ShapeSet* shapes = nullptr;
  FewShapes few;  ///< that Embree does not hold
  /// Of the scene's meshes, then of each group's, where meshes are not handed over as triangles; else empty.
  std::vector<embree::MeshForms> forms;
  EmbreeOptions::Primitives primitives = EmbreeOptions::Primitives::triangles;  ///< what meshes are handed over as
  std::size_t form_bytes = 0;
  std::atomic<std::ptrdiff_t> memory{0};
  std::atomic<std::ptrdiff_t> peak_memory{0};
  std::mutex error_mutex;
  std::string error;  ///< first one Embree reported
  embree::Device device;
  /// One a group that has shapes and is used; before `scene`, so that they outlive it.
  std::vector<embree::SceneHandle> groups;
  embree::SceneHandle scene;
  embree::SceneBounds bounds;     ///< of `scene`
  GeometryId first_instance = 0;  ///< Embree's id of ShapeSet::instances[0]
  /// Embree's id of the first mesh's grids over copied points, of the scene, then of each group.
  std::vector<GeometryId> first_copied;
  bool instanced = false;
  bool together = true;  ///< see follows_packets_together()

  /// What Embree is told of a batch.
  Coherence told(Coherence coherence) const { return together ? coherence : Coherence::incoherent; }
  bool wide = true;  ///< 8-wide packets; else 4
};

}  // namespace raytree
