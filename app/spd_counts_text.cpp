#include "app/spd_counts_text.h"

#include <fmt/format.h>

#include "app/messages.h"
#include "renderer/spd_counts.h"

namespace raytree::app {

std::string spd_counts_text(const SceneDescription& scene, const RenderStatistics& statistics) {
  const SpdCounts counts = spd_counts(statistics);
  const std::optional<SpdCounts> published = published_spd_counts(scene);
  std::string text = fmt::format("{}, {} x {} corner rays, {} levels\n{:<10}{:>12}", scene.name, scene.image.width,
                                 scene.image.height, scene.render.depth, "rays", "traced");
  text += published ? fmt::format("{:>12}{:>12}\n", "published", "difference") : "\n";
  for (const SpdCountKind& kind : kSpdCounts) {
    const std::uint64_t count = counts.*kind.value;
    text += fmt::format("{:<10}{:>12}", kind.name, grouped(count));
    if (published) {
      const std::uint64_t expected = *published.*kind.value;
      text += fmt::format("{:>12}{:>+10.2f} %", grouped(expected), 100 * relative_difference(count, expected));
    }
    text += "\n";
  }
  return text;
}

}  // namespace raytree::app
