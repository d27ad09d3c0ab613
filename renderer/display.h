// From scene-linear radiance to what a display shows: exposure, view and display transform by OpenColorIO
// (this library's only use of it), finite values only, then quantisation with a dither keyed by the pixel.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "renderer/film.h"

namespace raytree {

struct DisplayOptions {
  std::string ocio_config;  ///< file; empty: $OCIO, or else the built-in config
  std::string display;      ///< empty: the config's default
  std::string view;         ///< empty: the display's default
  double exposure = 0;      ///< stops
};

/// One display of a config and its views, in the config's order.
struct DisplayChoices {
  std::string display;
  std::vector<std::string> views;
};

class DisplayTransform {
 public:
  /// Throws Error (bad_input): config unreadable (a set but bad $OCIO too), unknown display or view, with the choices.
  explicit DisplayTransform(const DisplayOptions& options);
  ~DisplayTransform();
  DisplayTransform(DisplayTransform&&) noexcept;
  DisplayTransform& operator=(DisplayTransform&&) noexcept;

  const std::string& config_name() const;
  const std::string& display() const;
  const std::string& view() const;
  std::vector<DisplayChoices> choices() const;

  /// Transforms count pixels [count][3] in place. Values are made finite first (NaN and negative infinity to 0, above
  /// 65504 to 65504); returns how many channel values were not finite. Thread-safe.
  std::int64_t apply(float* rgb, std::int64_t count) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// 8-bit planes R, G, B of a film's color, display-referred and dithered: [3][height][width].
struct DisplayImage {
  int width = 0, height = 0;
  std::vector<std::uint8_t> planes[3];
  std::int64_t not_finite = 0;  ///< channel values that had to be made finite
};
/// The dither depends on the pixel's position in the whole frame alone, so a crop equals its window of the frame.
DisplayImage display_image(const Film& film, const DisplayTransform& transform);

/// The text of the built-in config: displays sRGB, Rec.1886 and Phong's CRT (exponent .33); views Standard, Shade as
/// brightness (Phong 1973, App. I), ACES SDR, Raw.
const std::string& builtin_ocio_config();

}  // namespace raytree
