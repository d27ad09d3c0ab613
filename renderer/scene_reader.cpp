// Walks the tables of scene_fields.h over a JSON document, and over the path of a --set. Whatever is refused is
// named with its place: file, line, and the path of the object.
#include "renderer/scene_reader.h"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <memory>
#include <numbers>
#include <optional>
#include <system_error>
#include <unordered_map>
#include <vector>

#include "renderer/inline_mesh.h"
#include "renderer/json_document.h"
#include "renderer/json_writer.h"
#include "renderer/scene_fields.h"
#include "renderer/suggestion.h"

namespace raytree {
namespace {

constexpr std::size_t kFewMembers = 16;  // up to here comparing all pairs of keys beats a hash table

/// Where a value stands. A chain of its parents: the path is spelled out only for a message.
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

std::string range_text(const Range& range) {
  const std::string low = (range.low_open ? "greater than " : "at least ") + number_text(range.low);
  const std::string high = (range.high_open ? "less than " : "at most ") + number_text(range.high);
  if (range.low == -kLargestNumber) return high + " in size";
  return range.high == kLargestNumber ? low : low + " and " + high;
}

template <class E>
std::vector<std::string> enum_names() {
  std::vector<std::string> names;
  for (const auto& entry : EnumTable<E>::entries) names.emplace_back(entry.name);
  return names;
}

template <class Variant>
std::vector<std::string> alternative_names() {
  std::vector<std::string> names;
  for_each_alternative<Variant>([&]<class T>(std::in_place_type_t<T>) { names.emplace_back(Alternative<T>::name); });
  return names;
}

/// Puts the default of the alternative called `name` into the variant; false: there is none of that name.
template <class Variant>
bool choose_alternative(std::string_view name, Variant& variant) {
  bool found = false;
  for_each_alternative<Variant>([&]<class T>(std::in_place_type_t<T>) {
    if (Alternative<T>::name != name) return;
    variant = T{};
    found = true;
  });
  return found;
}

template <class T>
std::vector<std::string> names_of(const std::vector<T>& elements) {
  std::vector<std::string> names;
  for (const T& element : elements) names.push_back(element.name);
  return names;
}

// --- what a table cannot say --------------------------------------------------------------------------------

void check(const Place&, std::int64_t, const auto&) {}

void check(const Place& at, std::int64_t line, const ImageDescription& image) {
  if (std::int64_t{image.width} * image.height > kMaxPixels)
    at.fail(line, std::to_string(image.width) + " x " + std::to_string(image.height) +
                      " pixels are too many: width times height is at most " + std::to_string(kMaxPixels));
}

void check(const Place& at, std::int64_t line, const CameraDescription& camera) {
  const Vec3d sight = camera.target - camera.position;
  if (sight == Vec3d(0, 0, 0)) at.fail(line, "position and target are the same point");
  // Closer than this to parallel, the directions of the picture would be rounding errors.
  constexpr double kLeastSine = 1e-9;
  const Vec3d a = sight.normalized(), b = camera.up.normalized();
  if (a.cross(b).length() < kLeastSine) at.fail(line, "up points along the line of sight; give another direction");
}

void check_references(const Place& root, const SceneDescription& scene) {
  std::unordered_map<std::string_view, bool> known;
  for (const MaterialDescription& material : scene.materials) known.emplace(material.name, true);
  const Place shapes(root, "shapes");
  for (const ShapeDescription& shape : scene.shapes) {
    if (shape.material.empty() || known.contains(shape.material)) continue;
    Place(shapes, shape.name)
        .fail(shape.where.line, "unknown material " + in_quotes(shape.material) + "; " +
                                    choices_text("materials of this scene", shape.material, names_of(scene.materials)));
  }
}

/// Sine and cosine of an angle in degrees, exact at multiples of 90.
std::pair<double, double> sine_and_cosine(double degrees) {
  const double within = std::remainder(degrees, 360.0);  // exact
  if (within == 0) return {0, 1};
  if (within == 90) return {1, 0};
  if (within == -90) return {-1, 0};
  if (std::abs(within) == 180) return {0, -1};
  const double radians = within * (std::numbers::pi / 180);
  return {std::sin(radians), std::cos(radians)};
}

/// For row vectors: p * result.
Matrix44d matrix_of(const TransformStep& step) {
  if (step.matrix) return *step.matrix;
  Matrix44d m;
  if (step.scale)
    for (int i = 0; i < 3; ++i) m[i][i] = step.scale->value[i];
  if (step.rotate) {
    const auto [sx, cx] = sine_and_cosine(step.rotate->x);
    const auto [sy, cy] = sine_and_cosine(step.rotate->y);
    const auto [sz, cz] = sine_and_cosine(step.rotate->z);
    m = m * Matrix44d(1, 0, 0, 0, 0, cx, sx, 0, 0, -sx, cx, 0, 0, 0, 0, 1) *
        Matrix44d(cy, 0, -sy, 0, 0, 1, 0, 0, sy, 0, cy, 0, 0, 0, 0, 1) *
        Matrix44d(cz, sz, 0, 0, -sz, cz, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1);
  }
  if (step.translate)
    for (int i = 0; i < 3; ++i) m[3][i] = (*step.translate)[i];
  return m;
}

/// Whether the inverse can be formed with some digits left; lengths of the axes do not matter.
bool invertible(const Matrix44d& m) {
  constexpr double kLeastVolume = 1e-12;  // of the axes made unit; float has 7 digits, double 16
  std::array<Vec3d, 3> axes;
  for (int i = 0; i < 3; ++i) {
    Vec3d axis(m[i][0], m[i][1], m[i][2]);
    const double largest = std::max({std::abs(axis.x), std::abs(axis.y), std::abs(axis.z)});
    if (!(largest > 0) || !std::isfinite(largest)) return false;
    axes[static_cast<std::size_t>(i)] = (axis / largest).normalized();
  }
  return std::abs(axes[0].dot(axes[1].cross(axes[2]))) > kLeastVolume;
}

// --- values -------------------------------------------------------------------------------------------------

template <class T>
void read_table(const Place& at, JsonValue value, T& out);

class ObjectReader;

double read_number(const Place& at, const Field& field, JsonValue value) {
  if (value.kind() != JsonKind::number) at.fail(value.line(), "expected a number, not " + description_of(value));
  const double x = value.number();
  if (!field.range.holds(x))
    at.fail(value.line(), number_text(x) + " is out of range: must be " + range_text(field.range));
  return x;
}

void read(const Place& at, const Field& field, JsonValue value, double& out) { out = read_number(at, field, value); }

template <std::integral Integer>
void read(const Place& at, const Field& field, JsonValue value, Integer& out) {
  if (value.kind() != JsonKind::number || value.number() != std::floor(value.number()))
    at.fail(value.line(), "expected a whole number, not " + description_of(value));
  out = static_cast<Integer>(read_number(at, field, value));
}

void read(const Place& at, const Field&, JsonValue value, bool& out) {
  if (value.kind() != JsonKind::boolean) at.fail(value.line(), "expected true or false, not " + description_of(value));
  out = value.boolean();
}

void read(const Place& at, const Field&, JsonValue value, std::string& out) {
  if (value.kind() != JsonKind::string) at.fail(value.line(), "expected a string, not " + description_of(value));
  out = value.string();
}

void read(const Place& at, const Field& field, JsonValue value, SceneVersion& out) {
  read(at, field, value, out.value);
  if (out.value != kSceneVersion)
    at.fail(value.line(), "scene version " + std::to_string(out.value) + " is unknown; this program reads version " +
                              std::to_string(kSceneVersion));
}

template <class E>
requires std::is_enum_v<E>
void read(const Place& at, const Field&, JsonValue value, E& out) {
  if (value.kind() == JsonKind::string)
    for (const auto& entry : EnumTable<E>::entries)
      if (entry.name == value.string()) {
        out = entry.value;
        return;
      }
  at.fail(value.line(),
          "unknown value " + description_of(value) + "; " +
              choices_text("known values", value.kind() == JsonKind::string ? value.string() : "", enum_names<E>()));
}

void read(const Place& at, const Field&, JsonValue value, Antialiasing& out) {
  const std::string_view text = value.kind() == JsonKind::string ? value.string() : std::string_view();
  constexpr std::string_view kGrid = "grid:";
  if (text == "none" || text == "whitted") {
    out = {text == "none" ? Antialiasing::Method::none : Antialiasing::Method::whitted, 1};
    return;
  }
  if (text.starts_with(kGrid)) {
    const std::string_view digits = text.substr(kGrid.size());
    int size = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), size);
    if (error == std::errc() && end == digits.data() + digits.size() && digits[0] >= '1' && size <= kMaxGridSize) {
      out = {Antialiasing::Method::grid, size};
      return;
    }
  }
  at.fail(value.line(), "unknown value " + description_of(value) +
                            "; known values: \"none\", \"whitted\", \"grid:N\" with N from 1 to " +
                            std::to_string(kMaxGridSize));
}

