#include "renderer/scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <set>
#include <string_view>

#include "geometry/embree_intersector.h"
#include "geometry/open_edges.h"
#include "geometry/stopwatch.h"
#include "renderer/groups.h"
#include "renderer/scene_fields.h"
#include "renderer/shape_assembly.h"
#include "renderer/shape_shading.h"
#include "renderer/tracer_choice.h"

namespace raytree {
namespace {

SourceLocation place_of(const SceneDescription& scene, const MaterialDescription& material) {
  return {scene.name, 0, "materials." + material.name};
}

/// Materials in the description's order, then the default one where some shape names none.
void resolve_materials(const SceneDescription& scene, const Vec3d& origin, Scene& result) {
  const auto make = [&](const MaterialDescription& description) {
    result.materials.push_back(make_material(description, description.fresnel.value_or(scene.render.fresnel), origin));
  };
  for (const MaterialDescription& material : scene.materials) {
    if (const std::string problem = material_problem(material); !problem.empty())
      throw Error(ErrorKind::bad_input, place_of(scene, material), problem);
    if (!(material.roughness >= 0 && material.roughness <= kMaxRoughness))
      throw Error(ErrorKind::bad_input, place_of(scene, material),
                  fmt::format("roughness must lie from 0 to {}, not {}", kMaxRoughness, material.roughness));
    make(material);
  }
  const auto fallback = static_cast<std::uint32_t>(scene.materials.size());
  const auto resolve = [&](const ShapeDescription& shape) {
    if (shape.material.empty() && !group_used_by(shape).empty()) {
      result.shape_materials.push_back(kOwnMaterials);
      return;
    }
    const auto found = std::find_if(scene.materials.begin(), scene.materials.end(),
                                    [&](const MaterialDescription& m) { return m.name == shape.material; });
    if (found == scene.materials.end() && !shape.material.empty())
      throw Error(ErrorKind::bad_input, shape.where, "no material \"" + shape.material + "\"");
    result.shape_materials.push_back(static_cast<std::uint32_t>(found - scene.materials.begin()));
    if (result.shape_materials.back() == fallback && result.materials.size() == fallback) make(MaterialDescription());
  };
  for (const ShapeDescription& shape : scene.shapes) resolve(shape);
  for (const GroupDescription& group : scene.groups)
    for (const ShapeDescription& shape : group.shapes) resolve(shape);
}

/// Indices into the scene's materials of those that shapes and mesh files name; what stands in a group that nothing
/// shows does not count.
std::set<std::uint32_t> materials_in_use(const Scene& scene) {
  std::set<std::uint32_t> used;
  auto next = scene.shape_materials.begin();
  const auto take = [&](std::size_t count, bool shown) {
    const auto end = next + static_cast<std::ptrdiff_t>(count);
    if (shown) used.insert(next, end);
    next = end;
  };
  take(scene.description.shapes.size(), true);
  std::set<std::string_view> shown_groups;
  for (const GroupSummary& group : scene.summary.groups) shown_groups.insert(group.name);
  for (const GroupDescription& group : scene.description.groups)
    take(group.shapes.size(), shown_groups.count(group.name) > 0);
  used.erase(kOwnMaterials);
  const auto& materials = scene.description.materials;
  const auto add = [&](const std::vector<ShapeSummary>& shapes) {
    for (const ShapeSummary& shape : shapes)
      for (const std::string& name : shape.file_materials)
        for (std::size_t i = 0; i < materials.size(); ++i)
          if (materials[i].name == name) used.insert(static_cast<std::uint32_t>(i));
  };
  add(scene.summary.shapes);
  for (const GroupSummary& group : scene.summary.groups) add(group.shapes);
  return used;
}

std::vector<std::string> features_in_use(const Scene& scene) {
  std::set<std::string> features;
  const RenderSettings& render = scene.description.render;
  for (const std::uint32_t index : materials_in_use(scene)) {
    const Material& material = scene.materials[index];
    if (material.has_reflection) features.insert("reflection");
    if (material.has_transmission) features.insert("refraction");
    if (material.has_highlight)
      features.insert(render.highlights == HighlightForm::reflected ? "highlights (reflected)"
                                                                    : "highlights (halfway)");
    if (material.fresnel && (material.has_reflection || material.has_transmission)) features.insert("fresnel");
    const MaterialDescription* description =
        index < scene.description.materials.size() ? &scene.description.materials[index] : nullptr;
    const auto note_pattern = [&](const ColorPattern& pattern) {
      if (std::holds_alternative<CheckerPattern>(pattern)) features.insert("checker patterns");
      if (std::holds_alternative<StripesPattern>(pattern)) features.insert("stripes");
      if (std::holds_alternative<NoisePattern>(pattern)) features.insert("noise");
    };
    if (description != nullptr) {
      note_pattern(description->diffuse);
      if (description->ambient) note_pattern(*description->ambient);
      if (description->bump) features.insert("bumps");
    }
    if (material.needs_texture) features.insert("texture coordinates");
    if (material.tabled_highlight) features.insert("highlights by angle");
    if (material.conductor) features.insert("conductors");
    if (material.thin) features.insert("thin sheets");
    if (material.one_sided) features.insert("one-sided surfaces");
    if (material.absorbs) features.insert("absorption");
    if (material.rough) features.insert("rough surfaces");
  }
  if (scene.transparent_shadows && !scene.lights.empty()) features.insert("transparent shadows");
  if (scene.tracks_media) features.insert("media by priority");
  if (render.shadows && !scene.lights.empty()) features.insert("shadows");
  for (const Light& light : scene.lights) {
    if (light.falloff != Falloff::none) features.insert("light falloff");
    if (light.has_cone) features.insert("spot lights");
  }
  if (render.distance_attenuation > 0) features.insert("distance attenuation");
  if (render.cutoff > 0 && (features.count("reflection") || features.count("refraction"))) features.insert("cutoff");
  if (render.antialias.method == Antialiasing::Method::grid) features.insert("antialiasing (grid)");
  if (render.antialias.method == Antialiasing::Method::whitted) features.insert("antialiasing (whitted)");
  if (scene.background.varies) features.insert("gradient background");
  const ShapeSet& shapes = *scene.shapes;
  const auto add_features_of = [&](const BoundedShapes& list) {
    if (std::any_of(list.meshes.begin(), list.meshes.end(), [](const MeshEntry& m) { return !m.mesh.normals.empty(); }))
      features.insert("smooth normals");
    if (!list.meshes.empty()) features.insert("triangle BVH");
    if (!list.spheres.shape.empty()) features.insert("sphere BVH");
    if (!list.discs.shape.empty()) features.insert("disc BVH");
    if (!list.cones.shape.empty()) features.insert("cone BVH");
  };
  add_features_of(shapes);
  for (const BoundedShapes& group : shapes.groups) add_features_of(group);
  const auto note_shading = [&](const std::vector<ShapeSummary>& list) {
    for (const ShapeSummary& shape : list)
      if (!shape.shading.empty() && shape.shading != "phong") features.insert(shape.shading + " shading");
  };
  note_shading(scene.summary.shapes);
  for (const GroupSummary& group : scene.summary.groups) note_shading(group.shapes);
  if (!shapes.instances.empty()) features.insert("instances");
  if (!scene.object_spaces.empty()) features.insert("object spaces");
  if (!shapes.planes.empty()) features.insert("planes");
  if (shapes.origin != Vec3d(0, 0, 0)) features.insert("recentering");
  return {features.begin(), features.end()};
}

void check_adaptive_sampling(const AdaptiveSampling& adaptive, const SourceLocation& where) {
  if (!(adaptive.threshold >= 0)) throw Error(ErrorKind::bad_input, where, "threshold must not be less than 0");
  if (adaptive.levels < 0 || adaptive.levels > kMaxSamplingLevels)
    throw Error(
        ErrorKind::bad_input, where,
        "levels must lie from 0 to " + std::to_string(kMaxSamplingLevels) + ", not " + std::to_string(adaptive.levels));
  if (adaptive.minimum_level < 0 || adaptive.minimum_level > adaptive.levels)
    throw Error(ErrorKind::bad_input, where,
                "minimum_level " + std::to_string(adaptive.minimum_level) + " does not lie from 0 to levels, " +
                    std::to_string(adaptive.levels));
}

void check_light(const LightDescription& light, const SourceLocation& where) {
  const auto check_place = [&](const Vec3d& position) {
    if (!std::isfinite(position.length())) throw Error(ErrorKind::bad_input, where, "the light's place is not finite");
  };
  const auto check_direction = [&](const Vec3d& direction) {
    const double length = direction.length();
    if (!std::isfinite(length) || !(length > 0))
      throw Error(ErrorKind::bad_input, where, "the light needs a direction that is finite and not zero");
  };
  const auto check_falloff = [&](double least_distance) {
    // As float it must not be 0, nor its inverse square infinite.
    if (!(least_distance >= kLeastLightDistance))
      throw Error(ErrorKind::bad_input, where,
                  fmt::format("least_distance {} is less than {}", least_distance, kLeastLightDistance));
  };
  if (const auto* directional = std::get_if<DirectionalLight>(&light.kind)) check_direction(directional->direction);
  if (const auto* point = std::get_if<PointLight>(&light.kind)) {
    check_place(point->position);
    check_falloff(point->least_distance);
  }
  if (const auto* spot = std::get_if<SpotLight>(&light.kind)) {
    check_place(spot->position);
    check_direction(spot->direction);
    check_falloff(spot->least_distance);
    if (spot->inner_angle > spot->angle)
      throw Error(ErrorKind::bad_input, where,
                  fmt::format("inner_angle {} is larger than angle {}", spot->inner_angle, spot->angle));
  }
}

/// The shapes of a description in the order of their ids: the scene's, then those of its groups.
std::vector<const ShapeDescription*> all_shapes(const SceneDescription& scene) {
  std::vector<const ShapeDescription*> shapes;
  for (const ShapeDescription& shape : scene.shapes) shapes.push_back(&shape);
  for (const GroupDescription& group : scene.groups)
    for (const ShapeDescription& shape : group.shapes) shapes.push_back(&shape);
  return shapes;
}

/// Notes how each shape's facets are shaded, and whether any asks for more than its triangles.
void resolve_shading(Scene& scene) {
  for (const ShapeDescription* shape : all_shapes(scene.description)) {
    ShapeShading shading{shading_of(*shape, scene.description.render.facets)};
    if (shading.method == ShadingMethod::flat && shape->half_distance > 0)
      shading.inverse_half_distance = static_cast<float>(std::min(1 / shape->half_distance, 1e30));
    scene.shape_shading.push_back(shading);
  }
  const auto note = [&](const BoundedShapes& list) {
    for (const MeshEntry& entry : list.meshes) scene.shades_facets |= entry.facets != nullptr;
  };
  note(*scene.shapes);
  for (const BoundedShapes& group : scene.shapes->groups) note(group);
}

void warn_of_open_glass(const Scene& scene, Warnings& warnings) {
  const std::vector<const ShapeDescription*> shapes = all_shapes(scene.description);
  const auto check = [&](const BoundedShapes& list) {
    for (const MeshEntry& entry : list.meshes) {
      const std::uint32_t own = scene.shape_materials[entry.shape];
      const bool has_inside =
          scene.materials[own].has_inside ||
          std::any_of(entry.triangle_tags.begin(), entry.triangle_tags.end(),
                      [&](std::uint32_t tag) { return tag != kNoTag && scene.materials[tag].has_inside; });
      if (!has_inside) continue;
      if (const std::int64_t open = count_open_edges(entry.mesh); open > 0)
        warnings.push_back(
            {shapes[entry.shape]->where, "a refractive mesh that is not closed has no inside: open edges", open});
    }
  };
  check(*scene.shapes);
  for (const BoundedShapes& group : scene.shapes->groups) check(group);
}

/// Where k_s + k_t exceeds 1, levels of the tree add light to light, and the bound that the cutoff rests on grows.
void warn_of_more_light_than_arrives(const Scene& scene, Warnings& warnings) {
  const std::vector<MaterialDescription>& described = scene.description.materials;
  for (const std::uint32_t i : materials_in_use(scene)) {
    if (i >= described.size()) continue;  // the default material
    const Material& material = scene.materials[i];
    // The largest that float makes of parts that add up to 1 as written.
    constexpr float kOne = 1 + 4 * 0x1p-24f;
    if (material.fresnel || material.conductor) {
      if (max_channel(max(material.reflection, material.transmission)) > kOne)
        warnings.push_back({place_of(scene.description, described[i]),
                            "returns more light than arrives: reflection or transmission exceeds 1"});
    } else if (max_channel(material.reflection + material.transmission) > kOne) {
      warnings.push_back(
          {place_of(scene.description, described[i]),
           "returns more light than arrives: reflection + transmission exceed 1; Fresnel's weights would "
           "not (\"fresnel\": true)"});
    }
  }
}

std::uint64_t primitive_count(const SceneSummary& summary) {
  std::uint64_t sum = 0;
  const auto add = [&](const std::vector<ShapeSummary>& shapes) {
    for (const ShapeSummary& shape : shapes) sum += shape.triangles + shape.spheres;
  };
  add(summary.shapes);
  for (const GroupSummary& group : summary.groups) add(group.shapes);
  return sum + summary.instances;
}

std::string building_text(const SceneSummary& summary) {
  std::uint64_t triangles = 0, spheres = 0;
  const auto add = [&](const std::vector<ShapeSummary>& shapes) {
    for (const ShapeSummary& shape : shapes) triangles += shape.triangles, spheres += shape.spheres;
  };
  add(summary.shapes);
  for (const GroupSummary& group : summary.groups) add(group.shapes);
  std::string text = "building over " + std::to_string(triangles) + " triangles";
  if (spheres > 0) text += ", " + std::to_string(spheres) + " spheres";
  if (summary.instances > 0) text += ", " + std::to_string(summary.instances) + " instances";
  return text;
}

HierarchyDemand demand_of(const PrepareOptions& options, const Scene& scene) {
  std::uint64_t memory = 0;
  if (options.memory_allowed > 0)
    memory =
        options.memory_allowed > scene.summary.array_bytes ? options.memory_allowed - scene.summary.array_bytes : 1;
  return hierarchy_demand(*scene.shapes, primitive_count(scene.summary), expected_rays(scene.description), memory);
}

/// Of what would be built.
std::uint64_t estimated_intersector_bytes(const PrepareOptions& options, const Scene& scene) {
  constexpr std::uint64_t kBytesPerInstance = 400;  // measured
  const HierarchyDemand demand = demand_of(options, scene);
  const HierarchyChoice choice =
      options.hierarchy.empty() ? choose_hierarchy(demand) : hierarchy_named(options.hierarchy);
  return static_cast<std::uint64_t>(hierarchy_bytes(*choice.chosen, demand)) +
         kBytesPerInstance * scene.summary.instances;
}

void build_embree(const PrepareOptions& options, Scene& scene) {
  const HierarchyChoice choice =
      options.hierarchy.empty() ? choose_hierarchy(demand_of(options, scene)) : hierarchy_named(options.hierarchy);
  scene.summary.hierarchy = choice.reason;
  EmbreeOptions embree;
  embree.primitives = choice.chosen->primitives;
  embree.quality = choice.chosen->quality;
  embree.compact = choice.chosen->compact;
  embree.robust = options.watertight;
  embree.threads = options.threads;
  embree.stop = options.stop;
  scene.intersector = std::make_unique<EmbreeIntersector>(*scene.shapes, embree);
}

void build_spheres(const PrepareOptions& options, Scene& scene) {
  SphereBoundedOptions spheres = options.spheres;
  spheres.stop = options.stop;
  auto tracer = std::make_unique<SphereBoundedIntersector>(*scene.shapes, spheres);
  scene.summary.hierarchy = fmt::format("bounding spheres about {} objects, {}", tracer->object_count(),
                                        tracer->uses_hierarchy() ? "in a hierarchy" : "tried one after the other");
  scene.sphere_pixels = spheres.sphere_pixels;
  scene.intersector = std::move(tracer);
}

}  // namespace

Scene::Scene() = default;
Scene::~Scene() = default;
Scene::Scene(Scene&&) noexcept = default;
Scene& Scene::operator=(Scene&&) noexcept = default;

Scene prepare(SceneDescription description, const PrepareOptions& options, Warnings& warnings) {
  Scene scene;
  auto start = Clock::now();
  const CameraDescription camera = chosen_camera(description, options.camera);
  scene.shapes =
      std::make_unique<ShapeSet>(assemble_shapes(description, camera.position, options, scene.summary, warnings));
  scene.description = std::move(description);
  const Vec3d origin = scene.shapes->origin;

  if (const int samples = scene.description.render.rough_samples; samples < 1 || samples > kMaxRoughSamples)
    throw Error(ErrorKind::bad_input, {scene.description.name, 0, "render.rough_samples"},
                fmt::format("rough_samples must lie from 1 to {}, not {}", kMaxRoughSamples, samples));
  check_adaptive_sampling(scene.description.render.adaptive, {scene.description.name, 0, "render.adaptive"});
  resolve_materials(scene.description, origin, scene);
  for (const LightDescription& light : scene.description.lights) {
    check_light(light, {scene.description.name, 0, "lights." + light.name});
    scene.lights.push_back(make_light(light, origin));
  }
  resolve_shading(scene);
  scene.background = BackgroundLight(scene.description.background);
  scene.ambient = scene.description.ambient;
  scene.camera = Camera(camera, scene.description.image.width, scene.description.image.height, origin,
                        {scene.description.name, 0, "cameras." + camera.name});
  scene.bound =
      RadianceBound(scene.materials, scene.lights, scene.background, scene.ambient, scene.description.render.depth);

  for (const std::uint32_t index : materials_in_use(scene)) {
    const Material& material = scene.materials[index];
    const RenderSettings& render = scene.description.render;
    scene.transparent_shadows |= render.shadows && render.transparent_shadows && material.has_transmission;
    scene.tracks_media |= material.has_inside && material.priority != 0;
    scene.rough_surfaces |= material.rough;
  }
  // Where media or paths are tracked no surface is a plain one: one flag each serves the tracer's inner loops.
  const bool tracked = scene.tracks_media || scene.rough_surfaces;
  const bool free_reflections = scene.description.render.facets.reflections == FacetReflections::classic;
  scene.object_spaces = find_object_spaces(scene);
  for (Material& material : scene.materials) {
    material.follows_objects &= !scene.object_spaces.empty();
    material.free_reflections = free_reflections;
    material.special_optics |= free_reflections;
    material.takes_on_the_way = material.absorbs || material.one_sided || tracked;
    material.in_cells =
        material.diffuse.has_cells() && !material.follows_objects && !(kFeatures.bumps && material.bump != nullptr);
    material.is_plain = !material.is_varied && !material.ambient.varies() && !material.takes_on_the_way;
    material.special_optics |= tracked;
  }

  if (scene.description.render.antialias.method == Antialiasing::Method::whitted)
    scene.small_objects =
        SmallObjects(*scene.shapes, scene.camera, scene.description.image.width, scene.description.image.height);

  std::set<std::string> used;
  const auto use = [&](ShapeSummary& shape, const ShapeDescription& described) {
    shape.material = described.material;
    used.insert(shape.file_materials.begin(), shape.file_materials.end());
    if (!shape.material.empty())
      used.insert(shape.material);
    else if (group_used_by(described).empty())
      used.insert("(default)");
  };
  for (std::size_t i = 0; i < scene.summary.shapes.size(); ++i)
    use(scene.summary.shapes[i], scene.description.shapes[i]);
  for (GroupSummary& group : scene.summary.groups) {
    const GroupDescription& described = scene.description.groups[group_index(scene.description, group.name)];
    for (std::size_t i = 0; i < group.shapes.size(); ++i) use(group.shapes[i], described.shapes[i]);
  }
  scene.summary.materials_in_use = {used.begin(), used.end()};
  scene.summary.features = features_in_use(scene);
  warn_of_open_glass(scene, warnings);
  warn_of_more_light_than_arrives(scene, warnings);
  scene.seconds.load = seconds_since(start);
  if (!options.build) {
    scene.summary.intersector_bytes = estimated_intersector_bytes(options, scene);
    return scene;
  }

  if (options.on_phase) options.on_phase(building_text(scene.summary));
  start = Clock::now();
  if (options.tracer == Tracer::spheres)
    build_spheres(options, scene);
  else
    build_embree(options, scene);
  scene.summary.intersector_bytes = scene.intersector->memory_bytes();
  scene.seconds.build = seconds_since(start);
  return scene;
}

}  // namespace raytree
