// POV-Ray on a scene of ours: the scene file, the run, the picture that it wrote. What the scene file says is
// povray_scene.h's.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "benchmarks/child_process.h"
#include "benchmarks/povray_scene.h"
#include "benchmarks/rows.h"

namespace raytree::benchmarks {

inline constexpr std::uint32_t kLargest16 = 65535;

/// Red, green and blue of each pixel, plane after plane, in [0, 1] as a 16-bit file holds them.
using Picture = std::vector<float>;

class Povray {
 public:
  /// Writes the scene, under `name`, to the scratch folder. `reach`: see write_povray_scene().
  Povray(const MeasureContext& context, const Scene& scene, PovrayPicture picture, double reach,
         const std::string& name);

  /// Renders 16 bits of linear light; `flags`: of its anti-aliasing. Throws Error (failure) where POV-Ray fails.
  ChildResult run(const std::vector<std::string>& flags, int threads = 1) const;
  PovrayStatistics trace(const std::vector<std::string>& flags) const;

  /// Of the last run.
  Picture picture() const;

 private:
  std::filesystem::path scratch_, scene_file_, picture_;
  std::vector<std::string> size_;
};

}  // namespace raytree::benchmarks
