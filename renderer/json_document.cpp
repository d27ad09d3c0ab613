// nlohmann's SAX parser behind JsonDocument. It reports no positions, so it is fed through an iterator that
// knows how far the lexer has read.
#include "renderer/json_document.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <nlohmann/json.hpp>
#include <vector>

#include "geometry/error.h"
#include "renderer/json_writer.h"
#include "renderer/suggestion.h"

namespace raytree {
namespace {

/// Copies share one position, so that whoever made the first sees what the lexer's copy has consumed.
class ConsumingIterator {
 public:
  using iterator_category = std::input_iterator_tag;
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = const char&;

  ConsumingIterator() = default;
  explicit ConsumingIterator(const char** position) : position_(position) {}

  reference operator*() const { return **position_; }
  ConsumingIterator& operator++() { return ++*position_, *this; }
  ConsumingIterator operator++(int) { return ++*position_, *this; }
  friend bool operator==(const ConsumingIterator& a, const ConsumingIterator& b) {
    return *a.position_ == *b.position_;
  }
  friend bool operator!=(const ConsumingIterator& a, const ConsumingIterator& b) { return !(a == b); }

 private:
  const char** position_ = nullptr;
};

std::string readable_parse_error(std::string_view what) {
  // "[json.exception.parse_error.101] parse error at line 1, column 5: syntax error while ..."
  if (const auto end = what.find("] "); what.starts_with('[') && end != what.npos) what.remove_prefix(end + 2);
  if (what.starts_with("parse error")) {
    if (const auto end = what.find(": "); end != what.npos) what.remove_prefix(end + 2);
  }
  std::string text;
  for (const char c : what.substr(0, 240)) text += (c >= ' ' && c < 127) ? c : '?';
  if (what.size() > 240) text += "...";
  return text;
}

}  // namespace

/// Receives the parser's events and appends nodes.
class JsonTreeBuilder {
 public:
  using number_integer_t = nlohmann::json::number_integer_t;
  using number_unsigned_t = nlohmann::json::number_unsigned_t;
  using number_float_t = nlohmann::json::number_float_t;
  using string_t = nlohmann::json::string_t;
  using binary_t = nlohmann::json::binary_t;

  JsonTreeBuilder(std::string_view text, const std::string& name, std::size_t spare_bytes, JsonDocument& document)
      : name_(name),
        document_(document),
        consumed_(text.data()),
        counted_(text.data()),
        byte_limit_(text.size() + text.size() / 4 * 3 + spare_bytes) {}

  const char** position() { return &consumed_; }

  bool null() { return append(JsonKind::null), true; }
  bool boolean(bool value) { return append(JsonKind::boolean).boolean = value, true; }
  bool number_integer(number_integer_t value) { return number(static_cast<double>(value)); }
  bool number_unsigned(number_unsigned_t value) { return number(static_cast<double>(value)); }
  bool number_float(number_float_t value, const string_t&) { return number(value); }
  bool string(string_t& value) {
    JsonDocument::Node& node = append(JsonKind::string);
    node.span = {static_cast<std::uint32_t>(document_.strings_.size()), static_cast<std::uint32_t>(value.size())};
    document_.strings_ += value;
    return true;
  }
  bool binary(binary_t&) { return false; }
  bool start_object(std::size_t) { return open(JsonKind::object); }
  bool key(string_t& value) { return string(value); }
  bool end_object() { return close(true); }
  bool start_array(std::size_t) { return open(JsonKind::array); }
  bool end_array() { return close(false); }
  bool parse_error(std::size_t, const std::string&, const nlohmann::json::exception& error) {
    throw Error(ErrorKind::bad_input, {name_, line(), ""}, "not valid JSON: " + readable_parse_error(error.what()));
  }

 private:
  // The lexer has consumed the token and, after a number, one character more. A token's last character is never a line
  // break, so the breaks before the last consumed character are those before the token's end.
  std::uint32_t line() {
    if (consumed_ > counted_) {
      line_ += static_cast<std::uint32_t>(std::count(counted_, consumed_ - 1, '\n'));
      counted_ = consumed_ - 1;
    }
    return line_;
  }

