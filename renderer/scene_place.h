// Where a value of a scene stands: file, line, and the path of the object. For the messages of the scene readers.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <string_view>

#include "geometry/error.h"
#include "renderer/json_document.h"
#include "renderer/suggestion.h"

namespace raytree::reading {

/// A chain of its parents: the path is spelled out only for a message.
class Place {
 public:
  enum class Lines { known, none };
  explicit Place(const std::string& file, Lines lines = Lines::known) : file_(file), lines_(lines) {}
  Place(const Place& parent, std::string_view key)
      : file_(parent.file_), lines_(parent.lines_), parent_(&parent), key_(key) {}
  Place(const Place& parent, std::int64_t index)
      : file_(parent.file_), lines_(parent.lines_), parent_(&parent), index_(index) {}

  SourceLocation location(std::int64_t line) const { return {file_, lines_ == Lines::known ? line : 0, path()}; }
  [[noreturn]] void fail(std::int64_t line, const std::string& message) const {
    throw Error(ErrorKind::bad_input, location(line), message);
  }

 private:
  std::string path() const {
    if (parent_ == nullptr) return {};
    std::string text = parent_->path();
    if (index_ >= 0) return text + "[" + std::to_string(index_) + "]";
    if (!text.empty()) text += '.';
    const bool plain = !key_.empty() && std::all_of(key_.begin(), key_.end(), [](char c) {
      return c != '.' && c != '[' && c != '"' && static_cast<unsigned char>(c) > 0x20 && c != 0x7F;
    });
    return text + (plain && key_.size() <= 60 ? std::string(key_) : in_quotes(key_));
  }

  const std::string& file_;
  Lines lines_;
  const Place* parent_ = nullptr;
  std::string_view key_;
  std::int64_t index_ = -1;
};

}  // namespace raytree::reading
