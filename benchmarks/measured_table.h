// The table of `./run measure`, as it is measured and as README shows it, held against expected_lines.h.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "benchmarks/measurement.h"

namespace raytree::benchmarks {

/// Whether `text` is `pattern`, in which each `*` stands for any text, none too.
bool fits_pattern(std::string_view text, std::string_view pattern);

/// What is wrong with figures of a row, one sentence each: lines that are not expected, other bounds or units than are
/// expected, lines that lack. Figures that have a problem lack nothing: their row was not measured to its end.
std::vector<std::string> complaints_of_row(const std::string& row, const std::vector<Figure>& figures);

/// What is wrong with a printed table (Markdown, with or without the text around it), one sentence each: rows that are
/// not there, what complaints_of_row() says of each, and verdicts that do not follow from figure and bound. A figure
/// counts as anything that its digits may have been rounded from.
std::vector<std::string> complaints_of_table(std::string_view markdown);

}  // namespace raytree::benchmarks
