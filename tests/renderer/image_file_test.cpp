// Image files: every format comes back as it went in, bit for bit where the format can; damaged files are errors;
// modules that are missing or still loading do no harm.
#include "renderer/image_file.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <tbb/global_control.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <thread>

#include "geometry/error.h"
#include "renderer/film_image.h"
#include "tests/temporary_folder.h"
#include "tests/test_data.h"

// OpenImageIO's PNG reader jumps, as libpng has it, past a string of its own where a file ends early.
extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() { return "leak:ImageInput::geterror\n"; }

namespace raytree {
namespace {

using namespace test;
namespace fs = std::filesystem;

/// A folder of its own for each test.
class ImageFileTest : public ::testing::Test {
 protected:
  std::string path(const std::string& name) const { return folder_.path(name); }

  TemporaryFolder folder_;
};

std::uint32_t hashed(std::uint32_t x) {
  x ^= x >> 16;
  x *= 0x7feb352du;
  x ^= x >> 15;
  x *= 0x846ca68bu;
  return x ^ x >> 16;
}

// Every channel, with values that are hard to keep: ids up to 2^32 - 1, infinities, denormals, negative zero.
Film full_film(int frame_width, int frame_height, PixelWindow window) {
  ChannelSet all;
  for (int i = 0; i < kChannelGroupCount; ++i) all.add(static_cast<ChannelGroup>(i));
  Film film(frame_width, frame_height, window, all);
  const auto pixels = static_cast<std::uint32_t>(window.width * window.height);
  for (int g = 0; g < kChannelGroupCount; ++g) {
    const auto group = static_cast<ChannelGroup>(g);
    const auto seed = static_cast<std::uint32_t>(g) * 7919u;
    if (holds_ids(group)) {
      std::uint32_t* plane = film.id_plane(group);
      for (std::uint32_t i = 0; i < pixels; ++i) plane[i] = hashed(i + seed);
      plane[0] = 0xffffffffu;
      plane[1] = (1u << 24) + 1;
      continue;
    }
    for (std::size_t p = 0; p < plane_names(group).size(); ++p) {
      float* plane = film.plane(group, static_cast<int>(p));
      for (std::uint32_t i = 0; i < pixels; ++i)
        plane[i] = static_cast<float>(hashed(i + seed + 31u * static_cast<std::uint32_t>(p))) * 0x1p-30f - 1;
      plane[0] = std::numeric_limits<float>::infinity();
      plane[1] = 1e-42f;
      plane[2] = -0.0f;
      plane[3] = 3e38f;
    }
  }
  return film;
}

const ImageMetadata kMetadata = {{"raytree:version", "0.1.0"},
                                 {"raytree:scene", "scenes/spheres-1980.json"},
                                 {"raytree:ocio", "raytree-builtin-1, sRGB, Standard"},
                                 {"raytree:settings", "depth 6: cutoff 0.001, \\ \"quoted\""}};

std::string metadata_of(const DecodedImage& image, const std::string& name) {
  for (const auto& [key, text] : image.metadata)
    if (key == name) return text;
  return "(absent)";
}

void expect_metadata(const DecodedImage& image) {
  for (const auto& [name, text] : kMetadata) EXPECT_EQ(metadata_of(image, name), text) << name;
}

void write_image(const std::string& file, const Image& image) { write_image_file(file, image, image_format(file)); }

bool same_bits(float a, float b) { return std::memcmp(&a, &b, sizeof a) == 0; }

TEST_F(ImageFileTest, ExrKeepsEveryBit) {
  const PixelWindow window{5, 3, 37, 41};
  const Film film = full_film(64, 48, window);
  write_image(path("a.exr"), scene_linear_image(film, false, kMetadata));
  const DecodedImage image = read_image_file(path("a.exr"));
  EXPECT_EQ(image.width, 37);
  EXPECT_EQ(image.height, 41);
  EXPECT_EQ(image.frame_width, 64);
  EXPECT_EQ(image.frame_height, 48);
  EXPECT_EQ(image.x0, 5);
  EXPECT_EQ(image.y0, 3);
  expect_metadata(image);
  EXPECT_EQ(image.names.size(), 17u);
  for (int g = 0; g < kChannelGroupCount; ++g) {
    const auto group = static_cast<ChannelGroup>(g);
    for (std::size_t p = 0; p < plane_names(group).size(); ++p) {
      const int index = image.plane_index(plane_names(group)[p]);
      ASSERT_GE(index, 0) << plane_names(group)[p];
      const auto at = static_cast<std::size_t>(index);
      if (holds_ids(group)) {
        EXPECT_EQ(image.types[at], PixelType::uint32);
        ASSERT_EQ(image.id_planes[at].size(), 37u * 41u);
        for (std::size_t i = 0; i < 37 * 41; ++i) ASSERT_EQ(image.id_planes[at][i], film.id_plane(group)[i]) << i;
      } else {
        EXPECT_EQ(image.types[at], PixelType::float32);
        for (std::size_t i = 0; i < 37 * 41; ++i)
          ASSERT_TRUE(same_bits(image.planes[at][i], film.plane(group, static_cast<int>(p))[i])) << i;
      }
    }
  }
}

TEST_F(ImageFileTest, HalfClampsWhatItCannotHoldAndCounts) {
  Film film(4, 2, {0, 0, 4, 2}, {ChannelGroup::color, ChannelGroup::depth, ChannelGroup::object_id});
  const float inf = std::numeric_limits<float>::infinity();
  const float values[8] = {65504, 65519, 65520, 1e30f, -7e4f, inf, 0.1f, 6e-8f};
  // half(0.1) = 1638.5 -> 1638 / 16384; 6e-8 is nearest to the least denormal half, 2^-24.
  const float expected[8] = {65504, 65504, 65504, 65504, -65504, inf, 1638.0f / 16384, 0x1p-24f};
  for (int c = 0; c < 3; ++c) std::copy(values, values + 8, film.plane(ChannelGroup::color, c));
  std::copy(values, values + 8, film.plane(ChannelGroup::depth, 0));
  const EncodeReport report = write_image_file(path("h.exr"), scene_linear_image(film, true, {}), ImageFormat::exr);
  EXPECT_EQ(report.half_clamped, 3 * 4);
  const DecodedImage image = read_image_file(path("h.exr"));
  const auto red = static_cast<std::size_t>(image.plane_index("R"));
  const auto depth = static_cast<std::size_t>(image.plane_index("Z"));
  EXPECT_EQ(image.types[red], PixelType::half);
  EXPECT_EQ(image.types[depth], PixelType::float32);
  for (std::size_t i = 0; i < 8; ++i) {
    EXPECT_EQ(image.planes[red][i], expected[i]) << i;
    EXPECT_EQ(image.planes[depth][i], values[i]) << i;
  }
}

TEST_F(ImageFileTest, EightBitsComeBackFromPngAndTiff) {
  const Film film = full_film(50, 40, {0, 0, 31, 29});
  DisplayImage display;
  display.width = 31;
  display.height = 29;
  display.display = "sRGB";
  for (std::uint32_t c = 0; c < 3; ++c)
    for (std::uint32_t i = 0; i < 31 * 29; ++i) display.planes[c].push_back(static_cast<std::uint8_t>(hashed(i + c)));
  for (const bool alpha : {false, true})
    for (const char* name : {"b.png", "b.tif", "B.TIFF"}) {
      write_image(path(name), display_referred_image(display, film, kMetadata, alpha));
      const DecodedImage image = read_image_file(path(name));
      ASSERT_EQ(image.names.size(), alpha ? 4u : 3u) << name;
      EXPECT_EQ(image.width, 31);
      expect_metadata(image);
      const char* const channels[3] = {"R", "G", "B"};
      for (std::size_t c = 0; c < 3; ++c) {
        const auto at = static_cast<std::size_t>(image.plane_index(channels[c]));
        ASSERT_LT(at, image.planes.size());
        EXPECT_EQ(image.types[at], PixelType::uint8);
        for (std::size_t i = 0; i < 31 * 29; ++i)
          ASSERT_EQ(std::lround(image.planes[at][i] * 255), display.planes[c][i]) << name << " " << i;
      }
      if (!alpha) continue;
      const auto at = static_cast<std::size_t>(image.plane_index("A"));
      for (std::size_t i = 0; i < 31 * 29; ++i) {
        const float a = film.plane(ChannelGroup::alpha, 0)[i];
        ASSERT_EQ(std::lround(image.planes[at][i] * 255), std::lround(std::min(std::max(a, 0.0f), 1.0f) * 255)) << i;
      }
    }
}

TEST_F(ImageFileTest, SixteenBitsAndFloatComeBackFromTiffAndPng) {
  std::vector<std::uint16_t> levels;
  std::vector<float> floats;
  for (std::uint32_t i = 0; i < 17 * 19; ++i) {
    levels.push_back(static_cast<std::uint16_t>(hashed(i)));
    floats.push_back(static_cast<float>(hashed(i)) * 1e-7f - 5);
  }
  Image image;
  image.frame_width = 17;
  image.frame_height = 19;
  image.window = {0, 0, 17, 19};
  for (const char* name : {"R", "G", "B"})
    image.planes.push_back({name, PixelType::uint16, PixelType::uint16, levels.data()});
  for (const char* file : {"c.tif", "c.png"}) {
    write_image(path(file), image);
    const DecodedImage back = read_image_file(path(file));
    EXPECT_EQ(back.types[1], PixelType::uint16);
    for (std::size_t i = 0; i < levels.size(); ++i)
      ASSERT_EQ(std::lround(back.planes[1][i] * 65535), levels[i]) << file;
  }
  for (ImagePlane& plane : image.planes) plane = {plane.name, PixelType::float32, PixelType::float32, floats.data()};
  write_image(path("d.tif"), image);
  const DecodedImage back = read_image_file(path("d.tif"));
  for (std::size_t i = 0; i < floats.size(); ++i) ASSERT_TRUE(same_bits(back.planes[2][i], floats[i]));
  EXPECT_THROW(encode_image(image, ImageFormat::png), Error);
  EXPECT_THROW(encode_image(image, ImageFormat::jpeg), Error);
}

TEST_F(ImageFileTest, JpegComesBackCloseAndSharpInColor) {
  // A red-blue edge at an odd column: with chroma at half resolution it would smear to half the step.
  DisplayImage display;
  display.width = display.height = 32;
  for (int c = 0; c < 3; ++c)
    for (int i = 0; i < 32 * 32; ++i)
      display.planes[c].push_back(static_cast<std::uint8_t>((i % 32 < 13 ? c == 0 : c == 2) ? 220 : 30));
  const Film film(32, 32, {0, 0, 32, 32}, {ChannelGroup::color});
  write_image(path("e.jpg"), display_referred_image(display, film, kMetadata));
  const DecodedImage image = read_image_file(path("e.jpg"));
  expect_metadata(image);
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t i = 0; i < 32 * 32; ++i)
      // Quality 95 quantises with steps of at most 12 levels: half a step in each of the few coefficients of the edge.
      ASSERT_NEAR(image.planes[c][i] * 255, display.planes[c][i], 24) << c << " " << i % 32;
}

TEST_F(ImageFileTest, BytesDependOnThePictureAlone) {
  const Film film = full_film(100, 80, {0, 0, 100, 80});
  DisplayImage display;
  display.display = "sRGB";
  for (std::uint32_t c = 0; c < 3; ++c)
    for (std::uint32_t i = 0; i < 100 * 80; ++i) display.planes[c].push_back(static_cast<std::uint8_t>(hashed(i + c)));
  const Image linear = scene_linear_image(film, false, kMetadata);
  const Image shown = display_referred_image(display, film, kMetadata);
  std::vector<std::vector<std::byte>> first;
  for (const std::size_t threads : {1u, 2u, 5u}) {
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
    std::vector<std::vector<std::byte>> files;
    files.push_back(encode_image(linear, ImageFormat::exr));
    for (const ImageFormat format : {ImageFormat::png, ImageFormat::jpeg, ImageFormat::tiff})
      files.push_back(encode_image(shown, format));
    if (first.empty()) first = files;
    EXPECT_TRUE(files == first) << threads;
    // Longer than the second that a time of day in a file would be rounded to.
    std::this_thread::sleep_for(std::chrono::milliseconds(600));
  }
}

TEST(ImageFormatTest, IsTheExtension) {
  EXPECT_EQ(image_format("a.EXR"), ImageFormat::exr);
  EXPECT_EQ(image_format("x.y/a.png"), ImageFormat::png);
  EXPECT_EQ(image_format("a.b.jpeg"), ImageFormat::jpeg);
  EXPECT_EQ(image_format("a.Jpg"), ImageFormat::jpeg);
  EXPECT_EQ(image_format("a.tif"), ImageFormat::tiff);
  for (const char* bad : {"a", "", "-", "a.gif", "x.png/a", "a."}) try {
      image_format(bad);
      ADD_FAILURE() << bad;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::bad_input);
      for (const char* choice : {".exr", ".png", ".jpg", ".tif"}) EXPECT_TRUE(contains(error.what(), choice));
    }
}

