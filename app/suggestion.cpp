#include "app/suggestion.h"

#include "renderer/suggestion.h"

namespace raytree::app {

std::string did_you_mean(std::string_view word, const std::vector<std::string>& candidates) {
  const std::optional<std::string> nearest = closest_name(word, candidates);
  return nearest ? "; did you mean " + *nearest + "?" : std::string();
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

}  // namespace raytree::app
