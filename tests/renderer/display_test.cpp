// The display transform: published values, which config wins, what errors say, finite values, dither, crops.
#include "renderer/display.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <string>

#include "geometry/error.h"
#include "tests/test_data.h"

namespace raytree {
namespace {

// Sets or clears $OCIO for one test.
class OcioEnvironment {
 public:
  explicit OcioEnvironment(const char* value) {
    const char* old = std::getenv("OCIO");
    had_ = old != nullptr;
    if (had_) old_ = old;
    if (value != nullptr)
      setenv("OCIO", value, 1);
    else
      unsetenv("OCIO");
  }
  ~OcioEnvironment() {
    if (had_)
      setenv("OCIO", old_.c_str(), 1);
    else
      unsetenv("OCIO");
  }

 private:
  bool had_ = false;
  std::string old_;
};

DisplayTransform transform_of(const std::string& display, const std::string& view, double exposure = 0,
                              const std::string& config = "builtin") {
  DisplayOptions options;
  options.ocio_config = config;
  options.display = display;
  options.view = view;
  options.exposure = exposure;
  return DisplayTransform(options);
}

float shown(const DisplayTransform& transform, float value) {
  float rgb[3] = {value, value, value};
  transform.apply(rgb, 1);
  EXPECT_NEAR(rgb[0], rgb[1], 4e-6);  // gray stays gray, but for the ACES matrices in float
  return rgb[1];
}

std::string error_of(const DisplayOptions& options) {
  try {
    const DisplayTransform transform(options);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::bad_input);
    return error.what();
  }
  return "";
}

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

Film film_of(int width, int height, PixelWindow window, float (*value)(int x, int y, int c)) {
  Film film(width, height, window, {ChannelGroup::color});
  for (int c = 0; c < 3; ++c)
    for (int y = 0; y < window.height; ++y)
      for (int x = 0; x < window.width; ++x)
        film.plane(ChannelGroup::color, c)[y * window.width + x] = value(window.x0 + x, window.y0 + y, c);
  return film;
}

float ramp(int x, int y, int c) { return static_cast<float>(x * 7 + y * 3 + c * 11) / 977.0f; }

TEST(DisplayCheckTest, PublishedValuesHold) {
  const auto rows = check_builtin_display();
  EXPECT_GE(rows.size(), 60u);
  for (const DisplayCheck& row : rows)
    EXPECT_TRUE(row.ok) << row.display << ", " << row.view << ": " << row.input << " gives " << row.got << ", expected "
                        << row.expected << " +- " << row.tolerance;
}

TEST(DisplayCheckTest, DoesNotDependOnTheEnvironment) {
  const OcioEnvironment environment("/nowhere/at/all.ocio");
  for (const DisplayCheck& row : check_builtin_display()) EXPECT_TRUE(row.ok);
}

TEST(DisplayTransformTest, BuiltinHasItsDisplaysAndViews) {
  const OcioEnvironment environment(nullptr);
  const DisplayTransform transform{DisplayOptions{}};
  EXPECT_EQ(transform.config_name(), "raytree-builtin-1");
  EXPECT_EQ(transform.display(), "sRGB");
  EXPECT_EQ(transform.view(), "Standard");
  EXPECT_EQ(transform.source_space(), "Linear Rec.709");
  const auto choices = transform.choices();
  ASSERT_EQ(choices.size(), 3u);
  const std::vector<std::string> views = {"Standard", "Shade as brightness", "ACES SDR", "Raw"};
  EXPECT_EQ(choices[0].display, "sRGB");
  EXPECT_EQ(choices[1].display, "Rec.1886");
  EXPECT_EQ(choices[2].display, "CRT");
  for (const DisplayChoices& choice : choices) EXPECT_EQ(choice.views, views) << choice.display;
}

TEST(DisplayTransformTest, DensityIsLinearInShade) {
  // Undoing the CRT's power leaves the light; -log10 of it is film density, 2 (1 - s).
  const DisplayTransform transform = transform_of("CRT", "Shade as brightness");
  for (int i = 0; i <= 64; ++i) {
    const float s = static_cast<float>(i) / 64;
    const double density = -std::log10(std::pow(shown(transform, s), 1 / 0.33));
    // d(density)/dv = 1 / (0.33 ln 10 v) <= 6.1 at v = .2188, times 4 ulp of v
    EXPECT_NEAR(density, 2 * (1 - s), 3e-6) << s;
  }
}

TEST(DisplayTransformTest, EveryViewIsMonotone) {
  for (const DisplayChoices& choice : transform_of("", "").choices())
    for (const std::string& view : choice.views) {
      const DisplayTransform transform = transform_of(choice.display, view);
      float last = -1;
      for (int i = 0; i <= 400; ++i) {
        const float v = shown(transform, static_cast<float>(i) / 100);
        EXPECT_GE(v, last) << choice.display << " " << view << " " << i;
        last = v;
      }
    }
}

TEST(DisplayTransformTest, ExposureCountsStops) {
  // Powers of two are exact in float, so a stop equals a doubled input bit for bit.
  for (const double stops : {-3.0, -1.0, 1.0, 2.0})
    EXPECT_EQ(shown(transform_of("sRGB", "Standard", stops), 0.11f),
              shown(transform_of("sRGB", "Standard"), 0.11f * std::exp2(static_cast<float>(stops))));
  DisplayOptions options;
  options.ocio_config = "builtin";
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity(), 101.0, -101.0}) {
    options.exposure = bad;
    EXPECT_TRUE(contains(error_of(options), "[-100, 100]")) << bad;
  }
}

