// How each value of a scene stands in a file, for scene_writer (scenes) and scene_schema (defaults): every key is
// written with its value, so that a file means the same when defaults change.
#pragma once

#include "renderer/inline_mesh.h"
#include "renderer/json_writer.h"
#include "renderer/scene_fields.h"

namespace raytree {

/// With a capital, unless a symbol like k_d heads it, and a period.
inline std::string sentence(std::string_view text) {
  std::string out(text);
  if (!out.empty() && out[0] >= 'a' && out[0] <= 'z' && (out.size() < 2 || out[1] != '_'))
    out[0] = static_cast<char>(out[0] - 'a' + 'A');
  return out + ".";
}

class SceneValueWriter {
 public:
  explicit SceneValueWriter(JsonWriter& out) : out_(out) {}

  // As the tables' visitor.
  template <class Member>
  void operator()(const Field& field, const Member& member) {
    if (is_absent(field, member)) return;
    out_.key(field.key);
    write(member);
  }

  template <class Variant>
  void tagged(const Field& field, const Variant& variant) {
    out_.key(field.key);
    std::visit(
        [&]<class T>(const T& alternative) {
          out_.value(Alternative<T>::name);
          visit_fields(*this, alternative);
        },
        variant);
  }

  void inlined(const MeshShape& mesh) {
    if (!mesh.file.empty() || !mesh.mesh) return;
    const InlineMesh lists = inline_mesh(*mesh.mesh);
    visit_fields(*this, lists);
  }

  /// Whether the writer leaves the key out.
  template <class T>
  static bool is_absent(const Field& field, const T& member) {
    if constexpr (std::same_as<T, MaterialBase>)
      return true;
    else if constexpr (std::same_as<T, std::string>)
      return member.empty() && !field.absent.empty();
    else if constexpr (std::same_as<T, FaceLists>)
      return member.sizes.empty();
    else if constexpr (std::same_as<T, std::vector<Vec3f>> || std::same_as<T, std::vector<Vec2f>> ||
                       std::same_as<T, std::vector<FaceGroup>> || std::same_as<T, std::vector<AngleWeight>> ||
                       std::same_as<T, std::vector<Vec3d>> || std::same_as<T, std::vector<double>> ||
                       is_index_lists<T> || std::same_as<T, std::vector<Crease>> ||
                       std::same_as<T, std::vector<SharpCorner>> || std::same_as<T, std::vector<std::uint32_t>>)
      return member.empty() && !field.required;
    else if constexpr (std::same_as<T, Matrix44d>)
      return member == Matrix44d();
    else if constexpr (requires { member.has_value(); })
      return !member.has_value();
    else
      return false;
  }

  void write(bool value) { out_.value(value); }
  void write(int value) { out_.value(value); }
  void write(std::int64_t value) { out_.value(value); }
  void write(std::uint32_t value) { out_.value(value); }
  void write(double value) { out_.value(value); }
  void write(const std::string& value) { out_.value(std::string_view(value)); }
  void write(const SceneVersion& version) { out_.value(version.value); }
  void write(const MaterialBase&) {}
  void write(const Antialiasing& antialias) { out_.value(std::string_view(antialiasing_text(antialias))); }
  template <class E>
  requires std::is_enum_v<E>
  void write(E value) { out_.value(enum_name(value)); }

  void write(const Vec2d& v) { components(v.x, v.y); }
  void write(const Vec2f& v) { components(v.x, v.y); }
  void write(const Vec3d& v) { components(v.x, v.y, v.z); }
  void write(const Vec3f& v) { components(v.x, v.y, v.z); }
  void write(const ScaleFactors& scale) { write(scale.value); }
  void write(const Rgb& color) { components(color.r, color.g, color.b); }
  void write(const ColorPattern& pattern) {
    if (const Rgb* color = std::get_if<Rgb>(&pattern))
      write(*color);
    else
      write_tagged(varying_pattern(pattern), JsonWriter::Layout::in_line);
  }
  void write(const Background& background) { write_tagged(background, JsonWriter::Layout::lines); }
  void write(const Matrix44d& matrix) {
    out_.begin_object(JsonWriter::Layout::in_line);
    out_.key("matrix");
    out_.begin_array();
    for (int i = 0; i < 16; ++i) out_.value(matrix[i / 4][i % 4]);
    out_.end_array();
    out_.end_object();
  }

  template <class T>
  void write(const std::optional<T>& value) {
    write(*value);
  }
  template <class T>
  void write(const std::vector<T>& list) {
    out_.begin_array(JsonWriter::Layout::lines);
    for (const T& element : list) write(element);
    out_.end_array();
  }
  template <std::size_t Count>
  void write(const std::array<std::uint32_t, Count>& indices) {
    out_.begin_array();
    for (const std::uint32_t index : indices) out_.value(index);
    out_.end_array();
  }
  void write(const FaceLists& faces) {
    out_.begin_array(JsonWriter::Layout::lines);
    std::size_t corner = 0;
    for (const std::uint32_t size : faces.sizes) {
      out_.begin_array();
      for (std::uint32_t i = 0; i < size; ++i) out_.value(faces.corners[corner++]);
      out_.end_array();
    }
    out_.end_array();
  }
  template <Named T>
  void write(const std::vector<T>& list) {
    out_.begin_object();
    for (const T& element : list) {
      out_.key(element.name);
      write(element);
    }
    out_.end_object();
  }
  template <Table T>
  void write(const T& object) {
    out_.begin_object();
    visit_fields(*this, object);
    out_.end_object();
  }

 private:
  template <class... Number>
  void components(Number... numbers) {
    out_.begin_array();
    (out_.value(numbers), ...);
    out_.end_array();
  }
  template <class Variant>
  void write_tagged(const Variant& variant, JsonWriter::Layout layout) {
    out_.begin_object(layout);
    tagged(Field{.key = kTypeKey}, variant);
    out_.end_object();
  }

  JsonWriter& out_;
};

}  // namespace raytree
