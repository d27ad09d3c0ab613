#include "renderer/builtin_materials.h"

#include <algorithm>
#include <array>
#include <utility>

namespace raytree {
namespace {

/// Rec.709's luminance.
constexpr float luminance(Rgb c) { return 0.2126f * c.r + 0.7152f * c.g + 0.0722f * c.b; }

/// Phong gives one number a color, C_p, after Luckiesh: how much of white light the material reflects in all. Hues are
/// ours; scaled so that their luminance is that number.
MaterialDescription painted(const char* name, Rgb hue, float reflectance, float weight, double exponent) {
  MaterialDescription material;
  material.name = name;
  material.diffuse = hue * (reflectance / luminance(hue));
  material.highlight.weight = Rgb(weight);
  material.highlight.exponent = exponent;
  return material;
}

MaterialDescription diffuse(const char* name, Rgb hue, float reflectance) {
  // Appendix II: "for a diffuse material, W(i) was about .2 and the power n was equal to 2".
  return painted(name, hue, reflectance, 0.2f, 2);
}

MaterialDescription polished_metal() {
  MaterialDescription material = painted("phong-polished-metal", Rgb(1), 0.15f, 0, 6);
  material.highlight.weight_by_angle = {{0, Rgb(0.6f)}, {90, Rgb(0.8f)}};
  return material;
}

std::array<BuiltinMaterial, 12> make_materials() {
  return {{
      {diffuse("phong-white", {1, 1, 1}, 0.80f), "white diffusing: C_p .80; W .2, n 2"},
      {diffuse("phong-red-purple", {1, 0.1f, 0.45f}, 0.16f), "red-purple: C_p .16; W .2, n 2"},
      {diffuse("phong-red", {1, 0.06f, 0.05f}, 0.20f), "red: C_p .20; W .2, n 2"},
      {diffuse("phong-orange", {1, 0.32f, 0.03f}, 0.38f), "orange: C_p .38; W .2, n 2"},
      {diffuse("phong-yellow", {1, 0.75f, 0.06f}, 0.60f), "yellow: C_p .60; W .2, n 2"},
      {diffuse("phong-yellow-green", {0.55f, 1, 0.08f}, 0.46f), "yellow-green: C_p .46; W .2, n 2"},
      {diffuse("phong-green", {0.08f, 1, 0.12f}, 0.32f), "saturated green: C_p .32; W .2, n 2"},
      {diffuse("phong-blue", {0.1f, 0.3f, 1}, 0.23f), "blue: C_p .23; W .2, n 2"},
      {diffuse("phong-violet", {0.45f, 0.12f, 1}, 0.14f), "violet: C_p .14; W .2, n 2"},
      {painted("phong-white-paint", Rgb(1), 0.80f, 0.1f, 2), "flat white paint: W .1, n 2; C_p .80 as white diffusing"},
      {painted("phong-aluminum-paint", Rgb(1), 0.3f, 0.6f, 4), "aluminum paint: W .6, n 4; C_p .30 is ours"},
      {polished_metal(), "polished metal: W from .6 at 0 to .8 at 90 degrees, n 6 (of 5 to 6); C_p .15 is ours"},
  }};
}

const std::array<BuiltinMaterial, 12>& materials() {
  static const std::array<BuiltinMaterial, 12> all = make_materials();
  return all;
}

}  // namespace

std::span<const BuiltinMaterial> builtin_materials() { return materials(); }

const MaterialDescription* builtin_material(std::string_view name) {
  const auto found = std::find_if(materials().begin(), materials().end(),
                                  [&](const BuiltinMaterial& m) { return m.description.name == name; });
  return found == materials().end() ? nullptr : &found->description;
}

std::vector<std::string> builtin_material_names() {
  std::vector<std::string> names;
  for (const BuiltinMaterial& material : materials()) names.push_back(material.description.name);
  return names;
}

void take_values(const MaterialDescription& from, MaterialDescription& to) {
  std::string name = std::move(to.name);
  to = from;
  to.name = std::move(name);
}

}  // namespace raytree