/// `count` numbers into `set(index, number)`.
template <class Set>
void read_components(const Place& at, const Field& field, JsonValue value, std::size_t count, std::string_view expected,
                     const Set& set) {
  if (value.kind() != JsonKind::array || value.size() != count)
    at.fail(value.line(), "expected " + std::string(expected) + ", not " + description_of(value));
  std::int64_t index = 0;
  value.for_each_element([&](JsonValue element) {
    set(static_cast<int>(index), read_number(Place(at, index), field, element));
    ++index;
  });
}

void check_nonzero(const Place& at, const Field& field, std::int64_t line, const Vec3d& v) {
  if (field.nonzero && v == Vec3d(0, 0, 0)) at.fail(line, "must not be (0, 0, 0)");
}

void read(const Place& at, const Field& field, JsonValue value, Vec3d& out) {
  read_components(at, field, value, 3, "[x, y, z]", [&](int i, double x) { out[i] = x; });
  check_nonzero(at, field, value.line(), out);
}
void read(const Place& at, const Field& field, JsonValue value, Vec2d& out) {
  read_components(at, field, value, 2, "two numbers, e.g. [0, 0]", [&](int i, double x) { out[i] = x; });
}
void read(const Place& at, const Field& field, JsonValue value, Vec3f& out) {
  read_components(at, field, value, 3, "[x, y, z]", [&](int i, double x) { out[i] = static_cast<float>(x); });
}
void read(const Place& at, const Field& field, JsonValue value, Vec2f& out) {
  read_components(at, field, value, 2, "[u, v]", [&](int i, double x) { out[i] = static_cast<float>(x); });
}

