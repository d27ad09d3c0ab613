// `raytree sheet`: every scene shaded in each of the four ways, side by side in one labelled picture.
#include <fmt/format.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <filesystem>
#include <optional>

#include "app/commands.h"
#include "app/exit_status.h"
#include "app/interruption.h"
#include "app/label_font.h"
#include "app/messages.h"
#include "app/process.h"
#include "app/progress.h"
#include "app/render_options.h"
#include "app/scene_argument.h"
#include "renderer/display.h"
#include "renderer/image_file.h"
#include "renderer/render.h"
#include "renderer/scene_fields.h"

namespace raytree::app {
namespace {

constexpr const char* kCellSize = "264x176";
constexpr int kDot = 2;     ///< pixels along the edge of a letter's dot
constexpr int kMargin = 8;  ///< pixels, around cells
constexpr int kLineHeight = kDot * kGlyphHeight + kMargin;
constexpr std::uint8_t kPaper = 38, kInk = 235;  ///< gray, display-referred

struct SheetOptions {
  SceneFlags scene;  ///< with every scene's name in turn
  std::vector<std::string> scenes;
  std::string output;
  int threads = 0;
  bool quiet = false;
};

/// Planes R, G and B of a picture under way.
class Sheet {
 public:
  Sheet(int width, int height) : width_(width), height_(height) {
    for (auto& plane : planes_) plane.assign(std::size_t(width) * std::size_t(height), kPaper);
  }

  void draw(const DisplayImage& picture, int left, int top) {
    for (int c = 0; c < 3; ++c)
      for (int y = 0; y < picture.height; ++y)
        std::copy_n(picture.planes[c].begin() + std::ptrdiff_t(y) * picture.width, picture.width,
                    planes_[std::size_t(c)].begin() + std::ptrdiff_t(top + y) * width_ + left);
  }

  void write(const std::string& text, int left, int top) {
    for_each_dot(text, [&](int column, int row) {
      for (int i = 0; i < kDot * kDot; ++i) {
        const int x = left + column * kDot + i % kDot, y = top + row * kDot + i / kDot;
        if (x >= width_ || y >= height_) continue;
        for (auto& plane : planes_) plane[std::size_t(y) * std::size_t(width_) + std::size_t(x)] = kInk;
      }
    });
  }

  Image image() const {
    Image image;
    image.frame_width = width_;
    image.frame_height = height_;
    image.window = {0, 0, width_, height_};
    image.color_space = "srgb";
    image.metadata = {{"Software", "Raytree " + version()}};
    const std::array<const char*, 3> names{"R", "G", "B"};
    for (std::size_t c = 0; c < 3; ++c)
      image.planes.push_back({names[c], PixelType::uint8, PixelType::uint8, planes_[c].data()});
    return image;
  }

