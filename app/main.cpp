// The program `raytree`: finds the subcommand and turns what it throws into a message and an exit status.
#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <exception>
#include <new>

#include "app/commands.h"
#include "app/exit_status.h"
#include "app/messages.h"
#include "app/process.h"
#include "app/sanitized.h"
#include "app/suggestion.h"

namespace raytree::app {
namespace {

struct Command {
  const char* name;
  const char* summary;
  int (*run)(const Words&);
};

constexpr Command kCommands[] = {
    {"render", "Render a scene to image files", render_command},
    {"info", "Say what is in a scene, and what it will take, without rendering", info_command},
    {"sheet", "Shade scenes in each of the four ways, side by side", sheet_command},
    {"convert", "Write a mesh to another file, subdivided or tessellated", convert_command},
    {"scenes", "List the built-in scenes", scenes_command},
    {"schema", "Print the JSON Schema of scene files", schema_command},
    {"bench", "Measure how fast a scene's rays are intersected", bench_command},
    {"chart", "Chart a scene's speed against its accuracy, setting by setting", chart_command},
    {"validate", "Compare every ray of a picture with a slow and plain tracer's", validate_command},
    {"stability", "Provoke the known failures of methods, and measure which hold", stability_command},
    {"ray", "Ask both tracers about one ray", ray_command},
    {"ocio", "List displays and views, or check the color transforms", ocio_command},
};

std::string general_help() {
  std::string text =
      "Raytree, a deterministic Whitted ray-tree renderer\n\n"
      "Usage: raytree COMMAND [ARGUMENTS]\n\nCommands:\n";
  for (const Command& command : kCommands) text += fmt::format("  {:<10}{}\n", command.name, command.summary);
  return text +
         "\nOptions:\n"
         "  -h,--help Print this help, or that of a command (raytree render --help)\n"
         "  --version Print the version\n\n"
         "Example: raytree render spheres-1980 -o spheres.png\n";
}

int run(const Words& words) {
  if (words.empty()) {
    print_message(general_help());
    return kBadInput;
  }
  const std::string& first = words.front();
  if (first == "--help" || first == "-h" || first == "help") {
    print_result(general_help());
    return kSuccess;
  }
  if (first == "--version") {
    print_result(version_text() + "\n");
    return kSuccess;
  }
  std::vector<std::string> names;
  for (const Command& command : kCommands) {
    if (first == command.name) return command.run(Words(words.begin() + 1, words.end()));
    names.emplace_back(command.name);
  }
  if (first[0] == '-') {
    names = {"--help", "--version"};
    throw usage_error(fmt::format("unknown flag {}{}; a command comes first: raytree render SCENE -o FILE", first,
                                  did_you_mean(first, names)));
  }
  throw usage_error(
      fmt::format("unknown command \"{}\"{}; commands: {}", first, did_you_mean(first, names), joined(names)));
}

/// A standard stream that is closed at launch would lend its number to the next file opened, and messages would end up
/// in that. Output to a read-only /dev/null fails as output to a closed stream does.
void occupy_standard_streams() {
  for (int stream = 0; stream <= 2; ++stream)
    if (fcntl(stream, F_GETFD) == -1) {
      const int opened = open("/dev/null", stream == 2 ? O_WRONLY : O_RDONLY);
      if (opened >= 0 && opened != stream) dup2(opened, stream), close(opened);
    }
}

int guarded_run(const Words& words) {
  try {
    return run(words);
  } catch (const Error& error) {
    print_error(error.what());
    return error.kind() == ErrorKind::bad_input ? kBadInput : kFailure;
  } catch (const std::bad_alloc&) {
    print_error("out of memory");
    return kFailure;
  } catch (const std::exception& error) {
    print_error(error.what());
    return kFailure;
  }
}

}  // namespace
}  // namespace raytree::app

int main(int argc, char** argv) {
  // A reader that goes away makes writing fail, which is reported, in place of ending the process without a word.
  std::signal(SIGPIPE, SIG_IGN);
  raytree::app::occupy_standard_streams();
  const int status = raytree::app::guarded_run(raytree::app::Words(argv + (argc > 0 ? 1 : 0), argv + argc));
  // LeakSanitizer reports at an ordinary exit.
  if (raytree::kAddressSanitized && status == raytree::app::kSuccess) return status;
  // All files are in their places: what is left would be waiting for the image library, which may still load in the
  // background, and the destructors of hundreds of libraries.
  std::fflush(nullptr);
  _exit(status);
}
