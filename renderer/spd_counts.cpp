#include "renderer/spd_counts.h"

#include <cmath>
#include <filesystem>
#include <limits>
#include <set>

#include "geometry/angle.h"
#include "renderer/spd_scenes.h"

namespace raytree {
namespace {

constexpr int kDepth = 5;
constexpr int kPictureSize = 512;
/// The light that it carries over five levels is below a display's, and still no denormal.
constexpr float kLeastReflection = 1e-6f;

SpdCounts published(SpdDatabase database) {
  switch (database) {
    case SpdDatabase::balls:
      return {263169, 175095, 0, 954368};
    case SpdDatabase::gears:
      return {245086, 304643, 207564, 2246955};
    case SpdDatabase::mount:
      return {173125, 354769, 354769, 412922};
    case SpdDatabase::rings:
      return {263169, 315236, 0, 1085002};
    case SpdDatabase::teapot:
      return {161120, 225248, 0, 407656};
    case SpdDatabase::tetra:
      return {49788, 0, 0, 46112};
    case SpdDatabase::tree:
      return {169836, 0, 0, 1097419};
  }
  return {};
}

/// Materials of what may be seen from behind by right: open surfaces with normals of their own.
std::set<std::string> two_sided_materials(const SceneDescription& scene) {
  std::set<std::string> names;
  const auto add = [&](const std::vector<ShapeDescription>& shapes) {
    for (const ShapeDescription& shape : shapes) {
      const auto* mesh = std::get_if<MeshShape>(&shape.kind);
      const bool flat = mesh != nullptr && mesh->normals == NormalSource::flat;
      const bool exact =
          std::holds_alternative<SphereShape>(shape.kind) || std::holds_alternative<SphereFlakeShape>(shape.kind) ||
          std::holds_alternative<ConeShape>(shape.kind) || std::holds_alternative<DiscShape>(shape.kind) ||
          std::holds_alternative<PlaneShape>(shape.kind);
      if (!flat && !exact) names.insert(shape.material);
    }
  };
  add(scene.shapes);
  for (const GroupDescription& group : scene.groups) add(group.shapes);
  return names;
}

}  // namespace

std::optional<SpdCounts> published_spd_counts(const SceneDescription& scene) {
  // The standard render has made the image one larger.
  if (scene.image.width - kPictureSize > 1 || scene.image.height != scene.image.width ||
      scene.image.width < kPictureSize)
    return std::nullopt;
  const std::filesystem::path path(scene.name);
  for (const SpdEntry& entry : spd_databases())
    if (scene.name == std::string(kSpdPrefix) + std::string(entry.name) ||
        path.filename() == std::string(entry.name) + ".nff")
      return published(entry.database);
  return std::nullopt;
}

void set_standard_spd_render(SceneDescription& scene) {
  const double growth = (scene.image.height + 1.0) / scene.image.height;
  for (CameraDescription& camera : scene.cameras) {
    const double half = camera.field_of_view * kPi / 360;
    camera.field_of_view = std::atan(std::tan(half) * growth) * 360 / kPi;
    camera.height *= growth;
  }
  ++scene.image.width;
  ++scene.image.height;
  RenderSettings& render = scene.render;
  render.depth = kDepth;
  render.cutoff = 0;
  render.antialias = {Antialiasing::Method::none, 1};
  render.shadows = true;
  render.transparent_shadows = false;
  const std::set<std::string> two_sided = two_sided_materials(scene);
  for (MaterialDescription& material : scene.materials) {
    if (is_black(material.transmission))
      material.one_sided = !two_sided.contains(material.name);
    else if (is_black(material.reflection))
      material.reflection = Rgb(kLeastReflection);
  }
}

SpdCounts spd_counts(const RenderStatistics& statistics) {
  const auto rays = [&](RayKind kind) { return statistics.rays[static_cast<std::size_t>(kind)]; };
  return {statistics.eye_hits, rays(RayKind::reflected), rays(RayKind::refracted) - statistics.rays_through_backs,
          rays(RayKind::shadow)};
}

double relative_difference(std::uint64_t count, std::uint64_t published) {
  if (count == published) return 0;
  if (published == 0) return std::numeric_limits<double>::infinity();
  return static_cast<double>(count) / static_cast<double>(published) - 1;
}

}  // namespace raytree