  JsonDocument::Node& append(JsonKind kind) {
    if ((document_.nodes_.size() + 1) * sizeof(JsonDocument::Node) + document_.strings_.size() > byte_limit_)
      throw Error(ErrorKind::bad_input, {name_, line(), ""},
                  "too many values for a scene file; put large meshes into OBJ or PLY files");
    JsonDocument::Node& node = document_.nodes_.emplace_back();
    node.kind = kind;
    node.line = line();
    node.span = {0, 0};
    return node;
  }
  bool number(double value) { return append(JsonKind::number).number = value, true; }

  bool open(JsonKind kind) {
    if (open_.size() == kMaxJsonDepth)
      throw Error(ErrorKind::bad_input, {name_, line(), ""},
                  "arrays and objects nested deeper than " + std::to_string(kMaxJsonDepth));
    append(kind);
    open_.push_back(static_cast<std::uint32_t>(document_.nodes_.size() - 1));
    return true;
  }
  bool close(bool object) {
    const std::uint32_t begin = open_.back();
    open_.pop_back();
    const auto end = static_cast<std::uint32_t>(document_.nodes_.size());
    std::uint32_t children = 0;
    document_.nodes_[begin].span = {end, 0};
    for (std::uint32_t i = begin + 1; i != end; i = document_.next(i)) ++children;
    document_.nodes_[begin].span.count = object ? children / 2 : children;
    return true;
  }

  const std::string& name_;
  JsonDocument& document_;
  std::vector<std::uint32_t> open_;
  const char* consumed_;
  const char* counted_;
  std::uint32_t line_ = 1;
  std::size_t byte_limit_;
};

namespace {

// The lexer buffers a token, and the blanks before it, several times over, so one of a gigabyte would take several; and
// it takes a zero byte for the end, whatever follows. All are found beforehand.
void refuse_bad_bytes(std::string_view text, const std::string& name) {
  const auto refuse = [&](std::size_t where, const char* message) {
    const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(where), '\n');
    throw Error(ErrorKind::bad_input, {name, line, ""}, message);
  };
  if (const auto zero = text.find('\0'); zero != text.npos) refuse(zero, "not valid JSON: a byte of value 0");
  std::size_t start = 0, blanks = 0;
  bool in_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    blanks = !in_string && c <= ' ' && c >= 0 ? blanks + 1 : 0;
    if (blanks > kMaxJsonToken) refuse(i, "more than 1 MiB of blanks in a row");
    if (in_string ? c == '"' : (c == ',' || c == ':' || c == '[' || c == ']' || c == '{' || c == '}' || c <= ' ')) {
      start = i + 1;
      in_string = false;
    } else if (c == '"') {
      start = i;
      in_string = true;
    } else if (c == '\\' && in_string) {
      ++i;
    }
    if (i >= start && i - start > kMaxJsonToken) refuse(start, "a string or number longer than 1 MiB");
  }
}

}  // namespace

JsonDocument JsonDocument::parse(std::string_view text, const std::string& name, std::size_t spare_bytes) {
  if (text.size() > kMaxJsonText) throw Error(ErrorKind::bad_input, {name, 0, ""}, "scene text larger than 1 GiB");
  refuse_bad_bytes(text, name);
  JsonDocument document;
  JsonTreeBuilder builder(text, name, spare_bytes, document);
  const char* end = text.data() + text.size();
  // Every refusal is thrown by the builder, which knows the line; false cannot come back.
  (void)nlohmann::json::sax_parse(ConsumingIterator(builder.position()), ConsumingIterator(&end), &builder);
  return document;
}

JsonDocument JsonDocument::of_string(std::string_view text) {
  JsonDocument document;
  document.strings_ = text;
  Node& node = document.nodes_.emplace_back();
  node.kind = JsonKind::string;
  node.line = 0;
  node.span = {0, static_cast<std::uint32_t>(text.size())};
  return document;
}

std::string description_of(JsonValue value) {
  switch (value.kind()) {
    case JsonKind::null:
      return "null";
    case JsonKind::boolean:
      return value.boolean() ? "true" : "false";
    case JsonKind::number:
      return number_text(value.number());
    case JsonKind::string:
      return in_quotes(value.string());
    case JsonKind::array:
      return value.size() == 0 ? "an empty array" : "an array of " + std::to_string(value.size());
    case JsonKind::object:
      return "an object";
  }
  return "";
}

}  // namespace raytree
