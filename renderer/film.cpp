#include "renderer/film.h"

#include <array>
#include <cstddef>

namespace raytree {
namespace {

struct GroupFacts {
  std::string_view name;
  std::vector<std::string> planes;
  bool ids;
};

const std::array<GroupFacts, kChannelGroupCount>& group_facts() {
  static const std::array<GroupFacts, kChannelGroupCount> facts{{
      {"color", {"R", "G", "B"}, false},
      {"alpha", {"A"}, false},
      {"depth", {"Z"}, false},
      {"normal", {"N.X", "N.Y", "N.Z"}, false},
      {"object_id", {"id.object"}, true},
      {"material_id", {"id.material"}, true},
      {"albedo", {"albedo.R", "albedo.G", "albedo.B"}, false},
      {"ray_count", {"rays"}, true},
      {"truncation", {"truncation.R", "truncation.G", "truncation.B"}, false},
  }};
  return facts;
}

const GroupFacts& facts_of(ChannelGroup group) { return group_facts()[static_cast<std::size_t>(group)]; }

}  // namespace

std::string_view channel_group_name(ChannelGroup group) { return facts_of(group).name; }

std::optional<ChannelGroup> channel_group_from_name(std::string_view name) {
  for (int i = 0; i < kChannelGroupCount; ++i)
    if (group_facts()[static_cast<std::size_t>(i)].name == name) return static_cast<ChannelGroup>(i);
  return std::nullopt;
}

const std::vector<std::string>& plane_names(ChannelGroup group) { return facts_of(group).planes; }
bool holds_ids(ChannelGroup group) { return facts_of(group).ids; }

Film::Film(int frame_width, int frame_height, PixelWindow window, ChannelSet channels)
    : frame_width_(frame_width), frame_height_(frame_height), window_(window), channels_(channels) {
  const std::size_t pixels = static_cast<std::size_t>(window.width) * static_cast<std::size_t>(window.height);
  for (int i = 0; i < kChannelGroupCount; ++i) {
    const auto group = static_cast<ChannelGroup>(i);
    if (!channels.has(group)) continue;
    if (holds_ids(group))
      id_planes_[i].resize(pixels);
    else
      float_planes_[i].assign(plane_names(group).size(), std::vector<float>(pixels));
  }
}

float* Film::plane(ChannelGroup group, int index) {
  return float_planes_[static_cast<int>(group)].at(static_cast<std::size_t>(index)).data();
}
const float* Film::plane(ChannelGroup group, int index) const {
  return float_planes_[static_cast<int>(group)].at(static_cast<std::size_t>(index)).data();
}
std::uint32_t* Film::id_plane(ChannelGroup group) { return id_planes_[static_cast<int>(group)].data(); }
const std::uint32_t* Film::id_plane(ChannelGroup group) const { return id_planes_[static_cast<int>(group)].data(); }

std::size_t Film::memory_bytes() const {
  std::size_t bytes = 0;
  for (const auto& planes : float_planes_)
    for (const auto& plane : planes) bytes += plane.size() * sizeof(float);
  for (const auto& plane : id_planes_) bytes += plane.size() * sizeof(std::uint32_t);
  return bytes;
}

}  // namespace raytree
