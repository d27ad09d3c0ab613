// Files of bicubic Bezier patches, .bpt, in the two layouts that the Utah teapot travels in. The file's axes are kept:
// the published teapot, cup and spoon have z up.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "geometry/bezier_patch.h"
#include "geometry/error.h"

namespace raytree {

/// Reads a patch file, either as Kouhia released the tea set in 1991 (the number of patches; 16 indices a patch,
/// one-based; the number of points; x, y, z a point) or with the points in place (the number of patches; for each "3
/// 3", its degrees, and 16 points). Numbers on a line are parted by commas or blanks; lines without any are skipped.
/// The first four indices or points of a patch lie along u. Memory is at most a constant times the file's size,
/// whatever numbers it claims. Throws Error (bad_input) with file and line; points that no patch uses are a warning.
std::vector<BezierPatch> read_patch_file(const std::string& path, Warnings& warnings);

/// The same for text in memory; `name` stands for the file in messages.
std::vector<BezierPatch> read_patches(std::string_view text, const std::string& name, Warnings& warnings);

/// Whether the name ends as a patch file's does.
bool is_patch_file_name(const std::string& path);

}  // namespace raytree