float& component(Rgb& color, int index) { return index == 0 ? color.r : index == 1 ? color.g : color.b; }

void read(const Place& at, const Field& field, JsonValue value, Rgb& out) {
  if (value.kind() == JsonKind::number) {
    out = Rgb(static_cast<float>(read_number(at, field, value)));
    return;
  }
  read_components(at, field, value, 3, "a color [r, g, b] or a number for a gray",
                  [&](int i, double x) { component(out, i) = static_cast<float>(x); });
}

void read(const Place& at, const Field& field, JsonValue value, ScaleFactors& out) {
  if (value.kind() == JsonKind::number)
    out.value = Vec3d(read_number(at, field, value));
  else
    read_components(at, field, value, 3, "[x, y, z] or one number for all three",
                    [&](int i, double x) { out.value[i] = x; });
  if (out.value.x == 0 || out.value.y == 0 || out.value.z == 0) at.fail(value.line(), "a factor must not be 0");
}

/// A list of what can be read; nothing is asked of its length.
template <class T>
void read(const Place& at, const Field& field, JsonValue value, std::vector<T>& out) {
  if (value.kind() != JsonKind::array) at.fail(value.line(), "expected a list, not " + description_of(value));
  out.clear();
  out.reserve(value.size());
  value.for_each_element([&](JsonValue element) {
    read(Place(at, static_cast<std::int64_t>(out.size())), field, element, out.emplace_back());
  });
}

void read(const Place& at, const Field&, JsonValue value, FaceLists& out) {
  if (value.kind() != JsonKind::array) at.fail(value.line(), "expected a list of faces, not " + description_of(value));
  const Field index_field{.range = {0, 4294967295.0}};
  out.sizes.reserve(value.size());
  out.lines.reserve(value.size());
  value.for_each_element([&](JsonValue face) {
    const Place face_place(at, static_cast<std::int64_t>(out.sizes.size()));
    if (face.kind() != JsonKind::array || face.size() < 3)
      face_place.fail(face.line(), "expected a face of 3 or more indices, not " + description_of(face));
    out.sizes.push_back(static_cast<std::uint32_t>(face.size()));
    out.lines.push_back(static_cast<std::uint32_t>(face.line()));
    face.for_each_element([&](JsonValue index) { read(face_place, index_field, index, out.corners.emplace_back()); });
  });
}

