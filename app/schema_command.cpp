// `raytree schema`: the JSON Schema of scene files, from the tables that the reader uses.
#include <CLI/CLI.hpp>

#include "app/commands.h"
#include "app/exit_status.h"
#include "app/messages.h"
#include "renderer/scene_reader.h"

namespace raytree::app {

int schema_command(const Words& words) {
  CLI::App command("Print the JSON Schema (draft 2020-12) of scene files.", "raytree schema");
  prepare_usage(command);
  if (!parse_usage(command, words)) return kSuccess;
  std::string schema = scene_schema();
  if (schema.empty() || schema.back() != '\n') schema += '\n';
  print_result(schema);
  return kSuccess;
}

}  // namespace raytree::app
