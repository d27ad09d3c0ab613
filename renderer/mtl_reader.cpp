#include "renderer/mtl_reader.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>

#include "geometry/mapped_file.h"
#include "geometry/text_scanning.h"
#include "renderer/suggestion.h"

namespace raytree {
namespace {

using text::is_blank;
using text::is_space;
using text::scan_double;
using text::skip_blanks;

/// A material as the library states it; what it does not state is empty.
struct MtlMaterial {
  std::string name;
  std::optional<Rgb> ambient, diffuse, specular, filter;          // Ka, Kd, Ks, Tf
  std::optional<double> exponent, index, dissolve, transparency;  // Ns, Ni, d, Tr
  std::optional<int> illumination;                                // illum
};

/// What is valid but odd, in the order of its warnings: dropped, or a number taken as the nearest that means something.
enum class Odd {
  texture,
  emission,
  physically_based,
  spectrum,
  matte,
  unknown,
  negative_color,
  low_exponent,
  no_index,
  share
};

class MtlParser {
 public:
  MtlParser(std::string_view text, const std::string& name, Warnings& warnings)
      : text_(text), name_(name), warnings_(warnings) {}

  std::vector<MtlMaterial> parse() {
    if (text_.substr(0, 3) == "\xef\xbb\xbf") text_.remove_prefix(3);
    if (text_.find('\n') == std::string_view::npos && text_.find('\r') != std::string_view::npos) newline_ = '\r';
    const char* p = text_.data();
    const char* const end = p + text_.size();
    while (p != end) {
      const char* const line_end = std::find(p, end, newline_);
      ++line_;
      read_statement(p, line_end);
      p = line_end == end ? end : line_end + 1;
    }
    report_odd();
    return std::move(materials_);
  }

 private:
  [[noreturn]] void fail(const std::string& message) const {
    throw Error(ErrorKind::bad_input,
                {name_, line_, materials_.empty() ? std::string() : "material " + in_quotes(materials_.back().name)},
                message);
  }

  static std::string_view next_word(const char*& p, const char* end) {
    p = skip_blanks(p, end);
    const char* const begin = p;
    while (p != end && !is_blank(*p)) ++p;
    return {begin, static_cast<std::size_t>(p - begin)};
  }

  std::optional<double> number(const char*& p, const char* end) const {
    const char* const start = skip_blanks(p, end);
    double value = 0;
    const char* const after = start == end ? nullptr : scan_double(start, end, value);
    if (!after || (after != end && !is_blank(*after)) || !std::isfinite(value)) return std::nullopt;
    p = after;
    return value;
  }

  double required_number(const char* p, const char* end, std::string_view statement) const {
    if (const auto value = number(p, end)) return *value;
    fail(std::string(statement) + " needs a number, not " + in_quotes(std::string(next_word(p, end))));
  }

  /// A number from 0 to 1, which one beyond is taken for.
  double share(const char* p, const char* end, std::string_view statement) {
    const double stated = required_number(p, end, statement), taken = std::clamp(stated, 0.0, 1.0);
    if (taken != stated) note(Odd::share);
    return taken;
  }

  /// r g b, or one number for all three; CIE XYZ becomes Rec.709. None where a spectrum's file is named.
  std::optional<Rgb> color(const char* p, const char* end, std::string_view statement) {
    const char* after_word = p;
    const std::string_view word = next_word(after_word, end);
    if (word == "spectral") {
      note(Odd::spectrum);
      return std::nullopt;
    }
    const bool is_xyz = word == "xyz";
    if (is_xyz) p = after_word;
    std::array<double, 3> v{};
    int count = 0;
    for (; count < 3; ++count) {
      if (skip_blanks(p, end) == end && count > 0) break;
      const auto value = number(p, end);
      if (!value)
        fail(std::string(statement) + " needs one number or three, not " + in_quotes(std::string(next_word(p, end))));
      v[static_cast<std::size_t>(count)] = *value;
    }
    if (count == 2) fail(std::string(statement) + " needs one number or three, not two");
    if (count == 1) v[1] = v[2] = v[0];
    // CIE 1931 XYZ to linear Rec.709 with white D65: the inverse of the matrix of IEC 61966-2-1.
    if (is_xyz)
      v = {3.2404542 * v[0] - 1.5371385 * v[1] - 0.4985314 * v[2],
           -0.9692660 * v[0] + 1.8760108 * v[1] + 0.0415560 * v[2],
           0.0556434 * v[0] - 0.2040259 * v[1] + 1.0572252 * v[2]};
    // Colors of XYZ outside Rec.709 have negative components, which no picture shows; stated ones are worth a word.
    if (!is_xyz && std::min({v[0], v[1], v[2]}) < 0) note(Odd::negative_color);
    const auto component = [](double x) { return static_cast<float>(std::clamp(x, 0.0, 1e18)); };
    return Rgb(component(v[0]), component(v[1]), component(v[2]));
  }

