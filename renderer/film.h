// The picture in memory: one plane of floats or ids per channel, scene-linear, row 0 at the top. Only the
// channels that were asked for are held.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace raytree {

/// What a render can record. Each group is one or more planes with the names that EXR readers expect.
enum class ChannelGroup : std::uint8_t {
  color,        ///< R G B: radiance, linear Rec.709
  alpha,        ///< A: share of the pixel's samples whose eye ray hit something
  depth,        ///< Z: distance along the eye ray, mean over the samples that hit, scene units; infinity: none
  normal,       ///< N.X N.Y N.Z: unit shading normal at the first hit, world space; 0: none
  object_id,    ///< id.object: shape index + 1; 0: none
  material_id,  ///< id.material: material index + 1; 0: none
  albedo,       ///< albedo.R .G .B: k_d at the first hit
  ray_count,    ///< rays: rays traced for the pixel, all kinds
  truncation    ///< truncation.R .G .B: bound on the radiance that the cutoff took away, mean over samples
};
inline constexpr int kChannelGroupCount = 9;

enum class PixelType : std::uint8_t { uint8, uint16, half, float32, uint32 };

/// Names as `--channels` takes them: "color", "alpha", "depth", "normal", "object_id", ...
std::string_view channel_group_name(ChannelGroup group);
std::optional<ChannelGroup> channel_group_from_name(std::string_view name);
/// Names of the planes of a group as they stand in an EXR file, e.g. {"R", "G", "B"}.
const std::vector<std::string>& plane_names(ChannelGroup group);

class ChannelSet {
 public:
  ChannelSet() = default;
  ChannelSet(std::initializer_list<ChannelGroup> groups) {
    for (ChannelGroup g : groups) add(g);
  }
  void add(ChannelGroup g) { bits_ |= 1u << static_cast<unsigned>(g); }
  bool has(ChannelGroup g) const { return bits_ >> static_cast<unsigned>(g) & 1u; }

 private:
  std::uint32_t bits_ = 0;
};

/// A window of pixels: x in [x0, x0 + width), y in [y0, y0 + height), y downwards.
struct PixelWindow {
  int x0 = 0, y0 = 0, width = 0, height = 0;
};

class Film {
 public:
  /// A film for `window` of a frame of frame_width x frame_height pixels, every plane zero.
  Film(int frame_width, int frame_height, PixelWindow window, ChannelSet channels);

  int frame_width() const { return frame_width_; }
  int frame_height() const { return frame_height_; }
  const PixelWindow& window() const { return window_; }
  const ChannelSet& channels() const { return channels_; }

  /// Plane `index` of a group held: [height][width] of the window. Ids and ray counts are uint32 planes.
  float* plane(ChannelGroup group, int index);
  const float* plane(ChannelGroup group, int index) const;
  std::uint32_t* id_plane(ChannelGroup group);
  const std::uint32_t* id_plane(ChannelGroup group) const;
  std::size_t memory_bytes() const;

 private:
  int frame_width_, frame_height_;
  PixelWindow window_;
  ChannelSet channels_;
  std::vector<std::vector<float>> float_planes_[kChannelGroupCount];
  std::vector<std::uint32_t> id_planes_[kChannelGroupCount];
};

/// Whether a group's plane holds ids (uint32) in place of floats.
bool holds_ids(ChannelGroup group);

}  // namespace raytree