TEST_F(ImageFileTest, FilesComeInPiecesAndWhatTheSinkThrowsComesBack) {
  const Film film = full_film(300, 400, {0, 0, 300, 400});
  const std::vector<std::uint8_t> gray(std::size_t(300) * 400, 100);
  Image shown;
  shown.window = {0, 0, 300, 400};
  shown.planes.push_back({"Y", PixelType::uint8, PixelType::uint8, gray.data()});
  for (const ImageFormat format : {ImageFormat::exr, ImageFormat::png}) {
    const Image image = format == ImageFormat::exr ? scene_linear_image(film, false, {}) : shown;
    const std::vector<std::byte> whole = encode_image(image, format);
    std::size_t largest = 0, calls = 0;
    encode_image(image, format, [&](std::uint64_t offset, const void*, std::size_t size) {
      EXPECT_LE(offset + size, whole.size());
      largest = std::max(largest, size), ++calls;
    });
    // A piece of an EXR is a mebibyte at most, so that what is written is never held as a whole.
    if (format == ImageFormat::exr) {
      EXPECT_GT(whole.size(), std::size_t(4) << 20);
      EXPECT_LE(largest, std::size_t(1) << 20);
      EXPECT_GE(calls, whole.size() >> 20);
    }
    // At the first piece and at the last, which OpenEXR writes where no exception passes.
    for (const std::size_t refused : {std::size_t(1), calls}) {
      std::size_t call = 0;
      const auto refuse = [&](std::uint64_t, const void*, std::size_t) {
        if (++call == refused) throw std::length_error("full");
      };
      EXPECT_THROW(encode_image(image, format, refuse), std::length_error) << refused << " of " << calls;
      EXPECT_EQ(call, refused);
    }
    EXPECT_THROW(write_image_file(path("left"), image, format, [] { throw std::length_error("interrupted"); }),
                 std::length_error);
    EXPECT_TRUE(folder_.names().empty());
  }
}

