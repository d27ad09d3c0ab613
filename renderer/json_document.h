// JSON text as a tree of values that know their line: member order and duplicates are kept, so that a reader
// can refuse them where they stand. What the values mean is left to scene_reader.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <string>
#include <string_view>

namespace raytree {

enum class JsonKind : std::uint32_t { null, boolean, number, string, array, object };

inline constexpr int kMaxJsonDepth = 100;                          ///< nested arrays and objects
inline constexpr std::size_t kMaxJsonText = std::size_t(1) << 30;  ///< bytes of one document
inline constexpr std::size_t kMaxJsonToken = std::size_t(1)
                                             << 20;  ///< bytes of one string or number, or of blanks in a row

inline constexpr std::size_t kJsonTreeBytes = std::size_t(160) << 20;  ///< see JsonDocument::parse

class JsonDocument;
struct JsonMember;

/// One value of a document; valid as long as the document is. Asking a value for what its kind does not hold is a
/// programming error (unchecked).
class JsonValue {
 public:
  JsonKind kind() const;
  std::int64_t line() const;  ///< one-based, of the value's first character (a string's, number's: its only line)
  bool boolean() const;
  double number() const;            ///< always finite
  std::string_view string() const;  ///< UTF-8; may hold '\0'
  std::size_t size() const;         ///< elements of an array, members of an object

  /// Calls visit(JsonValue) for each element of an array, in order.
  template <class Visit>
  void for_each_element(Visit&& visit) const;
  /// Calls visit(JsonMember) for each member of an object, in order, duplicates included.
  template <class Visit>
  void for_each_member(Visit&& visit) const;

 private:
  friend class JsonDocument;
  JsonValue(const JsonDocument& document, std::uint32_t index) : document_(&document), index_(index) {}
  const JsonDocument* document_;
  std::uint32_t index_;
};

struct JsonMember {
  std::string_view key;
  std::int64_t line;  ///< of the key
  JsonValue value;
};

class JsonDocument {
 public:
  /// Parses a whole document (RFC 8259, a UTF-8 byte order mark is skipped). Throws Error (bad_input) with `name` and
  /// the line for what is not JSON, too deep, too long, or made of so many tiny values that its tree would take more
  /// than 1.75 times the text plus `spare_bytes`.
  static JsonDocument parse(std::string_view text, const std::string& name, std::size_t spare_bytes = kJsonTreeBytes);
  /// A document of one string.
  static JsonDocument of_string(std::string_view text);

  JsonValue root() const { return {*this, 0}; }

 private:
  friend class JsonValue;
  friend class JsonTreeBuilder;

  // A document is one run of nodes: a container is followed by its children, an object's members by key and value.
  struct Span {
    std::uint32_t begin_or_end;  // string: offset in strings_; container: index just past its last node
    std::uint32_t count;         // string: bytes; container: elements or members
  };
  struct Node {
    JsonKind kind;
    std::uint32_t line;
    union {
      double number;
      bool boolean;
      Span span;
    };
  };
  static_assert(sizeof(Node) == 16);

  std::uint32_t next(std::uint32_t index) const {
    const Node& node = nodes_[index];
    return node.kind >= JsonKind::array ? node.span.begin_or_end : index + 1;
  }

  std::deque<Node> nodes_;  // a deque grows without a moment of two copies
  std::string strings_;
};

/// What a message calls a value: `"glass"`, `12.5`, `an array of 2`, `an object`, `true`, `null`.
std::string description_of(JsonValue value);

// --- details ------------------------------------------------------------------------------------------------

inline JsonKind JsonValue::kind() const { return document_->nodes_[index_].kind; }
inline std::int64_t JsonValue::line() const { return document_->nodes_[index_].line; }
inline bool JsonValue::boolean() const { return document_->nodes_[index_].boolean; }
inline double JsonValue::number() const { return document_->nodes_[index_].number; }
inline std::string_view JsonValue::string() const {
  const JsonDocument::Span span = document_->nodes_[index_].span;
  return std::string_view(document_->strings_).substr(span.begin_or_end, span.count);
}
inline std::size_t JsonValue::size() const { return document_->nodes_[index_].span.count; }

template <class Visit>
void JsonValue::for_each_element(Visit&& visit) const {
  const std::uint32_t end = document_->next(index_);
  for (std::uint32_t i = index_ + 1; i != end; i = document_->next(i)) visit(JsonValue(*document_, i));
}

template <class Visit>
void JsonValue::for_each_member(Visit&& visit) const {
  const std::uint32_t end = document_->next(index_);
  for (std::uint32_t i = index_ + 1; i != end; i = document_->next(i + 1)) {
    const JsonValue key(*document_, i);
    visit(JsonMember{key.string(), key.line(), JsonValue(*document_, i + 1)});
  }
}

}  // namespace raytree
