// A whole run over a small terrain: every configuration finds the same, wrong answers show, reports say it all.
#include "benchmarks/bench_run.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "benchmarks/bench_check.h"
#include "benchmarks/bench_report.h"
#include "benchmarks/edge_rays.h"
#include "benchmarks/reference_scenes.h"
#include "geometry/error.h"
#include "renderer/builtin_scenes.h"
#include "tests/temporary_folder.h"

namespace raytree::benchmarks {
namespace {

using test::contains;
using test::TemporaryFolder;
using Json = nlohmann::json;

Scene small_terrain(bool with_plane = false) {
  SceneDescription scene = terrain_scene(3000);
  scene.image = {48, 32};
  if (with_plane) {
    ShapeDescription plane;
    plane.name = "sea";
    plane.kind = PlaneShape{{0, 0.1, 0}, {0, 1, 0}};
    scene.shapes.push_back(plane);
  }
  return prepared(std::move(scene));
}

BenchReport short_run(const Scene& scene, const std::string& filter = "", int threads = 1) {
  BenchRunOptions options;
  options.threads = threads, options.repetitions = 2;
  options.filter = NameFilter(filter);
  return run_bench(scene, bench_rays(scene, 1, nullptr), options);
}

const BenchRow* row_named(const BenchReport& report, const std::string& name) {
  for (const BenchRow& row : report.rows)
    if (row.name() == name) return &row;
  return nullptr;
}

TEST(BenchRun, AllConfigurationsFindTheSameOfEveryKindOfRay) {
  for (const bool with_plane : {false, true}) {
    const Scene scene = small_terrain(with_plane);
    const BenchReport report = short_run(scene, "", 2);
    std::vector<std::string> kinds;
    for (const BenchRow& row : report.rows) {
      if (kinds.empty() || kinds.back() != row.rays_name) kinds.push_back(row.rays_name);
      EXPECT_FALSE(row.suspicious()) << row.name() << ": " << row.wrong << " of " << row.differ << ", "
                                     << row.wrong_example;
      EXPECT_GE(row.checked, row.configuration == kBenchBaseline ? 1 : row.differ);
      EXPECT_TRUE(row.repeatable);
      EXPECT_GT(row.speed.median, 0);
      EXPECT_EQ(row.speed.count, 2);
      EXPECT_EQ(row.samples.size(), 2u);
      EXPECT_GT(row.ratio.median, 0);
    }
    EXPECT_EQ(kinds, (std::vector<std::string>{"primary", "shadow", "mirror", "refracted", "bounce", "edge"}));
    EXPECT_TRUE(report.left_out.empty());
    const BenchRow* baseline = row_named(report, std::string("primary/") + kBenchBaseline);
    ASSERT_NE(baseline, nullptr);
    EXPECT_EQ(baseline->ratio.median, 1);
    EXPECT_GT(baseline->hits, 0u);
    EXPECT_TRUE(baseline->beside.empty());
    const BenchRow* quads = row_named(report, "primary/quads/robust/medium/8-coherent");
    if (quads != nullptr) {
      EXPECT_EQ(quads->beside, "triangles/robust/medium/8-coherent");
    }
    EXPECT_NE(row_named(report, "primary/naive"), nullptr);
    EXPECT_NE(row_named(report, "primary/seam"), nullptr);
    EXPECT_EQ(row_named(report, "primary/seam")->differ, 0u);
  }
}

TEST(BenchRun, BuildsAreMeasuredWithTheirBytes) {
  const BenchReport report = short_run(small_terrain(), "primary/(triangles|quads|grids)");
  const auto build = [&](const std::string& name) {
    for (const BenchBuild& one : report.builds)
      if (one.scene == name) return one;
    ADD_FAILURE() << name;
    return BenchBuild();
  };
  const BenchBuild triangles = build("triangles/robust/medium"), quads = build("quads/robust/medium"),
                   grids = build("grids/robust/medium");
  EXPECT_GT(triangles.seconds.median, 0);
  EXPECT_GE(triangles.peak_bytes, triangles.bytes);
  EXPECT_EQ(triangles.triangles_per_primitive, 1);
  EXPECT_EQ(quads.triangles_per_primitive, 2);
  EXPECT_GT(grids.triangles_per_primitive, 64);
  EXPECT_LT(quads.bytes, triangles.bytes);
  EXPECT_LT(grids.bytes, quads.bytes);
  EXPECT_LT(build("triangles/robust/medium-compact").bytes, triangles.bytes);
}

TEST(BenchRun, RaysHitsAndChecksumsAreTheSameForAnyThreads) {
  const Scene scene = small_terrain();
  const std::string filter = "/(seam|triangles/robust/medium/8-coherent)$";
  const BenchReport one = short_run(scene, filter, 1), three = short_run(scene, filter, 3);
  ASSERT_EQ(one.rows.size(), three.rows.size());
  for (std::size_t i = 0; i < one.rows.size(); ++i) {
    EXPECT_EQ(one.rows[i].name(), three.rows[i].name());
    EXPECT_EQ(one.rows[i].hits, three.rows[i].hits);
    EXPECT_EQ(one.rows[i].checksum, three.rows[i].checksum);
    EXPECT_EQ(one.rows[i].rays, three.rows[i].rays);
  }
}

/// Says of every ray that it hits something right at its origin.
class WrongTracer final : public RayIntersector {
 public:
  void intersect(const RayBatch& rays, Coherence, HitBatch& hits) const noexcept override {
    for (std::size_t i = 0; i < rays.size; ++i) hits.set(i, {kFirstMeshGeometry, 0, 0, 0, 1e-3f});
  }
  void occluded(const RayBatch& rays, Coherence, std::uint8_t* occluded) const noexcept override {
    std::fill_n(occluded, rays.size, std::uint8_t(1));
  }
  std::size_t memory_bytes() const noexcept override { return 0; }
  std::size_t peak_memory_bytes() const noexcept override { return 0; }
};

TEST(BenchRun, FastWrongAnswersShow) {
  Scene scene = small_terrain();
  BenchRunOptions options;
  options.repetitions = 1;
  options.filter = NameFilter("primary/(seam|triangles/robust/medium/8)");
  const std::vector<BenchRays> rays = bench_rays(scene, 1, nullptr);
  scene.intersector = std::make_unique<WrongTracer>();
  BenchRunReport report;
  report.scenes.push_back(run_bench(scene, rays, options));
  EXPECT_TRUE(report.scenes[0].suspicious());
  EXPECT_TRUE(contains(bench_text(report), "OTHER ANSWERS"));
  const Json json = Json::parse(bench_json(report));
  EXPECT_EQ(json["suspicious"], true);
  for (const Json& row : json["scenes"][0]["rows"]) EXPECT_EQ(row["suspicious"], row["configuration"] == "seam") << row;
}

/// A sound tracer but for one ray in a batch, of which it says something else.
class OnceWrongTracer final : public RayIntersector {
 public:
  enum class Fault { misses, finds, reports_nearer, reports_farther };
  OnceWrongTracer(std::unique_ptr<const RayIntersector> tracer, Fault fault)
      : tracer_(std::move(tracer)), fault_(fault) {}