template <class T>
void read(const Place& at, const Field& field, JsonValue value, std::optional<T>& out) {
  T inside{};
  read(at, field, value, inside);
  out = inside;
}

template <Table T>
void read(const Place& at, const Field&, JsonValue value, T& out) {
  read_table(at, value, out);
}

void read(const Place& at, const Field&, JsonValue value, Matrix44d& out) {
  const Field plain{};
  // Inside a step the key is "matrix" and sixteen numbers follow; elsewhere a step or a list of steps.
  const auto read_step = [&](const Place& place, JsonValue step_value) {
    TransformStep step;
    read_table(place, step_value, step);
    if (step.matrix && (step.scale || step.rotate || step.translate))
      place.fail(step_value.line(), "a matrix is a step of its own; put the others before or after it in a list");
    const Matrix44d m = matrix_of(step);
    if (!invertible(m)) place.fail(step_value.line(), "not invertible: it flattens or blows up what it is applied to");
    return m;
  };
  if (value.kind() == JsonKind::object) {
    out = read_step(at, value);
  } else if (value.kind() == JsonKind::array) {
    Matrix44d product;
    std::int64_t index = 0;
    value.for_each_element([&](JsonValue step) { product = product * read_step(Place(at, index++), step); });
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 3; ++j)
        if (!plain.range.holds(product[i][j])) at.fail(value.line(), "the steps' product has numbers larger than 1e18");
    if (!invertible(product))
      at.fail(value.line(), "not invertible: the steps together flatten what they are applied to");
    out = product;
  } else {
    at.fail(value.line(),
            "expected a step like {\"translate\": [0, 1, 0]} or a list of steps, not " + description_of(value));
  }
}

/// The key "matrix" of a step.
void read(const Place& at, const Field& field, JsonValue value, std::optional<Matrix44d>& out) {
  Matrix44d m;
  read_components(at, field, value, 16, "16 numbers", [&](int i, double x) { m[i / 4][i % 4] = x; });
  if (m[0][3] != 0 || m[1][3] != 0 || m[2][3] != 0 || m[3][3] != 1)
    at.fail(value.line(), "not affine: the fourth, eighth, twelfth and sixteenth number must be 0, 0, 0, 1");
  out = m;
}

void read(const Place& at, const Field& field, JsonValue value, Background& out);
void read(const Place& at, const Field& field, JsonValue value, ColorPattern& out);

/// A list keyed by name.
template <Named T>
void read(const Place& at, const Field&, JsonValue value, std::vector<T>& out) {
  if (value.kind() != JsonKind::object)
    at.fail(value.line(),
            "expected an object of " + std::string(noun_of<T>()) + "s by name, not " + description_of(value));
  out.clear();
  out.reserve(value.size());
  std::unordered_map<std::string_view, std::int64_t> lines;
  value.for_each_member([&](const JsonMember& member) {
    if (member.key.empty()) at.fail(member.line, "a " + std::string(noun_of<T>()) + " needs a name that is not empty");
    const auto [earlier, fresh] = lines.emplace(member.key, member.line);
    if (!fresh)
      at.fail(member.line, "a second " + std::string(noun_of<T>()) + " named " + in_quotes(member.key) +
                               "; the first is on line " + std::to_string(earlier->second));
    const Place place(at, member.key);
    T& element = out.emplace_back();
    element.name = member.key;
    if constexpr (std::same_as<T, ShapeDescription>) element.where = place.location(member.line);
    read_table(place, member.value, element);
  });
}

/// Reads the members of one object, table by table, then refuses what no table knew.
class ObjectReader {
 public:
  ObjectReader(const Place& at, JsonValue object) : at_(at), object_(object) {
    if (object.kind() != JsonKind::object) at.fail(object.line(), "expected an object, not " + description_of(object));
    refuse_duplicates();
  }