  void read_statement(const char* p, const char* end) {
    // A comment begins a line; within one, # may be part of a name.
    while (end != p && is_space(end[-1])) --end;
    const std::string_view word = next_word(p, end);
    if (word.empty() || word[0] == '#') return;
    if (word == "newmtl") {
      p = skip_blanks(p, end);
      constexpr std::ptrdiff_t kMaxName = 255;         // as the OBJ reader cuts the names that refer to these
      constexpr std::size_t kMostMaterials = 1 << 16;  // each takes many times the memory of its few letters
      if (materials_.size() == kMostMaterials) fail("more than 65536 materials in one library");
      materials_.push_back({});
      materials_.back().name.assign(p, std::min(end - p, kMaxName) + p);
      return;
    }
    if (materials_.empty()) fail(in_quotes(word.substr(0, 40)) + " stands before the first newmtl");
    MtlMaterial& material = materials_.back();
    if (word == "Ka") {
      material.ambient = color(p, end, word);
    } else if (word == "Kd") {
      material.diffuse = color(p, end, word);
    } else if (word == "Ks") {
      material.specular = color(p, end, word);
    } else if (word == "Tf" || word == "Kt") {
      material.filter = color(p, end, word);
    } else if (word == "Ns") {
      material.exponent = required_number(p, end, word);
      if (*material.exponent < 1) note(Odd::low_exponent);
    } else if (word == "Ni") {
      material.index = required_number(p, end, word);
      if (*material.index <= 0) note(Odd::no_index);
    } else if (word == "d") {
      const char* halo = p;
      if (next_word(halo, end) == "-halo") p = halo;  // less opaque toward the silhouette: taken as everywhere
      material.dissolve = share(p, end, word);
    } else if (word == "Tr") {
      material.transparency = share(p, end, word);
    } else if (word == "illum") {
      const double model = required_number(p, end, word);
      if (model != std::floor(model) || model < 0 || model > 10) {
        const char* after = p;
        fail("illum is a whole number from 0 to 10, not " + in_quotes(std::string(next_word(after, end))));
      }
      if (model == 10) note(Odd::matte);
      material.illumination = static_cast<int>(model);
    } else if (word == "Ke") {
      if (const auto emission = color(p, end, word); emission && !is_black(*emission)) note(Odd::emission);
    } else if (is_texture(word)) {
      note(Odd::texture);
    } else if (word != "sharpness") {  // of reflection maps, which are dropped
      note(is_physically_based(word) ? Odd::physically_based : Odd::unknown);
    }
  }

  static bool is_texture(std::string_view word) {
    for (const std::string_view name : {"bump", "disp", "decal", "refl", "norm"})
      if (word == name) return true;
    return word.substr(0, 4) == "map_";
  }
  static bool is_physically_based(std::string_view word) {
    for (const std::string_view name : {"Pr", "Pm", "Ps", "Pc", "Pcr", "aniso", "anisor"})
      if (word == name) return true;
    return false;
  }

  void note(Odd what) {
    auto& [line, count] = odd_[what];
    if (count++ == 0) line = line_;
  }

  void report_odd() {
    static const std::map<Odd, std::string> messages = {
        {Odd::texture, "textures dropped: colors are those of the numbers"},
        {Odd::emission, "emission (Ke) dropped: surfaces give no light of their own"},
        {Odd::physically_based, "statements of the physically based extension dropped"},
        {Odd::spectrum, "colors given by a file of their spectrum dropped"},
        {Odd::matte, "illum 10 (shadows on invisible surfaces) taken as illum 2"},
        {Odd::unknown, "unknown statements skipped"},
        {Odd::negative_color, "colors with negative components, taken as 0"},
        {Odd::low_exponent, "highlight exponents (Ns) below 1, taken as 1"},
        {Odd::no_index, "indices of refraction (Ni) that are not positive, taken as 1.5"},
        {Odd::share, "opacities (d, Tr) outside 0 to 1, taken as the nearer of the two"}};
    for (const auto& [what, place] : odd_)
      warnings_.push_back({{name_, place.first, {}}, messages.at(what), place.second});
  }

