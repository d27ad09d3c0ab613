// `raytree ocio`: the displays and views of a config, and whether the color transforms give the values they should.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>

#include "app/commands.h"
#include "app/exit_status.h"
#include "app/messages.h"
#include "app/suggestion.h"
#include "renderer/display.h"

namespace raytree::app {
namespace {

int list(const std::string& config) {
  DisplayOptions options;
  options.ocio_config = config;
  const DisplayTransform transform(options);
  std::string text = fmt::format("config   {}\n", transform.config_name());
  for (const DisplayChoices& choice : transform.choices()) {
    text += fmt::format("display  {}{}\n", choice.display, choice.display == transform.display() ? "  (default)" : "");
    for (const std::string& view : choice.views)
      text += fmt::format("  view   {}{}\n", view,
                          choice.display == transform.display() && view == transform.view() ? "  (default)" : "");
  }
  print_result(text);
  return kSuccess;
}

/// The built-in config against values known in advance.
int check_builtin() {
  std::string text = fmt::format("{:<10}{:<22}{:>8}{:>12}{:>12}\n", "display", "view", "value", "expected", "got");
  int off = 0;
  const std::vector<DisplayCheck> rows = check_builtin_display();
  for (const DisplayCheck& row : rows) {
    text += fmt::format("{:<10}{:<22}{:>8.3f}{:>12.6f}{:>12.6f}  {}\n", row.display, row.view, row.input, row.expected,
                        row.got, row.ok ? "ok" : "OFF");
    off += row.ok ? 0 : 1;
  }
  text += off ? fmt::format("{} of {} values are off\n", off, rows.size())
              : fmt::format("all {} values are right\n", rows.size());
  print_result(text);
  return off ? kFailure : kSuccess;
}

/// Another config has no values known in advance: every view of it must load and stay finite over the range of a scene.
int check_views(const std::string& config) {
  DisplayOptions options;
  options.ocio_config = config;
  const DisplayTransform first(options);
  std::string text = fmt::format("config   {}\n", first.config_name());
  int off = 0, count = 0;
  for (const DisplayChoices& choice : first.choices())
    for (const std::string& view : choice.views) {
      options.display = choice.display;
      options.view = view;
      std::string verdict = "ok";
      float values[] = {0, 0, 0, .18f, .18f, .18f, .5f, .5f, .5f, 1, 1, 1, 16, 16, 16, 1, 0, 0, 0, 1, 0, 0, 0, 1};
      try {
        DisplayTransform(options).apply(values, std::size(values) / 3);
        if (!std::all_of(std::begin(values), std::end(values), [](float v) { return std::isfinite(v); }))
          verdict = "OFF: not finite";
      } catch (const Error& error) {
        verdict = std::string("OFF: ") + error.what();
      }
      ++count;
      off += verdict == "ok" ? 0 : 1;
      text += fmt::format("{:<24}{:<24}  .18 -> {:.6f}  {}\n", choice.display, view, values[4], verdict);
    }
  text += off ? fmt::format("{} of {} views are off\n", off, count)
              : fmt::format("all {} views load and stay finite\n", count);
  print_result(text);
  return off ? kFailure : kSuccess;
}

}  // namespace

int ocio_command(const Words& words) {
  std::string action, config;
  CLI::App command("List the displays and views of a config, or check the values that they give.", "raytree ocio");
  command
      .add_option("ACTION", action,
                  "list: displays and views; check: values against those known (status 1 if one is off)")
      ->type_name("");
  command
      .add_option("--ocio", config, "OpenColorIO config; default: list: $OCIO, else the built-in one; check: built-in")
      ->type_name("FILE");
  prepare_usage(command);
  if (!parse_usage(command, words)) return kSuccess;
  if (action == "list") return list(config);
  if (action == "check") return config.empty() ? check_builtin() : check_views(config);
  const std::vector<std::string> actions = {"list", "check"};
  if (action.empty()) throw usage_error("raytree ocio: no action; actions: " + joined(actions));
  throw usage_error(fmt::format("raytree ocio: unknown action \"{}\"{}; actions: {}", action,
                                did_you_mean(action, actions), joined(actions)));
}

}  // namespace raytree::app
