// From a film to the planes of an image file: all channels for the linear master, three or four of 8 bits for a
// display. The planes point into film and display image, which must outlive the result.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "renderer/display.h"
#include "renderer/film.h"
#include "renderer/image_file.h"

namespace raytree {

using ImageMetadata = std::vector<std::pair<std::string, std::string>>;  ///< name, text

/// Every channel that the film holds. `half` stores color, alpha, normal and albedo in 16 bits; depth and truncation (a
/// bound, which rounding must not lower) stay float32, ids and counts uint32.
Image scene_linear_image(const Film& film, bool half, ImageMetadata metadata);
Image scene_linear_image(Film&& film, bool half, ImageMetadata metadata) = delete;

/// R, G, B in 8 bits, and A where `alpha` asks for it and the film holds it. Declares sRGB where the display is named
/// so.
Image display_referred_image(const DisplayImage& display, const Film& film, ImageMetadata metadata, bool alpha = false);

}  // namespace raytree
