// Image files: planes of pixels in, one whole file out (or none), and back. The work is done by shared modules that are
// opened on first use, or ahead of it in the background: raytree_exr_io writes EXR through OpenEXR, raytree_png_io PNG
// through libpng; raytree_image_io does the rest through OpenImageIO, whose loading costs a third of a second.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "renderer/film.h"

namespace raytree {

struct ImagePlane {
  std::string name;       ///< channel name in the file
  PixelType type;         ///< how the file stores it (EXR: half, float32, uint32; others: one type for all)
  PixelType source_type;  ///< type of `pixels`: equal to `type`, or float32 for half (beyond 65504 becomes 65504), and
                          ///< for uint8 and uint16 ([0, 1] to the whole range, rounded)
  const void* pixels;     ///< [height][width], row 0 at the top
};

enum class ImageFormat { exr, png, jpeg, tiff };

struct Image {
  int frame_width = 0, frame_height = 0;  ///< the whole frame (EXR display window)
  PixelWindow window;                     ///< the part held (EXR data window; other formats hold it alone)
  std::vector<ImagePlane> planes;
  std::vector<std::pair<std::string, std::string>> metadata;  ///< name, text; one line of plain text each is safest
  std::string color_space;  ///< what the file declares: "linear_rec709", "srgb" or empty (nothing)
};

/// Format by the file name's extension (.exr .png .jpg .jpeg .tif .tiff, any case). Throws Error (bad_input) that
/// lists the choices.
ImageFormat image_format(const std::string& path);

/// Whether files of this format can hold an alpha channel.
bool holds_alpha(ImageFormat format);

/// Begins loading the module that encodes `format` in a background thread; returns at once. Later calls wait for it. A
/// program that may end before calls finish_preloads() first. Modules lie in the folder $RAYTREE_MODULES if that is
/// set; else beside the program, in ../lib, ../lib/raytree or the installation's library folder relative to it. That
/// one is missing is reported by the call that needs it, as an Error (failure) that names the paths tried.
void preload_image_io(ImageFormat format);

/// Waits for what preload_image_io() has begun. Libraries register the ends of their static objects while they are
/// loaded: exit() in between would run those first, beneath the loading. (_exit() runs none, and needs no waiting.)
void finish_preloads();

struct EncodeReport {
  std::int64_t half_clamped = 0;  ///< finite values beyond 65504 that became 65504 in planes of type half
};

/// Takes bytes [offset, offset + size) of a file. They come in order, but for places left at the beginning that are
/// written again at the end (EXR's table of lines).
using ByteSink = std::function<void(std::uint64_t offset, const void* bytes, std::size_t size)>;

/// Encodes a picture, with as many threads as TBB's global_control allows; the bytes do not depend on them. The sink is
/// called from this thread, with a piece at a time, while others encode the next. Throws Error (failure), or what the
/// sink threw.
EncodeReport encode_image(const Image& image, ImageFormat format, const ByteSink& sink);

/// The same, the whole file in memory.
std::vector<std::byte> encode_image(const Image& image, ImageFormat format);

/// Encodes straight into an AtomicFile. `before_commit` is called when all is written and may throw to leave no file.
EncodeReport write_image_file(const std::string& path, const Image& image, ImageFormat format,
                              const std::function<void()>& before_commit = {});

/// A picture read back: float planes named as in the file, [height][width].
struct DecodedImage {
  int width = 0, height = 0;
  int frame_width = 0, frame_height = 0;  ///< EXR: the display window's size; else the picture's
  int x0 = 0, y0 = 0;                     ///< where the picture lies in the frame
  std::vector<std::string> names;
  std::vector<PixelType> types;  ///< in the file; what is none of PixelType counts as float32
  /// [plane][height][width]; 8 and 16 bits as [0, 1], uint32 rounded to float
  std::vector<std::vector<float>> planes;
  /// [plane]: exact values of planes of type uint32, empty for others
  std::vector<std::vector<std::uint32_t>> id_planes;
  std::vector<std::pair<std::string, std::string>> metadata;  ///< text attributes

  /// Index of the plane of that name, or -1.
  int plane_index(const std::string& name) const;
};

/// Reads an image file. Throws Error (bad_input).
DecodedImage read_image_file(const std::string& path);

}  // namespace raytree
