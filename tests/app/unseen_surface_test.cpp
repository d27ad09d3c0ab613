// A curved shape that no ray can meet is not made, and the picture is the same; where some ray may meet it, it is.
#include "renderer/unseen_surface.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "renderer/image_file.h"
#include "renderer/surface_tessellation.h"
#include "tests/app/program.h"

namespace raytree::test {
namespace {

using UnseenJson = nlohmann::json;

const char* const kCubeFaces = "[[0,4,6,2],[1,3,7,5],[0,1,5,4],[2,6,7,3],[0,2,3,1],[4,5,7,6]]";
const char* const kCubePositions = "[[-1,-1,-1],[1,-1,-1],[-1,1,-1],[1,1,-1],[-1,-1,1],[1,-1,1],[-1,1,1],[1,1,1]]";

/// A ball before the eye, which looks along -z from (0, 0, 8), and a cube's limit surface at `place`.
UnseenJson unseen_scene(const std::array<double, 3>& place) {
  UnseenJson scene = UnseenJson::parse(R"({
    "raytree": 1,
    "cameras": {"main": {"position": [0, 0, 8], "target": [0, 0, 0], "field_of_view": 30}},
    "image": {"width": 80, "height": 50},
    "render": {"shadows": false},
    "background": {"type": "gradient"},
    "materials": {"paint": {"diffuse": [0.7, 0.5, 0.3]}},
    "shapes": {"ball": {"type": "sphere", "radius": 1, "material": "paint"}},
    "lights": {"key": {"type": "directional", "direction": [0, -1, -1]}}
  })");
  scene["shapes"]["blob"] = {{"type", "mesh"},
                             {"material", "paint"},
                             {"positions", UnseenJson::parse(kCubePositions)},
                             {"faces", UnseenJson::parse(kCubeFaces)},
                             {"subdivision", UnseenJson::object()},
                             {"transform", {{"translate", place}}}};
  return scene;
}

class UnseenSurface : public testing::Test {
 protected:
  std::uint64_t triangles(const UnseenJson& scene, const std::vector<std::string>& flags = {}) const {
    write_text(path_, scene.dump());
    const ProgramResult result = run_program(with({"info", path_, "--json"}, flags));
    EXPECT_EQ(result.status, 0) << result.err;
    if (result.status != 0) return 0;
    const UnseenJson info = UnseenJson::parse(result.out);
    const UnseenJson& made = info["objects"].back()["tessellation"];
    EXPECT_EQ(made["faces"], 6) << info.dump(1);
    EXPECT_EQ(made.value("unseen", false), made["triangles"] == 0);
    EXPECT_EQ(info["totals"]["traced_triangles"], made["triangles"]);
    return made["triangles"].get<std::uint64_t>();
  }
  std::vector<std::vector<float>> picture(const UnseenJson& scene, const std::vector<std::string>& flags = {}) const {
    write_text(path_, scene.dump());
    const std::string out = folder_.path("out.exr");
    const ProgramResult result =
        run_program(with({"render", path_, "-o", out, "--channels", "color,alpha,normal,object_id"}, flags));
    EXPECT_EQ(result.status, 0) << result.err;
    return read_image_file(out).planes;
  }

