// A checked cage as OpenSubdiv's connected mesh. Included by the two .cpp files that subdivide, and by nothing else.
#pragma once

#include <opensubdiv/far/topologyRefiner.h>

#include <memory>

#include "geometry/error.h"
#include "geometry/polygon_mesh.h"
#include "geometry/subdivision_cage.h"
#include "geometry/vec.h"

namespace raytree {

namespace osd = OpenSubdiv;

/// A value as Far::PrimvarRefinerReal<double> wants it.
template <class Vector>
struct PrimvarValue {
  Vector value = Vector(0);
  void Clear(void* = nullptr) { value = Vector(0); }
  void AddWithWeight(const PrimvarValue& other, double weight) { value += other.value * weight; }
};

/// Builds the base level: faces, tags and, where the mesh has texture coordinates, face-varying channel 0 of them. The
/// cage must have passed check_cage(). Creases along edges that the cage lacks are counted in `warnings`. Throws Error
/// (bad_input) at `where` if OpenSubdiv refuses the cage all the same.
std::unique_ptr<osd::Far::TopologyRefiner> make_refiner(const PolygonMesh& mesh, const SubdivisionRules& rules,
                                                        const SourceLocation& where, Warnings& warnings);

}  // namespace raytree
