#include "renderer/groups.h"

#include <algorithm>
#include <string_view>
#include <unordered_map>

#include "renderer/suggestion.h"

namespace raytree {
namespace {

class GroupChecker {
 public:
  GroupChecker(const SceneDescription& scene, const RefuseShape& refuse)
      : scene_(scene), refuse_(refuse), states_(scene.groups.size(), State::unseen) {
    for (std::uint32_t i = 0; i < scene.groups.size(); ++i) {
      indices_.emplace(scene.groups[i].name, i);
      names_.push_back(scene.groups[i].name);
    }
  }

  void check() {
    check_list(nullptr, scene_.shapes);
    for (std::uint32_t i = 0; i < scene_.groups.size(); ++i)
      if (states_[i] == State::unseen) check_group(i);
  }

 private:
  enum class State : std::uint8_t { unseen, open, done };

  void check_list(const GroupDescription* group, const std::vector<ShapeDescription>& shapes) {
    for (const ShapeDescription& shape : shapes) {
      if (group != nullptr && std::holds_alternative<PlaneShape>(shape.kind))
        refuse_(group, shape, "a plane has no bounds, which a group must have; put it among the scene's shapes");
      if (const auto* scatter = std::get_if<ScatterShape>(&shape.kind)) check_terrain(group, shapes, shape, *scatter);
      if (std::holds_alternative<InstanceShape>(shape.kind) || std::holds_alternative<ScatterShape>(shape.kind))
        check_use(group, shape);
    }
  }

  void check_terrain(const GroupDescription* group, const std::vector<ShapeDescription>& shapes,
                     const ShapeDescription& shape, const ScatterShape& scatter) {
    std::vector<std::string> terrains;
    for (const ShapeDescription& other : shapes)
      if (std::holds_alternative<TerrainShape>(other.kind)) {
        if (other.name == scatter.terrain) return;
        terrains.push_back(other.name);
      }
    refuse_(group, shape,
            "unknown terrain " + in_quotes(scatter.terrain) + "; " +
                choices_text("terrains beside this shape", scatter.terrain, terrains));
  }

  void check_use(const GroupDescription* group, const ShapeDescription& shape) {
    const std::string& name = group_used_by(shape);
    const auto found = indices_.find(name);
    if (found == indices_.end())
      refuse_(group, shape,
              "unknown group " + in_quotes(name) + "; " + choices_text("groups of this scene", name, names_));
    const std::uint32_t index = found->second;
    if (states_[index] == State::done) return;
    if (states_[index] == State::open) {
      std::string chain;
      for (auto link = std::find(chain_.begin(), chain_.end(), index); link != chain_.end(); ++link)
        chain += in_quotes(names_[*link]) + " holds ";
      refuse_(group, shape, "a group may not hold itself: " + chain + in_quotes(name));
    }
    if (chain_.size() >= kMostGroupLevels)
      refuse_(group, shape,
              "groups stand within groups more than " + std::to_string(kMostGroupLevels) + " levels deep");
    check_group(index);
  }

  void check_group(std::uint32_t index) {
    states_[index] = State::open;
    chain_.push_back(index);
    check_list(&scene_.groups[index], scene_.groups[index].shapes);
    chain_.pop_back();
    states_[index] = State::done;
  }

  const SceneDescription& scene_;
  const RefuseShape& refuse_;
  std::vector<State> states_;
  std::vector<std::uint32_t> chain_;  ///< groups under way, the outermost first
  std::vector<std::string> names_;
  std::unordered_map<std::string_view, std::uint32_t> indices_;
};

}  // namespace

const std::string& group_used_by(const ShapeDescription& shape) {
  static const std::string none;
  if (const auto* instance = std::get_if<InstanceShape>(&shape.kind)) return instance->group;
  if (const auto* scatter = std::get_if<ScatterShape>(&shape.kind)) return scatter->group;
  return none;
}

void check_groups(const SceneDescription& scene, const RefuseShape& refuse) { GroupChecker(scene, refuse).check(); }

std::uint32_t group_index(const SceneDescription& scene, const std::string& name) {
  const auto found = std::find_if(scene.groups.begin(), scene.groups.end(),
                                  [&](const GroupDescription& group) { return group.name == name; });
  return static_cast<std::uint32_t>(found - scene.groups.begin());
}

}  // namespace raytree