  TemporaryFolder folder_;
  std::string path_ = folder_.path("s.json");
};

/// A material that reflects, which no shape shows: whoever may meet it is made.
UnseenJson with_a_mirror(UnseenJson scene) {
  scene["materials"]["mirror"] = {{"reflection", 0.5}};
  return scene;
}

TEST_F(UnseenSurface, IsNotMadeAndThePictureStays) {
  const std::vector<std::array<double, 3>> unseen{{0, 0, 14}, {9, 0, 0}, {-9, 0, 0}, {0, 9, 0}, {0, -9, 0}, {40, 0, 7}};
  for (const auto& place : unseen) {
    SCOPED_TRACE(testing::PrintToString(place));
    const UnseenJson scene = unseen_scene(place);
    EXPECT_EQ(triangles(scene), 0u);
    EXPECT_GT(triangles(with_a_mirror(scene)), 0u);
    EXPECT_EQ(picture(scene), picture(with_a_mirror(scene)));
  }
  // It stands at the frame's border, or reaches from behind the eye into it.
  for (const auto& place : std::vector<std::array<double, 3>>{{3.9, 0, 0}, {0, 2.6, 0}, {0, 0, 8}, {0.5, 0, 7.5}}) {
    SCOPED_TRACE(testing::PrintToString(place));
    EXPECT_GT(triangles(unseen_scene(place)), 0u);
  }
}

TEST_F(UnseenSurface, IsMadeWhereSomeRayMayMeetIt) {
  const UnseenJson scene = unseen_scene({0, 0, 14});
  ASSERT_EQ(triangles(scene), 0u);
  UnseenJson shadows = scene;
  shadows["render"]["shadows"] = true;
  EXPECT_GT(triangles(shadows), 0u);
  shadows["lights"] = UnseenJson::object();
  EXPECT_EQ(triangles(shadows), 0u) << "no light, no shadow";
  for (const char* key : {"reflection", "transmission"}) {
    UnseenJson seen = scene;
    seen["materials"]["paint"][key] = 0.2;
    EXPECT_GT(triangles(seen), 0u) << key;
    seen["render"]["depth"] = 1;
    EXPECT_EQ(triangles(seen), 0u) << "eye rays alone";
  }
  // Another mesh file may bring materials that mirror; one whose material is known brings none.
  write_text(folder_.path("other.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  UnseenJson file = scene;
  file["shapes"]["a file"] = {{"type", "mesh"}, {"file", "other.obj"}};
  UnseenJson known = scene;
  known["shapes"]["a file"] = {{"type", "mesh"}, {"file", "other.obj"}, {"material", "paint"}};
  for (UnseenJson* one : {&file, &known}) {
    write_text(path_, one->dump());
    const UnseenJson info = UnseenJson::parse(run_program({"info", path_, "--json"}).out);
    EXPECT_EQ(info["totals"]["traced_triangles"] == 1, one == &known) << info.dump(1);
  }
}

TEST_F(UnseenSurface, IsTheFramesAndNotACrops) {
  // Seen at the frame's right border alone; a crop of the left half shows nothing of it and makes it all the same.
  const UnseenJson scene = unseen_scene({3, 0, 0});
  const std::uint64_t all = triangles(scene);
  EXPECT_GT(all, 0u);
  write_text(path_, scene.dump());
  const auto render = [&](const std::vector<std::string>& flags, const std::string& name) {
    const ProgramResult result = run_program(with({"render", path_, "-o", folder_.path(name), "--verbose"}, flags));
    EXPECT_EQ(result.status, 0) << result.err;
    return read_image_file(folder_.path(name));
  };
  const DecodedImage whole = render({}, "whole.exr"), left = render({"--crop", "40x50+0+0"}, "left.exr");
  ASSERT_EQ(left.width, 40);
  for (std::size_t plane = 0; plane < whole.planes.size(); ++plane)
    for (int y = 0; y < 50; ++y)
      for (int x = 0; x < 40; ++x)
        ASSERT_EQ(whole.planes[plane][std::size_t(y * 80 + x)], left.planes[plane][std::size_t(y * 40 + x)]);
}

TEST_F(UnseenSurface, IsNamedByInfo) {
  write_text(path_, unseen_scene({0, 0, 14}).dump());
  const ProgramResult result = run_program({"info", path_, "--tessellation"});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_TRUE(contains(result.out, "blob: not made, no ray of the picture can meet it")) << result.out;
}

TEST(OutsideFrame, IsJudgedByTheBordersPlanes) {
  CameraDescription camera;
  camera.position = {0, 0, 8};
  for (const auto projection :
       {CameraDescription::Projection::perspective, CameraDescription::Projection::orthographic}) {
    camera.projection = projection;
    const TessellationView view = world_view(camera, {80, 50}, {});
    const auto outside = [&](const Vec3d& center, double radius) {
      return outside_frame({center - Vec3d(radius), center + Vec3d(radius)}, Matrix44d(), view);
    };
    // Of what the frame shows at 0, widened by a tenth and a pixel.
    const double depth = projection == CameraDescription::Projection::perspective ? 8 : 1;
    const double half_width = (40 * 1.1 + 1) * view.pixel * depth, half_height = (25 * 1.1 + 1) * view.pixel * depth;
    EXPECT_FALSE(outside({half_width * 0.99, 0, 0}, 1e-3));
    EXPECT_TRUE(outside({half_width * 1.01, 0, 0}, 1e-3));
    EXPECT_FALSE(outside({0, -half_height * 0.99, 0}, 1e-3));
    EXPECT_TRUE(outside({0, -half_height * 1.01, 0}, 1e-3));
    EXPECT_TRUE(outside({0, 0, 9.1}, 1)) << "behind the eye";
    EXPECT_FALSE(outside({0, 0, 8.9}, 1));
    EXPECT_FALSE(outside({0, 0, 0}, 100)) << "all about the eye";
    Matrix44d moved;
    moved.setTranslation(Vec3d(0, 0, 20));
    EXPECT_TRUE(outside_frame({Vec3d(-1), Vec3d(1)}, moved, view));
  }
  EXPECT_FALSE(outside_frame({Vec3d(-1), Vec3d(1)}, Matrix44d(), TessellationView())) << "seen from everywhere";
}

TEST(HullBounds, HoldCoonsPatchesThatLeaveTheirCurves) {
  // Borders that all bulge upward: the middle rises above each of them, by the sum of two ruled surfaces.
  const auto arch = [](const Vec3d& a, const Vec3d& b) {
    BezierCurve curve;
    curve.points = {a, a + (b - a) / 3.0 + Vec3d(0, 0, 1), b + (a - b) / 3.0 + Vec3d(0, 0, 1), b};
    return curve;
  };
  CoonsPatch patch;
  patch.bottom = arch({0, 0, 0}, {1, 0, 0});
  patch.top = arch({0, 1, 0}, {1, 1, 0});
  patch.left = arch({0, 0, 0}, {0, 1, 0});
  patch.right = arch({1, 0, 0}, {1, 1, 0});
  const std::vector<SurfacePatch> patches{patch};
  const Bounds3d hull = hull_bounds(patches);
  double highest = 0;
  for (int i = 0; i <= 8; ++i)
    for (int j = 0; j <= 8; ++j) {
      const Vec3d p = evaluate(patch, i / 8.0, j / 8.0).position;
      EXPECT_TRUE(hull.intersects(p)) << p;
      highest = std::max(highest, p.z);
    }
  EXPECT_GT(highest, 1.4) << "above all control points, which end at 1";
}

}  // namespace
}  // namespace raytree::test
