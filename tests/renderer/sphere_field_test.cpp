// No object is lost between samples (Whitted 1980, sec. 3): ten thousand spheres of .05 to 1 pixel radius, each seen,
// together as large as they are, also across the borders of tiles, in perspective, and as instances.
#include <gtest/gtest.h>

#include <random>

#include "geometry/angle.h"
#include "renderer/render.h"
#include "tests/renderer/test_scenes.h"

namespace raytree {
namespace {

using namespace test;

constexpr int kFieldBlocks = 100;  ///< each way; one sphere in each
constexpr int kFieldBlock = 4;     ///< pixels
// Blocks begin two pixels into the frame, so that their middles, where spheres are, lie on the borders of tiles too.
constexpr int kFieldMargin = 2;
constexpr int kFieldSize = kFieldBlocks * kFieldBlock + 2 * kFieldMargin;
static_assert(kTileSize % kFieldBlock == 0);

struct SphereFieldCase {
  const char* name;
  bool perspective, instances;
};

void PrintTo(const SphereFieldCase& field, std::ostream* out) { *out << field.name; }

class SphereField : public testing::TestWithParam<SphereFieldCase> {
 protected:
  /// The field, with the area of each sphere in the picture, pixels.
  SceneDescription scene() {
    SceneDescription scene = white_on_black(kFieldSize);
    if (GetParam().perspective) {
      scene.cameras[0] = CameraDescription();
      scene.cameras[0].position = {0, 0, 0};
      scene.cameras[0].target = {0, 0, -1};
      scene.cameras[0].field_of_view = 60;
    }
    if (GetParam().instances) scene.groups.push_back({"ball", {shape(SphereShape{{0, 0, 0}, 1}, "white", "ball")}, {}});
    std::mt19937 random(1980);
    std::uniform_real_distribution<double> place(1, 3), radius(0.05, 1), far(50, 200);
    const double focal = kFieldSize / 2.0 / std::tan(30 * kDegree);  // pixels
    for (int row = 0; row < kFieldBlocks; ++row)
      for (int column = 0; column < kFieldBlocks; ++column) {
        const double x = kFieldMargin + kFieldBlock * column + place(random),
                     y = kFieldMargin + kFieldBlock * row + place(random), r = radius(random);
        const auto nearest_border = [](double at) { return kTileSize * std::round(at / kTileSize); };
        across_ += std::abs(x - nearest_border(x)) < r || std::abs(y - nearest_border(y)) < r;
        Vec3d center(x - kFieldSize / 2.0, kFieldSize / 2.0 - y, 0);
        double world_radius = r, area = kPi * r * r;
        if (GetParam().perspective) {
          center.z = -focal;
          // The outline is an ellipse, longer away from the middle by the cosine there: r is its longer half.
          const double cosine = focal / center.length(), depth = far(random);
          center *= depth / focal;
          world_radius = r * cosine * center.length() / focal * cosine;
          // A cone of half-angle a about a direction off the axis by t meets the picture's plane in an ellipse.
          const double sine = world_radius / center.length();
          area = kPi * focal * focal * sine * sine * std::sqrt(1 - sine * sine) /
                 std::pow(cosine * cosine - sine * sine, 1.5);
        }
        areas_.push_back(area);
        if (GetParam().instances) {
          scene.shapes.push_back(shape(InstanceShape{"ball"}, ""));
          scene.shapes.back().transform = scaling(Vec3d(world_radius)) * translation(center);
        } else {
          scene.shapes.push_back(shape(SphereShape{center, world_radius}, "white"));
        }
      }
    return scene;
  }

  std::vector<double> areas_;
  int across_ = 0;  ///< spheres that cross a border of tiles
};

TEST_P(SphereField, LosesNoneAndCoversWhatTheSpheresCover) {
  const RenderResult result = rendered(scene(), {ChannelGroup::color});
  ASSERT_EQ(areas_.size(), 10000u);
  EXPECT_GT(across_, 500);
  int lost = 0;
  double sum = 0, area = 0, shares = 0;
  for (int i = 0; i < kFieldBlocks * kFieldBlocks; ++i) {
    double here = 0;
    for (int y = 0; y < kFieldBlock; ++y)
      for (int x = 0; x < kFieldBlock; ++x)
        here += color_at(result.film, kFieldMargin + kFieldBlock * (i % kFieldBlocks) + x,
                         kFieldMargin + kFieldBlock * (i / kFieldBlocks) + y)
                    .g;
    const double whole = areas_[static_cast<std::size_t>(i)];
    lost += here <= 0;
    sum += here, area += whole, shares += here / whole;
  }
  EXPECT_EQ(lost, 0);
  EXPECT_NEAR(sum / area, 1, 0.02);
  // Of each sphere by itself too, small ones as good as large ones.
  EXPECT_NEAR(shares / 10000, 1, 0.02);
  RecordProperty("area_seen", std::to_string(sum / area));
  RecordProperty("mean_share", std::to_string(shares / 10000));
}

INSTANTIATE_TEST_SUITE_P(TenThousand, SphereField,
                         testing::Values(SphereFieldCase{"orthographic", false, false},
                                         SphereFieldCase{"perspective", true, false},
                                         SphereFieldCase{"orthographic_instances", false, true},
                                         SphereFieldCase{"perspective_instances", true, true}),
                         [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace raytree
