// Prints the tables of scene_fields.h as the reference of docs/scene-format.md.
#include "renderer/scene_reader.h"
#include "renderer/scene_values.h"

namespace raytree {
namespace {

class ReferenceWriter {
 public:
  /// A heading and the rows of one object's keys.
  template <class T>
  void table(const std::string& heading, const std::string& intro, const T& defaults) {
    text_ += "\n### " + heading + "\n\n" + intro + "\n\n";
    text_ += "| key | type | default | range | meaning |\n|---|---|---|---|---|\n";
    visit_fields(*this, defaults);
  }

  void builtin_materials_table() {
    text_ +=
        "\n### What `from` of a material may name\n\nPhong 1973, Appendix II and p. 60: reflection coefficients, W "
        "and n.\n\n| name | what it is |\n|---|---|\n";
    for (const BuiltinMaterial& material : builtin_materials())
      text_ += "| `" + material.description.name + "` | " + sentence(material.text) + " |\n";
  }

  template <class Variant>
  void alternatives(const std::string& where, const Variant&) {
    for_each_alternative<Variant>([&]<class T>(std::in_place_type_t<T>) {
      const std::string name(Alternative<T>::name);
      table(where + ", type \"" + name + "\"", sentence(Alternative<T>::text), T{});
    });
  }

  template <class Member>
  void operator()(const Field& field, const Member& member) {
    text_ += "| `" + std::string(field.key) + "` | " + type_text(member) + " | " + default_text(field, member) + " | " +
             range_text(field, member) + " | " + std::string(field.text);
    if constexpr (std::is_enum_v<Member>) {
      text_ += ": ";
      bool first = true;
      for (const auto& entry : EnumTable<Member>::entries) {
        text_ += std::string(first ? "" : "; ") + "`\"" + std::string(entry.name) + "\"` " + std::string(entry.text);
        first = false;
      }
    }
    text_ += ". |\n";
  }
  template <class Variant>
  void tagged(const Field& field, const Variant&) {
    text_ += "| `" + std::string(field.key) + "` | string | required | | " + std::string(field.text) + ": ";
    bool first = true;
    for_each_alternative<Variant>([&]<class T>(std::in_place_type_t<T>) {
      text_ += std::string(first ? "" : ", ") + "`\"" + std::string(Alternative<T>::name) + "\"`";
      first = false;
    });
    text_ += "; its keys stand beside these. |\n";
  }
  void inlined(const MeshShape&) {
    const InlineMesh lists;
    visit_fields(*this, lists);
  }

  const std::string& text() const { return text_; }

 private:
  template <class T>
  static std::string type_text(const T&) {
    if constexpr (std::same_as<T, bool>) return "true or false";
    if constexpr (std::integral<T> || std::same_as<T, SceneVersion>) return "whole number";
    if constexpr (std::same_as<T, double>) return "number";
    if constexpr (std::same_as<T, std::string> || std::is_enum_v<T> || std::same_as<T, Antialiasing> ||
                  std::same_as<T, MaterialBase>)
      return "string";
    if constexpr (std::same_as<T, Vec2d>) return "`[x, y]`";
    if constexpr (std::same_as<T, Vec3d>) return "`[x, y, z]`";
    if constexpr (std::same_as<T, ScaleFactors>) return "number or `[x, y, z]`";
    if constexpr (std::same_as<T, Rgb>) return "color";
    if constexpr (std::same_as<T, ColorPattern>) return "color or pattern";
    if constexpr (std::same_as<T, Matrix44d>) return "transform";
    if constexpr (std::same_as<T, std::vector<Vec3d>> || std::same_as<T, std::vector<Vec3f>>)
      return "list of `[x, y, z]`";
    if constexpr (std::same_as<T, std::vector<Vec2f>>) return "list of `[u, v]`";
    if constexpr (std::same_as<T, FaceLists>) return "list of `[i, j, k, ...]`";
    if constexpr (std::same_as<T, std::vector<double>>) return "list of numbers";
    if constexpr (is_index_lists<T>) return "lists of " + std::to_string(index_list_count<T>) + " whole numbers";
    if constexpr (std::same_as<T, std::vector<FaceGroup>> || std::same_as<T, std::vector<AngleWeight>> ||
                  std::same_as<T, std::vector<Crease>> || std::same_as<T, std::vector<SharpCorner>>)
      return "list of objects";
    if constexpr (std::same_as<T, std::vector<std::uint32_t>>) return "list of whole numbers";
    if constexpr (requires(const T& list) { noun_of<typename T::value_type>(); }) return "objects by name";
    if constexpr (Table<T> || std::same_as<T, Background>) return "object";
    return {};
  }
  static std::string type_text(const std::optional<Matrix44d>&) { return "16 numbers"; }
  template <class T>
  static std::string type_text(const std::optional<T>&) {
    return type_text(T{});
  }

