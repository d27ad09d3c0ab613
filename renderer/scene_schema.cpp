// Prints the tables of scene_fields.h: as JSON Schema, and as the reference of docs/scene-format.md.
#include <set>

#include "renderer/scene_reader.h"
#include "renderer/scene_values.h"

namespace raytree {
namespace {

constexpr Range kIndexRange{0, 4294967295.0};

/// With a capital, unless a symbol like k_d heads it, and a period.
std::string sentence(std::string_view text) {
  std::string out(text);
  if (!out.empty() && out[0] >= 'a' && out[0] <= 'z' && (out.size() < 2 || out[1] != '_'))
    out[0] = static_cast<char>(out[0] - 'a' + 'A');
  return out + ".";
}

// --- JSON Schema --------------------------------------------------------------------------------------------

class SchemaWriter {
 public:
  explicit SchemaWriter(JsonWriter& out) : out_(out) {}

  /// A property: what it is, its documentation, its default.
  template <class Member>
  void operator()(const Field& field, const Member& member) {
    out_.key(field.key);
    out_.begin_object();
    describe(field);
    schema(field, member);
    // A struct's members have defaults of their own; a list's default is to be empty.
    if constexpr (!Table<Member> && !requires { member.size(); } && !std::same_as<Member, FaceLists> &&
                  !std::same_as<Member, SceneVersion>)
      write_default(field, member);
    out_.end_object();
    if (field.required) required_.insert(std::string(field.key));
  }

  void inlined(const MeshShape&) {
    const InlineMesh lists;
    visit_fields(*this, lists);
  }

  /// Of a table that chooses no alternative; of others `alternatives`.
  template <class T>
  void object(const T& defaults) {
    if constexpr (std::same_as<T, LightDescription> || std::same_as<T, ShapeDescription>) {
      alternatives(defaults.kind, [&](SchemaWriter& properties) {
        CommonFields common{properties};
        visit_fields(common, defaults);
      });
    } else {
      closed_object([&](SchemaWriter& properties) { visit_fields(properties, defaults); });
    }
  }

  /// oneOf an object per alternative, told apart by "type"; `common` adds the properties that all of them have.
  template <class Variant, class Common>
  void alternatives(const Variant&, const Common& common) {
    out_.key("oneOf");
    out_.begin_array(JsonWriter::Layout::lines);
    for_each_alternative<Variant>([&]<class T>(std::in_place_type_t<T>) {
      out_.begin_object();
      out_.key("title");
      out_.value(Alternative<T>::name);
      out_.key("description");
      out_.value(sentence(Alternative<T>::text));
      closed_object([&](SchemaWriter& properties) {
        properties.out_.key(kTypeKey);
        properties.out_.begin_object(JsonWriter::Layout::in_line);
        properties.out_.key("const");
        properties.out_.value(Alternative<T>::name);
        properties.out_.end_object();
        properties.required_.insert(std::string(kTypeKey));
        const T defaults{};
        visit_fields(properties, defaults);
        common(properties);
      });
      if constexpr (std::same_as<T, MeshShape>) {
        // Either a file or polygons given in place, the latter with both lists.
        out_.key("oneOf");
        out_.begin_array(JsonWriter::Layout::lines);
        out_.begin_object();
        write_required({"file"});
        out_.key("properties");
        out_.begin_object();
        out_.key("file");
        out_.begin_object(JsonWriter::Layout::in_line);
        out_.key("minLength");
        out_.value(1);
        out_.end_object();
        NoneOf none{out_};
        const InlineMesh lists;
        visit_fields(none, lists);
        out_.end_object();
        out_.end_object();
        out_.begin_object();
        write_required({"positions", "faces"});
        out_.key("properties");
        out_.begin_object();
        out_.key("file");
        out_.begin_object(JsonWriter::Layout::in_line);
        out_.key("const");
        out_.value("");
        out_.end_object();
        out_.end_object();
        out_.end_object();
        out_.end_array();
      }
      out_.end_object();
    });
    out_.end_array();
  }

