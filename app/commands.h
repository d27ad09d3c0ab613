// The subcommands. Each takes the words after its name and returns the exit status; errors are thrown.
#pragma once

#include "app/usage.h"

namespace raytree::app {

int render_command(const Words& words);
int info_command(const Words& words);
int sheet_command(const Words& words);
int scenes_command(const Words& words);
int schema_command(const Words& words);
int ocio_command(const Words& words);
int bench_command(const Words& words);
int chart_command(const Words& words);
int convert_command(const Words& words);
int validate_command(const Words& words);
int ray_command(const Words& words);
int stability_command(const Words& words);

}  // namespace raytree::app
