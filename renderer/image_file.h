// Image files: planes of pixels in, one whole file out (or none), and back. The work is done by the shared module
// raytree_image_io, the only place that links OpenImageIO; it is opened on first use, or ahead of it in the
// background, since loading OpenImageIO costs a third of a second.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "renderer/film.h"

namespace raytree {

struct ImagePlane {
  std::string name;       ///< channel name in the file
  PixelType type;         ///< how the file stores it (EXR: half, float32, uint32; others: one type for all)
  PixelType source_type;  ///< type of `pixels`: float32, uint32, uint8 or uint16
  const void* pixels;     ///< [height][width], row 0 at the top
};

enum class ImageFormat { exr, png, jpeg, tiff };

struct Image {
  int frame_width = 0, frame_height = 0;  ///< the whole frame (EXR display window)
  PixelWindow window;                     ///< the part held (EXR data window; other formats hold it alone)
  std::vector<ImagePlane> planes;
  std::vector<std::pair<std::string, std::string>> metadata;  ///< name, text
};

/// Format by the file name's extension (.exr .png .jpg .jpeg .tif .tiff, any case). Throws Error (bad_input) that
/// lists the choices.
ImageFormat image_format(const std::string& path);

/// Begins loading the module in a background thread; returns at once. Later calls wait for it.
void preload_image_io();

/// The encoded file. Throws Error (failure).
std::vector<std::byte> encode_image(const Image& image, ImageFormat format);

/// Writes bytes to `path` whole or not at all: a temporary file beside it, fsync, rename. "-" is standard output.
/// An existing file stays as it was when anything fails. Throws Error (failure) with the path and the system's reason.
void write_file_atomically(const std::string& path, const void* bytes, std::size_t size);

/// Removes the temporary file of a write under way, if any: for the handler of an interruption.
void remove_unfinished_file() noexcept;

/// A picture read back: float planes named as in the file, [height][width].
struct DecodedImage {
  int width = 0, height = 0;
  std::vector<std::string> names;
  std::vector<std::vector<float>> planes;
  std::vector<std::pair<std::string, std::string>> metadata;  ///< text attributes
};

/// Reads an image file. Throws Error (bad_input).
DecodedImage read_image_file(const std::string& path);

}  // namespace raytree