  void intersect(const RayBatch& rays, Coherence coherence, HitBatch& hits) const noexcept override {
    tracer_->intersect(rays, coherence, hits);
    std::size_t at = rays.size / 2;
    const bool of_misses = fault_ == Fault::finds;
    while (at < rays.size && (hits.geometry[at] == kNoGeometry) != of_misses) ++at;
    if (at == rays.size) return;
    if (fault_ == Fault::misses) hits.set(at, Hit());
    if (fault_ == Fault::finds) hits.set(at, {kFirstMeshGeometry, 0, 0.3f, 0.3f, 2});
    if (fault_ == Fault::reports_nearer) hits.distance[at] *= 0.99f;
    if (fault_ == Fault::reports_farther) hits.distance[at] *= 1.01f;
  }
  void occluded(const RayBatch& rays, Coherence coherence, std::uint8_t* occluded) const noexcept override {
    tracer_->occluded(rays, coherence, occluded);
    const std::uint8_t wanted = fault_ == Fault::misses ? 1 : 0;
    for (std::size_t at = rays.size / 2; at < rays.size; ++at)
      if (occluded[at] == wanted) {
        occluded[at] = 1 - wanted;
        return;
      }
  }
  std::size_t memory_bytes() const noexcept override { return 0; }
  std::size_t peak_memory_bytes() const noexcept override { return 0; }