 private:
  /// Every list of an inline mesh: refused beside a file.
  struct NoneOf {
    JsonWriter& out;
    void operator()(const Field& field, const auto&) {
      out.key(field.key);
      out.value(false);
    }
  };
  /// The table of a struct with alternatives, without them.
  struct CommonFields {
    SchemaWriter& properties;
    void operator()(const Field& field, const auto& member) { properties(field, member); }
    void tagged(const Field&, const auto&) {}
  };

  void describe(const Field& field) {
    std::string text = sentence(field.text);
    if (!field.unit.empty()) text += " Unit: " + std::string(field.unit) + ".";
    if (!field.absent.empty()) text += " Absent: " + std::string(field.absent) + ".";
    out_.key("description");
    out_.value(std::string_view(text));
  }

  template <class Member>
  void write_default(const Field& field, const Member& member) {
    if (field.required || SceneValueWriter::is_absent(field, member)) return;
    out_.key("default");
    SceneValueWriter(out_).write(member);
  }

  void write_required(const std::set<std::string>& keys) {
    if (keys.empty()) return;
    out_.key("required");
    out_.begin_array();
    for (const std::string& key : keys) out_.value(std::string_view(key));
    out_.end_array();
  }

  template <class Properties>
  void closed_object(const Properties& properties) {
    type("object");
    out_.key("properties");
    out_.begin_object();
    SchemaWriter inside(out_);
    properties(inside);
    out_.end_object();
    write_required(inside.required_);
    out_.key("additionalProperties");
    out_.value(false);
  }

  void type(std::string_view name) {
    out_.key("type");
    out_.value(name);
  }
  void bounds(const Range& range) {
    out_.key(range.low_open ? "exclusiveMinimum" : "minimum");
    out_.value(range.low);
    out_.key(range.high_open ? "exclusiveMaximum" : "maximum");
    out_.value(range.high);
  }
  /// As the value of a key or an element.
  template <class Inside>
  void nested(const Inside& inside) {
    out_.begin_object(JsonWriter::Layout::in_line);
    inside();
    out_.end_object();
  }
  template <class Items>
  void list(const Items& items, int least = 0, int most = -1) {
    type("array");
    out_.key("items");
    nested(items);
    if (least > 0) {
      out_.key("minItems");
      out_.value(least);
    }
    if (most >= 0) {
      out_.key("maxItems");
      out_.value(most);
    }
  }
  void numbers(const Range& range, int count) {
    list(
        [&] {
          type("number");
          bounds(range);
        },
        count, count);
  }
  void refuse_zero(const Field& field) {
    if (!field.nonzero) return;
    out_.key("not");
    nested([&] {
      out_.key("const");
      out_.begin_array();
      for (int i = 0; i < 3; ++i) out_.value(0);
      out_.end_array();
    });
  }