TEST(DisplayTransformTest, NothingThatIsNotFiniteReachesTheDisplay) {
  const float inf = std::numeric_limits<float>::infinity();
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (const double exposure : {0.0, 100.0, -100.0})
    for (const DisplayChoices& choice : transform_of("", "").choices())
      for (const std::string& view : choice.views) {
        const DisplayTransform transform = transform_of(choice.display, view, exposure);
        float rgb[] = {inf, 1, 1, nan, nan, nan, -inf, -inf, 2, -2, 3e38f, -3e38f, .5f, .25f, 0};
        EXPECT_EQ(transform.apply(rgb, 5), 6);
        for (const float v : rgb) EXPECT_TRUE(std::isfinite(v)) << choice.display << " " << view;
      }
  // Infinite light is white, not black, also through the ACES view.
  EXPECT_NEAR(shown(transform_of("sRGB", "Standard"), inf), 1, 1e-6);
  EXPECT_GT(shown(transform_of("sRGB", "ACES SDR"), inf), 0.99f);
  EXPECT_EQ(shown(transform_of("sRGB", "Standard"), nan), 0.0f);
}

TEST(DisplayTransformTest, OptionBeatsEnvironmentBeatsBuiltin) {
  const OcioEnvironment environment("/nowhere/at/all.ocio");
  EXPECT_EQ(transform_of("", "", 0, "builtin").config_name(), "raytree-builtin-1");
  // The environment's is used, and its being unreadable is an error that names it and the variable.
  const std::string message = error_of(DisplayOptions{});
  EXPECT_TRUE(contains(message, "/nowhere/at/all.ocio") && contains(message, "$OCIO")) << message;
  DisplayOptions options;
  options.ocio_config = "/nowhere/else.ocio";
  const std::string other = error_of(options);
  EXPECT_TRUE(contains(other, "/nowhere/else.ocio") && !contains(other, "$OCIO")) << other;
  const OcioEnvironment empty("");
  EXPECT_EQ(DisplayTransform(DisplayOptions{}).config_name(), "raytree-builtin-1");
}

TEST(DisplayTransformTest, UnknownNamesListTheChoices) {
  DisplayOptions options;
  options.ocio_config = "builtin";
  options.display = "srgb";
  std::string message = error_of(options);
  for (const char* part : {"\"srgb\"", "\"sRGB\"", "\"Rec.1886\"", "\"CRT\""})
    EXPECT_TRUE(contains(message, part)) << message;
  options.display = "CRT";
  options.view = "Filmic";
  message = error_of(options);
  for (const char* part : {"Filmic", "CRT", "\"Standard\"", "\"Shade as brightness\"", "\"ACES SDR\"", "\"Raw\""})
    EXPECT_TRUE(contains(message, part)) << message;
}

