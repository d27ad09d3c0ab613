// What a validation found, as text, JSON, a line of a table and a picture.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "benchmarks/validation.h"

namespace raytree::benchmarks {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kKindNames[kRayKindCount] = {"primary", "shadow", "reflected", "refracted"};

/// 8-bit, by verdict; agreement is the picture itself.
constexpr std::uint8_t kColors[kRayVerdictCount][3] = {{0, 0, 0},     {255, 200, 0}, {0, 200, 255}, {170, 90, 255},
                                                       {80, 230, 80}, {0, 120, 255}, {255, 130, 0}, {255, 0, 0}};

std::string hit_text(const Hit& hit) {
  if (hit.geometry == kNoGeometry) return "miss";
  std::string text = fmt::format("geometry {} primitive {}", hit.geometry, hit.primitive);
  if (hit.instance != kNoInstance) text += fmt::format(" instance {}", hit.instance);
  return text + " at " + exact(hit.distance);
}

std::string found_text(const ReferenceHit& found) {
  if (!found.hit()) return "miss";
  std::string text = fmt::format("geometry {} primitive {}", found.geometry, found.primitive);
  if (found.instance != kNoInstance) text += fmt::format(" instance {}", found.instance);
  return text + fmt::format(" at {}", found.distance);
}

std::string fast_text(const TreeRay& ray) {
  if (!ray.ray.occlusion) return hit_text(ray.hit);
  return ray.occluded ? "occluded" : "open";
}

std::string arguments(const ComparedRay& ray) {
  std::string text = exact(ray.origin) + " " + exact(ray.direction);
  if (std::isfinite(ray.max_distance)) text += " --end " + exact(ray.max_distance);
  return text;
}

const char* name_of(RayVerdict verdict) { return kRayVerdictNames[static_cast<std::size_t>(verdict)]; }

Json json_of(const ValidationCounts& counts) {
  Json json;
  json["rays"] = counts.rays;
  for (int v = 0; v < kRayVerdictCount; ++v) json[kRayVerdictNames[static_cast<std::size_t>(v)]] = counts.verdicts[v];
  json["largest_distance_ulps"] = counts.largest_ulps;
  return json;
}

}  // namespace

std::string exact(float value) { return fmt::format("{}", value); }
std::string exact(const Vec3f& value) { return fmt::format("{},{},{}", value.x, value.y, value.z); }

std::string report_text(const ValidationReport& report) {
  std::string text = fmt::format("scene    {}, {} x {}, {} of {} pixels' trees\n\n", report.scene, report.width,
                                 report.height, report.pixels, std::size_t(report.width) * std::size_t(report.height));
  text.pop_back();
  text += fmt::format("truth    {}\n{}\n", report.truth_name,
                      report.planted_fault.empty() ? "" : "planted  " + report.planted_fault + "\n");
  text += fmt::format("{:<10} {:>11}", "rays", "compared");
  for (int v = 1; v < kRayVerdictCount; ++v) text += fmt::format(" {:>12}", kRayVerdictNames[std::size_t(v)]);
  text += fmt::format(" {:>12}\n", "largest ulp");
  const auto line = [&](const char* name, const ValidationCounts& counts) {
    text += fmt::format("{:<10} {:>11}", name, counts.rays);
    for (int v = 1; v < kRayVerdictCount; ++v) text += fmt::format(" {:>12}", counts.verdicts[v]);
    text += fmt::format(" {:>12.2f}\n", counts.largest_ulps);
  };
  for (int kind = 0; kind < kRayKindCount; ++kind) line(kKindNames[kind], report.kinds[kind]);
  line("all", report.all());
  text += fmt::format("\nbounds   edges within {:.3g}, distances within {:.3g} scene units at most where they excuse\n",
                      report.largest_edge_error, report.largest_distance_error);
  text += fmt::format(
      "pixels   {} classified; of the others {} differ by more than 1/255 (largest {:.3g}); {} rays of the truth's "
      "trees have no like\n",
      report.classified_pixels, report.differing_pixels, report.largest_difference, report.diverged_rays);
  if (report.differing_pixels > 0)
    text += fmt::format("         first at pixel {},{}\n", report.differing_x, report.differing_y);
  text += fmt::format("speed    fast {:.3g} rays/s a thread, truth {:.3g}: {:.0f} times\n",
                      report.fast.rays_per_second(), report.truth.rays_per_second(),
                      report.truth.rays > 0 ? report.fast.rays_per_second() / report.truth.rays_per_second() : 0.0);
  if (!report.examples.empty()) text += "\n";
  for (const ValidationExample& example : report.examples) {
    const TreeRay& ray = example.ray;
    text += fmt::format("{}: {} ray of pixel {},{}: fast {}, truth {}{}\n", name_of(ray.comparison.verdict),
                        kKindNames[static_cast<int>(example.kind)], example.x, example.y, fast_text(ray),
                        found_text(ray.found), example.alone ? "" : " (in its packet only)");
    text += fmt::format("  {:.3g} from an edge known to {:.3g}, distance known to {:.3g}\n",
                        ray.comparison.edge_distance, ray.comparison.edge_error, ray.comparison.distance_error);
    text += "  raytree ray SCENE " + arguments(ray.ray) + "\n";
  }
  text += report.holds() ? "\nno defect\n" : "\nDEFECTS\n";
  return text;
}

