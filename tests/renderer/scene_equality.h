// Equality of scene descriptions, member by member. Structured bindings name every member, so that a member added
// to a struct does not compile here until it is compared; its count is held against the tables in the tests.
#pragma once

#include "renderer/scene_fields.h"

namespace raytree::test {

inline bool equal(const auto& a, const auto& b) { return a == b; }

inline bool equal(const Antialiasing& a, const Antialiasing& b) {
  const auto& [method, size] = a;
  return method == b.method && size == b.grid_size;
}
inline bool equal(const AdaptiveSampling& a, const AdaptiveSampling& b) {
  const auto& [threshold, levels, minimum] = a;
  return threshold == b.threshold && levels == b.levels && minimum == b.minimum_level;
}
inline bool equal(const TessellationSettings& a, const TessellationSettings& b) {
  const auto& [tolerance, rate] = a;
  return tolerance == b.tolerance && rate == b.rate;
}
inline bool equal(const FacetSettings& a, const FacetSettings& b) {
  const auto& [shading, terminator, reflections] = a;
  return shading == b.shading && terminator == b.shadow_terminator && reflections == b.reflections;
}
inline bool equal(const ImageDescription& a, const ImageDescription& b) {
  const auto& [width, height] = a;
  return width == b.width && height == b.height;
}
inline bool equal(const CameraDescription& a, const CameraDescription& b) {
  const auto& [name, projection, position, target, up, angle, height] = a;
  return name == b.name && projection == b.projection && position == b.position && target == b.target && up == b.up &&
         angle == b.field_of_view && height == b.height;
}
inline bool equal(const RenderSettings& a, const RenderSettings& b) {
  const auto& [depth, cutoff, antialias, adaptive, highlights, shadows, transparent, shadowed, fresnel, attenuation,
               rough_samples, tessellation, facets] = a;
  return depth == b.depth && cutoff == b.cutoff && equal(antialias, b.antialias) && equal(adaptive, b.adaptive) &&
         highlights == b.highlights && shadows == b.shadows && transparent == b.transparent_shadows &&
         shadowed == b.shadowed_highlights && fresnel == b.fresnel && attenuation == b.distance_attenuation &&
         rough_samples == b.rough_samples && equal(tessellation, b.tessellation) && equal(facets, b.facets);
}
inline bool equal(const ConstantBackground& a, const ConstantBackground& b) {
  const auto& [color] = a;
  return color == b.color;
}
inline bool equal(const GradientBackground& a, const GradientBackground& b) {
  const auto& [bottom, horizon, top] = a;
  return bottom == b.bottom && horizon == b.horizon && top == b.top;
}
inline bool equal(const DirectionalLight& a, const DirectionalLight& b) {
  const auto& [direction] = a;
  return direction == b.direction;
}
inline bool equal(const PointLight& a, const PointLight& b) {
  const auto& [position, falloff, least_distance] = a;
  return position == b.position && falloff == b.falloff && least_distance == b.least_distance;
}
inline bool equal(const SpotLight& a, const SpotLight& b) {
  const auto& [position, direction, angle, inner_angle, falloff, least_distance] = a;
  return position == b.position && direction == b.direction && angle == b.angle && inner_angle == b.inner_angle &&
         falloff == b.falloff && least_distance == b.least_distance;
}
inline bool equal(const CheckerPattern& a, const CheckerPattern& b) {
  const auto& [even, odd, size, plane, space, offset, filtered] = a;
  return even == b.even && odd == b.odd && size == b.size && plane == b.plane && space == b.space &&
         offset == b.offset && filtered == b.filtered;
}
inline bool equal(const StripesPattern& a, const StripesPattern& b) {
  const auto& [even, odd, size, direction, smooth, space, offset, filtered] = a;
  return even == b.even && odd == b.odd && size == b.size && direction == b.direction && smooth == b.smooth &&
         space == b.space && offset == b.offset && filtered == b.filtered;
}
inline bool equal(const NoisePattern& a, const NoisePattern& b) {
  const auto& [low, high, size, octaves, gain, contrast, seed, space, offset, filtered] = a;
  return low == b.low && high == b.high && size == b.size && octaves == b.octaves && gain == b.gain &&
         contrast == b.contrast && seed == b.seed && space == b.space && offset == b.offset && filtered == b.filtered;
}
inline bool equal(const BumpDescription& a, const BumpDescription& b) {
  const auto& [kind, amplitude, size, octaves, gain, seed, offset, direction, space] = a;
  return kind == b.kind && amplitude == b.amplitude && size == b.size && octaves == b.octaves && gain == b.gain &&
         seed == b.seed && offset == b.offset && direction == b.direction && space == b.space;
}
inline bool equal(const HighlightDescription& a, const HighlightDescription& b) {
  const auto& [weight, exponent, table] = a;
  return weight == b.weight && exponent == b.exponent &&
         std::equal(table.begin(), table.end(), b.weight_by_angle.begin(), b.weight_by_angle.end(),
                    [](const AngleWeight& x, const AngleWeight& y) {
                      const auto& [angle, point_weight] = x;
                      return angle == y.angle && point_weight == y.weight;
                    });
}
inline bool equal(const FaceGroup& a, const FaceGroup& b) {
  const auto& [name, material, first, count] = a;
  return name == b.name && material == b.material && first == b.first_face && count == b.face_count;
}
inline bool equal(const std::vector<FaceGroup>& a, const std::vector<FaceGroup>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const auto& x, const auto& y) { return equal(x, y); });
}
inline bool equal(const SubdivisionRules& a, const SubdivisionRules& b) {
  const auto& [scheme, boundary, face_varying, method, triangles, angle, creases, corners, holes] = a;
  return scheme == b.scheme && boundary == b.boundary && face_varying == b.face_varying && method == b.crease_method &&
         triangles == b.triangles && angle == b.crease_angle && holes == b.holes &&
         std::equal(creases.begin(), creases.end(), b.creases.begin(), b.creases.end(),
                    [](const Crease& x, const Crease& y) {
                      const auto& [vertices, sharpness] = x;
                      return vertices == y.vertices && sharpness == y.sharpness;
                    }) &&
         std::equal(corners.begin(), corners.end(), b.corners.begin(), b.corners.end(),
                    [](const SharpCorner& x, const SharpCorner& y) {
                      const auto& [vertex, sharpness] = x;
                      return vertex == y.vertex && sharpness == y.sharpness;
                    });
}
inline bool equal(const std::optional<SubdivisionRules>& a, const std::optional<SubdivisionRules>& b) {
  return a.has_value() == b.has_value() && (!a || equal(*a, *b));
}
inline bool equal(const PolygonMesh& a, const PolygonMesh& b) {
  const auto& [origin, positions, sizes, corners, normals, normal_corners, uv, uv_corners, groups, libraries, tags] = a;
  return origin == b.origin && positions == b.positions && sizes == b.face_sizes && corners == b.corners &&
         normals == b.normals && normal_corners == b.normal_corners && uv == b.texture_coordinates &&
         uv_corners == b.texture_corners && equal(groups, b.groups) && libraries == b.material_libraries &&
         equal(tags, b.subdivision);
}
inline bool equal(const MeshShape& a, const MeshShape& b) {
  const auto& [file, normals, angle, subdivision, mesh] = a;
  return file == b.file && normals == b.normals && angle == b.crease_angle && equal(subdivision, b.subdivision) &&
         !mesh == !b.mesh && (!mesh || equal(*mesh, *b.mesh));
}
inline bool equal(const PatchesShape& a, const PatchesShape& b) {
  const auto& [file, positions, weights, bezier, coons, lathe, angle, flip, normals] = a;
  return file == b.file && positions == b.positions && weights == b.weights && bezier == b.bezier && coons == b.coons &&
         lathe == b.lathe && angle == b.crease_angle && flip == b.flip && normals == b.degenerate_normals;
}
inline bool equal(const SphereShape& a, const SphereShape& b) {
  const auto& [center, radius, sides, stacks] = a;
  return center == b.center && radius == b.radius && sides == b.sides && stacks == b.stacks;
}
inline bool equal(const PlaneShape& a, const PlaneShape& b) {
  const auto& [point, normal] = a;
  return point == b.point && normal == b.normal;
}
inline bool equal(const ConeShape& a, const ConeShape& b) {
  const auto& [base, apex, base_radius, apex_radius, sides, stacks] = a;
  return base == b.base && apex == b.apex && base_radius == b.base_radius && apex_radius == b.apex_radius &&
         sides == b.sides && stacks == b.stacks;
}
inline bool equal(const DiscShape& a, const DiscShape& b) {
  const auto& [center, normal, radius, sides] = a;
  return center == b.center && normal == b.normal && radius == b.radius && sides == b.sides;
}
inline bool equal(const TerrainShape& a, const TerrainShape& b) {
  const auto& [triangles, size, height, roughness, seed] = a;
  return triangles == b.triangles && size == b.size && height == b.height && roughness == b.roughness && seed == b.seed;
}
inline bool equal(const SphereFlakeShape& a, const SphereFlakeShape& b) {
  const auto& [levels, center, radius] = a;
  return levels == b.levels && center == b.center && radius == b.radius;
}
inline bool equal(const TreeShape& a, const TreeShape& b) {
  const auto& [species, part, height, leaves, leaf_size, seed] = a;
  return species == b.species && part == b.part && height == b.height && leaves == b.leaves &&
         leaf_size == b.leaf_size && seed == b.seed;
}
inline bool equal(const InstanceShape& a, const InstanceShape& b) {
  const auto& [group] = a;
  return group == b.group;
}
inline bool equal(const ScatterShape& a, const ScatterShape& b) {
  const auto& [group, terrain, count, least, largest, lowest, highest, steepest, sink, clearings, size, seed] = a;
  return group == b.group && terrain == b.terrain && count == b.count && least == b.least_scale &&
         largest == b.largest_scale && lowest == b.lowest && highest == b.highest && steepest == b.steepest &&
         sink == b.sink && clearings == b.clearings && size == b.clearing_size && seed == b.seed;
}
template <class... T>
bool equal(const std::variant<T...>& a, const std::variant<T...>& b) {
  return a.index() == b.index() && std::visit([&]<class V>(const V& value) { return equal(value, std::get<V>(b)); }, a);
}
inline bool equal(const LightDescription& a, const LightDescription& b) {
  const auto& [name, color, kind] = a;
  return name == b.name && color == b.color && equal(kind, b.kind);
}
inline bool equal(const MaterialDescription& a, const MaterialDescription& b) {
  const auto& [name, diffuse, ambient, highlight, reflection, transmission, index, fresnel, conductor, absorption, thin,
               one_sided, priority, bump, roughness] = a;
  return name == b.name && equal(diffuse, b.diffuse) && ambient.has_value() == b.ambient.has_value() &&
         (!ambient || equal(*ambient, *b.ambient)) && equal(highlight, b.highlight) && reflection == b.reflection &&
         transmission == b.transmission && index == b.index_of_refraction && fresnel == b.fresnel &&
         conductor == b.conductor && absorption == b.absorption && thin == b.thin && one_sided == b.one_sided &&
         priority == b.priority && bump.has_value() == b.bump.has_value() && (!bump || equal(*bump, *b.bump)) &&
         roughness == b.roughness;
}
/// All but where it stood in its file.
inline bool equal(const std::optional<Smoothing>& a, const std::optional<Smoothing>& b) {
  if (!a || !b) return a.has_value() == b.has_value();
  const auto& [method, crease_angle, across_pieces] = *a;
  return method == b->method && crease_angle == b->crease_angle && across_pieces == b->across_pieces;
}
inline bool equal(const ShapeDescription& a, const ShapeDescription& b) {
  const auto& [name, material, transform, shading, interpolation, smoothing, half_distance, kind, where] = a;
  (void)where;
  return name == b.name && material == b.material && transform == b.transform && shading == b.shading &&
         interpolation == b.interpolation && equal(smoothing, b.smoothing) && half_distance == b.half_distance &&
         equal(kind, b.kind);
}
template <Named T>
bool equal(const std::vector<T>& a, const std::vector<T>& b);
/// All but where it stood in its file.
inline bool equal(const GroupDescription& a, const GroupDescription& b) {
  const auto& [name, shapes, where] = a;
  (void)where;
  return name == b.name && equal(shapes, b.shapes);
}
template <Named T>
bool equal(const std::vector<T>& a, const std::vector<T>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const T& x, const T& y) { return equal(x, y); });
}
/// All but name and folder, which a file does not hold.
inline bool equal(const SceneDescription& a, const SceneDescription& b) {
  const auto& [name, folder, title, image, render, background, ambient, cameras, lights, materials, groups, shapes] = a;
  (void)name;
  (void)folder;
  return title == b.title && equal(image, b.image) && equal(render, b.render) && equal(background, b.background) &&
         ambient == b.ambient && equal(cameras, b.cameras) && equal(lights, b.lights) &&
         equal(materials, b.materials) && equal(groups, b.groups) && equal(shapes, b.shapes);
}

}  // namespace raytree::test