  template <class Member>
  void operator()(const Field& field, Member& member) {
    known_.emplace_back(field.key);
    if (const auto value = find(field.key))
      read(Place(at_, field.key), field, *value, member);
    else if (field.required)
      // Said only after unknown keys: one of them may be this one, misspelled.
      afterwards_.emplace_back([this, key = field.key] { fail_missing(key, {}); });
  }

  template <class Variant>
  void tagged(const Field& field, Variant& variant) {
    known_.emplace_back(field.key);
    const auto names = alternative_names<Variant>();
    const auto value = find(field.key);
    if (!value) fail_missing(field.key, choices_text("one of", "", names));
    const std::string_view name = value->kind() == JsonKind::string ? value->string() : std::string_view();
    if (!choose_alternative(name, variant))
      Place(at_, field.key)
          .fail(value->line(),
                "unknown type " + description_of(*value) + "; " + choices_text("known types", name, names));
    std::visit([&](auto& alternative) { visit_fields(*this, alternative); }, variant);
  }

  void inlined(MeshShape& mesh) {
    auto lists = std::make_shared<InlineMesh>();
    found_ = 0;
    visit_fields(*this, *lists);
    const bool given_here = found_ > 0;
    afterwards_.emplace_back([this, lists, given_here, &mesh] {
      if (given_here != mesh.file.empty())
        at_.fail(object_.line(), given_here ? "give either \"file\" or \"positions\" and \"faces\", not both"
                                            : "a mesh needs \"file\", or \"positions\" and \"faces\"");
      if (!given_here) return;
      mesh.mesh = polygon_mesh(
          *lists, [&](const std::string& key, std::int64_t index, std::int64_t line, const std::string& message) {
            const auto value = find(key);
            const Place list(at_, key);
            const std::int64_t known_line = line > 0 ? line : value ? value->line() : object_.line();
            (index < 0 ? list : Place(list, index)).fail(known_line, message);
          });
    });
  }

  void finish() {
    object_.for_each_member([&](const JsonMember& member) {
      if (std::find(known_.begin(), known_.end(), member.key) == known_.end())
        at_.fail(member.line,
                 "unknown key " + in_quotes(member.key) + "; " + choices_text("known keys", member.key, known_));
    });
    for (const auto& action : afterwards_) action();
  }

 private:
  std::optional<JsonValue> find(std::string_view key) {
    std::optional<JsonValue> found;
    object_.for_each_member([&](const JsonMember& member) {
      if (!found && member.key == key) found = member.value;
    });
    if (found) ++found_;
    return found;
  }

  [[noreturn]] void fail_missing(std::string_view key, const std::string& choices) const {
    std::string message = "missing key " + in_quotes(key);
    if (!choices.empty()) message += "; " + choices;
    std::vector<std::string> present;
    object_.for_each_member([&](const JsonMember& member) { present.emplace_back(member.key.substr(0, 100)); });
    if (const auto closest = closest_name(key, present)) message += " (there is " + in_quotes(*closest) + ")";
    at_.fail(object_.line(), message);
  }

  void refuse_duplicates() const {
    const auto refuse = [&](const JsonMember& member, std::int64_t first) {
      at_.fail(member.line, "the key " + in_quotes(member.key) + " stands here again; the first is on line " +
                                std::to_string(first));
    };
    if (object_.size() <= kFewMembers) {
      std::vector<std::pair<std::string_view, std::int64_t>> seen;
      seen.reserve(object_.size());
      object_.for_each_member([&](const JsonMember& member) {
        for (const auto& [key, line] : seen)
          if (key == member.key) refuse(member, line);
        seen.emplace_back(member.key, member.line);
      });
    } else {
      std::unordered_map<std::string_view, std::int64_t> seen;
      object_.for_each_member([&](const JsonMember& member) {
        const auto [earlier, fresh] = seen.emplace(member.key, member.line);
        if (!fresh) refuse(member, earlier->second);
      });
    }
  }

  const Place& at_;
  JsonValue object_;
  std::vector<std::string> known_;
  std::vector<std::function<void()>> afterwards_;
  int found_ = 0;
};