  template <class T>
  static std::string default_text(const Field& field, const T& member) {
    if (field.required) return "required";
    if (!field.absent.empty()) return std::string(field.absent);
    if constexpr (Table<T>) {
      return "as its table";
    } else if constexpr (std::same_as<T, Background>) {
      return "black";
    } else if constexpr (std::same_as<T, MaterialBase>) {
      return "none";
    } else if constexpr (std::same_as<T, FaceLists> || (requires { member.size(); } && !std::same_as<T, std::string>)) {
      return "none";
    } else {
      JsonWriter out;
      out.begin_array();
      SceneValueWriter(out).write(member);
      out.end_array();
      // Without the array's brackets and line end.
      return "`" + out.text().substr(1, out.text().size() - 3) + "`";
    }
  }

  template <class T>
  static std::string range_text(const Field& field, const T&) {
    std::string text;
    if constexpr (std::integral<T> || std::floating_point<T> || std::same_as<T, Rgb> || std::same_as<T, ColorPattern> ||
                  std::same_as<T, std::optional<ColorPattern>> || std::same_as<T, std::vector<double>>) {
      if constexpr (std::same_as<T, bool>) return text;
      if (field.range.low > -kLargestNumber)
        text = (field.range.low_open ? "> " : ">= ") + number_text(field.range.low);
      if (field.range.high < kLargestNumber)
        text += (text.empty() ? "" : ", ") + std::string(field.range.high_open ? "< " : "<= ") +
                number_text(field.range.high);
    }
    if (field.nonzero) text = "not zero";
    if (!field.unit.empty()) text += (text.empty() ? "" : "; ") + std::string(field.unit);
    return text;
  }

  std::string text_;
};

}  // namespace

std::string scene_reference() {
  ReferenceWriter out;
  out.table("Top level", "The whole file is one object.", SceneDescription{});
  out.table("image", "The size of the picture.", ImageDescription{});
  out.table("render", "How the picture is traced.", RenderSettings{});
  out.table("render.adaptive", "The anti-aliasing of Whitted 1980, sec. 3: `\"antialias\": \"whitted\"`.",
            AdaptiveSampling{});
  out.table("render.tessellation", "What curved surfaces become: triangles, no more than the view needs.",
            TessellationSettings{});
  out.table("render.facets", "How facets are shaded; see docs/shading.md.", FacetSettings{});
  out.alternatives("background", Background{});
  out.table("cameras.NAME", "One camera.", CameraDescription{});
  out.table("lights.NAME", "One light; these keys and those of its type.", LightDescription{});
  out.alternatives("lights.NAME", LightDescription{}.kind);
  out.table("materials.NAME", "One material: I = ambient + diffuse + highlights + k_s S + k_t T (Whitted 1980, eq. 2).",
            MaterialDescription{});
  out.table("materials.NAME.bump", "A height over the surface, carried with its shape or still in the world.",
            BumpDescription{});
  out.table("materials.NAME.highlight", "W cos^n (Phong 1973, eq. 4.5).", HighlightDescription{});
  out.table("materials.NAME.highlight.weight_by_angle[]", "A point of W(i).", AngleWeight{});
  out.builtin_materials_table();
  out.alternatives("Where a color or pattern stands", VaryingPattern());
  out.table("groups.NAME", "One group of shapes, in a space of its own.", GroupDescription{});
  out.table("shapes.NAME", "One shape; these keys and those of its type.", ShapeDescription{});
  out.alternatives("shapes.NAME", ShapeKind{});
  out.table("shapes.NAME.smoothing", "Vertex normals as Gouraud and Phong found them; see docs/shading.md.",
            Smoothing{});
  out.table("shapes.NAME.subdivision",
            "What a mesh is as a cage. OpenSubdiv's tags in an OBJ (`t`) join these keys, which are the stronger ones; "
            "without "
            "this object the tags are not used.",
            SubdivisionRules{});
  out.table("shapes.NAME.subdivision.creases[]", "A chain of sharp edges.", Crease{});
  out.table("shapes.NAME.subdivision.corners[]", "A sharp vertex.", SharpCorner{});
  out.table("shapes.NAME.groups[]", "A run of faces.", FaceGroup{});
  out.table("shapes.NAME.transform", "One step. Within a step: scale first, then rotate, then translate.",
            TransformStep{});
  return out.text();
}

}  // namespace raytree
