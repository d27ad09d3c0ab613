// From scene-linear radiance to what a display shows: exposure, view and display transform by OpenColorIO
// (this library's only use of it), finite values only, then quantisation with a dither keyed by the pixel.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "renderer/film.h"

namespace raytree {

inline constexpr double kLargestExposure = 100;  ///< stops; 2^100 times the largest radiance kept still is a float

struct DisplayOptions {
  std::string ocio_config;  ///< file; "builtin": the built-in config; empty: $OCIO, or else the built-in config
  std::string display;      ///< empty: the config's default
  std::string view;         ///< empty: the display's default
  double exposure = 0;      ///< stops, in [-100, 100]; radiance is multiplied by 2^exposure before the view
};

/// One display of a config and its views, in the config's order.
struct DisplayChoices {
  std::string display;
  std::vector<std::string> views;
};

class DisplayTransform {
 public:
  /// Throws Error (bad_input): config unreadable (a set but bad $OCIO too), unknown display or view, with the choices;
  /// exposure out of range.
  explicit DisplayTransform(const DisplayOptions& options);
  ~DisplayTransform();
  DisplayTransform(DisplayTransform&&) noexcept;
  DisplayTransform& operator=(DisplayTransform&&) noexcept;

  /// The config's own name, or else its file's.
  const std::string& config_name() const;
  const std::string& display() const;
  const std::string& view() const;
  /// The config's space that linear Rec.709 radiance enters as: the one it names so; else its aces_interchange role,
  /// reached by a matrix; else its scene_linear role, taken to be Rec.709.
  const std::string& source_space() const;
  std::vector<DisplayChoices> choices() const;

  /// Transforms count pixels [count][3] in place, exposure included. Values are made finite first (NaN and negative
  /// infinity to 0, beyond +-65504 to +-65504): OpenColorIO turns infinity to black. Returns how many channel values
  /// were not finite. Thread-safe; a pixel's result depends on that pixel alone.
  std::int64_t apply(float* rgb, std::int64_t count) const;
  /// The same for pixels [count][4] whose fourth value is passed over; the faster of the two.
  std::int64_t apply_rgba(float* rgba, std::int64_t count) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// 8-bit planes R, G, B of a film's color, display-referred and dithered: [3][height][width].
struct DisplayImage {
  int width = 0, height = 0;
  std::vector<std::uint8_t> planes[3];
  std::int64_t not_finite = 0;  ///< channel values that had to be made finite
  std::string display, view;    ///< what the values are meant for
};
/// The dither depends on the pixel's position in the whole frame alone, so a crop equals its window of the frame.
/// Throws Error (bad_input) where the film holds no color.
DisplayImage display_image(const Film& film, const DisplayTransform& transform);

/// The dither: thresholds in (0, 1) of a 64 x 64 void-and-cluster mask (Ulichney 1993), repeated over the frame. A
/// display value v becomes floor(255 v + threshold), the same threshold for the three channels, so that grays stay
/// gray. Values within kDitherMargin of a step of 1/255 take that step wherever they stand; the mean over whole tiles
/// of the mask is within kDitherMargin + 1/8192 steps of the value.
inline constexpr int kDitherSize = 64;
inline constexpr float kDitherMargin = 1.0f / 256;
float dither_threshold(int frame_x, int frame_y);

/// One row of the check of the built-in config, for `raytree ocio check`.
struct DisplayCheck {
  std::string display, view;
  double input = 0, expected = 0, got = 0;
  double tolerance = 0;
  bool ok = false;
};
/// Published and closed-form values against what the built-in config gives here, whatever $OCIO says.
std::vector<DisplayCheck> check_builtin_display();

/// The text of the built-in config: displays sRGB, Rec.1886 and Phong's CRT (exponent .33); views Standard, Shade as
/// brightness (Phong 1973, App. I), ACES SDR, Raw.
const std::string& builtin_ocio_config();

}  // namespace raytree
