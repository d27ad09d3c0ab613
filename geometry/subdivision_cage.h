// What makes a polygon mesh a subdivision cage: the scheme and its rules, creases, sharp corners, holes. Pure data, as
// files give it, and the checks that must pass before subdivision_surface.h or subdivision_refinement.h take the cage.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "geometry/error.h"

namespace raytree {

struct PolygonMesh;

enum class SubdivisionScheme : std::uint8_t {
  catmark,  ///< Catmull and Clark 1978; faces of any size
  loop,     ///< Loop 1987; triangles alone
  bilinear  ///< the cage's own faces, quads bilinear, others cut into quads about their mean
};

/// What becomes of edges that one face alone has (OpenSubdiv's VtxBoundaryInterpolation).
enum class BoundaryRule : std::uint8_t {
  none,            ///< faces with a vertex on the boundary have no surface
  edge_only,       ///< the surface reaches the boundary, a cubic curve that rounds corners off
  edge_and_corner  ///< and a vertex that one face alone has stays where it is
};

/// Where texture coordinates are interpolated linearly (OpenSubdiv's FVarLinearInterpolation).
enum class FaceVaryingRule : std::uint8_t {
  none,           ///< nowhere: smooth, outlines of islands too
  corners_only,   ///< corners of islands stay where they are
  corners_plus1,  ///< and where three or more islands meet
  corners_plus2,  ///< and darts
  boundaries,     ///< outlines of islands stay where they are
  all             ///< everywhere: bilinear
};

enum class CreaseMethod : std::uint8_t {
  uniform,  ///< sharpness falls by one at each level
  chaikin   ///< and is smoothed along the crease
};

/// How Catmull-Clark treats triangles of the cage.
enum class TriangleRule : std::uint8_t {
  catmark,  ///< as any face
  smooth    ///< by weights that leave fewer ripples (Stam and Loop's; OpenSubdiv's TRI_SUB_SMOOTH)
};

/// Sharpness from here on is infinite, as OpenSubdiv has it: creases that no level smooths.
inline constexpr double kInfiniteSharpness = 10;

/// Edges along a chain of vertices, two or more.
struct Crease {
  std::vector<std::uint32_t> vertices;    ///< indices of positions, from 0
  double sharpness = kInfiniteSharpness;  ///< levels that the crease stays sharp for; >= 0
};

struct SharpCorner {
  std::uint32_t vertex = 0;
  double sharpness = kInfiniteSharpness;
};

/// A rule that is absent takes its default; file and scene may each give some. Where an edge or vertex is named twice,
/// the later sharpness counts.
struct SubdivisionRules {
  std::optional<SubdivisionScheme> scheme;      ///< default: catmark
  std::optional<BoundaryRule> boundary;         ///< default: edge_only
  std::optional<FaceVaryingRule> face_varying;  ///< default: boundaries
  std::optional<CreaseMethod> crease_method;    ///< default: uniform
  std::optional<TriangleRule> triangles;        ///< default: catmark
  /// Degrees, [0, 180]; edges whose two faces' normals (Newell) meet at a larger angle become infinitely sharp.
  std::optional<double> crease_angle;
  std::vector<Crease> creases;
  std::vector<SharpCorner> corners;
  std::vector<std::uint32_t> holes;  ///< faces without a surface; they shape their neighbours all the same
};

inline constexpr SubdivisionScheme kDefaultScheme = SubdivisionScheme::catmark;
inline constexpr BoundaryRule kDefaultBoundaryRule = BoundaryRule::edge_only;
inline constexpr FaceVaryingRule kDefaultFaceVaryingRule = FaceVaryingRule::boundaries;

/// Both together: where both give a rule, `stronger` counts; its creases, corners and holes follow the others.
SubdivisionRules joined(SubdivisionRules weaker, const SubdivisionRules& stronger);

/// Refuses, with Error (bad_input) at `where` and the face's number from 0, what OpenSubdiv would crash on or accept in
/// silence: indices out of range, faces with fewer than three corners or with a vertex twice, faces other than
/// triangles under Loop, more than 65535 corners of a face or faces at a vertex, positions, texture coordinates and
/// sharpnesses that are not finite (infinite sharpness is allowed), negative sharpness, angles outside [0, 180].
/// Creases along edges that the cage does not have are no error; they are counted where the surface is made.
void check_cage(const PolygonMesh& mesh, const SubdivisionRules& rules, const SourceLocation& where);

}  // namespace raytree
