// The claim of tolerance on real surfaces: subdivision cages of other programs, and the teapot's patches.
#include <gtest/gtest.h>

#include <cstdio>

#include "geometry/error.h"
#include "geometry/mesh_file.h"
#include "geometry/patch_reader.h"
#include "geometry/patch_surface.h"
#include "geometry/subdivision_surface.h"
#include "geometry/tessellation_error.h"
#include "geometry/tessellation_rates.h"
#include "tests/geometry/subdivision_cages.h"
#include "tests/test_data.h"

namespace raytree {
namespace {

/// The whole surface in a picture of `height` pixels, seen from before and above.
TessellationView view_of(const ParametricSurface& surface, double height) {
  Bounds3d box;
  const TriangleMesh rough = tessellate_uniformly(surface, 1);
  for (const Vec3f& p : rough.positions) box.extendBy(rough.origin + Vec3d(p));
  const double size = box.size().length();
  TessellationView view;
  view.projection = TessellationView::Projection::perspective;
  view.eye = box.center() + Vec3d(0.5, 0.6, 1.2) * size;
  view.forward = (box.center() - view.eye).normalized();
  view.right = view.forward.cross(Vec3d(0, 1, 0)).normalized();
  view.up = view.right.cross(view.forward);
  view.pixel = 0.8 / height;
  view.half_height = height / 2;
  view.half_width = height / 2;
  return view;
}

struct Outcome {
  std::size_t triangles = 0, coarse = 0;
  TessellationError error;
};

Outcome tessellated(const ParametricSurface& surface, double height, double tolerance) {
  const TessellationView view = view_of(surface, height);
  const ViewRates found = rates_for_view(surface, view, tolerance);
  const TriangleMesh mesh = tessellate(surface, found.rates);
  return {mesh.triangle_count(), found.coarse_faces, measure_tessellation(surface, found.rates, mesh, view)};
}

void expect_within(const std::string& name, const ParametricSurface& surface, double height, double tolerance) {
  SCOPED_TRACE(name);
  const Outcome outcome = tessellated(surface, height, tolerance);
  std::printf("%-32s %8zu triangles, %.3f px off, shading %.3f px, %zu coarse\n", name.c_str(), outcome.triangles,
              outcome.error.largest.pixels, outcome.error.largest.shading, outcome.coarse);
  // Faces that the rates give up on are counted, and warned of.
  if (outcome.coarse == 0) {
    EXPECT_LE(outcome.error.largest.pixels, tolerance);
  }
  // Shading is reported: facets of a few pixels are not cut for its sake.
  EXPECT_EQ(outcome.error.triangles, outcome.triangles);
}

TEST(TessellationCages, OwnCagesKeepTheTolerance) {
  Warnings warnings;
  for (int valence : {3, 5, 7, 12})
    expect_within("star " + std::to_string(valence),
                  *make_subdivision_surface(test::star_cage(valence), {}, {}, warnings), 500, 0.25);
  expect_within("cube", *make_subdivision_surface(test::cube_cage(), {}, {}, warnings), 500, 0.25);
}

TEST(TessellationCages, CagesOfOthersKeepTheTolerance) {
  std::size_t kept = 0, refused = 0;
  for (const auto& path : test::test_data_files("subdiv")) {
    if (path.extension() != ".obj" || path.string().find("hbr_reference") != std::string::npos) continue;
    const std::string name = path.filename().string();
    Warnings warnings;
    const PolygonMesh mesh = read_mesh_file(path.string(), warnings);
    SubdivisionRules rules = mesh.subdivision.value_or(SubdivisionRules{});
    rules.scheme = name.starts_with("loop")       ? SubdivisionScheme::loop
                   : name.starts_with("bilinear") ? SubdivisionScheme::bilinear
                                                  : SubdivisionScheme::catmark;
    std::unique_ptr<ParametricSurface> surface;
    try {
      surface = make_subdivision_surface(mesh, rules, {path.string(), 0, {}}, warnings);
    } catch (const Error&) {
      ++refused;
      continue;
    }
    expect_within(name, *surface, 300, 0.25);
    ++kept;
  }
  std::printf("cages: %zu measured, %zu refused\n", kept, refused);
}

TEST(TessellationCages, TheTeapotKeepsTheTolerance) {
  for (const auto& path : test::test_data_files("patches")) {
    if (path.extension() != ".bpt") continue;
    Warnings warnings;
    std::vector<SurfacePatch> patches;
    for (const BezierPatch& patch : read_patch_file(path.string(), warnings)) patches.emplace_back(patch);
    expect_within(path.filename().string(), PatchSurface(std::move(patches), {}, {}, warnings), 500, 0.25);
  }
}

}  // namespace
}  // namespace raytree