template <class T>
void read_table(const Place& at, JsonValue value, T& out) {
  ObjectReader reader(at, value);
  visit_fields(reader, out);
  reader.finish();
  check(at, value.line(), out);
}

template <class Variant>
void read_tagged(const Place& at, JsonValue value, Variant& out) {
  ObjectReader reader(at, value);
  reader.tagged(Field{.key = kTypeKey}, out);
  reader.finish();
}

void read(const Place& at, const Field&, JsonValue value, Background& out) { read_tagged(at, value, out); }

void read(const Place& at, const Field& field, JsonValue value, ColorPattern& out) {
  if (value.kind() == JsonKind::object) {
    std::variant<CheckerPattern> pattern;
    read_tagged(at, value, pattern);
    out = std::get<CheckerPattern>(pattern);
  } else if (value.kind() == JsonKind::array || value.kind() == JsonKind::number) {
    Rgb color;
    read(at, field, value, color);
    out = color;
  } else {
    at.fail(value.line(),
            "expected a color [r, g, b], a number for a gray, or an object with \"type\": \"checker\", not " +
                description_of(value));
  }
}

// --- one value by its path ----------------------------------------------------------------------------------

struct NewValue {
  JsonValue json;
  std::string_view text;  // as it was given
};

/// What of the path is still to be walked: "", ".key...", "[0]...".
class PathRest {
 public:
  explicit PathRest(std::string_view text) : text_(text) {}
  bool empty() const { return text_.empty(); }

  /// The next key, up to a dot or bracket, or within quotes; empty where an index stands or nothing is left.
  std::string_view take_key() {
    if (!text_.starts_with('.')) return {};
    text_.remove_prefix(1);
    if (text_.starts_with('"')) {
      if (const auto close = text_.find('"', 1); close != text_.npos) return take(1, close - 1, close + 1);
    }
    const std::size_t end = std::min(text_.find_first_of(".["), text_.size());
    return take(0, end, end);
  }

  /// The next name among `names`, the longest that fits, so that names may hold dots; otherwise as take_key.
  std::string_view take_name(const std::vector<std::string>& names) {
    const std::string* best = nullptr;
    if (text_.starts_with('.') && !text_.starts_with(".\"")) {
      const std::string_view rest = text_.substr(1);
      for (const std::string& name : names) {
        if (!rest.starts_with(name)) continue;
        if (rest.size() > name.size() && rest[name.size()] != '.' && rest[name.size()] != '[') continue;
        if (best == nullptr || name.size() > best->size()) best = &name;
      }
    }
    if (best == nullptr) return take_key();
    text_.remove_prefix(1);
    return take(0, best->size(), best->size());
  }

  /// "[2]" or ".2": 2; nothing otherwise.
  std::optional<std::int64_t> take_index() {
    const bool bracket = text_.starts_with('[');
    if (!bracket && !text_.starts_with('.')) return std::nullopt;
    std::int64_t index = 0;
    const char* begin = text_.data() + 1;
    const char* last = text_.data() + text_.size();
    const auto [end, error] = std::from_chars(begin, last, index);
    if (error != std::errc() || index < 0 || (bracket && (end == last || *end != ']'))) return std::nullopt;
    text_.remove_prefix(static_cast<std::size_t>(end - text_.data()) + (bracket ? 1 : 0));
    return index;
  }

  std::string_view text() const { return text_; }

 private:
  std::string_view take(std::size_t begin, std::size_t size, std::size_t drop) {
    const std::string_view taken = text_.substr(begin, size);
    text_.remove_prefix(drop);
    return taken;
  }
  std::string_view text_;
};

template <class T>
void set_table(const Place& at, PathRest rest, const NewValue& value, T& object);
template <class Variant>
void set_tagged(const Place& at, PathRest rest, const NewValue& value, Variant& variant);

template <class T>
void set_value(const Place& at, const Field& field, PathRest rest, const NewValue& value, T& out);

[[noreturn]] void fail_no_parts(const Place& at, PathRest rest) {
  at.fail(0,
          "has no part " + in_quotes(rest.text().substr(rest.text().starts_with('.') ? 1 : 0)) + "; set it as a whole");
}

