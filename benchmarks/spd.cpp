// Row spd: rays of the Standard Procedural Databases' standard renders beside those that their author published.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "benchmarks/reference_scenes.h"
#include "benchmarks/rows.h"
#include "renderer/render.h"
#include "renderer/spd_counts.h"
#include "renderer/spd_scenes.h"

namespace raytree::benchmarks {

std::vector<Figure> measure_spd(const MeasureContext& context) {
  std::vector<Figure> figures;
  for (const SpdEntry& entry : spd_databases()) {
    context.progress(fmt::format("spd: {}", entry.name));
    SceneDescription description = spd_scene(entry.database, entry.standard_size);
    const SpdCounts published = published_spd_counts(description).value();
    set_standard_spd_render(description);
    const SpdCounts counts = spd_counts(render(prepared(std::move(description)), {}).statistics);
    Figure figure;
    figure.row = "spd";
    figure.what = fmt::format("{}: largest difference of its counts from the published ones", entry.name);
    figure.unit = "%";
    double largest = 0;
    for (const SpdCountKind& kind : kSpdCounts) {
      const std::uint64_t count = counts.*kind.value, expected = published.*kind.value;
      const double difference = relative_difference(count, expected);
      largest = std::max(largest, 100 * std::abs(difference));
      figure.note += fmt::format("{}{} {} (published {}, {:+.2f} %)", figure.note.empty() ? "" : ", ", kind.name, count,
                                 expected, 100 * difference);
    }
    figure.measured = {largest, largest, largest, 1};
    figure.kind = BoundKind::at_most;
    figure.bound = 100 * kSpdTolerance;
    figures.push_back(std::move(figure));
  }
  return figures;
}

}  // namespace raytree::benchmarks
