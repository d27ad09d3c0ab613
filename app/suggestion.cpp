#include "app/suggestion.h"

#include <algorithm>
#include <cctype>

namespace raytree::app {

int edit_distance(std::string_view a, std::string_view b) {
  // Three rows of the usual table: a swap of neighbours looks back two.
  std::vector<int> before(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) last[j] = static_cast<int>(j);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = static_cast<int>(i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1)});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) row[j] = std::min(row[j], before[j - 2] + 1);
    }
    std::swap(before, last);
    std::swap(last, row);
  }
  return last[b.size()];
}

std::optional<std::string> nearest_word(std::string_view word, const std::vector<std::string>& candidates) {
  const auto lower = [](std::string_view text) {
    std::string result(text);
    for (char& c : result) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return result;
  };
  constexpr std::size_t kLongestWord = 200;  // the table is quadratic; nobody mistypes a word that long
  if (word.empty() || word.size() > kLongestWord) return std::nullopt;
  const std::string typed = lower(word);
  std::optional<std::string> nearest;
  int best = 0;
  for (const std::string& candidate : candidates) {
    if (candidate.size() > kLongestWord) continue;
    // What was typed may also be the beginning of a longer name.
    const std::string known = lower(candidate);
    const int distance =
        typed.size() >= 3 && known.compare(0, typed.size(), typed) == 0 ? 1 : edit_distance(typed, known);
    if (!nearest || distance < best) nearest = candidate, best = distance;
  }
  const int most = std::max(1, static_cast<int>(typed.size()) / 3);
  return best <= most ? nearest : std::nullopt;
}

std::string did_you_mean(std::string_view word, const std::vector<std::string>& candidates) {
  const std::optional<std::string> nearest = nearest_word(word, candidates);
  return nearest ? "; did you mean " + *nearest + "?" : std::string();
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

}  // namespace raytree::app