  void schema(const Field&, const SceneVersion& version) {
    out_.key("const");
    out_.value(version.value);
  }
  void schema(const Field&, const MaterialBase&) {
    out_.key("oneOf");
    out_.begin_array(JsonWriter::Layout::lines);
    for (const BuiltinMaterial& material : builtin_materials())
      nested([&] {
        out_.key("const");
        out_.value(std::string_view(material.description.name));
        out_.key("description");
        out_.value(std::string_view(sentence(material.text)));
      });
    out_.end_array();
  }
  void schema(const Field&, bool) { type("boolean"); }
  void schema(const Field&, const std::string&) { type("string"); }
  void schema(const Field& field, double) {
    type("number");
    bounds(field.range);
  }
  template <std::integral Integer>
  void schema(const Field& field, Integer) {
    type("integer");
    bounds(field.range);
  }
  template <class E>
  requires std::is_enum_v<E>
  void schema(const Field&, E) {
    out_.key("oneOf");
    out_.begin_array(JsonWriter::Layout::lines);
    for (const auto& entry : EnumTable<E>::entries)
      nested([&] {
        out_.key("const");
        out_.value(entry.name);
        out_.key("description");
        out_.value(std::string_view(sentence(entry.text)));
      });
    out_.end_array();
  }
  void schema(const Field&, const Antialiasing&) {
    static_assert(kMaxGridSize == 64, "the pattern spells it out");
    type("string");
    out_.key("pattern");
    out_.value("^(none|whitted|grid:([1-9]|[1-5][0-9]|6[0-4]))$");
  }
  void schema(const Field& field, const Vec2d&) { numbers(field.range, 2); }
  void schema(const Field& field, const Vec3d&) {
    numbers(field.range, 3);
    refuse_zero(field);
  }
  void number_or(const Range& range, int count, bool refuse_zeros) {
    out_.key("oneOf");
    out_.begin_array(JsonWriter::Layout::lines);
    color_choices(range, count, refuse_zeros);
    out_.end_array();
  }
  void color_choices(const Range& range, int count, bool refuse_zeros) {
    const auto not_zero = [&] {
      if (!refuse_zeros) return;
      out_.key("not");
      nested([&] {
        out_.key("const");
        out_.value(0);
      });
    };
    nested([&] {
      type("number");
      bounds(range);
      not_zero();
    });
    nested([&] {
      list(
          [&] {
            type("number");
            bounds(range);
            not_zero();
          },
          count, count);
    });
  }
  void schema(const Field& field, const Rgb&) { number_or(field.range, 3, false); }
  void schema(const Field& field, const ScaleFactors&) { number_or(field.range, 3, true); }
  void schema(const Field& field, const ColorPattern&) {
    out_.key("oneOf");
    out_.begin_array(JsonWriter::Layout::lines);
    color_choices(field.range, 3, false);
    out_.begin_object(JsonWriter::Layout::in_line);
    out_.key("$ref");
    out_.value("#/$defs/pattern");
    out_.end_object();
    out_.end_array();
  }
  void schema(const Field&, const Background& background) {
    alternatives(background, [](SchemaWriter&) {});
  }
  void schema(const Field&, const Matrix44d&) {
    out_.key("oneOf");
    out_.begin_array(JsonWriter::Layout::lines);
    const auto step = [&] {
      out_.key("$ref");
      out_.value("#/$defs/transform_step");
    };
    nested(step);
    nested([&] { list(step); });
    out_.end_array();
  }
  void schema(const Field& field, const std::optional<Matrix44d>&) { numbers(field.range, 16); }
  template <class T>
  void schema(const Field& field, const std::optional<T>&) {
    schema(field, T{});
  }
  void schema(const Field& field, const std::vector<Vec3d>&) { vertices(field, 3, 1); }
  void schema(const Field& field, const std::vector<Vec3f>&) { vertices(field, 3, 0); }
  void schema(const Field& field, const std::vector<Vec2f>&) { vertices(field, 2, 0); }
  void vertices(const Field& field, int count, int least) {
    list([&] { numbers(field.range, count); }, least);
  }
  void schema(const Field& field, const FaceLists&) {
    list(
        [&] {
          list(
              [&] {
                type("integer");
                bounds(kIndexRange);
              },
              3);
        },
        field.key == "faces" ? 1 : 0);
  }
  void schema(const Field& field, const std::vector<double>&) {
    list([&] {
      type("number");
      bounds(field.range);
    });
  }
  template <std::size_t Count>
  void schema(const Field&, const IndexLists<Count>&) {
    list([&] {
      list(
          [&] {
            type("integer");
            bounds(kIndexRange);
          },
          Count, Count);
    });
  }
  void schema(const Field&, const std::vector<FaceGroup>&) {
    list([&] { object(FaceGroup{}); });
  }
  void schema(const Field&, const std::vector<AngleWeight>&) {
    list([&] { object(AngleWeight{}); });
  }
  void schema(const Field&, const std::vector<Crease>&) {
    list([&] { object(Crease{}); });
  }
  void schema(const Field&, const std::vector<SharpCorner>&) {
    list([&] { object(SharpCorner{}); });
  }
  void schema(const Field& field, const std::vector<std::uint32_t>&) {
    list([&] { schema(field, std::uint32_t{}); });
  }
  template <Named T>
  void schema(const Field&, const std::vector<T>&) {
    type("object");
    out_.key("propertyNames");
    nested([&] {
      out_.key("minLength");
      out_.value(1);
    });
    out_.key("additionalProperties");
    if constexpr (std::same_as<T, ShapeDescription>) {
      // Shapes stand in the scene and in groups.
      nested([&] {
        out_.key("$ref");
        out_.value("#/$defs/shape");
      });
    } else {
      out_.begin_object();
      object(T{});
      out_.end_object();
    }
  }
  template <Table T>
  void schema(const Field&, const T& defaults) {
    object(defaults);
  }

