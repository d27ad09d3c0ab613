// What meshes are handed to Embree as in place of triangles: quads of pairs, or grids.
#include <cstddef>
#include <type_traits>

#include "geometry/embree_state.h"

namespace raytree::embree {
namespace {

// Grids are shared with Embree as they are.
static_assert(sizeof(LatticeGrid) == sizeof(RTCGrid) && std::is_standard_layout_v<LatticeGrid>);
static_assert(offsetof(LatticeGrid, first_point) == offsetof(RTCGrid, startVertexID));
static_assert(offsetof(LatticeGrid, stride) == offsetof(RTCGrid, stride));
static_assert(offsetof(LatticeGrid, width) == offsetof(RTCGrid, width));
static_assert(offsetof(LatticeGrid, height) == offsetof(RTCGrid, height));

void share_points(RTCGeometry geometry, std::span<const Vec3f> points) {
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, points.data(), 0, sizeof(Vec3f),
                             points.size());
}

}  // namespace

void share_quads(RTCGeometry geometry, const TriangleMesh& mesh, const QuadList& quads) {
  share_points(geometry, mesh.positions);
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT4, quads.corners.data(), 0,
                             4 * sizeof(std::uint32_t), quads.size());
}

void share_grids(RTCGeometry geometry, std::span<const Vec3f> points, std::span<const LatticeGrid> grids) {
  share_points(geometry, points);
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_GRID, 0, RTC_FORMAT_GRID, grids.data(), 0, sizeof(LatticeGrid),
                             grids.size());
}

MeshForms::MeshForms(const BoundedShapes& shapes, EmbreeOptions::Primitives primitives) {
  for (const MeshEntry& entry : shapes.meshes)
    if (primitives == EmbreeOptions::Primitives::quads)
      quads.push_back(joined_quads(entry.mesh.corners));
    else if (primitives == EmbreeOptions::Primitives::grids)
      grids.push_back(make_grids(entry.mesh.corners, entry.mesh.positions));
}

std::size_t MeshForms::memory_bytes() const {
  std::size_t bytes = 0;
  for (const QuadList& list : quads) bytes += list.memory_bytes();
  for (const MeshGrids& mesh : grids) bytes += mesh.memory_bytes();
  return bytes;
}

}  // namespace raytree::embree
