// How each value of a scene is read from JSON, the counterpart of scene_values.h: walks the tables of scene_fields.h.
// Included by the sources that read scene files and set single values alone.
#pragma once

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <unordered_map>
#include <vector>

#include "renderer/inline_mesh.h"
#include "renderer/json_document.h"
#include "renderer/json_writer.h"
#include "renderer/scene_checks.h"
#include "renderer/scene_fields.h"
#include "renderer/scene_place.h"
#include "renderer/suggestion.h"

namespace raytree::reading {

inline constexpr std::size_t kFewMembers = 16;  // up to here comparing all pairs of keys beats a hash table

inline std::string range_text(const Range& range) {
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
void read_table(const Place& at, JsonValue value, T& out);

class ObjectReader;

inline double read_number(const Place& at, const Field& field, JsonValue value) {
  if (value.kind() != JsonKind::number) at.fail(value.line(), "expected a number, not " + description_of(value));
  const double x = value.number();
  if (!field.range.holds(x))
    at.fail(value.line(), number_text(x) + " is out of range: must be " + range_text(field.range));
  return x;
}

inline void read(const Place& at, const Field& field, JsonValue value, double& out) {
  out = read_number(at, field, value);
}

template <std::integral Integer>
void read(const Place& at, const Field& field, JsonValue value, Integer& out) {
  if (value.kind() != JsonKind::number || value.number() != std::floor(value.number()))
    at.fail(value.line(), "expected a whole number, not " + description_of(value));
  const double x = read_number(at, field, value);
  // 2^n, which a double holds exactly where the largest integer itself may not be one.
  constexpr double kEnd = 2.0 * static_cast<double>(std::numeric_limits<Integer>::max() / 2 + 1);
  if (!(x >= static_cast<double>(std::numeric_limits<Integer>::min()) && x < kEnd))
    at.fail(value.line(), number_text(x) + " is out of range");
  out = static_cast<Integer>(x);
}

inline void read(const Place& at, const Field&, JsonValue value, bool& out) {
  if (value.kind() != JsonKind::boolean) at.fail(value.line(), "expected true or false, not " + description_of(value));
  out = value.boolean();
}

inline void read(const Place& at, const Field&, JsonValue value, std::string& out) {
  if (value.kind() != JsonKind::string) at.fail(value.line(), "expected a string, not " + description_of(value));
  out = value.string();
}

inline void read(const Place& at, const Field& field, JsonValue value, SceneVersion& out) {
  read(at, field, value, out.value);
  if (out.value != kSceneVersion)
    at.fail(value.line(), "scene version " + std::to_string(out.value) + " is unknown; this program reads version " +
                              std::to_string(kSceneVersion));
}

inline void read(const Place& at, const Field&, JsonValue value, MaterialBase& out) {
  const std::string name(value.kind() == JsonKind::string ? value.string() : std::string_view());
  if (builtin_material(name) == nullptr)
    at.fail(value.line(), "unknown material " + description_of(value) + "; " +
                              choices_text("built-in materials", name, builtin_material_names()));
  out.name = name;
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

inline void read(const Place& at, const Field&, JsonValue value, Antialiasing& out) {
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

inline void check_nonzero(const Place& at, const Field& field, std::int64_t line, const Vec3d& v) {
  if (field.nonzero && v == Vec3d(0, 0, 0)) at.fail(line, "must not be (0, 0, 0)");
}

inline void read(const Place& at, const Field& field, JsonValue value, Vec3d& out) {
  read_components(at, field, value, 3, "[x, y, z]", [&](int i, double x) { out[i] = x; });
  check_nonzero(at, field, value.line(), out);
}
inline void read(const Place& at, const Field& field, JsonValue value, Vec2d& out) {
  read_components(at, field, value, 2, "two numbers, e.g. [0, 0]", [&](int i, double x) { out[i] = x; });
}
inline void read(const Place& at, const Field& field, JsonValue value, Vec3f& out) {
  read_components(at, field, value, 3, "[x, y, z]", [&](int i, double x) { out[i] = static_cast<float>(x); });
}
inline void read(const Place& at, const Field& field, JsonValue value, Vec2f& out) {
  read_components(at, field, value, 2, "[u, v]", [&](int i, double x) { out[i] = static_cast<float>(x); });
}

inline float& component(Rgb& color, int index) { return index == 0 ? color.r : index == 1 ? color.g : color.b; }

inline void read(const Place& at, const Field& field, JsonValue value, Rgb& out) {
  if (value.kind() == JsonKind::number) {
    out = Rgb(static_cast<float>(read_number(at, field, value)));
    return;
  }
  read_components(at, field, value, 3, "a color [r, g, b] or a number for a gray",
                  [&](int i, double x) { component(out, i) = static_cast<float>(x); });
}

inline void read(const Place& at, const Field& field, JsonValue value, ScaleFactors& out) {
  if (value.kind() == JsonKind::number)
    out.value = Vec3d(read_number(at, field, value));
  else
    read_components(at, field, value, 3, "[x, y, z] or one number for all three",
                    [&](int i, double x) { out.value[i] = x; });
  if (out.value.x == 0 || out.value.y == 0 || out.value.z == 0) at.fail(value.line(), "a factor must not be 0");
}

template <std::size_t Count>
void read(const Place& at, const Field&, JsonValue value, std::array<std::uint32_t, Count>& out) {
  if (value.kind() != JsonKind::array || value.size() != Count)
    at.fail(value.line(), "expected " + std::to_string(Count) + " indices, not " + description_of(value));
  const Field index_field{.range = {0, 4294967295.0}};
  std::size_t count = 0;
  value.for_each_element([&](JsonValue index) { read(at, index_field, index, out[count++]); });
}

/// A list of what can be read; nothing is asked of its length.
template <class T>
void read(const Place& at, const Field& field, JsonValue value, std::vector<T>& out) {
  if (value.kind() != JsonKind::array) at.fail(value.line(), "expected a list, not " + description_of(value));
  out.clear();
  out.reserve(value.size());
  value.for_each_element([&](JsonValue element) {
    const auto index = static_cast<std::int64_t>(out.size());
    read(Place(at, index), field, element, out.emplace_back());
  });
}

inline void read(const Place& at, const Field&, JsonValue value, FaceLists& out) {
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

inline void read(const Place& at, const Field&, JsonValue value, Matrix44d& out) {
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
inline void read(const Place& at, const Field& field, JsonValue value, std::optional<Matrix44d>& out) {
  Matrix44d m;
  read_components(at, field, value, 16, "16 numbers", [&](int i, double x) { m[i / 4][i % 4] = x; });
  if (m[0][3] != 0 || m[1][3] != 0 || m[2][3] != 0 || m[3][3] != 1)
    at.fail(value.line(), "not affine: the fourth, eighth, twelfth and sixteenth number must be 0, 0, 0, 1");
  out = m;
}

inline void read(const Place& at, const Field& field, JsonValue value, Background& out);
inline void read(const Place& at, const Field& field, JsonValue value, ColorPattern& out);

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
    if constexpr (requires { element.where; }) element.where = place.location(member.line);
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
      afterwards_.emplace_back([this, key = field.key] {
        // Whose only value is known beforehand.
        constexpr bool is_version = std::same_as<Member, SceneVersion>;
        fail_missing(key, is_version ? "say " + in_quotes(key) + ": " + std::to_string(kSceneVersion) : std::string());
      });
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

inline void read(const Place& at, const Field&, JsonValue value, Background& out) { read_tagged(at, value, out); }

inline void read(const Place& at, const Field& field, JsonValue value, ColorPattern& out) {
  if (value.kind() == JsonKind::object) {
    VaryingPattern pattern;
    read_tagged(at, value, pattern);
    out = color_pattern(pattern);
  } else if (value.kind() == JsonKind::array || value.kind() == JsonKind::number) {
    Rgb color;
    read(at, field, value, color);
    out = color;
  } else {
    at.fail(value.line(),
            "expected a color [r, g, b], a number for a gray, or an object whose \"type\" is \"checker\", \"stripes\" "
            "or \"noise\", not " +
                description_of(value));
  }
}

}  // namespace raytree::reading