std::string report_json(const ValidationReport& report) {
  Json json;
  json["scene"] = report.scene;
  json["truth"] = report.truth_name;
  if (!report.planted_fault.empty()) json["planted_fault"] = report.planted_fault;
  json["image"] = {{"width", report.width}, {"height", report.height}};
  for (int kind = 0; kind < kRayKindCount; ++kind) json["rays"][kKindNames[kind]] = json_of(report.kinds[kind]);
  json["rays"]["all"] = json_of(report.all());
  json["bounds"] = {{"largest_edge_error", report.largest_edge_error},
                    {"largest_distance_error", report.largest_distance_error}};
  json["pixels"] = {{"compared", report.pixels},
                    {"classified", report.classified_pixels},
                    {"differing", report.differing_pixels},
                    {"largest_difference", report.largest_difference},
                    {"diverged_rays", report.diverged_rays}};
  json["examples"] = Json::array();
  for (const ValidationExample& example : report.examples) {
    const ComparedRay& ray = example.ray.ray;
    Json item;
    item["class"] = name_of(example.ray.comparison.verdict);
    item["kind"] = kKindNames[static_cast<int>(example.kind)];
    item["pixel"] = {example.x, example.y};
    item["origin"] = {ray.origin.x, ray.origin.y, ray.origin.z};
    item["direction"] = {ray.direction.x, ray.direction.y, ray.direction.z};
    if (std::isfinite(ray.max_distance)) item["end"] = ray.max_distance;
    item["fast"] = fast_text(example.ray);
    item["truth"] = found_text(example.ray.found);
    item["alone"] = example.alone;
    item["arguments"] = arguments(ray);
    json["examples"].push_back(item);
  }
  json["holds"] = report.holds();
  json["speed"] = {{"fast_rays_per_second", report.fast.rays_per_second()},
                   {"truth_rays_per_second", report.truth.rays_per_second()}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string validation_table_head() {
  std::string head = "| scene | rays |", rule = "|---|---:|";
  for (int v = 1; v < kRayVerdictCount; ++v) {
    head += fmt::format(" {} |", kRayVerdictNames[std::size_t(v)]);
    rule += "---:|";
  }
  return head + " largest distance error, ulp | pixels off |\n" + rule + "---:|---:|\n";
}

std::string validation_table_line(const ValidationReport& report) {
  const ValidationCounts all = report.all();
  // Files by their names: where they lie says nothing.
  std::string line = fmt::format("| {} | {} |", report.scene.substr(report.scene.rfind('/') + 1), all.rays);
  for (int v = 1; v < kRayVerdictCount; ++v) line += fmt::format(" {} |", all.verdicts[v]);
  return line + fmt::format(" {:.2f} | {} |\n", all.largest_ulps, report.differing_pixels);
}

Image marked_image(const ValidationReport& report, std::array<std::vector<std::uint8_t>, 3>& planes) {
  Image image;
  image.frame_width = report.width, image.frame_height = report.height;
  image.window = {0, 0, report.width, report.height};
  image.color_space = "srgb";
  const char* const names[3] = {"R", "G", "B"};
  constexpr float kDarker = 0.6f;  // so that marks, three pixels wide, stand out
  const auto at = [&](int x, int y) {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(report.width) + static_cast<std::size_t>(x);
  };
  for (std::size_t c = 0; c < 3; ++c) {
    planes[c].resize(report.gray.size());
    for (std::size_t i = 0; i < report.gray.size(); ++i)
      planes[c][i] = static_cast<std::uint8_t>(std::lround(std::clamp(report.gray[i], 0.0f, 1.0f) * kDarker * 255));
    for (int y = 0; y < report.height; ++y)
      for (int x = 0; x < report.width; ++x)
        if (const std::uint8_t verdict = report.verdicts[at(x, y)];
            verdict != ValidationReport::kNotCompared && verdict != 0)
          for (int v = std::max(0, y - 1); v <= std::min(report.height - 1, y + 1); ++v)
            for (int u = std::max(0, x - 1); u <= std::min(report.width - 1, x + 1); ++u)
              planes[c][at(u, v)] = kColors[verdict][c];
    image.planes.push_back({names[c], PixelType::uint8, PixelType::uint8, planes[c].data()});
  }
  return image;
}

}  // namespace raytree::benchmarks
