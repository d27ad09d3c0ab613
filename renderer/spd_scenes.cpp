#include "renderer/spd_scenes.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <utility>

#include "geometry/angle.h"
#include "geometry/sphere_flake.h"
#include "renderer/builtin_scenes.h"
#include "renderer/spd_meshes.h"

namespace raytree {
namespace {

constexpr SpdEntry kEntries[] = {
    {SpdDatabase::balls, "balls", "SPD balls: a sphere-flake of mirrors on a floor; size: its levels", 4,
     kLargestSphereFlakeLevel},
    {SpdDatabase::gears, "gears", "SPD gears: meshed gears, some of glass, over a mirror; size: gears along each axis",
     4, 32},
    {SpdDatabase::mount, "mount", "SPD mount: four glass spheres over a fractal mountain; size: its subdivisions", 6,
     11},
    {SpdDatabase::rings, "rings", "SPD rings: a pyramid of linked rings of cylinders; size: its layers", 7, 30},
    {SpdDatabase::teapot, "teapot",
     "SPD teapot: triangles of the teapot's patches, on a board; size: cells along a patch", 12, 200},
    {SpdDatabase::tetra, "tetra", "SPD tetra: a pyramid of tetrahedra; size: its levels", 6, 11},
    {SpdDatabase::tree, "tree", "SPD tree: a tree of cones and spheres, seven lights; size: its generations", 11, 17},
};

/// The exponent whose highlight falls to a half at such an angle.
double exponent_of(double degrees) { return std::log(0.5) / std::log(std::cos(degrees * kDegree)); }
constexpr double kNoHighlight = 100000;  ///< the exponent that the programs write then

class SceneBuilder {
 public:
  SceneBuilder(const SpdEntry& entry, int size) {
    scene_.name = std::string(kSpdPrefix) + std::string(entry.name);
    if (size != entry.standard_size) scene_.name += ":" + std::to_string(size);
    scene_.title = entry.summary;
    scene_.image = {512, 512};
    scene_.background = ConstantBackground{Rgb(0.078f, 0.361f, 0.753f)};
    scene_.ambient = Rgb(0.1f);
  }

  /// 45 degrees between the centers of the top and the bottom row.
  void set_view(const Vec3d& from, const Vec3d& at, const Vec3d& up) {
    CameraDescription camera;
    camera.name = "view";
    camera.position = from;
    camera.target = at;
    camera.up = up;
    const double rows = scene_.image.height;
    camera.field_of_view = std::atan(std::tan(kPi / 8) * rows / (rows - 1)) * 360 / kPi;
    scene_.cameras = {camera};
  }

  void set_lights(std::initializer_list<Vec3d> positions) {
    for (const Vec3d& position : positions) {
      LightDescription& light = scene_.lights.emplace_back();
      light.name = "light " + std::to_string(scene_.lights.size());
      light.color = Rgb(static_cast<float>(0.5 / std::sqrt(double(positions.size()))));
      light.kind = PointLight{position};
    }
  }

  /// Of the shapes that follow: k_d = color x Kd, k_s = Ks, k_t = T.
  void set_fill(const Rgb& color, float diffuse, float specular, double exponent, float transmittance = 0,
                double index = 0) {
    MaterialDescription& material = scene_.materials.emplace_back();
    material.name = "fill " + std::to_string(scene_.materials.size());
    material.diffuse = color * diffuse;
    material.highlight = {Rgb(specular), exponent};
    material.reflection = Rgb(specular);
    material.transmission = Rgb(transmittance);
    if (index > 0) material.index_of_refraction = index;
    use_fill(scene_.materials.size() - 1);
  }
  void use_fill(std::size_t index) { fill_ = scene_.materials[index].name; }

  ShapeDescription& add(const char* noun, ShapeKind kind) {
    ShapeDescription& shape = scene_.shapes.emplace_back();
    shape.name = std::string(noun) + " " + std::to_string(scene_.shapes.size());
    shape.material = fill_;
    shape.kind = std::move(kind);
    return shape;
  }
  void add_sphere(const Vec3d& center, double radius) { add("sphere", SphereShape{center, radius}); }
  void add_cone(const Vec3d& base, double base_radius, const Vec3d& apex, double apex_radius) {
    add("cone", ConeShape{base, apex, base_radius, apex_radius});
  }
  void add_mesh(const char* noun, std::shared_ptr<PolygonMesh> mesh) {
    MeshShape kind;
    kind.normals = mesh->normals.empty() ? NormalSource::flat : NormalSource::file;
    kind.mesh = std::move(mesh);
    if (!kind.mesh->corners.empty()) add(noun, std::move(kind));
  }
  void add_polygon(std::span<const Vec3d> corners) {
    PolygonList list;
    list.add(corners);
    add_mesh("polygon", std::move(list).mesh());
  }
  /// A square at such a height that faces up.
  void add_ground(double half, double z) {
    add_polygon(std::array{Vec3d(half, half, z), Vec3d(-half, half, z), Vec3d(-half, -half, z), Vec3d(half, -half, z)});
  }

