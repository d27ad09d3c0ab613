#include "benchmarks/stability/heat_map_svg.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "benchmarks/report_page.h"

namespace raytree::benchmarks {
namespace {

constexpr int kCellWidth = 36, kCellHeight = 26, kMapTop = 44, kMapFoot = 40;
constexpr double kLetter = 6.2;  ///< width of one at 11 px, about

struct HeatColor {
  double r, g, b;  ///< 0 to 255
};
/// From yellow over orange and red to purple: lightness falls steadily, so that steps stay apart without red or without
/// green, and ends above a dark page's black. Dark text on the first half, white on the other.
constexpr std::array<HeatColor, 4> kHeat{{{254, 226, 140}, {246, 158, 72}, {214, 70, 84}, {124, 40, 140}}};
/// Decades of the rate over which colors run: 1e-4 and less to 1.
constexpr double kHeatDecades = 4;

HeatColor heat_color(double rate) {
  const double place =
      std::clamp(1 + std::log10(rate) / kHeatDecades, 0.0, 1.0) * static_cast<double>(kHeat.size() - 1);
  const std::size_t low = std::min(static_cast<std::size_t>(place), kHeat.size() - 2);
  const double share = place - static_cast<double>(low);
  const HeatColor &a = kHeat[low], &b = kHeat[low + 1];
  return {a.r + (b.r - a.r) * share, a.g + (b.g - a.g) * share, a.b + (b.b - a.b) * share};
}

/// Relative luminance near enough to choose between dark and white figures.
bool is_light(const HeatColor& c) { return 0.3 * c.r + 0.59 * c.g + 0.11 * c.b > 140; }

/// "0", ".5", "2e-3": as short as two digits allow.
std::string rate_text(double rate) {
  if (std::isnan(rate)) return "\u2013";
  if (rate == 0) return "0";
  if (rate >= 0.0995) return rate >= 0.995 ? "1" : fmt::format("{:.2g}", rate).substr(1);
  const int exponent = static_cast<int>(std::floor(std::log10(rate) + 1e-9));
  return fmt::format("{:.0f}e{}", rate / std::pow(10.0, exponent), exponent);
}

}  // namespace

std::string heat_map_svg(const StabilityMap& map, std::size_t quantity) {
  const MapQuantity& shown = map.quantities[quantity];
  std::size_t longest = 0;
  for (const std::string& value : map.rows.values) longest = std::max(longest, value.size());
  const int left = 26 + static_cast<int>(kLetter * static_cast<double>(longest)) + 8;
  const int columns = static_cast<int>(map.columns.values.size()), rows = static_cast<int>(map.rows.values.size());
  const int width = left + columns * kCellWidth + 4, height = kMapTop + rows * kCellHeight + kMapFoot;
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" height=\"{1}\" role=\"img\" "
      "aria-label=\"{2}: {3}\" font-family=\"system-ui, sans-serif\" font-size=\"11\" fill=\"var(--ink, #1d2126)\">\n"
      "<text x=\"{4}\" y=\"14\" font-size=\"13\" font-weight=\"600\">{3}</text>\n"
      "<text x=\"14\" y=\"{5}\" fill=\"var(--quiet, #667079)\" text-anchor=\"middle\" transform=\"rotate(-90 14 {5})\">"
      "{6}</text>\n",
      width, height, escaped_html(map.title), escaped_html(shown.name), left, kMapTop + rows * kCellHeight / 2,
      escaped_html(map.rows.label));
  for (int column = 0; column < columns; ++column)
    svg += fmt::format("<text x=\"{}\" y=\"{}\" text-anchor=\"middle\">{}</text>\n",
                       left + column * kCellWidth + kCellWidth / 2, kMapTop - 8,
                       escaped_html(map.columns.values[static_cast<std::size_t>(column)]));
  for (int row = 0; row < rows; ++row) {
    const int y = kMapTop + row * kCellHeight;
    svg += fmt::format("<text x=\"{}\" y=\"{}\" text-anchor=\"end\">{}</text>\n", left - 8, y + kCellHeight / 2 + 4,
                       escaped_html(map.rows.values[static_cast<std::size_t>(row)]));
    for (int column = 0; column < columns; ++column) {
      const std::size_t cell = map.cell(static_cast<std::size_t>(row), static_cast<std::size_t>(column));
      const double rate = shown.rates[cell], promised = shown.promised[cell];
      const bool fails = rate > 0, broken = rate > promised;
      const HeatColor color = fails ? heat_color(rate) : HeatColor{};
      const std::string fill = fails ? fmt::format("#{:02x}{:02x}{:02x}", static_cast<int>(color.r),
                                                   static_cast<int>(color.g), static_cast<int>(color.b))
                                     : std::string("none");
      const std::string text = !fails            ? std::string("var(--quiet, #667079)")
                               : is_light(color) ? std::string("#1d2126")
                                                 : std::string("#ffffff");
      const std::string stroke = broken                  ? std::string("var(--bad, #b3261e)")
                                 : !std::isnan(promised) ? std::string("var(--good, #1c7c4a)")
                                                         : std::string("var(--line, #d9d6cf)");
      svg += fmt::format(
          "<g><title>{}: {} at {}, {}</title><rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" rx=\"3\" fill=\"{}\" "
          "stroke=\"{}\" stroke-width=\"{}\"/><text x=\"{}\" y=\"{}\" text-anchor=\"middle\" "
          "fill=\"{}\">{}</text></g>\n",
          escaped_html(shown.name), std::isnan(rate) ? std::string("none asked") : fmt::format("{:.3g}", rate),
          escaped_html(map.rows.values[static_cast<std::size_t>(row)]),
          escaped_html(map.columns.values[static_cast<std::size_t>(column)]), left + column * kCellWidth + 2, y + 2,
          kCellWidth - 4, kCellHeight - 4, fill, stroke, broken ? "3" : "1.2",
          left + column * kCellWidth + kCellWidth / 2, y + kCellHeight / 2 + 4, text, rate_text(rate));
    }
  }
  svg +=
      fmt::format("<text x=\"{}\" y=\"{}\" fill=\"var(--quiet, #667079)\" text-anchor=\"middle\">{}</text>\n</svg>\n",
                  left + columns * kCellWidth / 2, height - 14, escaped_html(map.columns.label));
  return svg;
}

std::string stability_map_html(const StabilityMap& map) {
  std::string pictures;
  for (std::size_t quantity = 0; quantity < map.quantities.size(); ++quantity)
    pictures += fmt::format("<figure>{}</figure>\n", heat_map_svg(map, quantity));
  std::string broken;
  for (const std::string& text : broken_promises(map))
    broken += fmt::format("<p class=\"fails\">{}</p>\n", escaped_html(text));
  return fmt::format(
      "<section class=\"card\" id=\"map-{}\"><h2>{}</h2>\n<p class=\"quiet\">{} {} rays a cell; figures are shares of "
      "them. Green frames: docs/stability.md makes a promise here.</p>\n"
      "<div style=\"display:flex;flex-wrap:wrap;gap:18px;overflow-x:auto\">{}</div>\n"
      "<p><b>Promised.</b> {}</p>\n<p><b>Measured.</b> {}</p>\n{}</section>\n",
      escaped_html(map.name), escaped_html(map.title), escaped_html(map.method), map.rays, pictures,
      escaped_html(map.promise), escaped_html(map.envelope), broken);
}

}  // namespace raytree::benchmarks
