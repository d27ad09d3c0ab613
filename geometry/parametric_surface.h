// The seam between smooth surfaces and tessellation: a surface made of faces with parameters of their own, joined along
// edges. Subdivision surfaces and patches implement it; tessellation.h turns it into triangles and never asks what kind
// it is.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "geometry/vec.h"

namespace raytree {

struct BezierPatch;

/// How a face's parameters lie.
enum class FaceDomain : std::uint8_t {
  quad,          ///< the unit square; corners (0,0), (1,0), (1,1), (0,1)
  triangle,      ///< u, v >= 0 and u + v <= 1; corners (0,0), (1,0), (0,1)
  quad_subfaces  ///< an n-gon cut into n quads, one at each corner, as OpenSubdiv's Bfr::Parameterization lays them out
};

/// One side of a face: from its corner `side` to the next one, counter-clockwise from outside.
struct FaceEdge {
  std::uint32_t edge = 0;     ///< in [0, edge_count())
  std::uint32_t vertex = 0;   ///< the side's first corner, in [0, vertex_count())
  bool reversed = false;      ///< this face runs along the edge against the edge's own direction
  bool sharp_edge = false;    ///< faces on both sides have normals of their own along it (infinite crease, boundary)
  bool sharp_vertex = false;  ///< the same at the corner
  /// Every point of the edge is its first corner, so that the next one is the same vertex. No other face has the edge;
  /// sharp: the normal differs along it.
  bool collapsed = false;
};

/// The surface at one parameter of one face.
struct SurfaceSample {
  Vec3f position;  ///< relative to origin()
  Vec3f normal;    ///< unit, outward; of the limit surface; never zero, also where du x dv vanishes
  Vec3f du, dv;    ///< first derivatives by the face's own parameters
};

class ParametricSurface {
 public:
  virtual ~ParametricSurface() = default;

  virtual Vec3d origin() const = 0;  ///< added to every position, in double
  virtual std::size_t face_count() const = 0;
  virtual std::size_t edge_count() const = 0;
  virtual std::size_t vertex_count() const = 0;
  virtual bool has_texture() const = 0;

  virtual FaceDomain domain(std::size_t face) const = 0;
  /// The face's sides in order; 3 or more, 4 for a quad. Empty: a hole, which has no surface.
  virtual std::span<const FaceEdge> sides(std::size_t face) const = 0;

  /// Evaluates one face at parameters of its domain; samples: [parameters.size()]. Safe to call from many threads. The
  /// same parameter of the same face gives the same bits in any company. Two faces need not agree bit for bit along
  /// their common edge: who wants shared points evaluates them once.
  virtual void evaluate(std::size_t face, std::span<const Vec2f> parameters,
                        std::span<SurfaceSample> samples) const = 0;

  /// The same for texture coordinates, (0, 0) without; coordinates: [parameters.size()].
  virtual void evaluate_texture(std::size_t face, std::span<const Vec2f> parameters,
                                std::span<Vec2f> coordinates) const = 0;

  /// Whether the face is one bicubic polynomial over its parameters, a quad; `patch` gets it then, relative to origin()
  /// and with equal weights. Faces of subdivision surfaces without extraordinary vertices and semi-sharp creases are,
  /// and polynomial patches without a collapsed side.
  virtual bool polynomial_patch(std::size_t face, BezierPatch& patch) const {
    (void)face, (void)patch;
    return false;
  }

  /// The cage's polygon or what else the user would call this face; for messages and for material runs.
  virtual std::uint32_t source_face(std::size_t face) const = 0;
};

}  // namespace raytree
