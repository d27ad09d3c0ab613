#include "benchmarks/chart/chart_settings.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string_view>

#include "geometry/lattice.h"
#include "renderer/scene_reader.h"

namespace raytree::benchmarks {
namespace {

/// A knob and its values from cheap to dear; `words` are the flags of each.
struct Knob {
  std::string name;
  std::vector<std::pair<std::string, Words>> values;
};

Knob flag_knob(const std::string& name, const std::string& flag, const std::vector<std::string>& values,
               const Words& also = {}) {
  Knob knob{name, {}};
  for (const std::string& value : values) {
    Words words = also;
    words.insert(words.end(), {flag, value});
    knob.values.emplace_back(value, std::move(words));
  }
  return knob;
}

Words sides_flags(const SceneTraits& traits, int sides) {
  Words words;
  for (const std::string& shape : traits.sided_shapes)
    words.insert(words.end(), {"--set", fmt::format("shapes.\"{}\".sides={}", shape, sides)});
  return words;
}

/// Grids that share no samples with the reference's halves, of `reference_grid` and one more.
std::vector<std::string> fair_grids(const std::vector<int>& grids, int reference_grid) {
  std::vector<std::string> fair;
  for (const int grid : grids)
    if (grid != reference_grid && grid != reference_grid + 1) fair.push_back(fmt::format("grid:{}", grid));
  return fair;
}

std::vector<Knob> knobs_of(const SceneTraits& traits, int reference_grid) {
  std::vector<Knob> knobs;
  const Words adaptive =
      traits.render.antialias.method == Antialiasing::Method::whitted ? Words() : Words{"--antialias", "whitted"};
  std::vector<std::string> antialias{"none", "whitted"};
  for (std::string& grid : fair_grids({2, 3, 4, 5, 6, 8}, reference_grid)) antialias.push_back(std::move(grid));
  knobs.push_back(flag_knob("antialias", "--antialias", antialias));
  knobs.push_back(flag_knob("threshold", "--threshold", {"0.5", "0.2", "0.1", "0.05", "0.02", "0.01", "0"}, adaptive));
  knobs.push_back(flag_knob("levels", "--levels", {"0", "1", "2", "3", "4", "5"}, adaptive));
  knobs.push_back(flag_knob("minimum level", "--minimum-level", {"0", "1", "2"}, adaptive));
  if (traits.branches) {
    knobs.push_back(flag_knob("depth", "--depth", {"1", "2", "3", "4", "6", "8", "12", "16", "32", "64"}));
    knobs.push_back(
        flag_knob("cutoff", "--cutoff", {"0.1", "0.03", "0.01", "0.00392157", "0.00098039", "0.0001", "0"}));
  }
  if (traits.rough)
    knobs.push_back(flag_knob("rough samples", "--rough-samples", {"1", "2", "4", "8", "16", "32", "64"}));
  if (traits.curved)
    knobs.push_back(flag_knob("tolerance", "--tolerance", {"8", "4", "2", "1", "0.5", "0.25", "0.125"}));
  if (!traits.sided_shapes.empty()) {
    Knob sides{"sides", {}};
    for (const int count : {8, 16, 32, 64, 128})
      sides.values.emplace_back(std::to_string(count), sides_flags(traits, count));
    sides.values.emplace_back("exact", sides_flags(traits, 0));
    knobs.push_back(std::move(sides));
  }
  if (traits.facets) {
    knobs.push_back(flag_knob("shading", "--shading", {"flat", "gouraud", "phong", "limit"}));
    // What facets of a plain mesh stand for is not known, and neither is how light would graze it.
    if (traits.knows_surface()) knobs.push_back(flag_knob("terminator", "--terminator", {"classic", "offset"}));
    if (traits.branches && traits.knows_surface())
      knobs.push_back(flag_knob("reflections", "--reflections", {"classic", "clamped", "consistent"}));
  }
  if (traits.triangles) {
    std::vector<std::string> kinds = {"quick", "quads", "balanced", "compact", "compact-quads"};
    if (traits.lattices) kinds.insert(kinds.begin() + 1, "grids");
    knobs.push_back(flag_knob("hierarchy", "--hierarchy", kinds));
    knobs.push_back(flag_knob("edges", "--edges", {"fast", "watertight"}));
  }
  knobs.push_back(flag_knob("tracer", "--intersector", {"embree", "spheres"}));
  return knobs;
}

using Choices = std::vector<Words>;

/// All combinations of a few values of the knobs that errors hang on most, in an order in which any first part of them
/// covers the whole.
std::vector<ChartSetting> crossed_set(const SceneTraits& traits, int reference_grid) {
  std::vector<Choices> axes;
  axes.push_back({{"--antialias", "none"},
                  {"--antialias", "whitted", "--threshold", "0.3", "--levels", "2"},
                  {"--antialias", "whitted"},
                  {"--antialias", "whitted", "--threshold", "0.03"},
                  {"--antialias", fair_grids({2, 4}, reference_grid).front()},
                  {"--antialias", fair_grids({4, 5, 6}, reference_grid).front()}});
  if (traits.branches) {
    axes.push_back({{"--depth", "3"}, {}, {"--depth", "16"}});
    axes.push_back({{"--cutoff", "0.03"}, {"--cutoff", "0.00392157"}, {"--cutoff", "0.0001"}});
  }
  if (traits.curved) axes.push_back({{"--tolerance", "2"}, {"--tolerance", "0.7"}, {"--tolerance", "0.25"}});
  if (!traits.sided_shapes.empty()) axes.push_back({sides_flags(traits, 16), sides_flags(traits, 64)});
  if (traits.facets) axes.push_back({{"--shading", "gouraud"}, {"--shading", "phong"}, {"--shading", "limit"}});
  if (traits.rough) axes.push_back({{"--rough-samples", "4"}, {"--rough-samples", "16"}});
  std::size_t count = 1;
  for (const Choices& axis : axes) count *= axis.size();
  // Steps of about count / golden ratio, coprime to count, visit every combination once.
  const auto coprime = [&](std::size_t step) {
    std::size_t a = count, b = step;
    while (b != 0) std::swap(a %= b, b);
    return a == 1;
  };
  std::size_t step = std::max<std::size_t>(1, static_cast<std::size_t>(static_cast<double>(count) * 0.618));
  while (!coprime(step)) ++step;
  std::vector<ChartSetting> settings;
  for (std::size_t i = 0; i < count; ++i) {
    std::size_t rest = i * step % count;
    ChartSetting setting{"crossed", "", {}, SweepPart::crossed};
    for (const Choices& axis : axes) {
      const Words& words = axis[rest % axis.size()];
      setting.flags.insert(setting.flags.end(), words.begin(), words.end());
      rest /= axis.size();
    }
    setting.value = command_text(setting.flags);
    settings.push_back(std::move(setting));
  }
  return settings;
}

void note_sides(const SceneDescription& scene, SceneTraits& traits) {
  for (const ShapeDescription& shape : scene.shapes) {
    const int sides = std::visit(
        [](const auto& kind) {
          if constexpr (requires { kind.sides; })
            return kind.sides;
          else
            return 0;
        },
        shape.kind);
    if (sides > 0) traits.sided_shapes.push_back(shape.name);
  }
}

class Fingerprint {
 public:
  void add(const void* bytes, std::size_t size) {
    const auto* byte = static_cast<const unsigned char*>(bytes);
    for (std::size_t i = 0; i < size; ++i) state_ = (state_ ^ byte[i]) * 0x100000001b3u;
  }
  void add(std::string_view text) { add(text.data(), text.size()); }
  std::string text() const { return fmt::format("{:016x}", state_); }

