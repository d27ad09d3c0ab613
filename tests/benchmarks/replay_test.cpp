// The two comparisons that floor and waves rest on: bare replays find what the render found, and the recursion paints
// what the generations paint. A comparison that cannot fail is worth nothing, so each is shown to fail too.
#include <gtest/gtest.h>

#include "benchmarks/bare_trace.h"
#include "benchmarks/recording_intersector.h"
#include "benchmarks/recursive_tracer.h"
#include "benchmarks/reference_scenes.h"
#include "renderer/builtin_scenes.h"

namespace raytree::benchmarks {
namespace {

SceneDescription small_scene() {
  SceneDescription scene = reference_scene();
  scene.image = {200, 150};
  return scene;
}

/// A plane in place of the floor: the part that Embree does not trace.
SceneDescription scene_with_plane() {
  SceneDescription scene = small_scene();
  ShapeDescription plane;
  plane.name = "ground";
  plane.kind = PlaneShape{{0, -0.5, 0}, {0, 1, 0}};
  scene.shapes.push_back(plane);
  return scene;
}

/// Colored shadows, absorption, a thin sheet, a conductor, and media by priority if asked for.
SceneDescription glass_scene(bool priorities) {
  SceneDescription scene = builtin_scene("glass");
  scene.image = {240, 160};
  scene.render.antialias = {Antialiasing::Method::none, 1};
  for (MaterialDescription& material : scene.materials)
    if (!priorities) material.priority = 0;
  return scene;
}

void expect_replays_agree(SceneDescription description) {
  Scene scene = prepared(std::move(description));
  const RecordedRender recorded = record_render(scene);
  const auto counts = recorded.record.ray_counts();
  EXPECT_EQ(counts[0], recorded.statistics.rays[static_cast<int>(RayKind::primary)]);
  // Shadow rays that are followed through what transmits ask for nearest hits.
  const auto traced = [&](RayKind kind) { return recorded.statistics.rays[static_cast<int>(kind)]; };
  const std::uint64_t secondary = traced(RayKind::reflected) + traced(RayKind::refracted) + traced(RayKind::shadow);
  // Where media are tracked, each tracer looks once for those that the eye lies in; such rays are none of the
  // picture's.
  EXPECT_GE(counts[1] + counts[2] + counts[3], secondary);
  EXPECT_LE(counts[1] + counts[2] + counts[3], secondary + (scene.tracks_media ? 64 : 0));
  EXPECT_GT(recorded.record.hits[0], 0u);
  EXPECT_GT(recorded.record.hits[2], 0u);

  const BareReplay replay(embree_of(scene), recorded.record);
  for (const ReplayCall call : {ReplayCall::coherent_packets, ReplayCall::incoherent_packets, ReplayCall::told_packets,
                                ReplayCall::single_rays})
    for (const int threads : {1, 2}) {
      ReplayCalls calls;
      calls.fill(call);
      const ReplayTally tally = replay_pass(replay, calls, threads);
      EXPECT_EQ(hit_mismatch(tally, recorded.record), "") << static_cast<int>(call) << " threads " << threads;
      EXPECT_GT(tally.total_seconds(), 0);
    }
}

TEST(Replay, FindsWhatTheRenderFound) { expect_replays_agree(small_scene()); }
TEST(Replay, FindsWhatTheRenderFoundBesideAPlane) { expect_replays_agree(scene_with_plane()); }

TEST(Replay, FindsWhatTheRenderFoundThroughGlass) {
  expect_replays_agree(glass_scene(false));
  expect_replays_agree(glass_scene(true));
}

TEST(Replay, AMismatchIsSeen) {
  Scene scene = prepared(small_scene());
  RecordedRender recorded = record_render(scene);
  const BareReplay replay(embree_of(scene), recorded.record);
  const ReplayTally tally = replay_pass(replay, ReplayCalls{}, 1);
  recorded.record.hits[2] += recorded.record.ray_counts()[2] / 1000;
  EXPECT_NE(hit_mismatch(tally, recorded.record), "");
}

TEST(Recursion, PaintsThePictureOfTheGenerations) {
  for (const double cutoff : {0.0, 0.02}) {
    SceneDescription description = small_scene();
    description.render.cutoff = cutoff;
    const Scene scene = prepared(std::move(description));
    const RenderResult rendered = render(scene, RenderOptions());
    const RecursiveResult recursive = render_recursively(scene, embree_of(scene), 2);
    EXPECT_EQ(picture_mismatch(recursive, rendered), "") << "cutoff " << cutoff;
    if (cutoff > 0) {
      EXPECT_GT(rendered.statistics.branches_cut, 0u);
    }
  }
}

TEST(Recursion, PaintsLightThroughThings) {
  for (const bool priorities : {false, true}) {
    const Scene scene = prepared(glass_scene(priorities));
    EXPECT_TRUE(scene.transparent_shadows);
    EXPECT_EQ(scene.tracks_media, priorities);
    EXPECT_EQ(picture_mismatch(render_recursively(scene, embree_of(scene), 2), render(scene, RenderOptions())), "");
  }
}

TEST(Recursion, PaintsPatternsThatAreCarriedWithTheirShapes) {
  SceneDescription description = small_scene();
  description.render.antialias = {Antialiasing::Method::none, 1};
  NoisePattern noise;
  noise.size = 0.2;
  CheckerPattern checker;
  checker.size = 0.2;
  MaterialDescription carried;
  carried.name = "carried", carried.diffuse = noise, carried.ambient = checker, carried.bump = BumpDescription{};
  description.materials.push_back(carried);
  ShapeDescription ball;
  ball.material = "carried", ball.kind = SphereShape{};
  ball.transform.scale(Vec3d(0.5));
  ball.transform.rotate(Vec3d(1, 2, 3));
  ShapeDescription use;
  use.kind = InstanceShape{"balls"};
  use.transform.translate(Vec3d(0.5, 1, 0));
  use.transform.rotate(Vec3d(0, 1, 0));
  description.groups.push_back({"balls", {ball}, {}});
  description.shapes.push_back(use);
  const Scene scene = prepared(std::move(description));
  ASSERT_FALSE(scene.object_spaces.empty());
  EXPECT_EQ(picture_mismatch(render_recursively(scene, embree_of(scene), 2), render(scene, RenderOptions())), "");
}

TEST(Recursion, AMismatchIsSeen) {
  const Scene scene = prepared(small_scene());
  const RenderResult rendered = render(scene, RenderOptions());
  RecursiveResult recursive = render_recursively(scene, embree_of(scene), 1);
  RecursiveResult other_tree = recursive;
  other_tree.rays[2] += other_tree.rays[2] / 100;
  EXPECT_NE(picture_mismatch(other_tree, rendered), "");
  for (std::size_t i = 0; i < recursive.pixels.size(); i += 500) recursive.pixels[i].g += 0.01f;
  EXPECT_NE(picture_mismatch(recursive, rendered), "");
}

}  // namespace
}  // namespace raytree::benchmarks
