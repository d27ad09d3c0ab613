#include "geometry/patch_reader.h"

#include <algorithm>
#include <cmath>

#include "geometry/mapped_file.h"
#include "geometry/mesh_file.h"
#include "geometry/text_scanning.h"

namespace raytree {
namespace {

/// The lines of the text that hold something, one after the other.
class Lines {
 public:
  Lines(std::string_view text, const std::string& name)
      : next_(text.data()), end_(text.data() + text.size()), name_(name) {}

  /// Goes to the next line that is not blank; false: there is none.
  bool advance() {
    while (next_ != end_) {
      ++number_;
      place_ = next_;
      line_end_ = std::find(next_, end_, '\n');
      next_ = line_end_ == end_ ? end_ : line_end_ + 1;
      place_ = text::skip_blanks(place_, line_end_);
      if (place_ != line_end_) return true;
    }
    ++number_;
    return false;
  }
  void need(const std::string& what) {
    if (!advance()) fail("the file ends where " + what + " should follow");
  }

  bool at_line_end() const { return place_ == line_end_; }
  std::int64_t integer(const char* what) {
    std::int64_t value = 0;
    take(text::scan_integer(place_, line_end_, value), what);
    return value;
  }
  double real(const char* what) {
    double value = 0;
    const char* const after = text::scan_double(place_, line_end_, value);
    if (after != nullptr && !std::isfinite(value)) fail("a coordinate that is not finite");
    take(after, what);
    return value;
  }
  void end_line() const {
    if (!at_line_end())
      fail("unexpected " + text::in_quotes(text::word_at(place_, line_end_)) + " after the last number");
  }

  std::size_t bytes_left() const { return static_cast<std::size_t>(end_ - next_); }
  const std::string& name() const { return name_; }
  std::int64_t number() const { return number_; }  ///< of the line, one-based
  [[noreturn]] void fail(const std::string& message) const {
    throw Error(ErrorKind::bad_input, {name_, number_, {}}, message);
  }

 private:
  /// Goes on behind a number and what parts it from the next one.
  void take(const char* after, const char* what) {
    if (at_line_end()) fail(std::string("the line ends where ") + what + " should follow");
    if (after == nullptr || (after != line_end_ && !text::is_blank(*after) && *after != ','))
      fail(std::string("expected ") + what + ", not " + text::in_quotes(text::word_at(place_, line_end_)));
    place_ = text::skip_blanks(after, line_end_);
    if (at_line_end() || *place_ != ',') return;
    place_ = text::skip_blanks(place_ + 1, line_end_);
    if (at_line_end()) fail("the line ends behind a comma");
  }

  const char* next_;
  const char* end_;
  const char* place_ = nullptr;
  const char* line_end_ = nullptr;
  std::int64_t number_ = 0;
  const std::string& name_;
};

Vec3d read_point(Lines& lines) {
  Vec3d point;
  for (int axis = 0; axis < 3; ++axis) point[axis] = lines.real("a coordinate");
  lines.end_line();
  return point;
}

/// A count of things that take at least so many bytes each, so that what it claims can be there.
std::size_t read_count(Lines& lines, const char* what, std::size_t least_bytes) {
  const std::int64_t count = lines.integer(what);
  lines.end_line();
  if (count < 1) lines.fail(std::string(what) + " must be at least 1, not " + std::to_string(count));
  // The last line needs no end.
  const std::size_t room = (lines.bytes_left() + 1) / least_bytes;
  if (static_cast<std::uint64_t>(count) > room)
    lines.fail(std::to_string(count) + " is more than the rest of the file can hold, " + std::to_string(room) +
               " at most");
  return static_cast<std::size_t>(count);
}

struct IndexLine {
  std::array<std::int64_t, 16> indices;
  std::int64_t line;
};

/// Kouhia's layout, from behind the first line of indices on.
std::vector<BezierPatch> read_indexed(Lines& lines, std::size_t count, const IndexLine& first, Warnings& warnings) {
  std::vector<IndexLine> index_lines{first};
  index_lines.reserve(count);
  while (index_lines.size() < count) {
    lines.need("a patch's 16 indices");
    IndexLine line{{}, lines.number()};
    for (std::int64_t& index : line.indices) index = lines.integer("one of 16 indices");
    lines.end_line();
    index_lines.push_back(line);
  }
  lines.need("the number of points");
  const std::size_t point_count = read_count(lines, "the number of points", 6);  // "0 0 0" and a line end
  std::vector<Vec3d> points(point_count);
  for (Vec3d& point : points) {
    lines.need("a point");
    point = read_point(lines);
  }

  std::vector<BezierPatch> patches(count);
  std::vector<bool> used(point_count);
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t k = 0; k < 16; ++k) {
      const std::int64_t index = index_lines[i].indices[k];
      if (index < 1 || static_cast<std::uint64_t>(index) > point_count)
        throw Error(ErrorKind::bad_input, {lines.name(), index_lines[i].line, {}},
                    "index " + std::to_string(index) + " is out of range: there are " + std::to_string(point_count) +
                        " points, counted from 1");
      patches[i].points[k] = points[static_cast<std::size_t>(index - 1)];
      used[static_cast<std::size_t>(index - 1)] = true;
    }
  if (const auto unused = std::count(used.begin(), used.end(), false); unused > 0) {
    warnings.push_back({{lines.name(), 0, {}}, "points that no patch uses", unused});
  }
  return patches;
}

void check_degrees(Lines& lines, std::int64_t first, std::int64_t second) {
  if (first != 3 || second != 3)
    lines.fail("a patch of degrees " + std::to_string(first) + " and " + std::to_string(second) +
               "; only bicubic ones, 3 3, are read");
}

/// Points in place, from behind the first patch's degrees on.
std::vector<BezierPatch> read_in_place(Lines& lines, std::size_t count) {
  std::vector<BezierPatch> patches;
  while (true) {
    BezierPatch& patch = patches.emplace_back();
    for (Vec3d& point : patch.points) {
      lines.need("one of a patch's 16 points");
      point = read_point(lines);
    }
    if (patches.size() == count) return patches;
    lines.need("a patch's degrees");
    const std::int64_t first = lines.integer("a degree"), second = lines.integer("a degree");
    lines.end_line();
    check_degrees(lines, first, second);
  }
}

}  // namespace

std::vector<BezierPatch> read_patches(std::string_view text, const std::string& name, Warnings& warnings) {
  Lines lines(text, name);
  lines.need("the number of patches");
  // 16 indices and what parts them take 32 bytes at least, points in place more.
  const std::size_t count = read_count(lines, "the number of patches", 32);
  lines.need("the first patch");
  IndexLine first{{}, lines.number()};
  std::size_t numbers = 0;
  while (!lines.at_line_end() && numbers < 16) first.indices[numbers++] = lines.integer("an index");
  lines.end_line();
  std::vector<BezierPatch> patches;
  if (numbers == 16) {
    patches = read_indexed(lines, count, first, warnings);
  } else if (numbers == 2) {
    check_degrees(lines, first.indices[0], first.indices[1]);
    patches = read_in_place(lines, count);
  } else {
    lines.fail("expected the 16 indices of a patch, or its two degrees, not " + std::to_string(numbers) + " numbers");
  }
  if (lines.advance()) lines.fail("expected the end of the file: all that it announced has been read");
  return patches;
}

std::vector<BezierPatch> read_patch_file(const std::string& path, Warnings& warnings) {
  const MappedFile file(path);
  return read_patches(file.bytes(), path, warnings);
}

bool is_patch_file_name(const std::string& path) { return lower_extension(path) == ".bpt"; }

}  // namespace raytree
