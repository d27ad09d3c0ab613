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

Error named_by(const Error& error, const SourceLocation& place) {
  std::string text = place.object + (place.object.empty() ? "" : " of ") + place.file;
  if (place.line > 0) text.append(":").append(std::to_string(place.line));
  return Error(error.kind(), error.where(), error.message() + " (" + text + ")");
}

}  // namespace raytree