TEST_F(ImageFileTest, OddRequestsAreErrors) {
  Image image;
  EXPECT_THROW(encode_image(image, ImageFormat::exr), Error);
  const std::vector<std::uint32_t> ids(4);
  image.window = {0, 0, 2, 2};
  image.planes.push_back({"id", PixelType::half, PixelType::uint32, ids.data()});
  EXPECT_THROW(encode_image(image, ImageFormat::exr), Error);
  image.planes[0].type = PixelType::uint32;
  EXPECT_THROW(encode_image(image, ImageFormat::png), Error);
}

// Damaged files that bring down, or hold up for seconds, OpenImageIO 2.4 or OpenEXR 3.1 themselves while they open
// them, before any size can be checked.
const char* library_fault(const std::string& name) {
  for (const char* part : {"5109751098769408", "5446594692513792", "6318802980700160", "6210287474311168"})
    if (contains(name, part)) return "OpenEXR takes seconds and 1-2 GB to refuse it";
  if (contains(name, "bomb-progressive")) return "the JPEG reader takes many seconds to open it";
  if (contains(name, "corrupt-icc-4552")) return "OpenImageIO's reader of color profiles crashes";
  if (contains(name, "xmp-list-blowup") || contains(name, "xmp-multi-packet")) return "OpenImageIO's XMP reader hangs";
  return nullptr;
}

