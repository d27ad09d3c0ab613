// Row floor: the time of the bare Embree calls that a picture needs, over the time that render() takes to trace it.
#include <fmt/format.h>

#include "benchmarks/bare_trace.h"
#include "benchmarks/recording_intersector.h"
#include "benchmarks/reference_scenes.h"
#include "benchmarks/row_bounds.h"
#include "benchmarks/rows.h"

namespace raytree::benchmarks {
namespace {

Figure floor_figure(const Scene& scene, const RayRecord& record, const BareReplay& replay, int threads) {
  const ReplayCalls calls = best_calls(replay, threads);
  RenderOptions options;
  options.threads = threads;
  ReplayTally tally;
  const auto bare = [&] {
    tally = replay_pass(replay, calls, threads);
    return tally.total_seconds() / threads;
  };
  const auto rendered = [&] { return render(scene, options).statistics.wall_seconds; };
  const PairedSpread pairs = measure_pairs(bare, rendered, PairLimits());

  Figure figure;
  figure.row = "floor";
  figure.what = "bare Embree calls / tracing phase, " + picture_text(scene, threads);
  figure.measured = pairs.ratio;
  figure.kind = BoundKind::at_least;
  figure.bound = kLeastFloor;
  figure.chase = kChasedFloor;
  figure.problem = hit_mismatch(tally, record);
  figure.note = fmt::format("{:.4f} s bare, {:.4f} s tracing, packets of {}; {}", pairs.a.median, pairs.b.median,
                            replay.packet_width(), calls_text(calls, record));
  return figure;
}

}  // namespace

std::vector<Figure> measure_floor(const MeasureContext& context) {
  std::vector<Figure> figures;
  for (const bool with_mesh : {false, true}) {
    Scene scene = prepared(with_mesh ? reference_scene_with_mesh() : reference_scene());
    const RecordedRender recorded = record_render(scene);
    const std::unique_ptr<EmbreeIntersector> embree = plain_embree(scene);
    const BareReplay replay(*embree, recorded.record);
    for (const int threads : {1, 2}) {
      context.progress(fmt::format("floor: {}, threads {}", scene.description.name, threads));
      figures.push_back(floor_figure(scene, recorded.record, replay, threads));
    }
  }
  return figures;
}

}  // namespace raytree::benchmarks
