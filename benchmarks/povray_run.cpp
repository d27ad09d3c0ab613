#include "benchmarks/povray_run.h"

#include <fmt/format.h>

#include <algorithm>

#include "renderer/image_file.h"

namespace raytree::benchmarks {

Povray::Povray(const MeasureContext& context, const Scene& scene, PovrayPicture picture, double reach,
               const std::string& name)
    : scratch_(context.scratch),
      scene_file_(context.scratch / (name + ".pov")),
      picture_(context.scratch / (name + ".png")) {
  write_povray_scene(scene_file_, scene, picture, reach);
  size_ = {fmt::format("+W{}", scene.description.image.width), fmt::format("+H{}", scene.description.image.height)};
}

ChildResult Povray::run(const std::vector<std::string>& flags, int threads) const {
  std::vector<std::string> words{"povray",
                                 "+I" + scene_file_.string(),
                                 "+O" + picture_.string(),
                                 "+FN16",
                                 "File_Gamma=1.0",
                                 fmt::format("+WT{}", threads),
                                 "-D",
                                 "-V"};
  words.insert(words.end(), size_.begin(), size_.end());
  words.insert(words.end(), flags.begin(), flags.end());
  const ChildResult child = run_child(words, scratch_);
  require_success(child, "povray");
  return child;
}

PovrayStatistics Povray::trace(const std::vector<std::string>& flags) const {
  return parse_povray_statistics(run(flags).errors);
}

Picture Povray::picture() const {
  const DecodedImage image = read_image_file(picture_);
  Picture result;
  for (const char* name : {"R", "G", "B"}) {
    // A picture without color is written as one of brightness alone.
    const int plane = std::max(0, image.plane_index(name));
    const std::vector<float>& values = image.planes.at(static_cast<std::size_t>(plane));
    result.insert(result.end(), values.begin(), values.end());
  }
  return result;
}

}  // namespace raytree::benchmarks
