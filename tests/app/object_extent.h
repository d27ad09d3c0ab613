// How much of the frame an object takes, from the channel of object ids.
#pragma once

#include <algorithm>

#include "renderer/image_file.h"

namespace raytree::test {

struct ObjectExtent {
  bool touches_border = false;
  double larger_share = 0;  ///< of the frame's width or height, whichever the object takes more of
};

/// Extent of the object of this id in a picture that has the channel group object_id.
inline ObjectExtent extent_of(const DecodedImage& image, float id) {
  const std::vector<float>& ids = image.planes.at(static_cast<std::size_t>(image.plane_index("id.object")));
  int left = image.width, right = -1, top = image.height, bottom = -1;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      if (ids[static_cast<std::size_t>(y * image.width + x)] == id) {
        left = std::min(left, x), right = std::max(right, x);
        top = std::min(top, y), bottom = std::max(bottom, y);
      }
  ObjectExtent extent;
  extent.touches_border = left <= 0 || top <= 0 || right >= image.width - 1 || bottom >= image.height - 1;
  extent.larger_share = std::max(double(right - left + 1) / image.width, double(bottom - top + 1) / image.height);
  return extent;
}

}  // namespace raytree::test