/// A component of a vector or color of `count`.
int take_component(const Place& at, PathRest& rest, int count) {
  const PathRest whole = rest;
  const auto index = rest.take_index();
  if (!index || *index >= count || !rest.empty())
    at.fail(0,
            "no such component: " + in_quotes(whole.text()) + "; they are [0] to [" + std::to_string(count - 1) + "]");
  return static_cast<int>(*index);
}

template <class T>
void set_part(const Place& at, const Field& field, PathRest rest, const NewValue& value, T& out) {
  if constexpr (Table<T>) {
    set_table(at, rest, value, out);
  } else if constexpr (std::same_as<T, Background>) {
    set_tagged(at, rest, value, out);
  } else if constexpr (std::same_as<T, Vec3d> || std::same_as<T, Vec2d>) {
    const int index = take_component(at, rest, static_cast<int>(T::dimensions()));
    out[index] = read_number(Place(at, index), field, value.json);
    if constexpr (std::same_as<T, Vec3d>) check_nonzero(at, field, 0, out);
  } else if constexpr (std::same_as<T, Rgb>) {
    const int index = take_component(at, rest, 3);
    component(out, index) = static_cast<float>(read_number(Place(at, index), field, value.json));
  } else if constexpr (std::same_as<T, ColorPattern>) {
    if (Rgb* color = std::get_if<Rgb>(&out); color != nullptr && rest.text() != ".type") {
      if (!rest.text().starts_with('[') && !PathRest(rest).take_index())
        at.fail(0, "is a color: its parts are [0] to [2]; for a checker set \"type\" to \"checker\" first");
      set_part(at, field, rest, value, *color);
    } else {
      std::variant<CheckerPattern> pattern;
      if (color == nullptr) pattern = std::get<CheckerPattern>(out);
      set_tagged(at, rest, value, pattern);
      out = std::get<CheckerPattern>(pattern);
    }
  } else {
    fail_no_parts(at, rest);
  }
}

template <class T>
void set_part(const Place& at, const Field& field, PathRest rest, const NewValue& value, std::optional<T>& out) {
  if (!out) {
    // A type can be chosen where nothing is yet; a part cannot be set of it.
    if (rest.text() != ".type") at.fail(0, "is not given in this scene; set it as a whole first");
    out.emplace();
  }
  set_part(at, field, rest, value, *out);
}

template <Named T>
void set_part(const Place& at, const Field& field, PathRest rest, const NewValue& value, std::vector<T>& out) {
  const auto names = names_of(out);
  const std::string_view name = rest.take_name(names);
  const auto element = std::find_if(out.begin(), out.end(), [&](const T& e) { return e.name == name; });
  if (element == out.end())
    at.fail(0, "unknown " + std::string(noun_of<T>()) + " " + in_quotes(name) + "; " +
                   choices_text("known " + std::string(noun_of<T>()) + "s", name, names));
  set_value(Place(at, name), field, rest, value, *element);
}

template <class T>
void set_value(const Place& at, const Field& field, PathRest rest, const NewValue& value, T& out) {
  if (!rest.empty()) {
    set_part(at, field, rest, value, out);
    return;
  }
  if constexpr (std::same_as<T, std::string>) {
    // On a command line a title like 1980 need not be quoted twice.
    out = value.json.kind() == JsonKind::string ? value.json.string() : value.text;
  } else {
    T fresh{};
    if constexpr (Named<T>) fresh.name = out.name;
    if constexpr (std::same_as<T, ShapeDescription>) fresh.where = out.where;
    read(at, field, value.json, fresh);
    out = std::move(fresh);
  }
}

/// Looks for one key in an object's tables and sets it.
class PathSetter {
 public:
  PathSetter(const Place& at, std::string_view key, PathRest rest, const NewValue& value)
      : at_(at), key_(key), rest_(rest), value_(value) {}

  template <class Member>
  void operator()(const Field& field, Member& member) {
    known_.emplace_back(field.key);
    if (done_ || field.key != key_) return;
    done_ = true;
    set_value(Place(at_, field.key), field, rest_, value_, member);
  }

