// The one exception type, and the collector of warnings: what went wrong, in which file, on which line, in
// which object. Thrown while loading, preparing or writing; tracing throws nothing.
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

namespace raytree {

/// Where in the user's input a message points. Empty or zero parts are left out of the text.
struct SourceLocation {
  std::string file;       ///< path as the user gave it
  std::int64_t line = 0;  ///< one-based; 0: unknown
  std::string object;     ///< e.g. "materials.glass"
};

/// "file:line: object: message", leaving out what is unknown.
std::string located_message(const SourceLocation& where, const std::string& message);

enum class ErrorKind {
  bad_input,  ///< usage, scene, mesh, config: the user can mend it (exit status 2)
  failure     ///< disk full, no memory, no library (exit status 1)
};

class Error : public std::runtime_error {
 public:
  Error(ErrorKind kind, SourceLocation where, const std::string& message)
      : std::runtime_error(located_message(where, message)), kind_(kind), where_(std::move(where)), message_(message) {}

  ErrorKind kind() const { return kind_; }
  const SourceLocation& where() const { return where_; }
  /// what() without the location.
  const std::string& message() const { return message_; }

 private:
  ErrorKind kind_;
  SourceLocation where_;
  std::string message_;
};

/// The same error of a file, followed by the place that names the file: "... (shapes.m of scene.json:2)".
[[nodiscard]] Error named_by(const Error& error, const SourceLocation& place);

/// What is valid but odd: loaded all the same, with a note of what was dropped and how often.
struct Warning {
  SourceLocation where;    ///< of the first occurrence
  std::string message;     ///< e.g. "faces with a repeated vertex dropped"
  std::int64_t count = 0;  ///< how many there are of what the message names in the plural; 0: nothing is counted
};

using Warnings = std::vector<Warning>;

}  // namespace raytree
