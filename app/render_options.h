// The flags of `raytree render` as text and as checked values: what can be said wrong is said before anything is read.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/progress.h"
#include "app/scene_argument.h"
#include "app/usage.h"
#include "renderer/display.h"
#include "renderer/film.h"
#include "renderer/image_file.h"

namespace raytree::app {

inline constexpr int kMostThreads = 1024;

struct OutputFile {
  std::string path;  ///< "-": standard output
  ImageFormat format = ImageFormat::exr;
  bool display_referred() const { return format != ImageFormat::exr; }
};

struct RenderCommandOptions {
  SceneFlags scene;
  std::vector<OutputFile> outputs;
  std::optional<PixelWindow> crop;
  int threads = 0;  ///< at least 1 once parsed
  ChannelSet channels;
  bool half = false;
  DisplayOptions display;
  std::string statistics;   ///< file; "-": standard output; empty: none
  bool spd_counts = false;  ///< the standard render of the SPD, and a table of its rays on standard output
  ProgressMode progress = ProgressMode::automatic;
  bool quiet = false, verbose = false;
  Warnings warnings;  ///< flags that have no effect on what was asked for

  bool writes_display_referred() const;
};

/// None when help or version was asked for and has been printed. Throws Error (bad_input).
std::optional<RenderCommandOptions> parse_render_options(const Words& words);

/// --threads, or all that the machine has when the flag was not given.
int parse_threads(const std::string& text);
/// Comma list of channel groups, or "all".
ChannelSet parse_channels(const std::string& text);

/// Throws Error unless a file can be made at `path`: its folder exists and is writable, and it is not a folder itself.
void check_writable(const std::string& path);

}  // namespace raytree::app
