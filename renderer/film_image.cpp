// Lists the planes of a film for an image file; copies no pixel.
#include "renderer/film_image.h"

namespace raytree {
namespace {

bool may_be_half(ChannelGroup group) {
  return group == ChannelGroup::color || group == ChannelGroup::alpha || group == ChannelGroup::normal ||
         group == ChannelGroup::albedo;
}

Image framed(const Film& film, ImageMetadata metadata) {
  Image image;
  image.frame_width = film.frame_width();
  image.frame_height = film.frame_height();
  image.window = film.window();
  image.metadata = std::move(metadata);
  return image;
}

}  // namespace

Image scene_linear_image(const Film& film, bool half, ImageMetadata metadata) {
  Image image = framed(film, std::move(metadata));
  image.color_space = "linear_rec709";
  for (int i = 0; i < kChannelGroupCount; ++i) {
    const auto group = static_cast<ChannelGroup>(i);
    if (!film.channels().has(group)) continue;
    const std::vector<std::string>& names = plane_names(group);
    for (std::size_t p = 0; p < names.size(); ++p) {
      if (holds_ids(group))
        image.planes.push_back({names[p], PixelType::uint32, PixelType::uint32, film.id_plane(group)});
      else
        image.planes.push_back({names[p], half && may_be_half(group) ? PixelType::half : PixelType::float32,
                                PixelType::float32, film.plane(group, static_cast<int>(p))});
    }
  }
  return image;
}

Image display_referred_image(const DisplayImage& display, const Film& film, ImageMetadata metadata, bool alpha) {
  Image image = framed(film, std::move(metadata));
  if (display.display.compare(0, 4, "sRGB") == 0) image.color_space = "srgb";
  const std::vector<std::string>& names = plane_names(ChannelGroup::color);
  for (std::size_t c = 0; c < 3; ++c)
    image.planes.push_back({names[c], PixelType::uint8, PixelType::uint8, display.planes[c].data()});
  if (alpha && film.channels().has(ChannelGroup::alpha))
    image.planes.push_back({plane_names(ChannelGroup::alpha)[0], PixelType::uint8, PixelType::float32,
                            film.plane(ChannelGroup::alpha, 0)});
  return image;
}

}  // namespace raytree
