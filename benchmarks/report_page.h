// The pages that benchmarks leave: one HTML file each that needs no network, all of one look.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace raytree::benchmarks {

/// Text as it may stand in HTML, in quoted attributes too.
std::string escaped_html(std::string_view text);

/// Bytes as an address that holds them: "data:image/png;base64,...".
std::string data_address(std::string_view media_type, const std::vector<std::byte>& bytes);

/// JSON as it may stand in a <script> element: "</" and "<!--" cannot end or comment it.
std::string script_json(std::string_view json);

struct ReportPage {
  std::string title;     ///< text
  std::string subtitle;  ///< text; one line under the title
  std::string style;     ///< CSS beyond the common sheet
  std::string body;      ///< HTML
  std::string script;    ///< JavaScript; runs once the body is there
};

/// The whole page, with the machine's line under it. Common classes of the sheet: `card` (a framed section), `quiet`
/// (secondary text), `number` (right-aligned figures), `holds`, `known`, `fails` (verdicts); tables need none. Light
/// and dark by the reader's choice, through the sheet's variables: --paper, --ink, --quiet, --line, --card, --accent,
/// --good,
/// --warn, --bad.
std::string report_page(const ReportPage& page);

/// "AMD EPYC, 2 threads, g++ 12.2.0, Release, AVX2, Embree 3.13.5".
std::string machine_line();

}  // namespace raytree::benchmarks
