// Parsing of a subcommand's words with CLI11: help and version are printed, what is wrong becomes an Error that names
// the flag and what would be right. Values are read here too, so that every flag words its errors alike.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "geometry/error.h"

namespace CLI {
class App;
}

namespace raytree::app {

using Words = std::vector<std::string>;

[[nodiscard]] Error usage_error(const std::string& message);

/// Sets what every subcommand shares: --help, --version, the layout of the help text.
void prepare_usage(CLI::App& command);

/// Parses words. False when the help or the version was asked for and has been printed. Throws Error (bad_input).
bool parse_usage(CLI::App& command, const Words& words);

/// The whole number that all of `text` is, if it is one.
std::optional<std::int64_t> whole_number(const std::string& text);
/// The whole number that `text` is; `flag` stands in the message of the Error thrown when it is none, or out of range.
std::int64_t parse_integer(const std::string& flag, const std::string& text, std::int64_t least, std::int64_t most);
/// The finite number that all of `text` is, if it is one.
std::optional<double> real_number(const std::string& text);
/// The finite number that `text` is; `flag` stands in the message of the Error thrown when it is none.
double parse_real(const std::string& flag, const std::string& text);

}  // namespace raytree::app