TEST(DisplayTransformTest, AcesConfigGetsRec709Radiance) {
  const auto files = test::test_data_files("ocio");
  for (const auto& file : files) {
    if (file.filename() != "cg-config-v1.0.0_aces-v1.3_ocio-v2.1.ocio" && file.filename() != "ocio-v2_demo.ocio")
      continue;
    const std::string config = file.string();
    const DisplayTransform transform = transform_of("", "", 0, config);
    if (contains(config, "cg-config")) {
      // Its scene_linear role is ACEScg: red must enter as Rec.709 red, which this view shows as pure red again.
      const DisplayTransform plain = transform_of("sRGB - Display", "Un-tone-mapped", 0, config);
      float rgb[6] = {1, 0, 0, .18f, .18f, .18f};
      plain.apply(rgb, 2);
      // The config's matrices are written with 15 digits; the sRGB slope at 0 is 12.92.
      EXPECT_NEAR(rgb[0], 1, 1e-5);
      EXPECT_NEAR(rgb[1], 0, 1e-5);
      EXPECT_NEAR(rgb[2], 0, 1e-5);
      EXPECT_NEAR(rgb[4], .461356, 1e-5);
      // The same ACES view as the built-in's: two independent ways in.
      const DisplayTransform aces = transform_of("sRGB - Display", "ACES 1.0 - SDR Video", 0, config);
      const DisplayTransform ours = transform_of("sRGB", "ACES SDR");
      float a[9] = {.18f, .18f, .18f, .7f, .2f, .05f, .02f, .4f, 1.5f}, b[9];
      std::copy(a, a + 9, b);
      aces.apply(a, 3);
      ours.apply(b, 3);
      for (int i = 0; i < 9; ++i) EXPECT_NEAR(a[i], b[i], 2e-5) << i;
    }
    for (const DisplayChoices& choice : transform.choices())
      for (const std::string& view : choice.views) try {
          shown(transform_of(choice.display, view, 0, config), .18f);
        } catch (const Error& error) {
          EXPECT_EQ(error.kind(), ErrorKind::bad_input);  // a view that asks for looks or files that are not there
        }
  }
}

TEST(DisplayTransformTest, ConfigWithoutRec709GetsItThroughAces) {
  // The built-in config with its Rec.709 space under a name nobody knows and another scene_linear role: the way through
  // aces_interchange must end at the same values.
  std::string text = builtin_ocio_config();
  const auto replace = [&](const std::string& from, const std::string& to) {
    for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
      text.replace(at, from.size(), to);
  };
  replace("aliases: [lin_rec709, Linear Rec.709 (sRGB)]", "aliases: []");
  replace("Linear Rec.709", "House space");
  replace("scene_linear: House space", "scene_linear: ACES2065-1");
  std::string file = ::testing::TempDir() + "raytree-XXXXXX.ocio";
  const int descriptor = mkstemps(file.data(), 5);
  ASSERT_GE(descriptor, 0);
  ASSERT_EQ(write(descriptor, text.data(), text.size()), static_cast<ssize_t>(text.size()));
  close(descriptor);
  {
    const DisplayTransform through = transform_of("sRGB", "Standard", 0, file);
    EXPECT_EQ(through.source_space(), "aces_interchange");
    float a[9] = {.18f, .18f, .18f, .7f, .2f, .05f, 0, .4f, 1}, b[9];
    std::copy(a, a + 9, b);
    through.apply(a, 3);
    transform_of("sRGB", "Standard").apply(b, 3);
    // The matrix and its inverse leave a few float roundings, times the sRGB slope of 12.92 at most.
    for (int i = 0; i < 9; ++i) EXPECT_NEAR(a[i], b[i], 12.92 * 8 * 0x1p-24) << i;
  }
  unlink(file.c_str());
}

TEST(DisplayTransformTest, DamagedConfigsAreErrors) {
  for (const auto& file : test::test_data_files("malformed/ocio")) {
    DisplayOptions options;
    options.ocio_config = file.string();
    const std::string message = error_of(options);
    EXPECT_TRUE(contains(message, file.string())) << file << ": " << message;
  }
  for (const auto& file : test::test_data_files("ocio")) try {
      DisplayOptions options;
      options.ocio_config = file.string();
      shown(DisplayTransform(options), .18f);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::bad_input);
      EXPECT_TRUE(contains(error.what(), file.string())) << error.what();
    }
}

TEST(DitherTest, MaskHoldsEveryThresholdOnce) {
  std::vector<int> seen(kDitherSize * kDitherSize);
  for (int y = 0; y < kDitherSize; ++y)
    for (int x = 0; x < kDitherSize; ++x) {
      const float t = dither_threshold(x, y);
      EXPECT_GT(t, kDitherMargin);
      EXPECT_LT(t, 1 - kDitherMargin);
      const float rank = (t - kDitherMargin) / (1 - 2 * kDitherMargin) * (kDitherSize * kDitherSize) - 0.5f;
      ++seen.at(static_cast<std::size_t>(std::lround(rank)));
      EXPECT_EQ(t, dither_threshold(x + kDitherSize, y - 3 * kDitherSize));
    }
  for (const int count : seen) EXPECT_EQ(count, 1);
}

