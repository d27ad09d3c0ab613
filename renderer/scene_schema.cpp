// Prints the tables of scene_fields.h as JSON Schema.
#include <set>

#include "renderer/scene_reader.h"
#include "renderer/scene_values.h"

namespace raytree {
namespace {

constexpr Range kIndexRange{0, 4294967295.0};

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

}  // namespace raytree
