// What both mesh readers do with what they parsed: choose the origin, drop faces that cannot be drawn, make every
// position finite. Parsing is theirs.
#pragma once

#include <cstddef>
#include <functional>
#include <string>

#include "geometry/error.h"
#include "geometry/polygon_mesh.h"

namespace raytree {

/// Stands in normal_corners and texture_corners, while reading, for a corner without one.
inline constexpr std::uint32_t kNoIndex = 0xffffffffu;

/// The origin of a mesh whose coordinates span `box`. Zero, unless some coordinate is 1024 or more and the mesh lies
/// farther away than it is large (largest |coordinate| > largest extent of the box): then the box's center, rounded
/// to integers. Where zero is kept, offsets from the center would gain at most one bit over the coordinates.
Vec3d mesh_origin(const Bounds3d& box);

/// Where an element stood in the file, by its zero-based number. Called for the first of a kind only.
struct MeshLocator {
  std::function<SourceLocation(std::size_t)> vertex;
  std::function<SourceLocation(std::size_t)> face;
};

/// Brings a parsed mesh (indices already in range) into the state that PolygonMesh promises:
/// - corners that repeat their predecessor's vertex are removed;
/// - faces with fewer than three corners left, and quads that use a vertex twice, are dropped;
///   larger faces may visit a vertex twice (that is how files write holes);
/// - faces with a position that is not finite are dropped, and such positions become the first finite one.
/// Group runs and holes follow; face_sizes is emptied when only triangles are left. Each kind adds one counted warning.
/// Throws Error (bad_input) when no face is left: at the file, or at the first element that is at fault.
void settle_mesh(PolygonMesh& mesh, const std::string& name, const MeshLocator& locate, Warnings& warnings);

/// Gives corners whose normal or texture corner is kNoIndex one: their face's unit normal (Newell) and the texture
/// coordinates (0, 0). An index array that equals `corners`, its values as many as the positions, is emptied: the
/// values are per position. Adds counted warnings.
void complete_corners(PolygonMesh& mesh, const MeshLocator& locate, Warnings& warnings);

}  // namespace raytree