 private:
  std::uint64_t state_ = 0xcbf29ce484222325u;
};

}  // namespace

std::string command_text(const Words& words) {
  constexpr std::string_view kPlain = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_=+:,./@%";
  std::string text;
  for (const std::string& word : words) {
    if (!text.empty()) text += ' ';
    if (!word.empty() && word.find_first_not_of(kPlain) == std::string::npos) {
      text += word;
      continue;
    }
    text += '\'';
    for (const char c : word) c == '\'' ? text += "'\\''" : text += c;
    text += '\'';
  }
  return text;
}

SceneTraits scene_traits(const Scene& scene) {
  SceneTraits traits;
  traits.render = scene.description.render;
  const auto note = [&](const std::vector<ShapeSummary>& shapes) {
    for (const ShapeSummary& shape : shapes) {
      traits.facets |= !shape.shading.empty() && shape.shading != "flat";
      traits.curved |= shape.tessellation.has_value();
      traits.triangles |= shape.triangles > 0;
    }
  };
  note(scene.summary.shapes);
  for (const GroupSummary& group : scene.summary.groups) note(group.shapes);
  const auto& features = scene.summary.features;
  const auto has = [&](const char* name) {
    return std::find(features.begin(), features.end(), name) != features.end();
  };
  traits.branches = has("reflection") || has("refraction");
  traits.rough = scene.rough_surfaces;
  const auto note_lattices = [&](const BoundedShapes& shapes) {
    for (const MeshEntry& entry : shapes.meshes) traits.lattices |= may_be_lattices(entry.mesh.corners);
  };
  note_lattices(*scene.shapes);
  for (const BoundedShapes& group : scene.shapes->groups) note_lattices(group);
  note_sides(scene.description, traits);
  return traits;
}

std::vector<ChartSetting> sweep_of(const SceneTraits& traits, const std::vector<Words>& added, int reference_grid) {
  std::vector<ChartSetting> settings{{"defaults", "the scene's own", {}, SweepPart::defaults}}, between;
  for (const Words& words : added) settings.push_back({"added", command_text(words), words, SweepPart::added});
  for (const Knob& knob : knobs_of(traits, reference_grid))
    for (std::size_t i = 0; i < knob.values.size(); ++i) {
      const auto& [value, words] = knob.values[i];
      const bool end = i == 0 || i + 1 == knob.values.size();
      const double dearness = static_cast<double>(i) / static_cast<double>(knob.values.size() - 1);
      (end ? settings : between)
          .push_back({knob.name, value, words, end ? SweepPart::ends : SweepPart::between, 0, dearness});
    }
  settings.insert(settings.end(), between.begin(), between.end());
  const std::vector<ChartSetting> crossed = crossed_set(traits, reference_grid);
  settings.insert(settings.end(), crossed.begin(), crossed.end());
  return settings;
}

void sort_cheap_first(std::vector<ChartSetting>& settings) {
  constexpr double kBetween = 2;
  const auto rank = [](const ChartSetting& setting) {
    const bool first = setting.part == SweepPart::defaults || setting.part == SweepPart::added;
    return first ? static_cast<int>(setting.part == SweepPart::added) : setting.expected_rays > 0 ? 2 : 3;
  };
  const auto cost = [&](const ChartSetting& setting) {
    if (rank(setting) < 2) return 0.0;
    if (rank(setting) == 3) return setting.dearness;
    return (setting.part == SweepPart::between ? kBetween : 1) * setting.expected_rays;
  };
  std::stable_sort(settings.begin(), settings.end(), [&](const ChartSetting& a, const ChartSetting& b) {
    return rank(a) != rank(b) ? rank(a) < rank(b) : cost(a) < cost(b);
  });
}

Words reference_surface_flags(const SceneTraits& traits, double tolerance) {
  Words words;
  if (traits.facets) words.insert(words.end(), {"--shading", "limit"});
  if (traits.curved) words.insert(words.end(), {"--tolerance", fmt::format("{}", tolerance)});
  const Words sides = sides_flags(traits, 0);
  words.insert(words.end(), sides.begin(), sides.end());
  return words;
}

std::string render_key(const ChartScene& scene) {
  SceneDescription settings;
  settings.image = scene.description.image;
  settings.render = scene.description.render;
  std::string key = write_scene(settings);
  for (const ShapeDescription& shape : scene.description.shapes)
    std::visit(
        [&](const auto& kind) {
          if constexpr (requires { kind.sides; }) key += fmt::format(",{}", kind.sides);
        },
        shape.kind);
  const PrepareOptions& prepare = scene.prepare;
  return key + fmt::format("|{}|{}|{}|{}|{}|{}|{}", prepare.camera, prepare.hierarchy, prepare.memory_allowed,
                           prepare.watertight, static_cast<int>(prepare.tracer), prepare.spheres.sphere_pixels,
                           static_cast<int>(prepare.spheres.search));
}

std::string text_hash(const std::string& text) {
  Fingerprint print;
  print.add(text);
  return print.text();
}

std::string scene_hash(const ChartScene& scene) {
  Fingerprint print;
  print.add(write_scene(scene.description));
  print.add(scene.prepare.camera);
  const auto add_file = [&](const std::string& name) {
    if (name.empty()) return;
    const std::filesystem::path path = std::filesystem::path(scene.description.folder) / name;
    std::ifstream file(path, std::ios::binary);
    std::vector<char> block(std::size_t{1} << 16);
    while (file.read(block.data(), static_cast<std::streamsize>(block.size())), file.gcount() > 0)
      print.add(block.data(), static_cast<std::size_t>(file.gcount()));
  };
  const auto add_shape = [&](const ShapeDescription& shape) {
    // A mesh in memory stands in the scene's text.
    if (const auto* mesh = std::get_if<MeshShape>(&shape.kind)) add_file(mesh->file);
    if (const auto* patches = std::get_if<PatchesShape>(&shape.kind)) add_file(patches->file);
  };
  for (const ShapeDescription& shape : scene.description.shapes) add_shape(shape);
  for (const GroupDescription& group : scene.description.groups)
    for (const ShapeDescription& shape : group.shapes) add_shape(shape);
  return print.text();
}

}  // namespace raytree::benchmarks