 private:
  std::unique_ptr<const RayIntersector> tracer_;
  Fault fault_;
};

TEST(BenchRun, OneWrongAnswerShows) {
  using Fault = OnceWrongTracer::Fault;
  for (const Fault fault : {Fault::misses, Fault::finds, Fault::reports_nearer, Fault::reports_farther})
    for (const std::string kind : {"primary", "shadow", "bounce"}) {
      if (kind == "shadow" && fault > Fault::finds) continue;  // no distances
      Scene scene = small_terrain();
      const std::vector<BenchRays> rays = bench_rays(scene, 1, nullptr);
      scene.intersector = std::make_unique<OnceWrongTracer>(std::move(scene.intersector), fault);
      for (const bool as_baseline : {false, true}) {
        BenchRunOptions options;
        options.repetitions = 1;
        options.filter = NameFilter(kind + "/(seam|triangles/robust/medium/8)");
        if (as_baseline) options.baseline = "seam";
        const BenchReport report = run_bench(scene, rays, options);
        const BenchRow* row = row_named(report, kind + "/seam");
        ASSERT_NE(row, nullptr);
        EXPECT_EQ(row->wrong, 1u) << kind << ", " << static_cast<int>(fault) << (as_baseline ? ", baseline" : "");
        EXPECT_TRUE(contains(row->wrong_example, "in double")) << row->wrong_example;
        EXPECT_TRUE(report.suspicious());
      }
    }
}

/// Embree 3.13 does not come back from some packets of 16 that are followed together among many instances.
TEST(BenchRun, PacketsOfSixteenComeBackFromManyInstances) {
  if (EmbreeBenchScene::widest_call() < 16) GTEST_SKIP() << "no packets of 16 on this processor";
  SceneDescription description = builtin_scene("forest");
  const Scene scene = prepared(std::move(description));
  BenchRunOptions options;
  options.repetitions = 1;
  options.seconds = 20;
  options.filter = NameFilter("shadow/triangles/robust/medium/16-coherent");
  const BenchReport report = run_bench(scene, bench_rays(scene, 64, nullptr), options);
  ASSERT_EQ(report.rows.size(), 1u);
  EXPECT_GT(report.rows[0].rays, 60000u);
  EXPECT_FALSE(report.suspicious()) << report.rows[0].wrong_example;
}

TEST(BenchRun, HitsAndMissesAreTwoAnswers) {
  EXPECT_TRUE(differs(kInfinity, 1));
  EXPECT_TRUE(differs(0, kInfinity));
  EXPECT_FALSE(differs(kInfinity, kInfinity));
  EXPECT_FALSE(differs(1, 1.0005f));
  EXPECT_TRUE(differs(1, 1.002f));
}

/// Where everything agrees, the baseline is looked at all the same.
TEST(BenchRun, AnswersThatAreAllWrongAlikeShow) {
  Scene scene = small_terrain();
  const std::vector<BenchRays> rays = bench_rays(scene, 1, nullptr);
  scene.intersector = std::make_unique<WrongTracer>();
  BenchRunOptions options;
  options.repetitions = 1;
  options.baseline = "seam";
  options.filter = NameFilter("primary/seam");
  const BenchReport report = run_bench(scene, rays, options);
  ASSERT_EQ(report.rows.size(), 1u);
  EXPECT_GT(report.rows[0].wrong, 100u);
}

TEST(BenchRun, RatiosAreTakenToTheConfigurationThatIsNamed) {
  const Scene scene = small_terrain();
  BenchRunOptions options;
  options.repetitions = 1;
  options.baseline = "quads/robust/medium/1";
  options.filter = NameFilter("primary/(quads|triangles)/robust/medium/1");
  const BenchReport report = run_bench(scene, bench_rays(scene, 1, nullptr), options);
  ASSERT_NE(row_named(report, "primary/quads/robust/medium/1"), nullptr);
  EXPECT_EQ(row_named(report, "primary/quads/robust/medium/1")->ratio.median, 1);
  options.baseline = "quads/robust/medium/2";
  EXPECT_THROW(run_bench(scene, bench_rays(scene, 1, nullptr), options), Error);
}

TEST(BenchRun, TimeIsSharedOutAndWhatIsLeftOutIsNamed) {
  const Scene scene = small_terrain();
  BenchRunOptions options;
  options.repetitions = 3;
  options.seconds = 1e-6;  // not even for one more hierarchy
  const BenchReport report = run_bench(scene, bench_rays(scene, 1, nullptr), options);
  EXPECT_FALSE(report.left_out.empty());
  EXPECT_FALSE(report.rows.empty()) << "the baseline's scene is there: its calls are measured all the same";
  BenchRunReport all;
  all.scenes.push_back(report);
  EXPECT_TRUE(contains(bench_text(all), "left out: quads/robust/medium: building it would take"));
  EXPECT_FALSE(Json::parse(bench_json(all))["scenes"][0]["left_out"].empty());
}

TEST(BenchRun, EarlierReportsAreComparedRowByRow) {
  TemporaryFolder folder;
  const Scene scene = small_terrain();
  BenchRunReport report;
  report.threads = 1;
  report.scenes.push_back(short_run(scene, "primary/triangles/robust/medium/[148]$"));
  ASSERT_EQ(report.scenes[0].rows.size(), 3u);
  for (BenchRow& row : report.scenes[0].rows) row.samples = {5, 5.1, 5.2, 5.3, 5.4, 5.5, 5.6};
  const std::string before = folder.write("before.json", bench_json(report));
  // One row twice as fast, one with other answers, one as it was.
  for (double& sample : report.scenes[0].rows[0].samples) sample *= 2;
  report.scenes[0].rows[1].checksum ^= 1;
  compare_with(report, before);
  ASSERT_EQ(report.changes.size(), 3u);
  EXPECT_EQ(report.changes[0].speed.change, Change::faster);
  EXPECT_NEAR(report.changes[0].speed.ratio, 2, 1e-9);
  EXPECT_EQ(report.changes[1].speed.change, Change::none);
  EXPECT_FALSE(report.changes[1].same_answers);
  EXPECT_EQ(report.changes[2].speed.change, Change::none);
  EXPECT_TRUE(report.changes[2].same_answers);
  const std::string text = bench_text(report);
  for (const char* part : {"faster", "no change", "OTHER ANSWERS"}) EXPECT_TRUE(contains(text, part)) << text;
  EXPECT_EQ(Json::parse(bench_json(report))["changes"][0]["verdict"], "faster");

  for (const char* wrong : {"{", "[]", "{\"scenes\": 1}", "{\"scenes\": [{}], \"machine\": {}}",
                            "{\"scenes\": [], \"machine\": {}, \"threads\": 1}"}) {
    BenchRunReport other = report;
    other.changes.clear();
    try {
      compare_with(other, folder.write("wrong.json", wrong));
      ADD_FAILURE() << wrong;
    } catch (const Error& error) {
      EXPECT_TRUE(contains(error.what(), "wrong.json")) << error.what();
    }
  }
}

TEST(BenchRays, FilesRaysBeginAndEndWhereTheySay) {
  const Scene scene = small_terrain();
  std::vector<FileRay> file(1);
  file[0].origin = {0, 50, 0}, file[0].direction = {0, -1, 0}, file[0].begin = 10, file[0].end = 12;
  const std::vector<BenchRays> rays = bench_rays(scene, file);
  ASSERT_EQ(rays.size(), 1u);
  EXPECT_EQ(rays[0].name, "file");
  const RayBatch& batch = rays[0].rays.batches.at(0);
  EXPECT_EQ(Vec3d(batch.origin(0)) + scene.shapes->origin, Vec3d(0, 40, 0));
  EXPECT_EQ(batch.max_distance[0], 2);
}

TEST(EdgeRays, PassThroughEdgesAndAreTheSameEachTime) {
  const Scene scene = small_terrain();
  const Vec3f eye(0.5f, 30, 0.25f);
  const RaySet rays = edge_aimed_rays(*scene.shapes, eye, 400), again = edge_aimed_rays(*scene.shapes, eye, 400);
  ASSERT_EQ(rays.size(), 400u);
  const TriangleMesh& mesh = scene.shapes->meshes.at(0).mesh;
  const RayBatch& batch = rays.batches[0];
  for (std::size_t i = 0; i < 40; ++i) {
    EXPECT_EQ(batch.direction(i), again.batches[0].direction(i));
    EXPECT_EQ(batch.origin(i), again.batches[0].origin(i));
    if (i % 2 == 0) {
      EXPECT_EQ(batch.origin(i), eye);
    }
    // The least distance between the ray and any edge, over the mesh's size.
    const Vec3d o(batch.origin(i)), d(batch.direction(i));
    double least = 1e30;
    for (std::size_t c = 0; c < mesh.corners.size(); ++c) {
      const Vec3d a(mesh.positions[mesh.corners[c]]), b(mesh.positions[mesh.corners[c / 3 * 3 + (c + 1) % 3]]);
      const Vec3d across = d.cross(b - a);
      if (across.length() < 1e-12) continue;
      // Where the ray's line comes nearest to the edge's, and whether that lies on the edge.
      const double along = -(o - a).cross(d).dot(across) / across.dot(across);
      if (along < -1e-3 || along > 1 + 1e-3) continue;
      least = std::min(least, std::abs((a - o).dot(across)) / across.length());
    }
    EXPECT_LT(least, 1e-5) << i;
  }
}

}  // namespace
}  // namespace raytree::benchmarks