 private:
  int width_, height_;
  std::array<std::vector<std::uint8_t>, 3> planes_;
};

/// A scene's name without folders and extension.
std::string scene_label(const std::string& scene) { return std::filesystem::path(scene).stem().string(); }

std::optional<SheetOptions> parse_sheet_options(const Words& words) {
  SheetOptions options;
  std::string threads;
  CLI::App command("Shade scenes in each of the four ways, side by side in one picture.", "raytree sheet");
  command.add_option("SCENE", options.scenes, "Scenes, as of raytree render; a row each")->type_name("");
  command.add_option("-o,--output", options.output, "Image file: .png, .jpg or .tif")
      ->type_name("FILE")
      ->group("Output");
  add_scene_flags(command, options.scene, true);
  command.add_option("--threads", threads, "Threads; default: all. Pixels do not depend on it")
      ->type_name("N")
      ->group("Tracing");
  command.add_flag("--quiet", options.quiet, "Errors alone: no progress, no warnings")->group("Messages");
  prepare_usage(command);
  if (!parse_usage(command, words)) return std::nullopt;
  if (options.scenes.empty())
    throw usage_error("no scene: give one or more, for example raytree sheet cylinders -o sheet.png");
  if (options.output.empty()) throw usage_error("no output: add -o FILE, for example -o sheet.png");
  if (image_format(options.output) == ImageFormat::exr)
    throw usage_error("-o: a sheet is a display-referred picture: .png, .jpg or .tif");
  if (options.scene.size.empty()) options.scene.size = kCellSize;
  options.scene.scene = options.scenes.front();
  check_scene_flags(options.scene);
  check_writable(options.output);
  options.threads = parse_threads(threads);
  return options;
}

/// The name that a scene's cells bear, the same in all of them: as much of it as fits before the longest method's.
std::string name_in_cells(const std::string& scene, int cell_width) {
  std::size_t longest = 0;
  for (const auto& method : EnumTable<ShadingMethod>::entries) longest = std::max(longest, method.name.size());
  const auto letters = static_cast<std::size_t>(cell_width / (kDot * kGlyphAdvance));
  return letters > longest + 1 ? shortened(scene_label(scene), letters - longest - 1) : std::string();
}

/// One cell of the sheet.
DisplayImage cell(SceneFlags flags, const SheetOptions& options, const DisplayTransform& display,
                  const Interruption& interruption, Warnings& warnings) {
  PrepareOptions prepare_options;
  prepare_options.camera = flags.camera;
  prepare_options.threads = options.threads;
  prepare_options.stop = &interruption.stop();
  const Scene scene = prepare(load_scene(flags, warnings), prepare_options, warnings);
  RenderOptions render_options;
  render_options.threads = options.threads;
  render_options.stop = &interruption.stop();
  return display_image(render(scene, render_options).film, display);
}

void make_sheet(const SheetOptions& options, Progress& progress, const Interruption& interruption) {
  const auto& methods = EnumTable<ShadingMethod>::entries;
  const ImageSize size = parse_size("--size", options.scene.size);
  const int column_width = size.width + kMargin, row_height = size.height + kLineHeight + kMargin;
  const auto rows = static_cast<int>(options.scenes.size());
  Sheet sheet(kMargin + column_width * static_cast<int>(methods.size()), kMargin + row_height * rows);
  const DisplayTransform display{DisplayOptions()};
  Warnings warnings;
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < static_cast<int>(methods.size()); ++column) {
      if (interruption.stop()) return;
      SceneFlags flags = options.scene;
      flags.scene = options.scenes[static_cast<std::size_t>(row)];
      flags.shading = methods[static_cast<std::size_t>(column)].name;
      progress.phase(fmt::format("{}, {}", flags.scene, flags.shading));
      Warnings of_cell;
      const int left = kMargin + column * column_width, top = kMargin + row * row_height;
      sheet.draw(cell(flags, options, display, interruption, of_cell), left, top + kLineHeight);
      const std::string name = name_in_cells(flags.scene, size.width);
      sheet.write(name.empty() ? flags.shading : name + " " + flags.shading, left, top);
      // What is odd about a scene is so in each of its cells.
      if (column == 0) warnings.insert(warnings.end(), of_cell.begin(), of_cell.end());
    }
  progress.clear();
  if (!options.quiet) print_warnings(warnings, false);
  if (interruption.stop()) return;
  write_image_file(options.output, sheet.image(), image_format(options.output));
  if (options.quiet) return;
  print_message(fmt::format("wrote {} ({}flat, gouraud, phong and limit)", options.output,
                            rows == 1 ? "" : fmt::format("{} scenes, each ", rows)));
}

}  // namespace

int sheet_command(const Words& words) {
  const std::optional<SheetOptions> options = parse_sheet_options(words);
  if (!options) return kSuccess;
  Progress progress(options->quiet ? ProgressMode::none : ProgressMode::automatic);
  const Interruption interruption([&progress] { progress.abandon(); });
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                  static_cast<std::size_t>(options->threads));
  tbb::task_arena arena(options->threads);
  try {
    arena.execute([&] { make_sheet(*options, progress, interruption); });
  } catch (const Error&) {
    // A step that the signal cut short may say so as an error of its own.
    if (!interruption.stop()) throw;
  }
  if (!interruption.stop()) return kSuccess;
  progress.clear();
  print_message("raytree: interrupted");
  return kSignalBase + interruption.signal();
}

}  // namespace raytree::app