TEST(DitherTest, MaskHasLittleNoiseThatTheEyeSees) {
  // Means of 8 x 8 blocks: white noise of variance 1/12 has 1/(12 64); blue noise far less: .08 of it
  // measured. The variance of 64 such means of white noise strays by sqrt(2/64) = .18 of itself.
  double variance = 0;
  for (int by = 0; by < 8; ++by)
    for (int bx = 0; bx < 8; ++bx) {
      double sum = 0;
      for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 8; ++x) sum += dither_threshold(8 * bx + x, 8 * by + y);
      variance += (sum / 64 - 0.5) * (sum / 64 - 0.5) / 64;
    }
  EXPECT_LT(variance, 0.15 / (12 * 64));
}

TEST(DisplayImageTest, MeanOfADitheredPlaneIsItsValue) {
  // Raw view: the display value is the radiance. Over 128 x 128 pixels (whole tiles) the mean is within the margin.
  for (const float value : {0.0011f, 0.25f, 0.3333f, 0.50049f, 0.7f, 0.9991f}) {
    Film film(128, 128, {0, 0, 128, 128}, {ChannelGroup::color});
    for (int c = 0; c < 3; ++c) std::fill_n(film.plane(ChannelGroup::color, c), 128 * 128, value);
    const DisplayImage image = display_image(film, transform_of("sRGB", "Raw"));
    for (const auto& plane : image.planes) {
      double sum = 0;
      for (const std::uint8_t v : plane) sum += v;
      EXPECT_NEAR(sum / (128 * 128), value * 255.0, kDitherMargin + 1.0 / 8192) << value;
    }
  }
}

TEST(DisplayImageTest, ExactValuesStayExact) {
  Film film(256, 64, {0, 0, 256, 64}, {ChannelGroup::color});
  for (int c = 0; c < 3; ++c)
    for (int y = 0; y < 64; ++y)
      for (int x = 0; x < 256; ++x) {
        // Radiance that sRGB encodes as x / 255, by the inverse of its curve in double.
        const double v = x / 255.0;
        const double linear = v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
        film.plane(ChannelGroup::color, c)[y * 256 + x] = static_cast<float>(linear);
      }
  const DisplayImage image = display_image(film, transform_of("sRGB", "Standard"));
  for (const auto& plane : image.planes)
    for (int i = 0; i < 256 * 64; ++i) ASSERT_EQ(plane[static_cast<std::size_t>(i)], i % 256) << i;
}

TEST(DisplayImageTest, CropEqualsItsWindow) {
  const DisplayTransform transform = transform_of("sRGB", "ACES SDR");
  const DisplayImage whole = display_image(film_of(101, 73, {0, 0, 101, 73}, ramp), transform);
  const PixelWindow window{37, 11, 45, 50};
  const DisplayImage crop = display_image(film_of(101, 73, window, ramp), transform);
  for (int c = 0; c < 3; ++c)
    for (int y = 0; y < window.height; ++y)
      for (int x = 0; x < window.width; ++x)
        ASSERT_EQ(crop.planes[c][static_cast<std::size_t>(y * window.width + x)],
                  whole.planes[c][static_cast<std::size_t>((window.y0 + y) * 101 + window.x0 + x)]);
}

TEST(DisplayImageTest, ThreadsDoNotMatter) {
  const DisplayTransform transform = transform_of("CRT", "Shade as brightness");
  const Film film = film_of(97, 61, {0, 0, 97, 61}, ramp);
  const DisplayImage first = display_image(film, transform);
  for (const std::size_t threads : {1u, 2u, 3u, 7u}) {
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
    const DisplayImage image = display_image(film, transform);
    for (int c = 0; c < 3; ++c) EXPECT_EQ(image.planes[c], first.planes[c]) << threads;
  }
}

TEST(DisplayImageTest, CountsWhatIsNotFinite) {
  Film film = film_of(33, 9, {0, 0, 33, 9}, ramp);
  film.plane(ChannelGroup::color, 0)[5] = std::numeric_limits<float>::quiet_NaN();
  film.plane(ChannelGroup::color, 2)[7] = std::numeric_limits<float>::infinity();
  const DisplayImage image = display_image(film, transform_of("sRGB", "Standard"));
  EXPECT_EQ(image.not_finite, 2);
  EXPECT_EQ(image.planes[0][5], 0);
  EXPECT_EQ(image.planes[2][7], 255);
}

TEST(DisplayImageTest, NeedsColor) {
  const Film film(4, 4, {0, 0, 4, 4}, {ChannelGroup::depth});
  EXPECT_THROW(display_image(film, transform_of("sRGB", "Standard")), Error);
}

TEST(DisplayImageTest, EmptyFilmIsAnEmptyPicture) {
  const Film film(4, 4, {0, 0, 0, 0}, {ChannelGroup::color});
  EXPECT_TRUE(display_image(film, transform_of("sRGB", "Standard")).planes[0].empty());
}

}  // namespace
}  // namespace raytree