  template <class Variant>
  void tagged(const Field& field, Variant& variant) {
    known_.emplace_back(field.key);
    if (field.key == key_) {
      done_ = true;
      if (!rest_.empty()) fail_no_parts(Place(at_, key_), rest_);
      const std::string_view name =
          value_.json.kind() == JsonKind::string ? value_.json.string() : std::string_view(value_.text);
      if (!choose_alternative(name, variant))
        Place(at_, key_).fail(0, "unknown type " + in_quotes(name) + "; " +
                                     choices_text("known types", name, alternative_names<Variant>()));
      return;
    }
    std::visit([&](auto& alternative) { visit_fields(*this, alternative); }, variant);
  }

  void inlined(MeshShape& mesh) {
    if (done_ && key_ == "file") mesh.mesh.reset();
    const bool was_done = done_;
    InlineMesh lists = mesh.mesh && !was_done ? inline_mesh(*mesh.mesh) : InlineMesh{};
    visit_fields(*this, lists);
    if (was_done || !done_) return;
    if (!mesh.file.empty()) at_.fail(0, "the mesh comes from a file; set the shape as a whole to give its faces");
    mesh.mesh =
        polygon_mesh(lists, [&](const std::string& key, std::int64_t index, std::int64_t, const std::string& message) {
          const Place list(at_, key);
          (index < 0 ? list : Place(list, index)).fail(0, message);
        });
  }

  void finish() const {
    if (!done_) at_.fail(0, "unknown key " + in_quotes(key_) + "; " + choices_text("known keys", key_, known_));
  }

 private:
  const Place& at_;
  std::string_view key_;
  PathRest rest_;
  const NewValue& value_;
  std::vector<std::string> known_;
  bool done_ = false;
};

template <class T>
void set_table(const Place& at, PathRest rest, const NewValue& value, T& object) {
  const std::string_view key = rest.take_key();
  PathSetter setter(at, key, rest, value);
  visit_fields(setter, object);
  setter.finish();
  check(at, 0, object);
}

template <class Variant>
void set_tagged(const Place& at, PathRest rest, const NewValue& value, Variant& variant) {
  const std::string_view key = rest.take_key();
  PathSetter setter(at, key, rest, value);
  setter.tagged(Field{.key = kTypeKey}, variant);
  setter.finish();
}

}  // namespace

SceneDescription read_scene(std::string_view json, const std::string& name, const std::string& folder) {
  const JsonDocument document = JsonDocument::parse(json, name);
  SceneDescription scene;
  scene.name = name;
  scene.folder = folder;
  const Place root(name);
  read_table(root, document.root(), scene);
  check_references(root, scene);
  return scene;
}

SceneDescription read_scene_file(const std::string& path) {
  const auto fail = [&](const std::string& message) { throw Error(ErrorKind::bad_input, {path, 0, ""}, message); };
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) fail("is a folder, not a scene file");
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"), std::fclose);
  if (!file) fail("cannot open: " + std::generic_category().message(errno));
  std::string text;
  // A file tells its size, so that reading it takes no second copy; a pipe does not.
  if (const auto size = std::filesystem::file_size(path, ignored); !ignored && size <= kMaxJsonText) text.reserve(size);
  std::vector<char> block(std::size_t(1) << 16);
  while (const std::size_t count = std::fread(block.data(), 1, block.size(), file.get())) {
    if (text.size() + count > kMaxJsonText) fail("larger than 1 GiB; put large meshes into OBJ or PLY files");
    text.append(block.data(), count);
  }
  if (std::ferror(file.get())) fail("cannot read: " + std::generic_category().message(errno));
  return read_scene(text, path, std::filesystem::path(path).parent_path().string());
}

void set_scene_value(SceneDescription& scene, const std::string& path, const std::string& value) {
  const std::string file = "--set";
  const Place root(file, Place::Lines::none);
  if (path.empty()) root.fail(0, "a path is missing, e.g. render.depth=12");
  JsonDocument document = JsonDocument::of_string(value);
  try {
    document = JsonDocument::parse(value, file);
  } catch (const Error&) {
    // Not JSON: a string, so that quotes need no quotes of their own on a command line.
  }
  // A path that fails leaves the scene as it was. Meshes are shared, not copied.
  SceneDescription changed = scene;
  const std::string dotted = "." + path;
  set_table(root, PathRest(dotted), NewValue{document.root(), value}, changed);
  check_references(root, changed);
  scene = std::move(changed);
}

}  // namespace raytree
