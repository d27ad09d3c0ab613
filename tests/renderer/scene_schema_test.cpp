// The schema and the reader are printed and driven by the same tables; here they are held against each other all the
// same, by a validator of the schema's own vocabulary and many documents, right and wrong.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <sstream>

#include "app/sanitized.h"
#include "renderer/builtin_scenes.h"
#include "renderer/scene_reader.h"

namespace raytree {
namespace {

using Json = nlohmann::json;

const Json& schema() {
  static const Json parsed = Json::parse(scene_schema());
  return parsed;
}

bool matches(const std::string& text, const std::string& pattern) {
  static std::map<std::string, std::regex> compiled;  // making one takes longer than the rest of a validation
  return std::regex_search(text, compiled.try_emplace(pattern, pattern).first->second);
}

/// JSON Schema draft 2020-12, as much of it as ours uses; an unknown keyword fails the test.
bool is_valid(const Json& rule, const Json& value) {
  if (rule.is_boolean()) return rule.get<bool>();
  if (rule.contains("if") && is_valid(rule["if"], value) && !is_valid(rule["then"], value)) return false;
  for (const auto& [keyword, argument] : rule.items()) {
    if (keyword == "$ref") {
      const std::string pointer = argument.get<std::string>().substr(1);
      if (!is_valid(schema().at(Json::json_pointer(pointer)), value)) return false;
    } else if (keyword == "type") {
      const std::string type = argument;
      const bool fits = type == "object"    ? value.is_object()
                        : type == "array"   ? value.is_array()
                        : type == "string"  ? value.is_string()
                        : type == "boolean" ? value.is_boolean()
                        : type == "number"  ? value.is_number()
                                            : value.is_number() && value == std::floor(value.get<double>());
      if (!fits) return false;
    } else if (keyword == "const") {
      if (value != argument) return false;
    } else if (keyword == "not") {
      if (is_valid(argument, value)) return false;
    } else if (keyword == "oneOf") {
      int fitting = 0;
      for (const Json& choice : argument) fitting += is_valid(choice, value) ? 1 : 0;
      if (fitting != 1) return false;
    } else if (keyword == "minimum") {
      if (value.is_number() && value.get<double>() < argument.get<double>()) return false;
    } else if (keyword == "maximum") {
      if (value.is_number() && value.get<double>() > argument.get<double>()) return false;
    } else if (keyword == "exclusiveMinimum") {
      if (value.is_number() && value.get<double>() <= argument.get<double>()) return false;
    } else if (keyword == "exclusiveMaximum") {
      if (value.is_number() && value.get<double>() >= argument.get<double>()) return false;
    } else if (keyword == "items") {
      if (value.is_array())
        for (const Json& element : value)
          if (!is_valid(argument, element)) return false;
    } else if (keyword == "minItems") {
      if (value.is_array() && value.size() < argument.get<std::size_t>()) return false;
    } else if (keyword == "maxItems") {
      if (value.is_array() && value.size() > argument.get<std::size_t>()) return false;
    } else if (keyword == "minLength") {
      if (value.is_string() && value.get<std::string>().size() < argument.get<std::size_t>()) return false;
    } else if (keyword == "maxProperties") {
      if (value.is_object() && value.size() > argument.get<std::size_t>()) return false;
    } else if (keyword == "pattern") {
      if (value.is_string() && !matches(value.get_ref<const std::string&>(), argument.get<std::string>())) return false;
    } else if (keyword == "required") {
      if (value.is_object())
        for (const Json& key : argument)
          if (!value.contains(key.get<std::string>())) return false;
    } else if (keyword == "propertyNames") {
      if (value.is_object())
        for (const auto& [key, unused] : value.items())
          if (!is_valid(argument, key)) return false;
    } else if (keyword == "properties") {
      if (value.is_object())
        for (const auto& [key, member] : value.items())
          if (argument.contains(key) && !is_valid(argument[key], member)) return false;
    } else if (keyword == "additionalProperties") {
      if (value.is_object())
        for (const auto& [key, member] : value.items())
          if (!(rule.contains("properties") && rule["properties"].contains(key)) && !is_valid(argument, member))
            return false;
    } else {
      static const std::set<std::string> kSaysNothing{"$schema", "$defs", "title", "description",
                                                      "default", "if",    "then"};
      EXPECT_TRUE(kSaysNothing.contains(keyword)) << keyword;
    }
  }
  return true;
}

std::string reader_refusal(const Json& document) {
  try {
    read_scene(document.dump(), "s.json", "");
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

/// A scene that uses every table: each object of the format stands in it at least once.
Json rich_document() {
  return Json::parse(R"({
    "raytree": 1, "title": "t", "image": {"width": 10, "height": 10},
    "render": {"depth": 3, "cutoff": 0, "antialias": "grid:2",
               "adaptive": {"threshold": 0.1, "levels": 3, "minimum_level": 1}, "highlights": "halfway", "shadows": true, "transparent_shadows": true,
               "shadowed_highlights": true, "fresnel": false, "distance_attenuation": 0, "rough_samples": 4,
               "tessellation": {"tolerance": 0.5, "rate": 4}},
    "background": {"type": "gradient", "bottom": 0, "horizon": [0, 0, 1], "top": 1}, "ambient": 0.1,
    "cameras": {"main": {"projection": "orthographic", "position": [0, 0, 5], "target": [0, 0, 0], "up": [0, 1, 0],
                         "field_of_view": 40, "height": 2}},
    "lights": {"a": {"type": "directional", "direction": [0, -1, 0], "color": 1},
               "b": {"type": "point", "position": [0, 1, 0], "color": [1, 1, 1]}},
    "materials": {"m": {"diffuse": {"type": "checker", "even": 1, "odd": 0, "size": 1, "plane": "uv", "space": "world",
                                    "offset": [0, 0], "filtered": false},
                        "ambient": {"type": "stripes", "even": 1, "odd": 0, "size": 1, "direction": [1, 0, 0],
                                    "smooth": true, "space": "uv", "offset": [0, 0, 0], "filtered": true},
                        "highlight": {"weight": 1, "exponent": 2}, "reflection": 0, "transmission": 0,
                        "index_of_refraction": 1.5, "conductor": false, "absorption": [0, 1, 2], "thin": false,
                        "one_sided": true, "priority": 1, "roughness": 0.1},
                  "n": {"diffuse": {"type": "noise", "low": 1, "high": 0, "size": 1, "octaves": 2, "gain": 0.5, "contrast": 1,
                                    "seed": 7, "space": "world", "offset": [0, 0, 0], "filtered": true},
                        "bump": {"kind": "ripples", "amplitude": -0.1, "size": 1, "octaves": 2, "gain": 0.5, "seed": 1,
                                 "offset": [0, 0, 0], "direction": [0, 1, 0], "space": "object"}},
                  "p": {"from": "phong-red", "highlight": {"weight_by_angle": [{"angle": 0, "weight": 0.5},
                                                                              {"angle": 90, "weight": [1, 1, 0]}]}}},
    "shapes": {
      "a": {"type": "mesh", "file": "a.ply", "normals": "flat", "crease_angle": 30, "material": "m"},
      "b": {"type": "mesh", "origin": [0, 0, 0], "positions": [[0, 0, 0], [1, 0, 0], [0, 1, 0]], "faces": [[0, 1, 2]],
            "vertex_normals": [[0, 0, 1]], "normal_faces": [[0, 0, 0]], "texture_coordinates": [[0, 0]],
            "texture_faces": [[0, 0, 0]], "groups": [{"name": "g", "material": "x", "first_face": 0, "face_count": 1}]},
      "c": {"type": "sphere", "center": [0, 0, 0], "radius": 1, "transform": {"translate": [0, 1, 0], "rotate": [0, 10, 0], "scale": 2}},
      "d": {"type": "plane", "point": [0, 0, 0], "normal": [0, 1, 0], "transform": [{"scale": [1, 2, 3]}]},
      "e": {"type": "disc", "center": [0, 0, 0], "normal": [0, 1, 0], "radius": 1,
            "transform": {"matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]}},
      "f": {"type": "terrain", "triangles": 100, "size": 1, "height": 1, "roughness": 0.5, "seed": 1},
      "g": {"type": "sphere_flake", "levels": 1, "center": [0, 0, 0], "radius": 1},
      "h": {"type": "instance", "group": "tree", "material": "m"},
      "i": {"type": "scatter", "group": "trees", "terrain": "f", "count": 10, "least_scale": 1, "largest_scale": 2, "lowest": 0,
            "highest": 1, "steepest": 30, "sink": 0.1, "clearings": 0.2, "clearing_size": 1, "seed": 4}},
    "groups": {
      "trees": {"shapes": {"x": {"type": "instance", "group": "tree", "transform": {"scale": 2}}}},
      "tree": {"shapes": {
        "w": {"type": "tree", "species": "conifer", "part": "wood", "height": 3, "leaves": 10, "leaf_size": 0.1, "seed": 2, "material": "m"},
        "l": {"type": "tree", "species": "broadleaf", "part": "leaves"}}}}})");
}

/// Where messages of the reader speak of what a schema cannot say.
bool beyond_a_schema(const std::string& message) {
  for (const char* text : {"unknown material",
                           "too many",
                           "same point",
                           "line of sight",
                           "not invertible",
                           "index ",
                           "not in the shape",
                           " positions; give",
                           "not affine",
                           "overlap the group",
                           "conductor transmits",
                           "thin sheet has no inside",
                           "seen from both sides",
                           "weight_by_angle: angle",
                           "unknown group",
                           "unknown terrain",
                           "may not hold itself",
                           "a plane has no bounds",
                           "is larger than largest_scale",
                           "lies above highest"})
    if (message.find(text) != message.npos) return true;
  return false;
}

/// Calls visit(pointer) for every value within.
void for_each_place(const Json& value, const Json::json_pointer& place,
                    const std::function<void(const Json::json_pointer&)>& visit) {
  visit(place);
  if (value.is_object())
    for (const auto& [key, member] : value.items()) for_each_place(member, place / key, visit);
  if (value.is_array())
    for (std::size_t i = 0; i < value.size(); ++i) for_each_place(value[i], place / i, visit);
}

int compared = 0;
void expect_agreement(const Json& document) {
  const std::string refusal = reader_refusal(document);
  const bool valid = is_valid(schema(), document);
  ++compared;
  if (refusal.empty()) {
    EXPECT_TRUE(valid) << "the reader accepts, the schema does not: " << document.dump();
  } else if (!beyond_a_schema(refusal)) {
    EXPECT_FALSE(valid) << "the schema accepts, the reader does not: " << refusal << "\n" << document.dump();
  }
}

TEST(SceneSchema, AcceptsWhatIsRight) {
  EXPECT_EQ(schema()["$schema"], "https://json-schema.org/draft/2020-12/schema");
  EXPECT_EQ(reader_refusal(rich_document()), "");
  EXPECT_TRUE(is_valid(schema(), rich_document()));
  EXPECT_TRUE(is_valid(schema(), Json::parse(R"({"raytree": 1})")));
  for (const EmbeddedScene& scene : embedded_scenes()) {
    EXPECT_TRUE(is_valid(schema(), Json::parse(scene.json))) << scene.name;
    EXPECT_TRUE(is_valid(schema(), Json::parse(write_scene(builtin_scene(scene.name))))) << scene.name;
  }
}

TEST(SceneSchema, AgreesWithTheReaderAboutChangedDocuments) {
  const Json right = rich_document();
  const std::vector<Json> values{nullptr,
                                 true,
                                 0,
                                 -1,
                                 1,
                                 2.5,
                                 7,
                                 8,
                                 65,
                                 180,
                                 181,
                                 1e18,
                                 -1e19,
                                 1e300,
                                 50000001,
                                 "",
                                 "none",
                                 "m",
                                 "grid:64",
                                 "grid:65",
                                 "whitted",
                                 "xz",
                                 "point",
                                 "constant",
                                 Json::array(),
                                 Json::array({0, 0, 0}),
                                 Json::array({1, 1, 1}),
                                 Json::array({-1, 2, 3}),
                                 Json::array({0, 1}),
                                 Json::object(),
                                 Json::parse(R"({"type": "checker"})"),
                                 Json::parse(R"({"type": "noise"})"),
                                 Json::parse(R"({"type": "constant"})")};
  compared = 0;
  // Sanitizers take twenty times as long: they get a quarter of the documents, another one at each place.
  constexpr int kEveryNth = kAddressSanitized ? 4 : 1;
  int turn = 0;
  for_each_place(right, Json::json_pointer(), [&](const Json::json_pointer& place) {
    // Every value replaced by every other kind of value.
    for (const Json& value : values) {
      if (++turn % kEveryNth != 0) continue;
      Json document = right;
      document[place] = value;
      expect_agreement(document);
    }
    if (place.empty()) return;
    // Every key and element removed.
    Json without = right;
    Json& parent = without[place.parent_pointer()];
    if (parent.is_object())
      parent.erase(place.back());
    else
      parent.erase(static_cast<std::size_t>(std::stoul(place.back())));
    expect_agreement(without);
  });
  EXPECT_GT(compared, 3000);
  std::fprintf(stderr, "schema and reader compared on %d documents\n", compared);
}

TEST(SceneSchema, AnInventedKeyIsRefusedAtEveryLevelByBoth) {
  const Json right = rich_document();
  int objects = 0;
  for_each_place(right, Json::json_pointer(), [&](const Json::json_pointer& place) {
    if (!right.at(place).is_object()) return;
    ++objects;
    Json document = right;
    document[place]["invented"] = 1;
    EXPECT_FALSE(is_valid(schema(), document)) << place.to_string();
    EXPECT_NE(reader_refusal(document), "") << place.to_string();
  });
  EXPECT_GT(objects, 20);
}

/// Calls visit(path, property) for every property that the schema lists, alternatives included.
void for_each_property(const Json& rule, const std::string& path,
                       const std::function<void(const std::string&, const Json&)>& visit) {
  if (rule.contains("properties"))
    for (const auto& [key, property] : rule["properties"].items()) {
      if (property.is_boolean() || !property.contains("description")) continue;
      visit(path + "." + key, property);
      for_each_property(property, path + "." + key, visit);
    }
  for (const char* inside : {"items", "additionalProperties"})
    if (rule.contains(inside) && rule[inside].is_object()) for_each_property(rule[inside], path + ".*", visit);
  if (rule.contains("oneOf"))
    for (const Json& choice : rule["oneOf"])
      for_each_property(choice, path + (choice.contains("title") ? "<" + choice["title"].get<std::string>() + ">" : ""),
                        visit);
}

// Each property's default is what the reader fills in: written out or left out, the scene is the same.
TEST(SceneSchema, DefaultsAreThoseOfTheReader) {
  int defaults = 0;
  using DocumentOf = std::function<Json(const Json&)>;
  const std::function<void(const Json&, const DocumentOf&)> check = [&](const Json& properties,
                                                                        const DocumentOf& document_of) {
    for (const auto& [name, property] : properties.items()) {
      const std::string key = name;  // a lambda takes no structured binding
      if (!property.is_object()) continue;
      if (property.contains("properties"))
        check(property.at("properties"), [&](const Json& given) { return document_of({{key, given}}); });
      if (!property.contains("default")) continue;
      SCOPED_TRACE(document_of({{key, property.at("default")}}).dump());
      ++defaults;
      EXPECT_TRUE(is_valid(property, property.at("default"))) << key;
      EXPECT_EQ(write_scene(read_scene(document_of({{key, property.at("default")}}).dump(), "a", "")),
                write_scene(read_scene(document_of(Json::object()).dump(), "b", "")))
          << key;
    }
  };
  // The scene with all that some shapes need beside them.
  const auto scene_with = [](const std::string& key, const Json& value) {
    Json document{{"raytree", 1},
                  {"groups", {{"g", {{"shapes", {{"s", {{"type", "sphere"}}}}}}}}},
                  {"shapes", {{"t", {{"type", "terrain"}}}}}};
    if (value.is_object())
      document[key].update(value);
    else
      document[key] = value;
    return document;
  };
  const Json& top = schema().at("properties");
  for (const auto& [name, property] : top.items()) {
    const std::string key = name;
    if (property.contains("default"))
      check({{key, property}}, [&](const Json& given) {
        return given.contains(key) ? scene_with(key, given.at(key)) : scene_with("raytree", 1);
      });
    else if (property.contains("properties"))
      check(property.at("properties"), [&](const Json& given) { return scene_with(key, given); });
  }
  for (const char* key : {"cameras", "materials"})
    check(top.at(key).at("additionalProperties").at("properties"), [&](const Json& given) {
      return scene_with(key, {{"x", given}});
    });
  const auto check_alternatives = [&](const Json& rule, const DocumentOf& document_of) {
    for (const Json& choice : rule.at("oneOf")) {
      if (!choice.contains("title")) continue;
      const std::string type = choice.at("title");
      check(choice.at("properties"), [&](Json given) {
        given["type"] = type;
        if (type == "mesh") given["file"] = "a.ply";
        if (type == "patches") given["file"] = "a.bpt";
        if (type == "instance" || type == "scatter") given["group"] = "g";
        if (type == "scatter") given["terrain"] = "t";
        return document_of(given);
      });
    }
  };
  check_alternatives(top.at("background"), [&](const Json& given) { return scene_with("background", given); });
  check_alternatives(top.at("lights").at("additionalProperties"), [&](const Json& given) {
    return scene_with("lights", {{"x", given}});
  });
  check_alternatives(schema().at("$defs").at("shape"), [&](const Json& given) {
    return scene_with("shapes", {{"x", given}});
  });
  check_alternatives(schema().at("$defs").at("pattern"), [&](const Json& given) {
    return scene_with("materials", {{"x", {{"diffuse", given}}}});
  });
  EXPECT_GT(defaults, 120);
}

// docs/scene-format.md ends with the tables as the program prints them. RAYTREE_UPDATE_DOCS=1 writes them there.
TEST(SceneReference, StandsInTheDocumentation) {
  const std::string path = std::string(RAYTREE_SOURCE_DIR) + "/docs/scene-format.md";
  const std::string marker =
      "<!-- From here on printed by scene_reference(); RAYTREE_UPDATE_DOCS=1 renderer_tests writes it. -->\n";
  std::stringstream text;
  text << std::ifstream(path).rdbuf();
  std::string document = text.str();
  const auto begin = document.find(marker);
  ASSERT_NE(begin, document.npos) << path;
  if (const char* update = std::getenv("RAYTREE_UPDATE_DOCS"); update != nullptr && *update == '1') {
    document = document.substr(0, begin) + marker + scene_reference();
    std::ofstream(path) << document;
  }
  EXPECT_EQ(document.substr(begin + marker.size()), scene_reference());
  // Every key of the schema is named.
  int keys = 0;
  const auto named = [&](const std::string& place, const Json&) {
    ++keys;
    const std::string key = place.substr(place.rfind('.') + 1);
    EXPECT_NE(document.find("| `" + key + "` |"), document.npos) << place;
  };
  for_each_property(schema(), "", named);
  for_each_property(schema()["$defs"]["pattern"], "", named);
  for_each_property(schema()["$defs"]["transform_step"], "", named);
  for_each_property(schema()["$defs"]["shape"], "", named);
  EXPECT_GT(keys, 70);
}

// Each JSON example of the documentation is a scene, or the beginning of one.
TEST(SceneReference, ExamplesRead) {
  std::stringstream text;
  text << std::ifstream(std::string(RAYTREE_SOURCE_DIR) + "/docs/scene-format.md").rdbuf();
  const std::string document = text.str();
  int examples = 0;
  const std::string fence = "```json\n";
  for (auto begin = document.find(fence); begin != document.npos; begin = document.find(fence, begin + 1)) {
    const auto start = begin + fence.size();
    const std::string example = document.substr(start, document.find("```", start) - start);
    EXPECT_NO_THROW(read_scene(example, "example", "")) << example;
    ++examples;
  }
  EXPECT_GE(examples, 3);
}

}  // namespace
}  // namespace raytree
