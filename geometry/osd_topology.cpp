#include "geometry/osd_topology.h"

#include <opensubdiv/far/topologyRefinerFactory.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/angle.h"
#include "geometry/newell.h"

namespace raytree {
namespace {

/// What the factory walks, and what it finds on the way.
struct CageSource {
  const PolygonMesh& mesh;
  const SubdivisionRules& rules;
  mutable std::int64_t missing_creases = 0;
};

using CageFactory = osd::Far::TopologyRefinerFactory<CageSource>;

float limited_sharpness(double sharpness) { return static_cast<float>(std::min(sharpness, kInfiniteSharpness)); }

osd::Sdc::SchemeType scheme_of(const SubdivisionRules& rules) {
  switch (rules.scheme.value_or(kDefaultScheme)) {
    case SubdivisionScheme::loop:
      return osd::Sdc::SCHEME_LOOP;
    case SubdivisionScheme::bilinear:
      return osd::Sdc::SCHEME_BILINEAR;
    case SubdivisionScheme::catmark:
      break;
  }
  return osd::Sdc::SCHEME_CATMARK;
}

osd::Sdc::Options options_of(const SubdivisionRules& rules) {
  using Options = osd::Sdc::Options;
  Options options;
  switch (rules.boundary.value_or(kDefaultBoundaryRule)) {
    case BoundaryRule::none:
      options.SetVtxBoundaryInterpolation(Options::VTX_BOUNDARY_NONE);
      break;
    case BoundaryRule::edge_only:
      options.SetVtxBoundaryInterpolation(Options::VTX_BOUNDARY_EDGE_ONLY);
      break;
    case BoundaryRule::edge_and_corner:
      options.SetVtxBoundaryInterpolation(Options::VTX_BOUNDARY_EDGE_AND_CORNER);
      break;
  }
  switch (rules.face_varying.value_or(kDefaultFaceVaryingRule)) {
    case FaceVaryingRule::none:
      options.SetFVarLinearInterpolation(Options::FVAR_LINEAR_NONE);
      break;
    case FaceVaryingRule::corners_only:
      options.SetFVarLinearInterpolation(Options::FVAR_LINEAR_CORNERS_ONLY);
      break;
    case FaceVaryingRule::corners_plus1:
      options.SetFVarLinearInterpolation(Options::FVAR_LINEAR_CORNERS_PLUS1);
      break;
    case FaceVaryingRule::corners_plus2:
      options.SetFVarLinearInterpolation(Options::FVAR_LINEAR_CORNERS_PLUS2);
      break;
    case FaceVaryingRule::boundaries:
      options.SetFVarLinearInterpolation(Options::FVAR_LINEAR_BOUNDARIES);
      break;
    case FaceVaryingRule::all:
      options.SetFVarLinearInterpolation(Options::FVAR_LINEAR_ALL);
      break;
  }
  if (rules.crease_method.value_or(CreaseMethod::uniform) == CreaseMethod::chaikin)
    options.SetCreasingMethod(Options::CREASE_CHAIKIN);
  if (rules.triangles.value_or(TriangleRule::catmark) == TriangleRule::smooth)
    options.SetTriangleSubdivision(Options::TRI_SUB_SMOOTH);
  return options;
}

}  // namespace
}  // namespace raytree