TEST_F(ImageFileTest, DamagedFilesAreErrors) {
  int pictures = 0;
  for (const char* folder : {"malformed/exr", "malformed/image"})
    for (const auto& file : test::test_data_files(folder)) {
      if (file.extension() == ".bmp") continue;
      if (const char* fault = library_fault(file.filename().string()); fault != nullptr) {
        std::fprintf(stderr, "LEFT OUT: %s: %s\n", file.filename().c_str(), fault);
        continue;
      }
      try {
        const DecodedImage image = read_image_file(file.string());
        for (const auto& plane : image.planes)
          EXPECT_EQ(plane.size(), static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height));
        ++pictures;
      } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::bad_input) << file;
        EXPECT_TRUE(contains(error.what(), file.string())) << error.what();
      }
    }
  std::fprintf(stderr, "%d of the damaged files hold a picture all the same\n", pictures);
  folder_.write("empty.exr", "");
  folder_.write("text.png", "not a picture");
  const Film film = full_film(40, 40, {0, 0, 40, 40});
  write_image(path("whole.exr"), scene_linear_image(film, false, {}));
  folder_.write("half.exr", file_text(path("whole.exr")).substr(0, 8000));
  for (const char* name : {"empty.exr", "text.png", "half.exr", "absent.exr", ""})
    EXPECT_THROW(read_image_file(path(name)), Error) << name;
}

