#include "geometry/subdivision_patches.h"

#include <opensubdiv/far/patchTableFactory.h>
#include <opensubdiv/far/primvarRefiner.h>

#include <array>
#include <cmath>
#include <memory>

#include "geometry/bicubic_spline.h"
#include "geometry/facet_pattern.h"
#include "geometry/osd_topology.h"

namespace raytree {
namespace {

using PatchTable = osd::Far::PatchTable;
using Value = PrimvarValue<Vec3d>;
using SixteenPoints = std::array<Vec3d, 16>;

/// Positions of all refined vertices, and behind them of the points that irregular patches have of their own.
std::vector<Value> refined_points(const PolygonMesh& mesh, const osd::Far::TopologyRefiner& refiner,
                                  const PatchTable& table) {
  const auto refined = static_cast<std::size_t>(refiner.GetNumVerticesTotal());
  std::vector<Value> points(refined + static_cast<std::size_t>(table.GetNumLocalPoints()));
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) points[i].value = Vec3d(mesh.positions[i]);
  const osd::Far::PrimvarRefinerReal<double> refinement(refiner);
  Value* source = points.data();
  for (int level = 1; level <= refiner.GetMaxLevel(); ++level) {
    Value* target = source + refiner.GetLevel(level - 1).GetNumVertices();
    refinement.Interpolate(level, source, target);
    source = target;
  }
  if (table.GetNumLocalPoints() > 0) {
    Value* local = points.data() + refined;
    table.GetLocalPointStencilTable<double>()->UpdateValues(points.data(), local);
  }
  return points;
}

/// Replaces the points beyond sides where the surface ends (bits as kBottomSide and following): a uniform cubic
/// B-spline ends at its point a, with second derivative zero, when the one before a is 2 a - b.
void end_at_sides(SixteenPoints& p, int sides) {
  for (std::size_t i = 0; i < 4; ++i) {
    if (sides & 8) p[4 * i] = p[4 * i + 1] * 2.0 - p[4 * i + 2];
    if (sides & 2) p[4 * i + 3] = p[4 * i + 2] * 2.0 - p[4 * i + 1];
  }
  for (std::size_t i = 0; i < 4; ++i) {
    if (sides & 1) p[i] = p[4 + i] * 2.0 - p[8 + i];
    if (sides & 4) p[12 + i] = p[8 + i] * 2.0 - p[4 + i];
  }
}

SixteenPoints bezier_of_spline(SixteenPoints p, int open_sides) {
  end_at_sides(p, open_sides);
  spline_to_bezier(p);
  return p;
}

/// A bilinear patch, corners once around.
SixteenPoints bezier_of_quad(const std::array<Vec3d, 4>& corner) {
  SixteenPoints p;
  for (std::size_t j = 0; j < 4; ++j)
    for (std::size_t i = 0; i < 4; ++i) {
      const double u = double(i) / 3, v = double(j) / 3;
      p[4 * j + i] = (corner[0] * (1 - u) + corner[1] * u) * (1 - v) + (corner[3] * (1 - u) + corner[2] * u) * v;
    }
  return p;
}

/// OpenSubdiv numbers quads, and the quads that other faces are cut in, in one row ("ptex faces").
struct QuadPlace {
  std::uint32_t face;
  std::uint32_t corner;  ///< of an n-gon: at which of its corners the quad lies
  std::uint32_t sides;   ///< of the face
};

std::vector<QuadPlace> quad_places(const osd::Far::TopologyRefiner& refiner) {
  std::vector<QuadPlace> places;
  const osd::Far::TopologyLevel& level = refiner.GetLevel(0);
  for (int face = 0; face < level.GetNumFaces(); ++face) {
    const auto sides = static_cast<std::uint32_t>(level.GetFaceVertices(face).size());
    for (std::uint32_t i = 0; i < (sides == 4 ? 1 : sides); ++i)
      places.push_back({static_cast<std::uint32_t>(face), i, sides});
  }
  return places;
}

/// Where a part of a quad lies: its parameters' lowest place, and how wide it is.
void place_patch(const QuadPlace& quad, const osd::Far::PatchParam& param, LimitPatch& patch) {
  const double width = double(param.GetParamFraction());
  Vec2d corner(double(param.GetU()) * width, double(param.GetV()) * width);
  double scale = 1;
  if (quad.sides != 4) {
    scale = 0.5;
    corner = subface_corner(quad.sides, quad.corner) + corner * scale;
  }
  patch.face = quad.face;
  patch.domain = quad.sides == 4 ? FaceDomain::quad : FaceDomain::quad_subfaces;
  patch.corner = corner;
  patch.along_u = {width * scale, 0};
  patch.along_v = {0, width * scale};
}

}  // namespace

std::vector<LimitPatch> subdivision_patches(const PolygonMesh& mesh, const SubdivisionRules& rules,
                                            const SourceLocation& where) {
  check_cage(mesh, rules, where);
  if (rules.scheme.value_or(kDefaultScheme) == SubdivisionScheme::loop) return {};
  Warnings known_already;  // to whoever made the surface
  const std::unique_ptr<osd::Far::TopologyRefiner> refiner = make_refiner(mesh, rules, where, known_already);

  using Factory = osd::Far::PatchTableFactory;
  Factory::Options options(kSharpIsolation);
  options.useInfSharpPatch = true;
  options.generateLegacySharpCornerPatches = false;
  options.generateVaryingTables = false;
  options.SetEndCapType(Factory::Options::ENDCAP_BSPLINE_BASIS);
  options.SetPatchPrecision<double>();
  osd::Far::TopologyRefiner::AdaptiveOptions adaptive = options.GetRefineAdaptiveOptions();
  adaptive.SetSecondaryLevel(kSmoothIsolation);
  refiner->RefineAdaptive(adaptive);
  const std::unique_ptr<PatchTable> table(Factory::Create(*refiner, options));
  if (!table) throw Error(ErrorKind::bad_input, where, "subdivision cage: OpenSubdiv makes no patches of it");

  const std::vector<Value> points = refined_points(mesh, *refiner, *table);
  const std::vector<QuadPlace> quads = quad_places(*refiner);
  std::vector<LimitPatch> patches;
  patches.reserve(static_cast<std::size_t>(table->GetNumPatchesTotal()));
  for (int array = 0; array < table->GetNumPatchArrays(); ++array) {
    const bool spline = table->GetPatchArrayDescriptor(array).GetType() == osd::Far::PatchDescriptor::REGULAR;
    for (int i = 0; i < table->GetNumPatches(array); ++i) {
      const auto corners = table->GetPatchVertices(array, i);
      const osd::Far::PatchParam param = table->GetPatchParam(array, i);
      const auto point = [&](int k) { return points[static_cast<std::size_t>(corners[k])].value; };
      LimitPatch patch;
      if (spline) {
        SixteenPoints p;
        for (int k = 0; k < 16; ++k) p[static_cast<std::size_t>(k)] = point(k);
        patch.patch.points = bezier_of_spline(p, param.GetBoundary());
      } else {
        patch.patch.points = bezier_of_quad({point(0), point(1), point(2), point(3)});
      }
      place_patch(quads[static_cast<std::size_t>(param.GetFaceId())], param, patch);
      patches.push_back(patch);
    }
  }
  return patches;
}

}  // namespace raytree
