// OpenColorIO's only use: finds the config (the one asked for, $OCIO, or the built-in), checks display and view, and
// brings radiance to display values. Quantisation and its dither stand in dither.cpp.
#include "renderer/display.h"

#include <OpenColorIO/OpenColorIO.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <mutex>
#include <sstream>
#include <utility>

#include "geometry/error.h"
#include "renderer/suggestion.h"

namespace raytree {
namespace {

namespace OCIO = OCIO_NAMESPACE;

constexpr const char* kBuiltinName = "builtin";
constexpr float kLargestValue = 65504;  // the largest half; beyond it view transforms of configs overflow

// Spaces that configs in use give linear Rec.709, by name or alias.
constexpr std::array<const char*, 6> kLinearRec709Names = {
    "lin_rec709", "lin_rec709_srgb", "Linear Rec.709 (sRGB)", "Linear Rec.709", "Utility - Linear - Rec.709",
    "lin_srgb"};

// Linear Rec.709 to ACES2065-1, D65 adapted to the ACES white by Bradford.
constexpr double kRec709ToAces[16] = {0.439632981919491,
                                      0.382988698151554,
                                      0.177378319928955,
                                      0,
                                      0.0897764429588424,
                                      0.813439428748981,
                                      0.0967841282921771,
                                      0,
                                      0.0175411703831727,
                                      0.111546553302387,
                                      0.87091227631444,
                                      0,
                                      0,
                                      0,
                                      0,
                                      1};

// Fast approximations of log, exp and pow differ between instruction sets and cost accuracy; all else is welcome.
constexpr auto kOptimization = static_cast<OCIO::OptimizationFlags>(
    static_cast<unsigned>(OCIO::OPTIMIZATION_VERY_GOOD) & ~static_cast<unsigned>(OCIO::OPTIMIZATION_FAST_LOG_EXP_POW));

struct LoadedConfig {
  OCIO::ConstConfigRcPtr config;
  std::string name;
  std::string file;    // for messages; empty: built-in
  std::string origin;  // what led to this file, as a clause for messages
};

[[noreturn]] void throw_bad(const LoadedConfig& loaded, const std::string& object, const std::string& message) {
  throw Error(ErrorKind::bad_input, {loaded.file, 0, object}, message);
}

/// What may stand there, and which of it `word` most likely means.
std::string choices_for(const std::string& word, const std::vector<std::string>& names) {
  std::vector<std::string> quoted;  // names of a config hold blanks and commas
  for (const std::string& name : names) quoted.push_back("\"" + name + "\"");
  const std::optional<std::string> closest = closest_name(word, names);
  return choices_text("choices", "", quoted) + (closest ? " (did you mean \"" + *closest + "\"?)" : "");
}

LoadedConfig load_config(const std::string& asked) {
  // OpenColorIO writes warnings to stderr unless told otherwise; a library does not print.
  static std::once_flag silence;
  std::call_once(silence, [] { OCIO::SetLoggingFunction([](const char*) {}); });

  LoadedConfig loaded;
  if (!asked.empty()) {
    if (asked != kBuiltinName) loaded.file = asked;
  } else if (const char* environment = std::getenv("OCIO"); environment != nullptr && *environment != '\0') {
    loaded.file = environment;
    loaded.origin = " (named by $OCIO)";
  }
  try {
    if (loaded.file.empty()) {
      std::istringstream text(builtin_ocio_config());
      loaded.config = OCIO::Config::CreateFromStream(text);
    } else {
      loaded.config = OCIO::Config::CreateFromFile(loaded.file.c_str());
    }
    const char* own_name = loaded.config->getName();
    loaded.name = own_name != nullptr ? own_name : "";
  } catch (const std::exception& problem) {
    throw_bad(loaded, "", "not a usable OpenColorIO config" + loaded.origin + ": " + problem.what());
  }
  if (loaded.name.empty()) {
    const std::size_t slash = loaded.file.find_last_of('/');
    loaded.name = slash == std::string::npos ? loaded.file : loaded.file.substr(slash + 1);
  }
  return loaded;
}

std::vector<DisplayChoices> choices_of(const OCIO::ConstConfigRcPtr& config) {
  std::vector<DisplayChoices> choices;
  for (int d = 0; d < config->getNumDisplays(); ++d) {
    DisplayChoices choice;
    choice.display = config->getDisplay(d);
    for (int v = 0; v < config->getNumViews(choice.display.c_str()); ++v)
      choice.views.emplace_back(config->getView(choice.display.c_str(), v));
    choices.push_back(std::move(choice));
  }
  return choices;
}

struct Source {
  std::string space;
  bool through_aces = false;
};

Source source_of(const LoadedConfig& loaded) {
  for (const char* name : kLinearRec709Names)
    if (const OCIO::ConstColorSpaceRcPtr space = loaded.config->getColorSpace(name)) return {space->getName(), false};
  if (loaded.config->hasRole(OCIO::ROLE_INTERCHANGE_SCENE)) return {OCIO::ROLE_INTERCHANGE_SCENE, true};
  if (loaded.config->hasRole(OCIO::ROLE_SCENE_LINEAR)) return {OCIO::ROLE_SCENE_LINEAR, false};
  throw_bad(loaded, "",
            "the config" + loaded.origin + " has neither a space named " + kLinearRec709Names[0] +
                " nor a role aces_interchange or scene_linear: radiance cannot enter it");
}

}  // namespace

struct DisplayTransform::State {
  LoadedConfig loaded;
  std::string display, view, source_space;
  std::vector<DisplayChoices> choices;
  OCIO::ConstCPUProcessorRcPtr processor;
  float gain = 1;
};

DisplayTransform::DisplayTransform(const DisplayOptions& options) : state_(std::make_unique<State>()) {
  State& state = *state_;
  if (!(std::abs(options.exposure) <= kLargestExposure))
    throw Error(ErrorKind::bad_input, {"", 0, "exposure"}, "must lie in [-100, 100] stops");
  state.gain = static_cast<float>(std::exp2(options.exposure));
  state.loaded = load_config(options.ocio_config);
  try {
    state.choices = choices_of(state.loaded.config);
    if (state.choices.empty()) throw_bad(state.loaded, "", "the config" + state.loaded.origin + " has no display");

    state.display = options.display.empty() ? state.loaded.config->getDefaultDisplay() : options.display;
    const auto display = std::find_if(state.choices.begin(), state.choices.end(),
                                      [&](const DisplayChoices& c) { return c.display == state.display; });
    if (display == state.choices.end()) {
      std::vector<std::string> names;
      for (const DisplayChoices& c : state.choices) names.push_back(c.display);
      throw_bad(state.loaded, "display",
                "unknown display \"" + state.display + "\"; " + choices_for(state.display, names));
    }
    state.view = options.view.empty() ? state.loaded.config->getDefaultView(state.display.c_str()) : options.view;
    if (std::find(display->views.begin(), display->views.end(), state.view) == display->views.end())
      throw_bad(state.loaded, "view",
                "unknown view \"" + state.view + "\" of display \"" + state.display + "\"; " +
                    choices_for(state.view, display->views));

    const Source source = source_of(state.loaded);
    state.source_space = source.space;
    const OCIO::GroupTransformRcPtr group = OCIO::GroupTransform::Create();
    if (source.through_aces) {
      const OCIO::MatrixTransformRcPtr matrix = OCIO::MatrixTransform::Create();
      matrix->setMatrix(kRec709ToAces);
      group->appendTransform(matrix);
    }
    const OCIO::DisplayViewTransformRcPtr transform = OCIO::DisplayViewTransform::Create();
    transform->setSrc(state.source_space.c_str());
    transform->setDisplay(state.display.c_str());
    transform->setView(state.view.c_str());
    group->appendTransform(transform);
    state.processor = state.loaded.config->getProcessor(group)->getOptimizedCPUProcessor(
        OCIO::BIT_DEPTH_F32, OCIO::BIT_DEPTH_F32, kOptimization);
  } catch (const Error&) {
    throw;
  } catch (const std::exception& problem) {
    throw_bad(state.loaded, "display \"" + state.display + "\", view \"" + state.view + "\"",
              "the config" + state.loaded.origin + " does not give this transform: " + problem.what());
  }
}

DisplayTransform::~DisplayTransform() = default;
DisplayTransform::DisplayTransform(DisplayTransform&&) noexcept = default;
DisplayTransform& DisplayTransform::operator=(DisplayTransform&&) noexcept = default;

const std::string& DisplayTransform::config_name() const { return state_->loaded.name; }
const std::string& DisplayTransform::display() const { return state_->display; }
const std::string& DisplayTransform::view() const { return state_->view; }
const std::string& DisplayTransform::source_space() const { return state_->source_space; }
std::vector<DisplayChoices> DisplayTransform::choices() const { return state_->choices; }

std::int64_t DisplayTransform::apply_rgba(float* rgba, std::int64_t count) const {
  if (count <= 0) return 0;
  const float gain = state_->gain;
  std::int64_t not_finite = 0;
  for (std::int64_t i = 0; i < 4 * count; ++i) {
    const float value = rgba[i];
    const bool finite = std::abs(value) <= std::numeric_limits<float>::max();
    not_finite += !finite && (i & 3) != 3;
    const float exposed = finite ? value * gain : (value > 0 ? kLargestValue : 0.0f);
    rgba[i] = std::clamp(exposed, -kLargestValue, kLargestValue);
  }
  OCIO::PackedImageDesc image(rgba, static_cast<long>(count), 1, 4);
  state_->processor->apply(image);
  return not_finite;
}

std::int64_t DisplayTransform::apply(float* rgb, std::int64_t count) const {
  constexpr std::int64_t kBatch = 1024;
  std::array<float, 4 * kBatch> rgba;
  std::int64_t not_finite = 0;
  for (std::int64_t begin = 0; begin < count; begin += kBatch) {
    const std::int64_t size = std::min(kBatch, count - begin);
    float* pixels = rgb + 3 * begin;
    for (std::int64_t i = 0; i < size; ++i) {
      for (std::int64_t c = 0; c < 3; ++c) rgba[static_cast<std::size_t>(4 * i + c)] = pixels[3 * i + c];
      rgba[static_cast<std::size_t>(4 * i + 3)] = 1;
    }
    not_finite += apply_rgba(rgba.data(), size);
    for (std::int64_t i = 0; i < size; ++i)
      for (std::int64_t c = 0; c < 3; ++c) pixels[3 * i + c] = rgba[static_cast<std::size_t>(4 * i + c)];
  }
  return not_finite;
}

DisplayImage display_image(const Film& film, const DisplayTransform& transform) {
  if (!film.channels().has(ChannelGroup::color))
    throw Error(ErrorKind::bad_input, {"", 0, "channels"}, "a display-referred picture needs the channel color");
  const PixelWindow& window = film.window();
  DisplayImage image;
  image.width = window.width;
  image.height = window.height;
  image.display = transform.display();
  image.view = transform.view();
  const std::size_t pixels = static_cast<std::size_t>(window.width) * static_cast<std::size_t>(window.height);
  for (auto& plane : image.planes) plane.resize(pixels);
  if (pixels == 0) return image;

  const float* source[3];
  for (int c = 0; c < 3; ++c) source[c] = film.plane(ChannelGroup::color, c);
  std::atomic<std::int64_t> not_finite{0};
  const auto width = static_cast<std::size_t>(window.width);
  dither_threshold(0, 0);  // builds the mask before the tasks ask for it
  tbb::parallel_for(tbb::blocked_range<int>(0, window.height, 4), [&](const tbb::blocked_range<int>& rows) {
    std::vector<float> rgba(4 * width);
    std::int64_t count = 0;
    for (int y = rows.begin(); y < rows.end(); ++y) {
      const std::size_t row = static_cast<std::size_t>(y) * width;
      for (std::size_t x = 0; x < width; ++x) {
        for (std::size_t c = 0; c < 3; ++c) rgba[4 * x + c] = source[c][row + x];
        rgba[4 * x + 3] = 1;
      }
      count += transform.apply_rgba(rgba.data(), window.width);
      for (std::size_t x = 0; x < width; ++x) {
        const float threshold = dither_threshold(window.x0 + static_cast<int>(x), window.y0 + y);
        for (std::size_t c = 0; c < 3; ++c) {
          // Written so that NaN, which a config of the user's may make, becomes 0.
          const float value = rgba[4 * x + c] > 0 ? std::min(rgba[4 * x + c], 1.0f) : 0.0f;
          image.planes[c][row + x] = static_cast<std::uint8_t>(value * 255.0f + threshold);
        }
      }
    }
    not_finite += count;
  });
  image.not_finite = not_finite;
  return image;
}

}  // namespace raytree
