// JSON text out: indentation, commas, escapes, and numbers that read back equal in the fewest digits.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace raytree {

/// The fewest digits that read back equal; whole numbers below 1e15 without an exponent. Finite.
std::string number_text(double number);

class JsonWriter {
 public:
  enum class Layout {
    lines,   ///< a line per member or element
    in_line  ///< all on one line
  };

  void begin_object(Layout layout = Layout::lines) { begin('{', layout); }
  void end_object() { end('}'); }
  void begin_array(Layout layout = Layout::in_line) { begin('[', layout); }
  void end_array() { end(']'); }
  void key(std::string_view name);

  void value(std::string_view text);
  void value(const char* text) { value(std::string_view(text)); }
  void value(bool truth);
  void value(double number);  ///< finite
  void value(float number);   ///< finite
  void value(std::int64_t number);
  void value(int number) { value(std::int64_t{number}); }
  void value(std::uint32_t number) { value(std::int64_t{number}); }

  const std::string& text() const { return text_; }

 private:
  struct Level {
    Layout layout;
    bool empty;
  };
  void begin(char bracket, Layout layout);
  void end(char bracket);
  void separate();
  void raw(std::string_view text);

  std::string text_;
  std::vector<Level> levels_;
  bool after_key_ = false;
};

}  // namespace raytree
