#include "geometry/error.h"

namespace raytree {

std::string located_message(const SourceLocation& where, const std::string& message) {
  std::string text;
  if (!where.file.empty()) {
    text += where.file;
    if (where.line > 0) text.append(":").append(std::to_string(where.line));
    text += ": ";
  }
  if (!where.object.empty()) text += where.object + ": ";
  return text + message;
}

}  // namespace raytree
