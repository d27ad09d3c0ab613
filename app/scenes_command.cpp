// `raytree scenes`: the built-in scenes by name.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "app/exit_status.h"
#include "app/messages.h"
#include "renderer/builtin_scenes.h"

namespace raytree::app {

int scenes_command(const Words& words) {
  bool as_json = false;
  CLI::App command("List the built-in scenes.", "raytree scenes");
  command.add_flag("--json", as_json, "Print JSON");
  prepare_usage(command);
  if (!parse_usage(command, words)) return kSuccess;

  if (as_json) {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const BuiltinScene& scene : builtin_scenes())
      list.push_back({{"name", scene.name}, {"summary", scene.summary}});
    print_result(list.dump(2) + "\n");
    return kSuccess;
  }
  std::size_t width = 0;
  for (const BuiltinScene& scene : builtin_scenes()) width = std::max(width, scene.name.size());
  std::string text;
  for (const BuiltinScene& scene : builtin_scenes())
    text += fmt::format("{:<{}}  {}\n", scene.name, width, scene.summary);
  print_result(text);
  return kSuccess;
}

}  // namespace raytree::app
