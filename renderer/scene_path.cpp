// One value of a scene by its path, as --set gives it: walks the path and the tables of scene_fields.h together.
#include <algorithm>
#include <charconv>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

#include "renderer/json_document.h"
#include "renderer/scene_reader.h"
#include "renderer/scene_value_reader.h"
#include "renderer/suggestion.h"

namespace raytree {
namespace {

using namespace reading;

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
        at.fail(0,
                "is a color: its parts are [0] to [2]; for a pattern set \"type\" first, to checker, stripes or noise");
      set_part(at, field, rest, value, *color);
    } else {
      VaryingPattern pattern = varying_pattern(out);
      set_tagged(at, rest, value, pattern);
      out = color_pattern(pattern);
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
    if constexpr (requires { fresh.where; }) fresh.where = out.where;
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

void set_scene_value(SceneDescription& scene, const std::string& path, const std::string& value,
                     const std::string& flag) {
  const Place root(flag, Place::Lines::none);
  if (path.empty()) root.fail(0, "a path is missing, e.g. render.depth=12");
  JsonDocument document = JsonDocument::of_string(value);
  try {
    document = JsonDocument::parse(value, flag);
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
