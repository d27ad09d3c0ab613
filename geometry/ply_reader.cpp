#include "geometry/ply_reader.h"

#include "geometry/ply_body.h"
#include "geometry/text_scanning.h"

namespace raytree {
namespace {

using namespace ply;

void warn_skipped(const Header& header, const std::string& name, Warnings& warnings) {
  for (const Element& element : header.elements) {
    if (element.use != Use::skipped || element.count == 0) continue;
    Warning& warning = warnings.emplace_back();
    warning.where.file = name;
    warning.message = "elements " + text::in_quotes(element.name) + " skipped";
    warning.count = static_cast<std::int64_t>(element.count);
  }
}

}  // namespace

PolygonMesh read_ply(std::string_view bytes, const std::string& name, Warnings& warnings) {
  const Header header = read_header(bytes, name, warnings);
  PolygonMesh mesh;
  bool by_lines = false;
  if (header.format == Format::ascii)
    by_lines = read_ascii_body(header, bytes, name, warnings, mesh);
  else
    read_binary_body(header, bytes, name, warnings, mesh);
  warn_skipped(header, name, warnings);

  // An item by its line, where lines tell it; by its number too.
  const auto location = [&](const Element& element, std::size_t item) {
    return SourceLocation{name, by_lines ? ascii_line(header, bytes, element, item) : 0, item_name(element, item)};
  };
  const MeshLocator locate{[&](std::size_t i) { return location(header.vertices(), i); },
                           [&](std::size_t i) { return location(header.faces(), i); }};
  settle_mesh(mesh, name, locate, warnings);
  return mesh;
}

}  // namespace raytree