TEST_F(ImageFileTest, HeaderThatPromisesTooMuchIsRefused) {
  const Film film(4, 4, {0, 0, 4, 4}, {ChannelGroup::color});
  write_image(path("a.exr"), scene_linear_image(film, false, {}));
  std::string bytes = file_text(path("a.exr"));
  const std::string name("dataWindow\0box2i\0", 17);
  const std::size_t at = bytes.find(name);
  ASSERT_NE(at, std::string::npos);
  const std::int32_t box[4] = {0, 0, 99999, 9999};
  std::memcpy(&bytes[at + name.size() + 4], box, sizeof box);
  folder_.write("bomb.exr", bytes);
  EXPECT_THROW(read_image_file(path("bomb.exr")), Error);
}

// A program that exits while the module is still loading, or never finds it, must do so quietly.
TEST_F(ImageFileTest, ExitDuringThePreloadIsSafe) {
  for (const int pause_ms : {0, 20, 100}) {
    const pid_t child = fork();
    if (child == 0) {
      setenv("RAYTREE_PRELOAD_TEST", std::to_string(pause_ms).c_str(), 1);
      // What the image library's own libraries leave behind when their loading ends in an exit is not judged here.
      setenv("ASAN_OPTIONS", "detect_leaks=0", 1);
      execl("/proc/self/exe", "renderer_tests", "--gtest_filter=PreloadChild.DISABLED_Exits",
            "--gtest_also_run_disabled_tests", "--gtest_brief=1", nullptr);
      _exit(9);
    }
    int status = 0;
    waitpid(child, &status, 0);
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << pause_ms << " " << status;
  }
}

TEST(PreloadChild, DISABLED_Exits) {
  const char* pause = std::getenv("RAYTREE_PRELOAD_TEST");
  ASSERT_NE(pause, nullptr) << "run by ExitDuringThePreloadIsSafe";
  preload_image_io(ImageFormat::jpeg);
  preload_image_io(ImageFormat::jpeg);
  preload_image_io(ImageFormat::png);
  preload_image_io(ImageFormat::exr);
  std::this_thread::sleep_for(std::chrono::milliseconds(std::atoi(pause)));
  finish_preloads();
  std::exit(0);
}

TEST(MissingModuleChild, DISABLED_Reports) {
  const Film film(2, 2, {0, 0, 2, 2}, {ChannelGroup::color});
  const Image image = scene_linear_image(film, false, {});
  for (const auto& [format, module] : {std::pair(ImageFormat::exr, "/nowhere/raytree_exr_io.so"),
                                       std::pair(ImageFormat::png, "/nowhere/raytree_png_io.so"),
                                       std::pair(ImageFormat::jpeg, "/nowhere/raytree_image_io.so")}) {
    preload_image_io(format);
    for (int i = 0; i < 2; ++i) try {
        encode_image(image, format);
        FAIL();
      } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::failure);
        EXPECT_TRUE(contains(error.what(), module)) << error.what();
      }
  }
}

TEST_F(ImageFileTest, MissingModuleIsAnErrorThatNamesThePath) {
  const pid_t child = fork();
  if (child == 0) {
    setenv("RAYTREE_MODULES", "/nowhere", 1);
    execl("/proc/self/exe", "renderer_tests", "--gtest_filter=MissingModuleChild.DISABLED_Reports",
          "--gtest_also_run_disabled_tests", "--gtest_brief=1", nullptr);
    _exit(9);
  }
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << status;
}

}  // namespace
}  // namespace raytree
