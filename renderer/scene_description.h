// A scene as its file tells it: pure data, nothing loaded, nothing built. scene_fields.h says which key of the
// file fills which member; prepare() in scene.h makes the immutable Scene of it.
// World: right-handed, Y up, metres unless the scene means otherwise. Colors are linear Rec.709.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "geometry/error.h"
#include "geometry/facet_weights.h"
#include "geometry/patch_surface.h"
#include "geometry/polygon_mesh.h"
#include "geometry/vec.h"
#include "renderer/color.h"

namespace raytree {

inline constexpr int kSceneVersion = 1;  ///< the value of the key "raytree" that heads a scene file

struct CameraDescription {
  enum class Projection { perspective, orthographic };
  std::string name;
  Projection projection = Projection::perspective;
  Vec3d position{0, 0, 5};
  Vec3d target{0, 0, 0};
  Vec3d up{0, 1, 0};
  double field_of_view = 40;  ///< perspective: vertical, degrees, between 0 and 180
  double height = 2;          ///< orthographic: of the window, scene units
};

struct ImageDescription {
  int width = 960;  ///< pixels
  int height = 540;
};

struct Antialiasing {
  enum class Method {
    none,    ///< one sample at the pixel's center
    grid,    ///< the same samples in every pixel
    whitted  ///< corners, and more where they differ: Whitted 1980, sec. 3; see AdaptiveSampling
  };
  Method method = Method::whitted;
  int grid_size = 1;  ///< grid: grid_size^2 samples a pixel, at the centers of equal cells
};

/// How Antialiasing::Method::whitted divides a pixel.
struct AdaptiveSampling {
  /// A square is divided where its corners differ by more than this over its edge in pixels, on a display-like scale
  /// from 0 to 1.
  double threshold = 0.1;
  int levels = 4;         ///< divisions at most: samples lie no closer than 2^-levels pixels
  int minimum_level = 0;  ///< divisions at least, whatever the corners show
};

/// How finely curved surfaces are cut in triangles.
struct TessellationSettings {
  double tolerance = 0.25;  ///< pixels that a facet may lie off the limit surface, > 0; see tessellation_rates.h
  int rate = 0;             ///< segments of every edge, to 1024; 0: as many as the tolerance asks for
};

/// What a facet's light is made of.
enum class ShadingMethod {
  flat,     ///< one normal a facet
  gouraud,  ///< light found at the corners and interpolated (Gouraud 1971)
  phong,    ///< normals of the corners interpolated and made unit (Phong 1973, eq. 4.4)
  limit     ///< the normal of the surface that the facets stand for; as phong where there is none
};

/// What becomes of shadow rays near the line where the light grazes a smooth shape made of facets.
enum class ShadowTerminator {
  classic,  ///< they start on the facet and meet its neighbors
  offset    ///< they start off it, on the surface that the vertex normals tell of (Hanika 2021)
};

/// What becomes of directions that are mirrored about an interpolated normal and lead below the facet.
enum class FacetReflections {
  classic,    ///< they are followed: into the facet itself
  clamped,    ///< they are turned back to its upper side
  consistent  ///< none arises: normals are bent continuously before (Reshetov, Soupikov and Mark 2010)
};

/// Shading of facets, for all shapes.
struct FacetSettings {
  std::optional<ShadingMethod> shading;  ///< in place of what shapes ask for
  ShadowTerminator shadow_terminator = ShadowTerminator::classic;
  FacetReflections reflections = FacetReflections::clamped;
};

enum class HighlightForm {
  reflected,  ///< Phong 1973, eq. 4.5: angle between reflected light and the line of sight
  halfway     ///< Whitted 1980, eq. 1: angle between normal and halfway vector
};

struct RenderSettings {
  int depth = 8;               ///< levels of the ray tree; the eye ray is level 1
  double cutoff = 1.0 / 1020;  ///< largest radiance that cutting branches may take from a sample; 0: cut none
  Antialiasing antialias;
  AdaptiveSampling adaptive;
  HighlightForm highlights = HighlightForm::reflected;
  bool shadows = true;
  bool transparent_shadows = true;  ///< what transmits lets light through its shadow, straight on
  bool shadowed_highlights =
      true;              ///< a shadow takes the highlight too (a departure from Whitted, who names the diffuse term)
  bool fresnel = false;  ///< k_s F and k_t (1 - F) in place of constant k_s and k_t
  double distance_attenuation = 0;  ///< a of max(0, 1 - a t) on child segments, per scene unit; 0: off
  int rough_samples = 16;           ///< facets that a sample's first rough bounce is made of; later ones have one each
  TessellationSettings tessellation;
  FacetSettings facets;
};
/// Bounds what a thread keeps of a tree: 2 rough_samples batches of rays.
inline constexpr int kMaxRoughSamples = 1024;
inline constexpr int kMaxDepth = 1'000'000;  ///< of the ray tree

struct ConstantBackground {
  Rgb color{0, 0, 0};
};
/// Blend by the height of the direction: `bottom` straight down, `horizon` level, `top` straight up.
struct GradientBackground {
  Rgb bottom{0.4f, 0.4f, 0.4f}, horizon{0.7f, 0.8f, 0.9f}, top{0.15f, 0.3f, 0.6f};
};
using Background = std::variant<ConstantBackground, GradientBackground>;

struct DirectionalLight {
  Vec3d direction{0, -1, 0};  ///< the way the light travels; need not be unit, must not be zero
};
/// Light that falls off with the square from nearer than this could leave float's range.
inline constexpr double kLeastLightDistance = 1e-9;

/// How light weakens with the distance d from its source: times 1, 1 / d or 1 / d^2, d in scene units.
enum class Falloff { none, linear, inverse_square };
struct PointLight {
  Vec3d position{0, 10, 0};
  Falloff falloff = Falloff::none;  ///< Whitted's sums know none
  double least_distance = 1;        ///< nearer than this the light grows no stronger; scene units, positive
};
/// A point light within a cone: full inside `inner_angle`, none outside `angle`, smooth between.
struct SpotLight {
  Vec3d position{0, 10, 0};
  Vec3d direction{0, -1, 0};  ///< the cone's axis, the way the light travels; any length but zero
  double angle = 30;          ///< between axis and border, degrees, in (0, 180]
  double inner_angle = 25;    ///< degrees, at most `angle`
  Falloff falloff = Falloff::none;
  double least_distance = 1;
};
struct LightDescription {
  std::string name;
  Rgb color{1, 1, 1};  ///< intensity I of Whitted's sums; with falloff, that at distance 1
  std::variant<DirectionalLight, PointLight, SpotLight> kind;
};

/// The space that a solid pattern or a bump is measured in.
enum class SolidSpace {
  object,  ///< the shape's own, before its transform and those of instances: patterns are carried with the shape
  world    ///< patterns lie still, and shapes move through them
};

/// A checkerboard over two coordinates of the hit point.
struct CheckerPattern {
  enum class Plane { xz, xy, yz, uv };  ///< axes of `space`, or the surface's texture coordinates
  Rgb even{0.9f, 0.9f, 0.9f}, odd{0.1f, 0.1f, 0.1f};
  double size = 1;  ///< edge of one square, units of `space` (texture units for uv)
  Plane plane = Plane::xz;
  SolidSpace space = SolidSpace::object;  ///< nothing to uv
  Vec2d offset{0, 0};                     ///< where a corner of an even square lies, in the same units
  /// Whether an eye ray's sample sees the mean over what it covers of the surface in place of one point (not over uv).
  bool filtered = true;
};

/// What a pattern lies over: positions, see SolidSpace, or the surface's texture coordinates (u, v, 0).
enum class PatternSpace { object, world, uv };

/// Layers across a direction, of two colors by turns.
struct StripesPattern {
  Rgb even{0.9f, 0.9f, 0.9f}, odd{0.1f, 0.1f, 0.1f};
  double size = 1;           ///< width of one stripe
  Vec3d direction{1, 0, 0};  ///< across the stripes; any length but zero
  bool smooth = false;       ///< the colors pass into each other as a sine does
  PatternSpace space = PatternSpace::object;
  Vec3d offset{0, 0, 0};  ///< a point where an even stripe begins
  bool filtered = true;
};

/// Octaves of solid gradient noise between two colors.
struct NoisePattern {
  Rgb low{0.1f, 0.1f, 0.1f}, high{0.9f, 0.9f, 0.9f};
  double size = 1;      ///< edge of a cell of the first octave; blotches are about as large
  int octaves = 4;      ///< each twice as fine as the one before
  double gain = 0.5;    ///< and so many times as high
  double contrast = 2;  ///< the share of `high` is 1/2 + contrast * noise / 2, kept between 0 and 1
  std::uint32_t seed = 0;
  PatternSpace space = PatternSpace::object;
  Vec3d offset{0, 0, 0};  ///< a corner of a cell
  bool filtered = true;
};
using ColorPattern = std::variant<Rgb, CheckerPattern, StripesPattern, NoisePattern>;

/// A height over the surface that its normals follow but its outline does not (Blinn 1978).
struct BumpDescription {
  enum class Kind { noise, wrinkles, ripples, stripes };
  Kind kind = Kind::wrinkles;
  /// Units of `space`. Waves are so high above their mean, noise deviates by about a quarter of it; less than 0 sinks
  /// what was raised.
  double amplitude = 0.1;
  double size = 1;  ///< units of `space`: edge of a cell of the first octave; length of a wave
  int octaves = 1;
  double gain = 0.5;
  std::uint32_t seed = 0;
  Vec3d offset{0, 0, 0};     ///< where it begins; ripples: their center
  Vec3d direction{1, 0, 0};  ///< stripes: across them; any length but zero
  /// The surface is raised in this space: a transform stretches and turns the bump with its shape, or leaves it alone.
  SolidSpace space = SolidSpace::object;
};

/// W(i) of Phong's eq. 4.5 at one angle of incidence.
struct AngleWeight {
  double angle = 0;  ///< between the light and the normal, degrees, [0, 90]
  Rgb weight{0, 0, 0};
};

struct HighlightDescription {
  Rgb weight{0, 0, 0};   ///< W of Phong's eq. 4.5, multiplied by the light's color
  double exponent = 20;  ///< n, >= 1
  /// W(i) in place of `weight`: linear between these points, whose angles rise; constant beyond them. Empty: `weight`.
  std::vector<AngleWeight> weight_by_angle{};
};

/// Coefficients of Whitted's eq. 2. Side is decided by the geometric normal; outside has index 1.
struct MaterialDescription {
  std::string name;
  ColorPattern diffuse = Rgb(0.8f);     ///< k_d
  std::optional<ColorPattern> ambient;  ///< share of the scene's ambient light reflected; default: as diffuse
  HighlightDescription highlight;
  Rgb reflection{0, 0, 0};           ///< k_s
  Rgb transmission{0, 0, 0};         ///< k_t
  double index_of_refraction = 1.5;  ///< of the inside over the outside, > 0
  /// Whether k_s and k_t follow Fresnel by angle; default: as RenderSettings::fresnel says.
  std::optional<bool> fresnel;
  bool conductor = false;   ///< k_s is the reflectance at normal incidence and rises to 1 by Schlick's formula
  Rgb absorption{0, 0, 0};  ///< a of exp(-a t) inside, per scene unit
  bool thin = false;        ///< a sheet without an inside: transmits without bending
  bool one_sided =
      false;         ///< rays that come from behind go through as if nothing were there; shadows are cast all the same
  int priority = 0;  ///< among overlapping media the highest is there; 0 everywhere: media are not tracked
  std::optional<BumpDescription> bump;
  /// Standard deviation, along any direction, of the slopes of microfacets that perturb the normal before R and P are
  /// formed; 0: polished. Light from sources has its highlight instead.
  double roughness = 0;
};
inline constexpr double kMaxRoughness = 1;

// --- shapes -------------------------------------------------------------------------------------------------

/// Where vertex normals come from.
enum class NormalSource {
  file,    ///< the file's own; where it has none, as smooth
  smooth,  ///< angle-weighted mean of the faces within the crease angle
  flat     ///< the face's own
};

struct MeshShape {
  std::string file;  ///< .obj or .ply, relative to the scene file; empty: `mesh` is already there
  NormalSource normals = NormalSource::file;
  double crease_angle = 40;  ///< degrees; faces that meet at a larger angle share no normal
  /// Makes a subdivision cage of the mesh: its limit surface is what is seen. These rules join those of the file's tags
  /// and are the stronger ones.
  std::optional<SubdivisionRules> subdivision;
  /// The loaded mesh (also for polygons given in the scene file). Consumed by prepare().
  std::shared_ptr<PolygonMesh> mesh;
};

/// How vertex normals are found from the facets around, whatever normals there are else.
struct Smoothing {
  enum class Method { angle, unit, area, edges, terminating_edges, corners, analytic };
  Method method = Method::angle;  ///< see geometry/vertex_normals.h; analytic: those of the surface
  double crease_angle = 40;       ///< degrees; facets that meet at a larger angle share no normal
  bool across_pieces = false;     ///< vertices of equal position count as one
};

/// Lists of indices into positions, `Count` each.
template <std::size_t Count>
using IndexLists = std::vector<std::array<std::uint32_t, Count>>;

/// Bezier and Coons patches, from a file or given here. Patches count in the order bezier, coons, lathe.
struct PatchesShape {
  std::string file;              ///< .bpt, relative to the scene file; empty: what follows
  std::vector<Vec3d> positions;  ///< control points
  std::vector<double> weights;   ///< positive, one a position; empty: all 1
  IndexLists<16> bezier;         ///< bicubic patches: rows along u, from v = 0 on
  IndexLists<12> coons;          ///< borders, once around from (u, v) = (0, 0) along u: four cubics, corners once
  IndexLists<4> lathe;           ///< cubics of (radius, y, anything) that are turned about the y axis; see revolve()
  double crease_angle = kPatchCreaseAngle;  ///< degrees
  bool flip = false;                        ///< turned inside out
  DegenerateNormal degenerate_normals = DegenerateNormal::limit;
};
/// `sides` of what is round: flat facets around it; 0: exact.
inline constexpr int kMostSides = 4096;
struct SphereShape {
  Vec3d center{0, 0, 0};
  double radius = 1;
  int sides = 0;
  int stacks = 0;  ///< rings of facets from pole to pole (y); 0: half of the sides, at least 2
};
/// Infinite, through `point`.
struct PlaneShape {
  Vec3d point{0, 0, 0};
  Vec3d normal{0, 1, 0};
};
struct DiscShape {
  Vec3d center{0, 0, 0};
  Vec3d normal{0, 1, 0};
  double radius = 1;
  int sides = 0;
};
inline constexpr double kLargestScatterHeight = 1e18;
/// The lateral surface between two circles about one axis, open at both ends: a cylinder where the radii are equal, a
/// pointed cone where one is 0.
struct ConeShape {
  Vec3d base{0, 0, 0}, apex{0, 1, 0};       ///< centers of the circles; apart
  double base_radius = 1, apex_radius = 0;  ///< not negative, not both 0
  int sides = 0;
  int stacks = 1;  ///< rings of facets
};
/// A fractal height field over the square [-size/2, size/2]^2 in x and z.
struct TerrainShape {
  std::int64_t triangles = 1'000'000;  ///< up to 50 million; the count made is the nearest that a grid allows
  double size = 10;                    ///< edge of the square
  double height = 2.2;                 ///< between the lowest and the highest point, about
  double roughness = 0.5;              ///< amplitude ratio of successive octaves, (0, 1)
  std::uint32_t seed = 1980;
};
/// A sphere that carries nine smaller ones, each of which carries nine, in the manner of SPD's balls.
struct SphereFlakeShape {
  int levels = 4;  ///< spheres: (9^(levels + 1) - 1) / 8
  Vec3d center{0, 0, 0};
  double radius = 1;
};
enum class TreeSpecies { broadleaf, conifer };
/// Which half of a tree: they take different materials.
enum class TreePart { wood, leaves };
/// A tree on the origin, growing along y.
struct TreeShape {
  TreeSpecies species = TreeSpecies::broadleaf;
  TreePart part = TreePart::wood;
  double height = 10;
  std::int64_t leaves = 8000;  ///< leaves, or sprays of needles, two triangles each
  double leaf_size = 0.3;      ///< length
  std::uint32_t seed = 1980;
};
/// One use of a group.
struct InstanceShape {
  std::string group;  ///< a name in SceneDescription::groups
};
/// Uses of a group spread over the surface of a terrain, upright, each turned and scaled at random.
struct ScatterShape {
  std::string group;
  std::string terrain;       ///< a terrain of the same list of shapes
  std::int64_t count = 100;  ///< at most; places that do not suit are tried again a limited number of times
  double least_scale = 0.8, largest_scale = 1.2;
  double lowest = -kLargestScatterHeight, highest = kLargestScatterHeight;  ///< world y of the places taken
  double steepest = 35;                                                     ///< slope, degrees
  double sink = 0.1;     ///< how deep each stands in the ground, scene units
  double clearings = 0;  ///< share of the ground that stays empty, in patches, [0, 1]
  double clearing_size = 1;
  std::uint32_t seed = 1980;
};
using ShapeKind = std::variant<MeshShape, PatchesShape, SphereShape, PlaneShape, DiscShape, ConeShape, TerrainShape,
                               SphereFlakeShape, TreeShape, InstanceShape, ScatterShape>;

struct ShapeDescription {
  std::string name;
  std::string material;  ///< a name in SceneDescription::materials; empty: the default material
  Matrix44d transform;   ///< object to world, row vectors; identity by default
  /// Absent: flat where a mesh's normals are said to be; else phong.
  std::optional<ShadingMethod> shading;
  FacetInterpolation interpolation = FacetInterpolation::barycentric;
  /// Absent: a mesh's by its `normals`; those of the surface where there is one.
  std::optional<Smoothing> smoothing;
  /// Flat: distance to the light over which the shade falls to a half (Warnock, in Phong 1973, p. 3-6); 0: any.
  double half_distance = 0;
  ShapeKind kind;
  SourceLocation where;  ///< for messages
};

/// Shapes in a space of their own, there to be used by instances, as often as one likes. Groups may hold instances of
/// other groups.
struct GroupDescription {
  std::string name;
  std::vector<ShapeDescription> shapes;
  SourceLocation where;
};

struct SceneDescription {
  std::string name;    ///< file or built-in name
  std::string folder;  ///< that mesh files are relative to; empty: the working folder
  std::string title;   ///< free text
  ImageDescription image;
  RenderSettings render;
  Background background;
  Rgb ambient{0.2f, 0.2f, 0.2f};
  std::vector<CameraDescription> cameras;  ///< the first is the default one
  std::vector<LightDescription> lights;
  std::vector<MaterialDescription> materials;
  std::vector<GroupDescription> groups;
  std::vector<ShapeDescription> shapes;
};

}  // namespace raytree