  std::string_view text_;
  const std::string& name_;
  Warnings& warnings_;
  char newline_ = '\n';
  std::int64_t line_ = 0;
  std::vector<MtlMaterial> materials_;
  std::map<Odd, std::pair<std::int64_t, std::int64_t>> odd_;  ///< line of the first, count
};

/// What an illumination model switches on (the format's table of illum 0 to 10).
struct Illumination {
  bool lights, highlight, reflection, glass, refraction;
  std::optional<bool> fresnel;
};

Illumination illumination_of(const MtlMaterial& material, bool transparent) {
  const bool has_specular = material.specular && !is_black(*material.specular);
  switch (material.illumination.value_or(transparent ? 9 : has_specular ? 2 : 1)) {
    case 0:
      return {false, false, false, false, false, {}};
    case 1:
      return {true, false, false, false, false, {}};
    case 3:
      return {true, true, true, false, false, {}};
    case 4:
      return {true, true, true, true, false, {}};
    case 5:
      return {true, true, true, false, false, true};
    case 6:
      return {true, true, true, true, true, false};
    case 7:
      return {true, true, true, true, true, true};
    case 9:
      return {true, true, false, true, false, {}};
    default:  // 2, 8 (reflection by maps alone) and 10
      return {true, true, false, false, false, {}};
  }
}

/// Of the light behind, the share that the material as a whole lets through, before Tf.
double transparency_of(const MtlMaterial& material) {
  if (material.dissolve) return 1 - *material.dissolve;
  return material.transparency.value_or(0);
}

ColorPattern scaled(const Rgb& color, double factor) { return color * static_cast<float>(factor); }

MaterialDescription described(const MtlMaterial& mtl) {
  double transparency = transparency_of(mtl);
  const Illumination model = illumination_of(mtl, transparency > 0);
  const bool states_opacity = mtl.dissolve || mtl.transparency;
  // A glass says by Tf alone what it lets through, and all of it where it says nothing at all.
  if (model.glass && transparency == 0 && (mtl.filter || !states_opacity)) transparency = 1;
  // A dissolved surface is there only so much; glass has its own colors.
  const double presence = model.glass ? 1 : 1 - transparency;

  MaterialDescription material;
  material.name = mtl.name;
  const Rgb diffuse = mtl.diffuse.value_or(Rgb(model.glass ? 0.0f : 0.8f));
  material.diffuse = model.lights ? scaled(diffuse, presence) : ColorPattern(Rgb());
  if (!model.lights)
    material.ambient = scaled(diffuse, presence);
  else if (mtl.ambient)
    material.ambient = scaled(*mtl.ambient, presence);
  const Rgb specular = mtl.specular.value_or(Rgb());
  if (model.highlight) material.highlight.weight = specular;
  material.highlight.exponent = std::clamp(mtl.exponent.value_or(20), 1.0, 1e18);
  if (model.reflection) material.reflection = specular;
  material.transmission = mtl.filter.value_or(Rgb(1)) * static_cast<float>(transparency);
  const bool has_index = mtl.index && *mtl.index > 0;
  material.index_of_refraction = has_index ? *mtl.index : 1.5;
  // What is not refracted goes straight on.
  if (transparency > 0 && !model.refraction) material.thin = true;
  material.fresnel = model.fresnel;
  return material;
}

}  // namespace

std::vector<MaterialDescription> read_mtl(std::string_view text, const std::string& name, Warnings& warnings) {
  std::vector<MaterialDescription> result;
  std::map<std::string, std::size_t> known;
  std::int64_t repeated = 0;
  for (const MtlMaterial& mtl : MtlParser(text, name, warnings).parse()) {
    MaterialDescription material = described(mtl);
    const auto [place, is_new] = known.emplace(material.name, result.size());
    if (is_new)
      result.push_back(std::move(material));
    else
      ++repeated, result[place->second] = std::move(material);
  }
  if (repeated > 0)
    warnings.push_back({{name, 0, {}}, "materials with the name of an earlier one: the later counts", repeated});
  return result;
}

std::vector<MaterialDescription> read_mtl_file(const std::string& path, Warnings& warnings) {
  const MappedFile file(path);
  return read_mtl(file.bytes(), path, warnings);
}

}  // namespace raytree