// What the factory asks of a mesh type.
namespace OpenSubdiv::OPENSUBDIV_VERSION::Far {

using raytree::CageFactory;
using raytree::CageSource;

template <>
bool CageFactory::resizeComponentTopology(TopologyRefiner& refiner, const CageSource& cage) {
  const auto faces = static_cast<int>(cage.mesh.face_count());
  setNumBaseFaces(refiner, faces);
  for (int face = 0; face < faces; ++face)
    setNumBaseFaceVertices(
        refiner, face,
        cage.mesh.all_triangles() ? 3 : static_cast<int>(cage.mesh.face_sizes[static_cast<std::size_t>(face)]));
  setNumBaseVertices(refiner, static_cast<int>(cage.mesh.positions.size()));
  return true;
}

template <>
bool CageFactory::assignComponentTopology(TopologyRefiner& refiner, const CageSource& cage) {
  std::size_t corner = 0;
  for (int face = 0; face < getNumBaseFaces(refiner); ++face) {
    IndexArray vertices = getBaseFaceVertices(refiner, face);
    for (int i = 0; i < vertices.size(); ++i) vertices[i] = static_cast<int>(cage.mesh.corners[corner++]);
  }
  return true;
}

template <>
bool CageFactory::assignFaceVaryingTopology(TopologyRefiner& refiner, const CageSource& cage) {
  const raytree::PolygonMesh& mesh = cage.mesh;
  if (mesh.texture_coordinates.empty()) return true;
  const int channel = createBaseFVarChannel(refiner, static_cast<int>(mesh.texture_coordinates.size()));
  const auto& indices = mesh.texture_corners.empty() ? mesh.corners : mesh.texture_corners;
  std::size_t corner = 0;
  for (int face = 0; face < getNumBaseFaces(refiner); ++face) {
    IndexArray values = getBaseFaceFVarValues(refiner, face, channel);
    for (int i = 0; i < values.size(); ++i) values[i] = static_cast<int>(indices[corner++]);
  }
  return true;
}

template <>
bool CageFactory::assignComponentTags(TopologyRefiner& refiner, const CageSource& cage) {
  if (cage.rules.crease_angle) {
    std::vector<raytree::Vec3d> normals(cage.mesh.face_count());
    std::size_t first = 0;
    for (std::size_t face = 0; face < normals.size(); ++face) {
      const std::size_t size = cage.mesh.all_triangles() ? 3 : cage.mesh.face_sizes[face];
      normals[face] =
          raytree::newell_normal(cage.mesh.positions.data(), cage.mesh.corners.data() + first, size).normalized();
      first += size;
    }
    const double least_cosine = std::cos(*cage.rules.crease_angle * raytree::kDegree);
    for (int edge = 0; edge < getNumBaseEdges(refiner); ++edge) {
      const IndexArray faces = getBaseEdgeFaces(refiner, edge);
      if (faces.size() == 2 &&
          normals[static_cast<std::size_t>(faces[0])].dot(normals[static_cast<std::size_t>(faces[1])]) < least_cosine)
        setBaseEdgeSharpness(refiner, edge, static_cast<float>(raytree::kInfiniteSharpness));
    }
  }
  for (const raytree::Crease& crease : cage.rules.creases)
    for (std::size_t i = 0; i + 1 < crease.vertices.size(); ++i) {
      const Index edge =
          findBaseEdge(refiner, static_cast<int>(crease.vertices[i]), static_cast<int>(crease.vertices[i + 1]));
      if (edge == INDEX_INVALID)
        ++cage.missing_creases;
      else
        setBaseEdgeSharpness(refiner, edge, raytree::limited_sharpness(crease.sharpness));
    }
  for (const raytree::SharpCorner& corner : cage.rules.corners)
    setBaseVertexSharpness(refiner, static_cast<int>(corner.vertex), raytree::limited_sharpness(corner.sharpness));
  for (const std::uint32_t hole : cage.rules.holes) setBaseFaceHole(refiner, static_cast<int>(hole), true);
  return true;
}

template <>
void CageFactory::reportInvalidTopology(TopologyError, const char*, const CageSource&) {}

}  // namespace OpenSubdiv::OPENSUBDIV_VERSION::Far

namespace raytree {

std::unique_ptr<osd::Far::TopologyRefiner> make_refiner(const PolygonMesh& mesh, const SubdivisionRules& rules,
                                                        const SourceLocation& where, Warnings& warnings) {
  // OpenSubdiv counts in int, and has up to twice as many edges as corners on its way.
  constexpr std::size_t kMost = std::numeric_limits<int>::max() / 2;
  if (mesh.corners.size() > kMost || mesh.positions.size() > kMost || mesh.texture_coordinates.size() > kMost)
    throw Error(ErrorKind::bad_input, where, "subdivision cage: more than 1073741823 corners or vertices");
  const CageSource source{mesh, rules};
  std::unique_ptr<osd::Far::TopologyRefiner> refiner(
      CageFactory::Create(source, CageFactory::Options(scheme_of(rules), options_of(rules))));
  if (!refiner)
    throw Error(ErrorKind::bad_input, where, "subdivision cage: OpenSubdiv cannot connect these faces to a surface");
  if (source.missing_creases > 0)
    warnings.push_back(
        {where, "creases along edges that the subdivision cage does not have ignored", source.missing_creases});
  return refiner;
}

}  // namespace raytree
