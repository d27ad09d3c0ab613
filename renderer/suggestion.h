// Words of messages: what stands there, in quotes; and what would have been right, the list of known names and the one
// that a misspelled word most likely meant.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace raytree {

/// `text` in quotes, control characters escaped, at most about 60 characters of it.
std::string in_quotes(std::string_view text);

/// The name nearest to `word` by swapped, missing, wrong and extra letters (case ignored), if it is near enough to be
/// meant: one error in three letters, at least one.
std::optional<std::string> closest_name(std::string_view word, const std::vector<std::string>& names);

/// `known keys: a, b, c (did you mean "b"?)`; at most 40 names are listed. `label` is "known keys" and the like.
std::string choices_text(std::string_view label, std::string_view word, const std::vector<std::string>& names);

}  // namespace raytree