  JsonWriter& out_;
  std::set<std::string> required_;
};

// --- reference ----------------------------------------------------------------------------------------------

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

std::string scene_schema() {
  JsonWriter out;
  SchemaWriter schema(out);
  out.begin_object();
  out.key("$schema");
  out.value("https://json-schema.org/draft/2020-12/schema");
  out.key("title");
  out.value("Raytree scene file");
  schema.object(SceneDescription{});
  out.key("$defs");
  out.begin_object();
  out.key("pattern");
  out.begin_object();
  schema.alternatives(VaryingPattern(), [](SchemaWriter&) {});
  out.end_object();
  out.key("shape");
  out.begin_object();
  schema.object(ShapeDescription{});
  out.end_object();
  out.key("transform_step");
  out.begin_object();
  schema.object(TransformStep{});
  out.key("if");
  out.begin_object(JsonWriter::Layout::in_line);
  out.key("required");
  out.begin_array();
  out.value("matrix");
  out.end_array();
  out.end_object();
  out.key("then");
  out.begin_object(JsonWriter::Layout::in_line);
  out.key("maxProperties");
  out.value(1);
  out.end_object();
  out.end_object();
  out.end_object();
  out.end_object();
  return out.text();
}

std::string scene_reference() {
  ReferenceWriter out;
  out.table("Top level", "The whole file is one object.", SceneDescription{});
  out.table("image", "The size of the picture.", ImageDescription{});
  out.table("render", "How the picture is traced.", RenderSettings{});
  out.table("render.adaptive", "The anti-aliasing of Whitted 1980, sec. 3: `\"antialias\": \"whitted\"`.",
            AdaptiveSampling{});
  out.table("render.tessellation", "What curved surfaces become: triangles, no more than the view needs.",
            TessellationSettings{});
  out.alternatives("background", Background{});
  out.table("cameras.NAME", "One camera.", CameraDescription{});
  out.table("lights.NAME", "One light; these keys and those of its type.", LightDescription{});
  out.alternatives("lights.NAME", LightDescription{}.kind);
  out.table("materials.NAME", "One material: I = ambient + diffuse + highlights + k_s S + k_t T (Whitted 1980, eq. 2).",
            MaterialDescription{});
  out.table("materials.NAME.bump", "A height over the surface; it lies still in the world.", BumpDescription{});
  out.table("materials.NAME.highlight", "W cos^n (Phong 1973, eq. 4.5).", HighlightDescription{});
  out.table("materials.NAME.highlight.weight_by_angle[]", "A point of W(i).", AngleWeight{});
  out.builtin_materials_table();
  out.alternatives("Where a color or pattern stands", VaryingPattern());
  out.table("groups.NAME", "One group of shapes, in a space of its own.", GroupDescription{});
  out.table("shapes.NAME", "One shape; these keys and those of its type.", ShapeDescription{});
  out.alternatives("shapes.NAME", ShapeKind{});
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