  SceneDescription take() { return std::move(scene_); }

 private:
  SceneDescription scene_;
  std::string fill_;
};

constexpr double kUsualAngle = 37;  ///< degrees: half width of most highlights

void build_balls(int size, SceneBuilder& scene) {
  scene.set_view({2.1, 1.3, 1.7}, {0, 0, 0}, {0, 0, 1});
  scene.set_lights({{4, 3, 2}, {1, -4, 4}, {-3, 1, 5}});
  scene.set_fill({1, 0.75f, 0.33f}, 0.8f, 0, kNoHighlight);
  scene.add_ground(12, -0.5);
  scene.set_fill({1, 0.9f, 0.7f}, 0.5f, 0.5f, exponent_of(kUsualAngle));
  // A flake grows along y: (x, y, z) -> (x, -z, y).
  scene.add("balls", SphereFlakeShape{size, {0, 0, 0}, 0.5}).transform =
      Matrix44d(1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1);
}

void build_gears(int size, SceneBuilder& scene) {
  scene.set_view({-1.1, -2.1, 2.6}, {0, 0, 0}, {0, 0, 1});
  scene.set_lights({{2, 4, 4}, {-2, 4, 3}, {2, -2.5, 2.5}, {-1, -4, 2}, {-1.111, -2.121, 2.626}});
  scene.set_fill({1, 0.85f, 0.7f}, 0.3f, 0.6f, exponent_of(kUsualAngle));
  scene.add_ground(2, 0);
  // The teeth, a tenth of the radius, mesh; a half per cent of it keeps them apart.
  constexpr double kTeeth = 0.1, kGap = 0.005;
  const double radius = 1 / (size - (size - 1) * kTeeth / 2), step = radius * (2 - kTeeth);
  const auto color_of = [](int i, int j, int k, int factor) {
    return 0.01 + (i * 3 + j * 2 + k + 1) * factor % 7 / 7.0;
  };
  for (int k = 0; k < size; ++k)
    for (int j = 0; j < size; ++j)
      for (int i = 0; i < size; ++i) {
        const Vec3d color(color_of(i, j, k, 5), color_of(j, k, i, 3), color_of(k, i, j, 2));
        const Vec3f scaled(color / std::max({color.x, color.y, color.z}));
        const Rgb fill(scaled.x, scaled.y, scaled.z);
        if ((i * 4 + j * 2 + k) % 5 == 0)
          scene.set_fill(fill, 0.2f, 0, kNoHighlight, 0.8f, 1.1);
        else
          scene.set_fill(fill, 1, 0, kNoHighlight);
        const Vec3d center(radius - 1 + i * step, radius - 1 + j * step, 1 - double(k) / size);
        scene.add_mesh("gear", spd_gear(center, (i + j + k) % 2 * kPi / kSpdTeeth, (1 - kGap) * radius,
                                        (1 - kTeeth) * radius, std::min(0.1, 0.5 / size)));
      }
}

void build_mount(int size, SceneBuilder& scene) {
  scene.set_view({-1.6, 1.6, 1.7}, {0, 0, 0}, {0, 0, 1});
  scene.set_lights({{-100, -100, 100}});
  scene.set_fill({1, 1, 1}, 0.1f, 0.1f, exponent_of(6.7), 0.9f, 1.5);
  // Four spheres that touch: one above the middle, the others the tetrahedral angle from it.
  const double radius = 0.17, distance = radius * std::sqrt(1.5), angle = std::acos(-1.0 / 3);
  const Vec3d middle(-0.8, 0.8, 1);
  scene.add_sphere(middle + Vec3d(0, 0, distance), radius);
  for (int i = 0; i < 3; ++i) {
    const double azimuth = -kPi / 4 + i * 2 * kPi / 3, flat = distance * std::sin(angle);
    scene.add_sphere(middle + Vec3d(flat * std::cos(azimuth), flat * std::sin(azimuth), distance * std::cos(angle)),
                     radius);
  }
  scene.set_fill({0.5f, 0.45f, 0.35f}, 1, 0, kNoHighlight);
  scene.add_mesh("mountain", spd_mountain(size));
}

/// The midpoints of a dodecahedron's edges as six pentagons about the origin, five points each; the rings about them
/// fit into the unit sphere.
std::array<Vec3d, 30> ring_points(double ring_radius) {
  std::array<Vec3d, 30> points;
  const double radius = 1 / (1 + ring_radius);
  // The angle between neighboring faces of the dodecahedron.
  const double tilt = 2 * std::acos(std::cos(kPi / 3) / std::sin(kPi / 5));
  for (std::size_t pentagon = 0; pentagon < 6; ++pentagon)
    for (std::size_t i = 0; i < 5; ++i) {
      const double azimuth = double(i) * 2 * kPi / 5;
      Vec3d p(radius * std::cos(azimuth), radius * std::sin(azimuth), 0);
      if (pentagon > 0) {
        const double turn = kPi * (2 * double(pentagon) - 1) / 5;
        p = p * Matrix44d().rotate(Vec3d(tilt, 0, 0)) * Matrix44d().rotate(Vec3d(0, 0, turn));
      }
      points[5 * pentagon + i] = p;
    }
  return points;
}

void build_rings(int size, SceneBuilder& scene) {
  const double spread = 1 / std::sin(kPi / 8), wall = spread * (size + 1);
  const Vec3d eye(-1, -spread, 0.5);
  scene.set_view(eye, eye + Vec3d(0, 1, 0), {0, 0, 1});
  scene.set_lights({{3, -spread, 3}, {-4, -spread, 1}, {2, -spread, -4}});
  scene.set_fill({1, 1, 1}, 1, 0, kNoHighlight);
  // The wall is one per cent larger than the view.
  const double half = 1.01 * (wall - eye.y) * std::tan(kPi / 8);
  const auto corner = [&](int x, int z) { return Vec3d(eye.x + x * half, wall, eye.z + z * half); };
  scene.add_polygon(std::array{corner(1, 1), corner(-1, 1), corner(-1, -1), corner(1, -1)});
  for (const Rgb& color : {Rgb(1, 0, 0), Rgb(0, 1, 0), Rgb(0, 0, 1), Rgb(0, 1, 1), Rgb(1, 0, 1), Rgb(1, 1, 0)})
    scene.set_fill(color, 0.5f, 0.2f, exponent_of(kUsualAngle));
  const double radius = 0.07412;
  const std::array<Vec3d, 30> points = ring_points(radius);
  for (int layer = 0; layer < size; ++layer)
    for (int z = -layer; z <= layer; z += 2)
      for (int x = -layer; x <= layer; x += 2)
        for (std::size_t i = 0; i < points.size(); ++i) {
          const Vec3d middle(x, spread * (layer + 1), z);
          scene.use_fill(1 + i / 5);
          const Vec3d& before = points[i % 5 == 0 ? i + 4 : i - 1];
          scene.add_cone(middle + points[i], radius, middle + before, radius);
          scene.add_sphere(middle + points[i], radius);
        }
}

/// Newell's patches, as the built-in scene "teapot" has them.
std::vector<BezierPatch> teapot_patches() {
  const SceneDescription scene = builtin_scene("teapot");
  std::vector<BezierPatch> patches;
  for (const ShapeDescription& shape : scene.shapes) {
    if (shape.name != "teapot") continue;
    const auto& kind = std::get<PatchesShape>(shape.kind);
    for (const auto& indices : kind.bezier) {
      BezierPatch& patch = patches.emplace_back();
      for (std::size_t i = 0; i < indices.size(); ++i) patch.points[i] = kind.positions[indices[i]];
    }
  }
  return patches;
}

void build_teapot(int size, SceneBuilder& scene) {
  scene.set_view({4.86, 7.2, 5.4}, {0, 0, 0}, {0, 0, 1});
  scene.set_lights({{-3.1, 9.8, 12.1}, {11.3, 5.1, 8.8}});
  scene.set_fill({1, 1, 1}, 0.5f, 0.5f, exponent_of(30));
  scene.add_mesh("white squares", spd_board(size, true));
  scene.set_fill({0.5f, 0.5f, 0.5f}, 0.5f, 0.5f, exponent_of(30));
  scene.add_mesh("grey squares", spd_board(size, false));
  scene.set_fill({1, 0.5f, 0.1f}, 0.75f, 0.25f, exponent_of(kUsualAngle));
  scene.add_mesh("teapot", spd_patches(teapot_patches(), size));
}

void build_tetra(int size, SceneBuilder& scene) {
  scene.set_view({1.022846, -3.177154, -2.174512}, {-0.004103, -0.004103, 0.216539}, {-0.816497, -0.816497, 0.816497});
  scene.set_lights({{2, -18, -5}});
  scene.set_fill({1, 0.2f, 0.2f}, 1, 0, kNoHighlight);
  scene.add_mesh("tetrahedra", spd_tetrahedra(size));
}

/// Aono and Kunii's branching (IEEE CG&A 4(5), 1984): each branch is a unit cone along z in a space of its own and
/// carries two smaller ones at its end.
void grow_branch(const Matrix44d& space, double radius, int generations, SceneBuilder& scene) {
  constexpr double kThinning = 0.67;
  struct Side {
    double angle, divergence, contraction;  ///< degrees, degrees, share of the length
  };
  constexpr Side kSides[] = {{40, 90, 0.65}, {25, 230, 0.7}};
  const Vec3d base = Vec3d(0, 0, 0) * space, apex = Vec3d(0, 0, 1) * space;
  const double thinner = radius * kThinning;
  scene.add_cone(base, radius, apex, thinner);
  scene.add_sphere(apex, thinner);
  if (generations == 0) return;
  for (const Side& side : kSides) {
    const Matrix44d turn = Matrix44d().rotate(Vec3d(side.angle * kDegree, 0, 0)) *
                           Matrix44d().rotate(Vec3d(0, 0, side.divergence * kDegree));
    const Matrix44d shrink = Matrix44d().scale(Vec3d(side.contraction)) * Matrix44d().translate(Vec3d(0, 0, 1));
    grow_branch(turn * shrink * space, thinner, generations - 1, scene);
  }
}

void build_tree(int size, SceneBuilder& scene) {
  scene.set_view({4.5, 0.4, 2}, {0, 0, 1.5}, {0, 0, 1});
  scene.set_lights(
      {{-5, 5, 50}, {30, -30, 30}, {-40, -30, 20}, {10, 30, 40}, {-30, 40, 10}, {50, 25, 20}, {-10, -60, 30}});
  scene.set_fill({0.2f, 0.7f, 0.2f}, 1, 0, kNoHighlight);
  scene.add_ground(50, 0);
  scene.set_fill({0.55f, 0.4f, 0.2f}, 1, 0, kNoHighlight);
  grow_branch(Matrix44d(), 0.15, size, scene);
}

/// Null: there is none.
const SpdEntry* named_entry(std::string_view name) {
  if (!name.starts_with(kSpdPrefix)) return nullptr;
  const std::string_view rest = name.substr(kSpdPrefix.size()), stem = rest.substr(0, rest.find(':'));
  for (const SpdEntry& entry : kEntries)
    if (stem == entry.name) return &entry;
  return nullptr;
}

}  // namespace

std::span<const SpdEntry> spd_databases() { return kEntries; }

const SpdEntry& spd_entry(SpdDatabase database) { return kEntries[static_cast<std::size_t>(database)]; }

SceneDescription spd_scene(SpdDatabase database, int size) {
  const SpdEntry& entry = spd_entry(database);
  if (size < 1 || size > entry.largest_size)
    throw Error(ErrorKind::bad_input, {},
                "spd-" + std::string(entry.name) + ": the size must be a whole number from 1 to " +
                    std::to_string(entry.largest_size));
  SceneBuilder scene(entry, size);
  switch (database) {
    case SpdDatabase::balls:
      build_balls(size, scene);
      break;
    case SpdDatabase::gears:
      build_gears(size, scene);
      break;
    case SpdDatabase::mount:
      build_mount(size, scene);
      break;
    case SpdDatabase::rings:
      build_rings(size, scene);
      break;
    case SpdDatabase::teapot:
      build_teapot(size, scene);
      break;
    case SpdDatabase::tetra:
      build_tetra(size, scene);
      break;
    case SpdDatabase::tree:
      build_tree(size, scene);
      break;
  }
  return scene.take();
}

bool is_spd_scene(std::string_view name) { return named_entry(name) != nullptr; }

SceneDescription spd_scene(std::string_view name) {
  const SpdEntry* const entry = named_entry(name);
  if (entry == nullptr) throw Error(ErrorKind::bad_input, {}, "no database of the SPD has this name");
  const std::size_t colon = name.find(':');
  int size = entry->standard_size;
  if (colon != name.npos) {
    const std::string_view text = name.substr(colon + 1);
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), size);
    if (error != std::errc() || end != text.data() + text.size()) size = 0;
  }
  return spd_scene(entry->database, size);
}

}  // namespace raytree
