#include "renderer/json_writer.h"

#include <array>
#include <charconv>
#include <cmath>

namespace raytree {
namespace {

template <class... Arguments>
std::string characters(Arguments... arguments) {
  std::array<char, 48> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), arguments...).ptr;
  return {text.data(), end};
}

void append_escaped(std::string& out, std::string_view text) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  out += '"';
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      out += '\\';
      out += c;
    } else if (c == '\n') {
      out += "\\n";
    } else if (c == '\t') {
      out += "\\t";
    } else if (byte < 0x20) {
      out += "\\u00";
      out += kDigits[byte >> 4];
      out += kDigits[byte & 15];
    } else {
      out += c;
    }
  }
  out += '"';
}

}  // namespace

std::string number_text(double number) {
  constexpr double kLargestPlain = 1e15;
  const bool plain = std::abs(number) < kLargestPlain && number == std::floor(number);
  return plain ? characters(number, std::chars_format::fixed) : characters(number);
}

void JsonWriter::key(std::string_view name) {
  separate();
  append_escaped(text_, name);
  text_ += ": ";
  after_key_ = true;
}

void JsonWriter::value(std::string_view text) {
  separate();
  append_escaped(text_, text);
}
void JsonWriter::value(bool truth) { raw(truth ? "true" : "false"); }
void JsonWriter::value(double number) { raw(number_text(number)); }
void JsonWriter::value(std::int64_t number) { raw(characters(number)); }

void JsonWriter::value(float number) {
  if (number == std::floor(number)) return raw(number_text(static_cast<double>(number)));
  // A reader makes a double of the text first; rounding twice must not miss the float.
  const std::string text = characters(number);
  double read = 0;
  std::from_chars(text.data(), text.data() + text.size(), read);
  raw(static_cast<float>(read) == number ? text : number_text(static_cast<double>(number)));
}

void JsonWriter::begin(char bracket, Layout layout) {
  separate();
  text_ += bracket;
  // What stands inside one line stays on it.
  if (!levels_.empty() && levels_.back().layout == Layout::in_line) layout = Layout::in_line;
  levels_.push_back({layout, true});
}

void JsonWriter::end(char bracket) {
  const Level level = levels_.back();
  levels_.pop_back();
  if (level.layout == Layout::lines && !level.empty) {
    text_ += '\n';
    text_.append(2 * levels_.size(), ' ');
  }
  text_ += bracket;
  if (levels_.empty()) text_ += '\n';
}

void JsonWriter::separate() {
  if (after_key_) {
    after_key_ = false;
    return;
  }
  if (levels_.empty()) return;
  Level& level = levels_.back();
  if (!level.empty) text_ += ',';
  if (level.layout == Layout::lines) {
    text_ += '\n';
    text_.append(2 * levels_.size(), ' ');
  } else if (!level.empty) {
    text_ += ' ';
  }
  level.empty = false;
}

void JsonWriter::raw(std::string_view text) {
  separate();
  text_ += text;
}

}  // namespace raytree
