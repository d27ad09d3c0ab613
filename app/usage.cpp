#include "app/usage.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <cmath>

#include "app/messages.h"
#include "app/process.h"
#include "app/suggestion.h"

namespace raytree::app {
namespace {

/// Every flag of a command, as it is typed: "--size", "-o".
std::vector<std::string> flags_of(const CLI::App& command) {
  std::vector<std::string> flags;
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& name : option->get_lnames()) flags.push_back("--" + name);
    for (const std::string& name : option->get_snames()) flags.push_back("-" + name);
  }
  return flags;
}

/// The error of a flag given more often than it takes values, if there is one; CLI11 speaks of arguments there.
std::optional<Error> given_twice(const CLI::App& command) {
  for (const CLI::Option* option : command.get_options())
    if (!option->get_positional() && option->get_items_expected_max() == 1 && option->count() > 1)
      return usage_error(fmt::format("{} is given {}", option->get_name(),
                                     option->count() == 2 ? "twice" : fmt::format("{} times", option->count())));
  return std::nullopt;
}

/// The error of a flag that nothing follows, or another flag, in the name that was typed.
std::optional<Error> lacks_value(const CLI::App& command, const Words& words) {
  const auto flag_of = [&](const std::string& word) {
    return word.size() > 1 && word[0] == '-' ? command.get_option_no_throw(word) : nullptr;
  };
  for (std::size_t i = 0; i < words.size(); ++i) {
    const CLI::Option* const option = flag_of(words[i]);
    if (option == nullptr || option->get_items_expected_min() == 0) continue;
    if (option->get_type_name() == "FLAGS" && i + 1 != words.size()) {  // whose value is flags itself
      ++i;
      continue;
    }
    if (i + 1 == words.size() || flag_of(words[i + 1]) != nullptr)
      return usage_error(fmt::format("{}: no value follows; it takes {}", words[i], option->get_type_name()));
  }
  return std::nullopt;
}

}  // namespace

Error usage_error(const std::string& message) { return Error(ErrorKind::bad_input, {}, message); }

void prepare_usage(CLI::App& command) {
  command.set_help_flag("-h,--help", "Print this help and exit");
  command.set_version_flag("--version", version_text(), "Print the version and exit");
  command.get_formatter()->column_width(30);
  // Words that fit no option are collected, so that the message can name them before anything else is complained of.
  command.allow_extras();
}

bool parse_usage(CLI::App& command, const Words& words) {
  // CLI11 would take the next flag for the value.
  if (const std::optional<Error> lacking = lacks_value(command, words)) throw *lacking;
  // And the next word for that of "--camera=".
  for (const std::string& word : words)
    if (const auto equals = word.find('='); word.rfind("--", 0) == 0 && equals + 1 == word.size())
      if (command.get_option_no_throw(word.substr(0, equals)) != nullptr)
        throw usage_error(word.substr(0, equals) + ": the value is empty");
  std::vector<std::string> reversed(words.rbegin(), words.rend());  // as CLI11 wants them
  try {
    command.parse(reversed);
  } catch (const CLI::CallForHelp&) {
    print_result(command.help());
    return false;
  } catch (const CLI::CallForVersion&) {
    print_result(version_text() + "\n");
    return false;
  } catch (const CLI::ParseError& error) {
    if (const std::optional<Error> twice = given_twice(command)) throw *twice;
    throw usage_error(error.what());
  }
  // An empty value is a mistake (an unset variable of a script, most likely), never the absence of the flag.
  for (const CLI::Option* option : command.get_options())
    for (const std::string& value : option->results())
      if (value.empty()) throw usage_error(option->get_name() + ": the value is empty");
  const std::vector<std::string> extras = command.remaining();
  for (const std::string& word : extras)
    if (word.size() > 1 && word[0] == '-') {
      const std::string flag = word.substr(0, word.find('='));
      throw usage_error(fmt::format("unknown flag {}{} (see {} --help)", flag, did_you_mean(flag, flags_of(command)),
                                    command.get_name()));
    }
  if (!extras.empty())
    throw usage_error(fmt::format("unexpected argument \"{}\" (see {} --help)", extras.front(), command.get_name()));
  return true;
}

std::optional<std::int64_t> whole_number(const std::string& text) {
  std::int64_t value = 0;
  const char* const end = text.data() + text.size();
  const auto [stop, code] = std::from_chars(text.data(), end, value);
  return code == std::errc() && stop == end ? std::optional(value) : std::nullopt;
}

std::int64_t parse_integer(const std::string& flag, const std::string& text, std::int64_t least, std::int64_t most) {
  const std::optional<std::int64_t> value = whole_number(text);
  if (!value || *value < least || *value > most)
    throw usage_error(fmt::format("{}: \"{}\" is not a whole number from {} to {}", flag, text, least, most));
  return *value;
}

std::optional<double> real_number(const std::string& text) {
  double value = 0;
  const char* const begin = text.data() + (text.size() > 1 && text[0] == '+' ? 1 : 0);
  const char* const end = text.data() + text.size();
  const auto [stop, code] = std::from_chars(begin, end, value);
  return code == std::errc() && stop == end && std::isfinite(value) ? std::optional(value) : std::nullopt;
}

double parse_real(const std::string& flag, const std::string& text) {
  const std::optional<double> value = real_number(text);
  if (!value) throw usage_error(fmt::format("{}: \"{}\" is not a number", flag, text));
  return *value;
}

}  // namespace raytree::app
