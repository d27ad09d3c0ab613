// The tables of a scene file: for each struct of scene_description.h which key fills which member, what it means, in
// which unit and range. Reader, writer, schema, --set and the reference in docs/scene-format.md all walk these
// tables, so none can know a key that another does not. Defaults are those of default-constructed structs.
#pragma once

#include <array>
#include <concepts>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "geometry/facet_pattern.h"
#include "renderer/builtin_materials.h"
#include "renderer/scene_description.h"

namespace raytree {

/// Numbers beyond are refused: their squares would leave float, and Embree sees nothing past 1.8e18.
inline constexpr double kLargestNumber = 1e18;
inline constexpr std::int64_t kMaxPixels = std::int64_t(1) << 30;  ///< width * height
inline constexpr int kMaxGridSize = 64;                            ///< of antialias "grid:N"
inline constexpr int kMaxSamplingLevels = 6;                       ///< 2^6: as fine as the largest grid
inline constexpr int kMaxPatternOctaves = 16;                      ///< of noise

/// What a number, or each component of a vector or color, may be.
struct Range {
  double low = -kLargestNumber;
  double high = kLargestNumber;
  bool low_open = false;   ///< `low` itself is refused
  bool high_open = false;  ///< `high` itself is refused

  constexpr bool holds(double x) const { return (low_open ? x > low : x >= low) && (high_open ? x < high : x <= high); }
};
inline constexpr Range kNotNegative{0};
inline constexpr Range kPositive{0, kLargestNumber, true};

/// One key: what everybody who walks a table is told about it.
struct Field {
  std::string_view key = {};
  std::string_view text = {};    ///< for schema and reference; a sentence without its period
  std::string_view unit = {};    ///< empty: none
  Range range = {};              ///< of numbers
  bool required = false;         ///< the reader refuses an object without it
  bool nonzero = false;          ///< a vector that must not be (0, 0, 0)
  std::string_view absent = {};  ///< what happens without the key, where no default value says so
};

// --- enumerations -------------------------------------------------------------------------------------------

template <class E>
struct EnumEntry {
  E value;
  std::string_view name;
  std::string_view text;
};

template <class E>
struct EnumTable;  // specialized below: `entries`

template <>
struct EnumTable<CameraDescription::Projection> {
  using E = CameraDescription::Projection;
  static constexpr std::array<EnumEntry<E>, 2> entries{
      {{E::perspective, "perspective", "uses field_of_view"}, {E::orthographic, "orthographic", "uses height"}}};
};
template <>
struct EnumTable<HighlightForm> {
  using E = HighlightForm;
  static constexpr std::array<EnumEntry<E>, 2> entries{
      {{E::reflected, "reflected", "angle between reflected light and line of sight, Phong 1973, eq. 4.5"},
       {E::halfway, "halfway", "angle between normal and halfway vector, Whitted 1980, eq. 1"}}};
};
template <>
struct EnumTable<ShadingMethod> {
  using E = ShadingMethod;
  static constexpr std::array<EnumEntry<E>, 4> entries{
      {{E::flat, "flat", "one normal a facet"},
       {E::gouraud, "gouraud",
        "light is found at the facet's corners, highlights too, and interpolated (Gouraud 1971)"},
       {E::phong, "phong", "the corners' normals are interpolated and made unit (Phong 1973)"},
       {E::limit, "limit", "the normal of the surface that the facets stand for; as phong where there is none"}}};
};
template <>
struct EnumTable<FacetInterpolation> {
  using E = FacetInterpolation;
  static constexpr std::array<EnumEntry<E>, 3> entries{
      {{E::barycentric, "barycentric", "linear over the triangles that polygons are cut in"},
       {E::bilinear, "bilinear", "quads by the parameters of a bilinear patch, larger ones by mean value coordinates"},
       {E::scanline, "scanline",
        "along edges, then along the picture's rows, as in 1971: it changes as a polygon turns"}}};
};
template <>
struct EnumTable<Smoothing::Method> {
  using E = Smoothing::Method;
  static constexpr std::array<EnumEntry<E>, 7> entries{
      {{E::angle, "angle", "mean of unit normals of the facets, weighted by their angle at the vertex"},
       {E::unit, "unit", "mean of unit normals"},
       {E::area, "area", "weighted by area, Phong 1973, eq. 4.2"},
       {E::edges, "edges", "eq. 4.1 over the number of edges: facets of fewer edges count more"},
       {E::terminating_edges, "terminating_edges", "sum of cross products of the edges that end there, eq. 4.3"},
       {E::corners, "corners", "mean of those cross products made unit (Gouraud 1971, p. 30)"},
       {E::analytic, "analytic", "the surface's own, of curved surfaces and of round shapes with `sides`"}}};
};
template <>
struct EnumTable<ShadowTerminator> {
  using E = ShadowTerminator;
  static constexpr std::array<EnumEntry<E>, 2> entries{
      {{E::classic, "classic", "shadow rays start on the facet, whose neighbors shade it where the light grazes"},
       {E::offset, "offset", "they start off it, where the vertex normals say that the surface is (Hanika 2021)"}}};
};
template <>
struct EnumTable<FacetReflections> {
  using E = FacetReflections;
  static constexpr std::array<EnumEntry<E>, 3> entries{
      {{E::classic, "classic", "rays mirrored to below their facet are followed, and meet it"},
       {E::clamped, "clamped", "they are turned back above it"},
       {E::consistent, "consistent",
        "normals are bent so that none leads below it, continuously (Reshetov, Soupikov and Mark 2010)"}}};
};
template <>
struct EnumTable<Falloff> {
  using E = Falloff;
  static constexpr std::array<EnumEntry<E>, 3> entries{
      {{E::none, "none", "the same at every distance"},
       {E::linear, "linear", "1 / d, at most 1 / least_distance"},
       {E::inverse_square, "inverse_square", "1 / d^2, at most 1 / least_distance^2"}}};
};
template <>
struct EnumTable<CheckerPattern::Plane> {
  using E = CheckerPattern::Plane;
  static constexpr std::array<EnumEntry<E>, 4> entries{{{E::xz, "xz", "x and z, a floor"},
                                                        {E::xy, "xy", "x and y, a wall"},
                                                        {E::yz, "yz", "y and z, a side wall"},
                                                        {E::uv, "uv", "the surface's texture coordinates"}}};
};
inline constexpr std::string_view kObjectSpaceText =
    "the shape's own space, before its transform and those of instances, so it is carried with the shape";
inline constexpr std::string_view kWorldSpaceText = "world space, so it lies still and shapes move through it";
template <>
struct EnumTable<SolidSpace> {
  using E = SolidSpace;
  static constexpr std::array<EnumEntry<E>, 2> entries{
      {{E::object, "object", kObjectSpaceText}, {E::world, "world", kWorldSpaceText}}};
};
template <>
struct EnumTable<PatternSpace> {
  using E = PatternSpace;
  static constexpr std::array<EnumEntry<E>, 3> entries{{{E::object, "object", kObjectSpaceText},
                                                        {E::world, "world", kWorldSpaceText},
                                                        {E::uv, "uv", "the surface's texture coordinates (u, v, 0)"}}};
};
template <>
struct EnumTable<BumpDescription::Kind> {
  using E = BumpDescription::Kind;
  static constexpr std::array<EnumEntry<E>, 4> entries{{{E::noise, "noise", "soft dents and swellings"},
                                                        {E::wrinkles, "wrinkles", "ridges that run where noise is 0"},
                                                        {E::ripples, "ripples", "sine waves in circles about `offset`"},
                                                        {E::stripes, "stripes", "sine waves along `direction`"}}};
};
template <>
struct EnumTable<NormalSource> {
  using E = NormalSource;
  static constexpr std::array<EnumEntry<E>, 3> entries{
      {{E::file, "file", "the mesh's own; as smooth where it has none"},
       {E::smooth, "smooth", "angle-weighted mean of the faces within crease_angle"},
       {E::flat, "flat", "the face's own"}}};
};
template <>
struct EnumTable<DegenerateNormal> {
  using E = DegenerateNormal;
  static constexpr std::array<EnumEntry<E>, 4> entries{
      {{E::limit, "limit", "the limit of the normals that lie inside the patch"},
       {E::first_order, "first_order", "first-order expansion of P_u x P_v toward the inside, as OpenSubdiv has it"},
       {E::gouraud, "gouraud", "the cross product of the two boundaries' tangents, Gouraud 1971, p. 27-28"},
       {E::none, "none", "nothing: the mean normal of the patch"}}};
};
template <>
struct EnumTable<SubdivisionScheme> {
  using E = SubdivisionScheme;
  static constexpr std::array<EnumEntry<E>, 3> entries{
      {{E::catmark, "catmark", "Catmull-Clark, for faces of any size"},
       {E::loop, "loop", "Loop, for triangles alone"},
       {E::bilinear, "bilinear", "the faces themselves, quads bilinear"}}};
};
template <>
struct EnumTable<BoundaryRule> {
  using E = BoundaryRule;
  static constexpr std::array<EnumEntry<E>, 3> entries{
      {{E::none, "none", "faces at the boundary have no surface"},
       {E::edge_only, "edge_only", "the surface reaches the boundary and rounds its corners"},
       {E::edge_and_corner, "edge_and_corner", "and corners that one face alone has stay where they are"}}};
};
template <>
struct EnumTable<FaceVaryingRule> {
  using E = FaceVaryingRule;
  static constexpr std::array<EnumEntry<E>, 6> entries{
      {{E::none, "none", "nowhere"},
       {E::corners_only, "corners_only", "at corners of islands"},
       {E::corners_plus1, "corners_plus1", "and where three or more islands meet"},
       {E::corners_plus2, "corners_plus2", "and at darts"},
       {E::boundaries, "boundaries", "along outlines of islands"},
       {E::all, "all", "everywhere: bilinear"}}};
};
template <>
struct EnumTable<CreaseMethod> {
  using E = CreaseMethod;
  static constexpr std::array<EnumEntry<E>, 2> entries{{{E::uniform, "uniform", "sharpness falls by one at each level"},
                                                        {E::chaikin, "chaikin", "and is smoothed along the crease"}}};
};
template <>
struct EnumTable<TriangleRule> {
  using E = TriangleRule;
  static constexpr std::array<EnumEntry<E>, 2> entries{
      {{E::catmark, "catmark", "as any other face"}, {E::smooth, "smooth", "weights that leave fewer ripples"}}};
};
template <>
struct EnumTable<TreeSpecies> {
  using E = TreeSpecies;
  static constexpr std::array<EnumEntry<E>, 2> entries{
      {{E::broadleaf, "broadleaf", "a forked crown of leaves"}, {E::conifer, "conifer", "whorls of drooping boughs"}}};
};
template <>
struct EnumTable<TreePart> {
  using E = TreePart;
  static constexpr std::array<EnumEntry<E>, 2> entries{
      {{E::wood, "wood", "trunk and branches"}, {E::leaves, "leaves", "leaves or needles alone"}}};
};

// --- alternatives of a variant, told apart by the key "type" ------------------------------------------------

inline constexpr std::string_view kTypeKey = "type";

template <class T>
struct Alternative;  // specialized below: `name` and `text`

template <>
struct Alternative<ConstantBackground> {
  static constexpr std::string_view name = "constant", text = "one color in every direction";
};
template <>
struct Alternative<GradientBackground> {
  static constexpr std::string_view name = "gradient", text = "blend by the height of the direction";
};
template <>
struct Alternative<DirectionalLight> {
  static constexpr std::string_view name = "directional", text = "light at infinity (Whitted's and Phong's)";
};
template <>
struct Alternative<PointLight> {
  static constexpr std::string_view name = "point", text = "light from a point, to all sides";
};
template <>
struct Alternative<SpotLight> {
  static constexpr std::string_view name = "spot", text = "light from a point, within a cone";
};
template <>
struct Alternative<CheckerPattern> {
  static constexpr std::string_view name = "checker", text = "squares of two colors";
};
template <>
struct Alternative<StripesPattern> {
  static constexpr std::string_view name = "stripes", text = "layers of two colors across a direction";
};
template <>
struct Alternative<NoisePattern> {
  static constexpr std::string_view name = "noise", text = "octaves of solid gradient noise between two colors";
};
template <>
struct Alternative<MeshShape> {
  static constexpr std::string_view name = "mesh",
                                    text = "polygons from `file`, or given here as `positions` and `faces`";
};
template <>
struct Alternative<PatchesShape> {
  static constexpr std::string_view name = "patches",
                                    text =
                                        "bicubic Bezier patches and Coons patches, rational ones too, from `file`, or "
                                        "given here as `positions` and lists of indices";
};
template <>
struct Alternative<SphereShape> {
  static constexpr std::string_view name = "sphere", text = "an exact sphere";
};
template <>
struct Alternative<PlaneShape> {
  static constexpr std::string_view name = "plane", text = "an infinite plane";
};
template <>
struct Alternative<DiscShape> {
  static constexpr std::string_view name = "disc", text = "a flat disc";
};
template <>
struct Alternative<ConeShape> {
  static constexpr std::string_view name = "cone",
                                    text = "an exact cone or cylinder without caps, cut off at both ends";
};
template <>
struct Alternative<TerrainShape> {
  static constexpr std::string_view name = "terrain",
                                    text = "a fractal height field over the square [-size/2, size/2] in x and z";
};
template <>
struct Alternative<SphereFlakeShape> {
  static constexpr std::string_view name = "sphere_flake",
                                    text = "a sphere that carries nine smaller ones, each of which carries nine";
};
template <>
struct Alternative<TreeShape> {
  static constexpr std::string_view name = "tree",
                                    text = "half of a tree on the origin, growing along y: its wood or its leaves";
};
template <>
struct Alternative<InstanceShape> {
  static constexpr std::string_view name = "instance",
                                    text =
                                        "one use of a group of shapes; a material given here takes the place of all "
                                        "of the group's";
};
template <>
struct Alternative<ScatterShape> {
  static constexpr std::string_view name = "scatter",
                                    text =
                                        "uses of a group spread over a terrain, upright, each turned and scaled at "
                                        "random; as instance";
};

// --- forms that exist in files only -------------------------------------------------------------------------

/// The key "raytree": always kSceneVersion once read.
struct SceneVersion {
  int value = kSceneVersion;
};

/// The key "from" of a material: its values are there before those of the other keys. Never kept.
struct MaterialBase {
  std::string name;
};

/// Three factors, in a file also one number for all three.
struct ScaleFactors {
  Vec3d value{1, 1, 1};
};

/// One step of a shape's transform: scale, then rotate, then translate; or a matrix alone.
struct TransformStep {
  std::optional<ScaleFactors> scale;
  std::optional<Vec3d> rotate;
  std::optional<Vec3d> translate;
  std::optional<Matrix44d> matrix;
};

/// Polygons as lists of indices, with the lines they stand on for messages (0: not from a file).
struct FaceLists {
  std::vector<std::uint32_t> sizes;
  std::vector<std::uint32_t> corners;
  std::vector<std::uint32_t> lines;
};

/// A polygon mesh as a scene file gives it.
struct InlineMesh {
  std::optional<Vec3d> origin;
  std::vector<Vec3d> positions;
  FaceLists faces;
  std::vector<Vec3f> vertex_normals;
  FaceLists normal_faces;
  std::vector<Vec2f> texture_coordinates;
  FaceLists texture_faces;
  std::vector<FaceGroup> groups;
};

// --- the tables ---------------------------------------------------------------------------------------------
// visit_fields(visit, object) calls visit(Field, member) for each key in the order of the reference,
// visit.tagged(Field, variant) where the key "type" chooses among structs whose keys stand beside it, and
// visit.inlined(mesh) where InlineMesh's keys stand for a PolygonMesh.

template <class T, class Struct>
concept Is = std::same_as<std::remove_const_t<T>, Struct>;

template <class Visitor, Is<ImageDescription> T>
void visit_fields(Visitor& visit, T& image) {
  visit(
      Field{.key = "width", .text = "Width; width times height is at most 2^30", .unit = "pixels", .range = {1, 65536}},
      image.width);
  visit(Field{.key = "height", .text = "Height", .unit = "pixels", .range = {1, 65536}}, image.height);
}

template <class Visitor, Is<AdaptiveSampling> T>
void visit_fields(Visitor& visit, T& adaptive) {
  visit(Field{.key = "threshold",
              .text = "A square of a pixel is divided in four where its corners differ by more than this over its edge "
                      "in pixels; differences are those of a display, black to white is 1",
              .range = kNotNegative},
        adaptive.threshold);
  visit(Field{.key = "levels",
              .text = "How often a pixel is divided at most; samples lie no closer than 2^-levels pixels",
              .range = {0, kMaxSamplingLevels}},
        adaptive.levels);
  visit(Field{.key = "minimum_level",
              .text = "How often every pixel is divided whatever its corners show; at most `levels`",
              .range = {0, kMaxSamplingLevels}},
        adaptive.minimum_level);
}

template <class Visitor, Is<TessellationSettings> T>
void visit_fields(Visitor& visit, T& tessellation) {
  visit(
      Field{.key = "tolerance",
            .text = "How far facets may lie off the limit surface as the camera sees it, in the picture; four times as "
                    "far along the line of sight and where the frame does not reach. Normals of facets "
                    "of 6 pixels and more are off by no more than a shift of as many pixels turns them; of smaller "
                    "ones, and beside extraordinary vertices and semi-sharp creases, of eight times as many",
            .unit = "pixels",
            .range = kPositive},
      tessellation.tolerance);
  visit(Field{.key = "rate",
              .text = "Segments that every edge of a surface is cut in; 0: as many as the tolerance asks for",
              .range = {0, kLargestRate}},
        tessellation.rate);
}

template <class Visitor, Is<FacetSettings> T>
void visit_fields(Visitor& visit, T& facets) {
  visit(Field{.key = "shading",
              .text = "Shading of all facets, in place of what shapes ask for",
              .absent = "as shapes ask for"},
        facets.shading);
  visit(Field{.key = "shadow_terminator", .text = "Where shadow rays start on facets with vertex normals of their own"},
        facets.shadow_terminator);
  visit(Field{.key = "reflections", .text = "What keeps mirrored directions above facets with such normals"},
        facets.reflections);
}

template <class Visitor, Is<RenderSettings> T>
void visit_fields(Visitor& visit, T& render) {
  visit(Field{.key = "depth", .text = "Levels of the ray tree; the eye ray is level 1", .range = {1, kMaxDepth}},
        render.depth);
  visit(Field{.key = "cutoff",
              .text = "Largest radiance per channel that cutting branches of the tree may take from a sample; 0 cuts "
                      "none",
              .unit = "radiance",
              .range = kNotNegative},
        render.cutoff);
  visit(Field{.key = "antialias",
              .text = "\"none\" traces pixel centers, \"grid:N\" the centers of N x N equal cells of a pixel, N from 1 "
                      "to 64, \"whitted\" the corners of pixels and more samples where those differ"},
        render.antialias);
  visit(Field{.key = "adaptive", .text = "How \"whitted\" divides pixels"}, render.adaptive);
  visit(Field{.key = "highlights", .text = "Form of the highlight"}, render.highlights);
  visit(Field{.key = "shadows", .text = "Whether things cast shadows"}, render.shadows);
  visit(Field{.key = "transparent_shadows",
              .text = "Whether light passes through what transmits, straight on: k_t for each surface that it crosses, "
                      "and absorption inside"},
        render.transparent_shadows);
  visit(Field{.key = "shadowed_highlights",
              .text = "Whether a shadow takes the highlight too (Whitted names the diffuse term only)"},
        render.shadowed_highlights);
  visit(Field{.key = "fresnel",
              .text = "Weights k_s F and k_t (1 - F) by Fresnel's formulas in place of constant k_s and k_t"},
        render.fresnel);
  visit(Field{.key = "distance_attenuation",
              .text = "a of max(0, 1 - a t) on reflected and refracted segments; 0 is off",
              .unit = "per scene unit",
              .range = kNotNegative},
        render.distance_attenuation);
  visit(Field{.key = "rough_samples",
              .text = "How many facets stand for a rough surface where a way down the tree first meets one; what lies "
                      "behind takes one each",
              .range = {1, kMaxRoughSamples}},
        render.rough_samples);
  visit(Field{.key = "tessellation", .text = "How finely curved surfaces are cut in triangles"}, render.tessellation);
  visit(Field{.key = "facets", .text = "How facets are shaded, over all shapes"}, render.facets);
}

template <class Visitor, Is<CameraDescription> T>
void visit_fields(Visitor& visit, T& camera) {
  visit(Field{.key = "projection", .text = "Kind of projection"}, camera.projection);
  visit(Field{.key = "position", .text = "Where the eye is", .unit = "scene units"}, camera.position);
  visit(Field{.key = "target",
              .text = "Point that the middle of the picture shows; not the position",
              .unit = "scene units"},
        camera.target);
  visit(Field{.key = "up", .text = "Direction that is up in the picture; not along the line of sight", .nonzero = true},
        camera.up);
  visit(Field{.key = "field_of_view",
              .text = "Perspective: vertical angle of view",
              .unit = "degrees",
              .range = {0, 180, true, true}},
        camera.field_of_view);
  visit(Field{.key = "height", .text = "Orthographic: height of the window", .unit = "scene units", .range = kPositive},
        camera.height);
}

template <class Visitor, Is<ConstantBackground> T>
void visit_fields(Visitor& visit, T& background) {
  visit(Field{.key = "color", .text = "Radiance of what lies behind everything", .range = kNotNegative},
        background.color);
}

template <class Visitor, Is<GradientBackground> T>
void visit_fields(Visitor& visit, T& background) {
  visit(Field{.key = "bottom", .text = "Radiance straight down", .range = kNotNegative}, background.bottom);
  visit(Field{.key = "horizon", .text = "Radiance at the level of the eye", .range = kNotNegative}, background.horizon);
  visit(Field{.key = "top", .text = "Radiance straight up", .range = kNotNegative}, background.top);
}

template <class Visitor, Is<DirectionalLight> T>
void visit_fields(Visitor& visit, T& light) {
  visit(Field{.key = "direction", .text = "The way the light travels; any length but zero", .nonzero = true},
        light.direction);
}

/// What lights that stand somewhere have in common.
template <class Visitor, class Light>
void visit_falloff(Visitor& visit, Light& light) {
  visit(Field{.key = "falloff", .text = "How the light weakens with distance d"}, light.falloff);
  visit(Field{.key = "least_distance",
              .text = "With falloff: nearer than this the light grows no stronger",
              .unit = "scene units",
              .range = {kLeastLightDistance}},
        light.least_distance);
}

template <class Visitor, Is<PointLight> T>
void visit_fields(Visitor& visit, T& light) {
  visit(Field{.key = "position", .text = "Where the light is", .unit = "scene units"}, light.position);
  visit_falloff(visit, light);
}

template <class Visitor, Is<SpotLight> T>
void visit_fields(Visitor& visit, T& light) {
  visit(Field{.key = "position", .text = "Where the light is", .unit = "scene units"}, light.position);
  visit(Field{.key = "direction",
              .text = "The cone's axis, the way the light travels; any length but zero",
              .nonzero = true},
        light.direction);
  visit(Field{.key = "angle",
              .text = "Between the cone's axis and its border, where the light ends",
              .unit = "degrees",
              .range = {0, 180, true}},
        light.angle);
  visit(Field{.key = "inner_angle",
              .text = "Up to which the light is full; at most `angle`, between the two it fades",
              .unit = "degrees",
              .range = {0, 180}},
        light.inner_angle);
  visit_falloff(visit, light);
}

template <class Visitor, Is<LightDescription> T>
void visit_fields(Visitor& visit, T& light) {
  visit.tagged(Field{.key = kTypeKey, .text = "Kind of light", .required = true}, light.kind);
  visit(Field{.key = "color", .text = "Intensity; of a light with falloff, that at distance 1", .range = kNotNegative},
        light.color);
}

template <class Visitor, class Kind>
void visit_filtered(Visitor& visit, Kind& pattern) {
  visit(Field{.key = "filtered",
              .text = "Whether what the eye sees directly is the mean over the sample's share of the picture, not one "
                      "point (not over uv)"},
        pattern.filtered);
}

template <class Visitor, Is<CheckerPattern> T>
void visit_fields(Visitor& visit, T& checker) {
  visit(Field{.key = "even", .text = "Color of the square at `offset` and of every second one", .range = kNotNegative},
        checker.even);
  visit(Field{.key = "odd", .text = "Color of the squares between", .range = kNotNegative}, checker.odd);
  visit(Field{.key = "size",
              .text = "Edge of a square",
              .unit = "units of space, or of texture for uv",
              .range = kPositive},
        checker.size);
  visit(Field{.key = "plane", .text = "The two coordinates that the squares lie over"}, checker.plane);
  visit(Field{.key = "space", .text = "The space of these coordinates; nothing to uv"}, checker.space);
  visit(Field{.key = "offset", .text = "Where a corner of an even square lies", .unit = "as size"}, checker.offset);
  visit_filtered(visit, checker);
}

template <class Visitor, Is<StripesPattern> T>
void visit_fields(Visitor& visit, T& stripes) {
  visit(Field{.key = "even",
              .text = "Color of the stripe that begins at `offset` and of every second one",
              .range = kNotNegative},
        stripes.even);
  visit(Field{.key = "odd", .text = "Color of the stripes between", .range = kNotNegative}, stripes.odd);
  visit(Field{.key = "size",
              .text = "Width of a stripe",
              .unit = "units of space, or of texture for uv",
              .range = kPositive},
        stripes.size);
  visit(Field{.key = "direction", .text = "Across the stripes; any length but zero", .nonzero = true},
        stripes.direction);
  visit(Field{.key = "smooth", .text = "Whether the colors pass into each other, as a sine does"}, stripes.smooth);
  visit(Field{.key = "space", .text = "What the stripes lie over"}, stripes.space);
  visit(Field{.key = "offset", .text = "A point where an even stripe begins", .unit = "as size"}, stripes.offset);
  visit_filtered(visit, stripes);
}

/// What sums of octaves have in common.
template <class Visitor, class Sum>
void visit_octaves(Visitor& visit, Sum& sum) {
  visit(Field{.key = "octaves",
              .text = "Number of layers of noise, each twice as fine as the one before",
              .range = {1, kMaxPatternOctaves}},
        sum.octaves);
  visit(Field{.key = "gain", .text = "Ratio of the heights of successive octaves", .range = {0, 1}}, sum.gain);
  visit(Field{.key = "seed", .text = "Another number, another noise", .range = {0, 4294967295.0}}, sum.seed);
}

template <class Visitor, Is<NoisePattern> T>
void visit_fields(Visitor& visit, T& noise) {
  visit(Field{.key = "low", .text = "Color where the noise is low", .range = kNotNegative}, noise.low);
  visit(Field{.key = "high", .text = "Color where the noise is high", .range = kNotNegative}, noise.high);
  visit(Field{.key = "size",
              .text = "Edge of a cell of the first octave: blotches are about as large",
              .unit = "units of space, or of texture for uv",
              .range = kPositive},
        noise.size);
  visit_octaves(visit, noise);
  visit(Field{.key = "contrast",
              .text = "The share of `high` is 1/2 + contrast n / 2 for a noise n of mean 0 and deviation .27, kept "
                      "between 0 and 1",
              .range = kNotNegative},
        noise.contrast);
  visit(Field{.key = "space", .text = "What the noise lies over"}, noise.space);
  visit(Field{.key = "offset", .text = "A corner of a cell", .unit = "as size"}, noise.offset);
  visit_filtered(visit, noise);
}

template <class Visitor, Is<BumpDescription> T>
void visit_fields(Visitor& visit, T& bump) {
  visit(Field{.key = "kind", .text = "What the height looks like"}, bump.kind);
  visit(Field{.key = "amplitude",
              .text = "Height of the waves above their mean; noise and wrinkles deviate by about a quarter of it; less "
                      "than 0 sinks what was raised",
              .unit = "units of space"},
        bump.amplitude);
  visit(Field{.key = "size",
              .text = "Length of a wave; edge of a cell of the first octave",
              .unit = "units of space",
              .range = kPositive},
        bump.size);
  visit_octaves(visit, bump);
  visit(Field{.key = "offset", .text = "Where the height begins; the center of ripples", .unit = "as size"},
        bump.offset);
  visit(Field{.key = "direction", .text = "Stripes: across them; any length but zero", .nonzero = true},
        bump.direction);
  visit(Field{.key = "space", .text = "What it is measured in, and raised in"}, bump.space);
}

template <class Visitor, Is<AngleWeight> T>
void visit_fields(Visitor& visit, T& point) {
  visit(Field{.key = "angle",
              .text = "Of incidence, between the light and the normal",
              .unit = "degrees",
              .range = {0, 90},
              .required = true},
        point.angle);
  visit(Field{.key = "weight", .text = "W at this angle", .range = kNotNegative, .required = true}, point.weight);
}

template <class Visitor, Is<HighlightDescription> T>
void visit_fields(Visitor& visit, T& highlight) {
  visit(Field{.key = "weight", .text = "W of Phong 1973, eq. 4.5, times the light's color", .range = kNotNegative},
        highlight.weight);
  visit(Field{.key = "exponent",
              .text = "n of Phong 1973, eq. 4.5; larger is smaller and sharper",
              .range = {1, kLargestNumber}},
        highlight.exponent);
  visit(Field{.key = "weight_by_angle",
              .text = "W(i) of Phong 1973, eq. 4.5, in place of `weight` where it holds any points: in the order of "
                      "their angles, linear "
                      "between them, constant beyond"},
        highlight.weight_by_angle);
}

template <class Visitor, Is<MaterialDescription> T>
void visit_fields(Visitor& visit, T& material) {
  MaterialBase base;
  visit(Field{.key = "from", .text = "A built-in material whose values hold where no other key gives one"}, base);
  if constexpr (!std::is_const_v<T>)
    if (!base.name.empty()) take_values(*builtin_material(base.name), material);
  visit(Field{.key = "diffuse", .text = "k_d of Whitted 1980, eq. 2", .range = kNotNegative}, material.diffuse);
  visit(Field{.key = "ambient",
              .text = "Share of the scene's ambient light that is reflected",
              .range = kNotNegative,
              .absent = "as diffuse"},
        material.ambient);
  visit(Field{.key = "highlight", .text = "Highlight of the lights"}, material.highlight);
  visit(Field{.key = "reflection", .text = "k_s of Whitted 1980, eq. 2", .range = kNotNegative}, material.reflection);
  visit(Field{.key = "transmission", .text = "k_t of Whitted 1980, eq. 2", .range = kNotNegative},
        material.transmission);
  visit(Field{.key = "index_of_refraction",
              .text = "Of the inside over the outside; the geometric normal points outside",
              .range = kPositive},
        material.index_of_refraction);
  visit(Field{.key = "fresnel",
              .text = "Weights k_s F and k_t (1 - F) by Fresnel's formulas in place of constant k_s and k_t",
              .absent = "as render.fresnel"},
        material.fresnel);
  visit(Field{.key = "conductor",
              .text = "Whether `reflection` is that of a metal at normal incidence: k_s + (1 - k_s) (1 - cos i)^5 by "
                      "Schlick's formula; it transmits nothing"},
        material.conductor);
  visit(
      Field{.key = "absorption",
            .text = "a of exp(-a t): what a length t inside lets through. It acts on the way to a surface that is hit "
                    "from behind; where some material has a priority, on every way inside",
            .unit = "per scene unit",
            .range = kNotNegative},
      material.absorption);
  visit(Field{.key = "thin",
              .text = "Whether the surface is a sheet without an inside, which transmits without bending; with fresnel "
                      "it reflects what both faces of a thin pane do, 2F / (1 + F)"},
        material.thin);
  visit(
      Field{.key = "one_sided",
            .text = "Whether the surface is seen from its front alone, which the geometric normal points to: rays that "
                    "come from behind go on as if nothing were there. Shadows are cast to both sides; it transmits "
                    "nothing"},
      material.one_sided);
  visit(Field{.key = "priority",
              .text =
                  "Where media overlap, that of the highest priority is there, and surfaces of the others do nothing; "
                  "of equal ones that which was entered last. 0 in every material: media are not tracked, and a "
                  "surface separates its own inside from empty space",
              .range = {-1000, 1000}},
        material.priority);
  visit(Field{.key = "bump",
              .text = "A height that normals follow, and so light, but not the outline (Blinn 1978)",
              .absent = "smooth"},
        material.bump);
  visit(
      Field{.key = "roughness",
            .text = "Standard deviation of the slopes of facets that take the normal's place for reflected and "
                    "refracted rays (Whitted 1980, sec. 2); matches a highlight of exponent 1 / roughness^2 (halfway) "
                    "or 1 / (4 roughness^2) (reflected). 0 is polished",
            .range = {0, kMaxRoughness}},
      material.roughness);
}

template <class Visitor, Is<FaceGroup> T>
void visit_fields(Visitor& visit, T& group) {
  visit(Field{.key = "name", .text = "Name of the group"}, group.name);
  visit(Field{.key = "material", .text = "Material named by the mesh file that the group came from"}, group.material);
  visit(Field{.key = "first_face", .text = "Index of its first face", .range = {0, 4294967295.0}, .required = true},
        group.first_face);
  visit(Field{.key = "face_count", .text = "Number of its faces", .range = {0, 4294967295.0}, .required = true},
        group.face_count);
}

template <class Visitor, Is<InlineMesh> T>
void visit_fields(Visitor& visit, T& mesh) {
  visit(Field{.key = "origin",
              .text = "Added to every position, in double precision: positions themselves are single precision",
              .unit = "scene units",
              .absent = "chosen so that far from (0, 0, 0) nothing is lost; positions stay what the file says"},
        mesh.origin);
  visit(Field{.key = "positions", .text = "Vertices, relative to `origin` where that is given", .unit = "scene units"},
        mesh.positions);
  visit(Field{.key = "faces",
              .text = "Polygons of 3 or more indices into positions, zero-based, counter-clockwise from outside"},
        mesh.faces);
  visit(Field{.key = "vertex_normals", .text = "One normal a position, or what normal_faces refer to; any length"},
        mesh.vertex_normals);
  visit(Field{.key = "normal_faces",
              .text = "Indices into vertex_normals, in the shape of faces",
              .absent = "one normal a position"},
        mesh.normal_faces);
  visit(Field{.key = "texture_coordinates", .text = "One pair a position, or what texture_faces refer to"},
        mesh.texture_coordinates);
  visit(Field{.key = "texture_faces",
              .text = "Indices into texture_coordinates, in the shape of faces",
              .absent = "one pair a position"},
        mesh.texture_faces);
  visit(Field{.key = "groups", .text = "Runs of faces under a name, in order, that do not overlap"}, mesh.groups);
}

template <class Visitor, Is<Crease> T>
void visit_fields(Visitor& visit, T& crease) {
  visit(Field{.key = "vertices",
              .text = "Chain of two or more indices into positions, zero-based; each two in a row are an edge",
              .range = {0, 4294967295.0},
              .required = true},
        crease.vertices);
  visit(Field{.key = "sharpness",
              .text = "Levels of subdivision that it stays sharp for; from 10 on for ever",
              .range = kNotNegative},
        crease.sharpness);
}

template <class Visitor, Is<SharpCorner> T>
void visit_fields(Visitor& visit, T& corner) {
  visit(
      Field{.key = "vertex", .text = "Index into positions, zero-based", .range = {0, 4294967295.0}, .required = true},
      corner.vertex);
  visit(Field{.key = "sharpness", .text = "As a crease's", .range = kNotNegative}, corner.sharpness);
}

template <class Visitor, Is<SubdivisionRules> T>
void visit_fields(Visitor& visit, T& rules) {
  visit(Field{.key = "scheme", .text = "Scheme", .absent = "the file's; else catmark"}, rules.scheme);
  visit(Field{.key = "boundary",
              .text = "What becomes of edges that one face alone has",
              .absent = "the file's; else edge_only"},
        rules.boundary);
  visit(Field{.key = "face_varying",
              .text = "Where texture coordinates are interpolated linearly",
              .absent = "the file's; else boundaries"},
        rules.face_varying);
  visit(Field{.key = "crease_method",
              .text = "How sharpness falls from level to level",
              .absent = "the file's; else uniform"},
        rules.crease_method);
  visit(
      Field{
          .key = "triangles", .text = "How catmark treats triangles of the cage", .absent = "the file's; else catmark"},
      rules.triangles);
  visit(Field{.key = "crease_angle",
              .text = "Edges whose faces meet at a larger angle become infinitely sharp",
              .unit = "degrees",
              .range = {0, 180},
              .absent = "none do"},
        rules.crease_angle);
  visit(Field{.key = "creases", .text = "Sharp edges; the last one counts where an edge is named twice"},
        rules.creases);
  visit(Field{.key = "corners", .text = "Sharp vertices"}, rules.corners);
  visit(Field{.key = "holes",
              .text = "Faces, counted from 0, that have no surface but shape their neighbors",
              .range = {0, 4294967295.0}},
        rules.holes);
}

template <class Visitor, Is<Smoothing> T>
void visit_fields(Visitor& visit, T& normals) {
  visit(Field{.key = "method", .text = "What each facet gives to the normal of its corner"}, normals.method);
  visit(Field{.key = "crease_angle",
              .text = "Facets that meet at a larger angle share no normal",
              .unit = "degrees",
              .range = {0, 180}},
        normals.crease_angle);
  visit(
      Field{.key = "across_pieces",
            .text = "Whether vertices of equal position count as one, so that pieces of the shape share normals along "
                    "their boundary"},
      normals.across_pieces);
}

/// Facets in place of what is round.
template <class Visitor>
void visit_sides(Visitor& visit, auto& sides) {
  visit(
      Field{
          .key = "sides", .text = "Flat facets around; at least 3, or 0 for the exact shape", .range = {0, kMostSides}},
      sides);
}

template <class Visitor, Is<MeshShape> T>
void visit_fields(Visitor& visit, T& mesh) {
  visit(Field{.key = "file",
              .text = "An .obj or .ply file, relative to the folder of the scene file",
              .absent = "positions and faces are given here"},
        mesh.file);
  visit(Field{.key = "normals", .text = "Where vertex normals come from"}, mesh.normals);
  visit(Field{.key = "crease_angle",
              .text = "Faces that meet at a larger angle share no normal",
              .unit = "degrees",
              .range = {0, 180}},
        mesh.crease_angle);
  visit(Field{.key = "subdivision",
              .text = "Makes the mesh the cage of a smooth surface; {} where the defaults and the file's tags will do",
              .absent = "the polygons themselves are drawn"},
        mesh.subdivision);
  visit.inlined(mesh);
}

template <class Visitor, Is<PatchesShape> T>
void visit_fields(Visitor& visit, T& patches) {
  visit(Field{.key = "file",
              .text = "A .bpt file, relative to the folder of the scene file; its axes are kept (the published tea set "
                      "has z up)",
              .absent = "positions and patches are given here"},
        patches.file);
  visit(Field{.key = "positions", .text = "Control points, for all patches", .unit = "scene units"}, patches.positions);
  visit(Field{.key = "weights",
              .text = "One a position; where they differ patches are rational",
              .range = kPositive,
              .absent = "all 1"},
        patches.weights);
  visit(
      Field{.key = "bezier",
            .text = "Bicubic Bezier patches: 16 zero-based indices into positions each, four rows along u; outside is "
                    "where u turns to v counter-clockwise"},
      patches.bezier);
  visit(Field{.key = "coons",
              .text = "Bilinearly blended Coons patches: 12 indices each, once around four cubic Bezier curves that "
                      "share their ends, counter-clockwise from outside, from (u, v) = (0, 0) along u"},
        patches.coons);
  visit(
      Field{.key = "lathe",
            .text = "Surfaces of revolution about the y axis: 4 indices each, of a cubic Bezier curve through (radius, "
                    "y, anything); exact circles. Outside is to the right of the curve's way"},
      patches.lathe);
  visit(Field{.key = "crease_angle",
              .text = "Where the normals of two patches differ by more than this along a common edge, each keeps its "
                      "own; a wider angle makes both take one's, which shows",
              .unit = "degrees",
              .range = {0, 180}},
        patches.crease_angle);
  visit(Field{.key = "flip", .text = "Whether inside and outside are exchanged"}, patches.flip);
  visit(Field{.key = "degenerate_normals",
              .text =
                  "The normal where that of a patch vanishes because an edge is a point or the partials are parallel"},
        patches.degenerate_normals);
}

template <class Visitor, Is<SphereShape> T>
void visit_fields(Visitor& visit, T& sphere) {
  visit(Field{.key = "center", .text = "Center", .unit = "scene units"}, sphere.center);
  visit(Field{.key = "radius", .text = "Radius", .unit = "scene units", .range = kPositive}, sphere.radius);
  visit_sides(visit, sphere.sides);
  visit(Field{.key = "stacks",
              .text = "With sides: rings of facets from pole to pole, along y; 0: half as many as sides, at least 2",
              .range = {0, kMostSides}},
        sphere.stacks);
}

template <class Visitor, Is<PlaneShape> T>
void visit_fields(Visitor& visit, T& plane) {
  visit(Field{.key = "point", .text = "Any point of the plane", .unit = "scene units"}, plane.point);
  visit(Field{.key = "normal", .text = "Direction to the outside; any length but zero", .nonzero = true}, plane.normal);
}

template <class Visitor, Is<DiscShape> T>
void visit_fields(Visitor& visit, T& disc) {
  visit(Field{.key = "center", .text = "Center", .unit = "scene units"}, disc.center);
  visit(Field{.key = "normal", .text = "Direction to the outside; any length but zero", .nonzero = true}, disc.normal);
  visit(Field{.key = "radius", .text = "Radius", .unit = "scene units", .range = kPositive}, disc.radius);
  visit_sides(visit, disc.sides);
}

template <class Visitor, Is<ConeShape> T>
void visit_fields(Visitor& visit, T& cone) {
  visit(Field{.key = "base", .text = "Center of one end", .unit = "scene units"}, cone.base);
  visit(Field{.key = "apex", .text = "Center of the other end, apart from the first", .unit = "scene units"},
        cone.apex);
  visit(Field{.key = "base_radius", .text = "Radius at `base`", .unit = "scene units", .range = kNotNegative},
        cone.base_radius);
  visit(Field{.key = "apex_radius",
              .text = "Radius at `apex`; equal to the other for a cylinder, not 0 with it",
              .unit = "scene units",
              .range = kNotNegative},
        cone.apex_radius);
  visit_sides(visit, cone.sides);
  visit(Field{.key = "stacks", .text = "With sides: rings of facets", .range = {1, kMostSides}}, cone.stacks);
}

template <class Visitor, Is<TerrainShape> T>
void visit_fields(Visitor& visit, T& terrain) {
  visit(Field{.key = "triangles",
              .text = "Number of triangles wanted; made is the nearest number that a grid allows",
              .range = {2, 50'000'000}},
        terrain.triangles);
  visit(Field{.key = "size", .text = "Edge of the square", .unit = "scene units", .range = kPositive}, terrain.size);
  visit(Field{.key = "height",
              .text = "Between the lowest and the highest point, about",
              .unit = "scene units",
              .range = kNotNegative},
        terrain.height);
  visit(Field{.key = "roughness", .text = "Ratio of the amplitudes of successive octaves", .range = {0, 1, true, true}},
        terrain.roughness);
  visit(Field{.key = "seed", .text = "Another number, another landscape", .range = {0, 4294967295.0}}, terrain.seed);
}

template <class Visitor, Is<SphereFlakeShape> T>
void visit_fields(Visitor& visit, T& flake) {
  visit(Field{.key = "levels", .text = "Generations; the spheres are (9^(levels + 1) - 1) / 8", .range = {0, 7}},
        flake.levels);
  visit(Field{.key = "center", .text = "Center of the largest sphere", .unit = "scene units"}, flake.center);
  visit(Field{.key = "radius", .text = "Radius of the largest sphere", .unit = "scene units", .range = kPositive},
        flake.radius);
}

template <class Visitor, Is<TreeShape> T>
void visit_fields(Visitor& visit, T& tree) {
  visit(Field{.key = "species", .text = "How it grows"}, tree.species);
  visit(Field{.key = "part", .text = "Which half; the two of equal keys fit"}, tree.part);
  visit(Field{.key = "height", .text = "Height of the tree", .unit = "scene units", .range = kPositive}, tree.height);
  visit(Field{.key = "leaves",
              .text = "Number of leaves, or of sprays of needles; two triangles each",
              .range = {1, 10'000'000}},
        tree.leaves);
  visit(
      Field{.key = "leaf_size", .text = "Length of a leaf or spray, about", .unit = "scene units", .range = kPositive},
      tree.leaf_size);
  visit(Field{.key = "seed", .text = "Another number, another tree", .range = {0, 4294967295.0}}, tree.seed);
}

template <class Visitor, Is<InstanceShape> T>
void visit_fields(Visitor& visit, T& instance) {
  visit(Field{.key = "group", .text = "Name of a group of this file", .required = true}, instance.group);
}

template <class Visitor, Is<ScatterShape> T>
void visit_fields(Visitor& visit, T& scatter) {
  visit(Field{.key = "group", .text = "Name of a group of this file", .required = true}, scatter.group);
  visit(Field{.key = "terrain", .text = "Name of a terrain among the shapes beside this one", .required = true},
        scatter.terrain);
  visit(Field{.key = "count",
              .text = "Number of uses; fewer where the ground offers no more places after 16 tries for each",
              .range = {0, 10'000'000}},
        scatter.count);
  visit(Field{.key = "least_scale", .text = "Scale of the smallest", .range = kPositive}, scatter.least_scale);
  visit(Field{.key = "largest_scale", .text = "Scale of the largest; at least least_scale", .range = kPositive},
        scatter.largest_scale);
  visit(Field{.key = "lowest", .text = "World y below which nothing stands", .unit = "scene units"}, scatter.lowest);
  visit(Field{.key = "highest", .text = "World y above which nothing stands", .unit = "scene units"}, scatter.highest);
  visit(Field{.key = "steepest", .text = "Slope beyond which nothing stands", .unit = "degrees", .range = {0, 90}},
        scatter.steepest);
  visit(Field{.key = "sink", .text = "How deep each stands in the ground, times its scale", .unit = "scene units"},
        scatter.sink);
  visit(Field{.key = "clearings", .text = "Share of the ground that stays empty, in patches", .range = {0, 1}},
        scatter.clearings);
  visit(Field{.key = "clearing_size", .text = "Width of the patches, about", .unit = "scene units", .range = kPositive},
        scatter.clearing_size);
  visit(Field{.key = "seed", .text = "Another number, other places", .range = {0, 4294967295.0}}, scatter.seed);
}

template <class Visitor, Is<ShapeDescription> T>
void visit_fields(Visitor& visit, T& shape) {
  visit.tagged(Field{.key = kTypeKey, .text = "Kind of shape", .required = true}, shape.kind);
  visit(Field{.key = "material",
              .text = "Name of a material of this file",
              .absent = "the default material; of instances: each shape's own"},
        shape.material);
  visit(
      Field{
          .key = "transform", .text = "Object to world: a step or a list of steps, applied in order", .absent = "none"},
      shape.transform);
  visit(Field{.key = "shading",
              .text = "How facets are shaded; exact shapes have none",
              .absent = "flat where a mesh's `normals` are; else phong"},
        shape.shading);
  visit(Field{.key = "interpolation", .text = "How gouraud and phong interpolate inside polygons"},
        shape.interpolation);
  visit(Field{.key = "smoothing",
              .text = "Makes vertex normals of the facets, whatever normals there are else",
              .absent = "a mesh's as `normals` says; those of the surface where there is one"},
        shape.smoothing);
  visit(Field{.key = "half_distance",
              .text = "With flat: the distance from the light (of a directional one: from the eye) at which the shade "
                      "has fallen to a half, so that parallel planes differ (Warnock, in Phong 1973, p. 6); 0: it does "
                      "not fall",
              .unit = "scene units",
              .range = kNotNegative},
        shape.half_distance);
}

template <class Visitor, Is<TransformStep> T>
void visit_fields(Visitor& visit, T& step) {
  visit(Field{.key = "scale", .text = "Factors along x, y and z, not zero; negative ones mirror", .absent = "1"},
        step.scale);
  visit(Field{.key = "rotate",
              .text = "About the x axis, then y, then z, right-handed",
              .unit = "degrees",
              .absent = "none"},
        step.rotate);
  visit(Field{.key = "translate", .text = "Displacement", .unit = "scene units", .absent = "none"}, step.translate);
  visit(Field{.key = "matrix",
              .text = "The whole step, alone: 16 numbers, the images of the x, y and z axis and of the origin, each "
                      "followed by its fourth coordinate (0, 0, 0, 1); glTF's order",
              .absent = "none"},
        step.matrix);
}

template <class Visitor, Is<GroupDescription> T>
void visit_fields(Visitor& visit, T& group) {
  visit(Field{.key = "shapes", .text = "Shapes by name, planes excepted; instances of other groups too"}, group.shapes);
}

template <class Visitor, Is<SceneDescription> T>
void visit_fields(Visitor& visit, T& scene) {
  std::conditional_t<std::is_const_v<T>, const SceneVersion, SceneVersion> version;
  visit(Field{.key = "raytree", .text = "Version of the scene format", .required = true}, version);
  visit(Field{.key = "title", .text = "Free text; goes into the picture's metadata"}, scene.title);
  visit(Field{.key = "image", .text = "Size of the picture"}, scene.image);
  visit(Field{.key = "render", .text = "How the picture is traced"}, scene.render);
  visit(Field{.key = "background", .text = "What rays see that leave the scene"}, scene.background);
  visit(Field{.key = "ambient", .text = "Ambient light, from everywhere", .range = kNotNegative}, scene.ambient);
  visit(Field{.key = "cameras", .text = "Cameras by name; the first is the default one"}, scene.cameras);
  visit(Field{.key = "lights", .text = "Lights by name"}, scene.lights);
  visit(Field{.key = "materials", .text = "Materials by name"}, scene.materials);
  visit(Field{.key = "groups", .text = "Groups of shapes by name, each for any number of instances"}, scene.groups);
  visit(Field{.key = "shapes", .text = "Shapes by name"}, scene.shapes);
}

// --- which members are what ---------------------------------------------------------------------------------

/// A struct with a table.
template <class T>
concept Table = Is<T, ImageDescription> || Is<T, AdaptiveSampling> || Is<T, TessellationSettings> ||
    Is<T, FacetSettings> || Is<T, Smoothing> || Is<T, RenderSettings> || Is<T, CameraDescription> ||
    Is<T, LightDescription> || Is<T, CheckerPattern> || Is<T, StripesPattern> || Is<T, NoisePattern> ||
    Is<T, BumpDescription> || Is<T, Crease> || Is<T, SharpCorner> || Is<T, SubdivisionRules> || Is<T, AngleWeight> ||
    Is<T, HighlightDescription> || Is<T, MaterialDescription> || Is<T, FaceGroup> || Is<T, ShapeDescription> ||
    Is<T, GroupDescription> || Is<T, TransformStep> || Is<T, SceneDescription>;

/// An element of a list keyed by name.
template <class T>
concept Named = requires(T& t) {
  t.name;
}
&&(Is<T, CameraDescription> || Is<T, LightDescription> || Is<T, MaterialDescription> || Is<T, ShapeDescription> ||
   Is<T, GroupDescription>);

/// Lists of so and so many indices each.
template <class T>
inline constexpr std::size_t index_list_count = 0;
template <std::size_t Count>
inline constexpr std::size_t index_list_count<IndexLists<Count>> = Count;
template <class T>
inline constexpr bool is_index_lists = index_list_count<T> > 0;

/// What a named element is called in messages: "material" of "materials".
template <Named T>
constexpr std::string_view noun_of() {
  if constexpr (Is<T, CameraDescription>) return "camera";
  if constexpr (Is<T, LightDescription>) return "light";
  if constexpr (Is<T, MaterialDescription>) return "material";
  if constexpr (Is<T, ShapeDescription>) return "shape";
  if constexpr (Is<T, GroupDescription>) return "group";
}

template <class E>
requires std::is_enum_v<E> std::string_view enum_name(E value) {
  for (const auto& entry : EnumTable<E>::entries)
    if (entry.value == value) return entry.name;
  return {};
}

/// "none", "grid:N" or "whitted".
inline std::string antialiasing_text(const Antialiasing& antialias) {
  switch (antialias.method) {
    case Antialiasing::Method::none:
      return "none";
    case Antialiasing::Method::grid:
      return "grid:" + std::to_string(antialias.grid_size);
    case Antialiasing::Method::whitted:
      return "whitted";
  }
  return {};
}

/// What a color may be beside a constant, for the key "type".
using VaryingPattern = std::variant<CheckerPattern, StripesPattern, NoisePattern>;

inline ColorPattern color_pattern(const VaryingPattern& pattern) {
  return std::visit([](const auto& kind) { return ColorPattern(kind); }, pattern);
}
/// A default one where `pattern` is constant.
inline VaryingPattern varying_pattern(const ColorPattern& pattern) {
  return std::visit(
      []<class T>(const T& kind) {
        if constexpr (std::same_as<T, Rgb>)
          return VaryingPattern();
        else
          return VaryingPattern(kind);
      },
      pattern);
}

/// Calls visit(std::in_place_type<T>) for each alternative T of a variant.
template <class Variant, class Visit>
void for_each_alternative(Visit&& visit) {
  [&]<std::size_t... I>(std::index_sequence<I...>) {
    (visit(std::in_place_type<std::variant_alternative_t<I, Variant>>), ...);
  }
  (std::make_index_sequence<std::variant_size_v<Variant>>());
}

}  // namespace raytree
