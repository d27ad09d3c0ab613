#include "renderer/nff_reader.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <filesystem>
#include <optional>
#include <utility>

#include "geometry/angle.h"
#include "geometry/mapped_file.h"
#include "geometry/text_scanning.h"
#include "renderer/scene_fields.h"
#include "renderer/suggestion.h"

namespace raytree {
namespace {

using text::is_space;
using text::scan_double;
using text::skip_blanks;

/// Words of the text with the line they stand on; a # and what follows on its line are left out.
class WordReader {
 public:
  WordReader(std::string_view text, const std::string& name)
      : p_(text.data()), end_(text.data() + text.size()), name_(name) {}

  std::int64_t line() const { return line_; }
  [[noreturn]] void fail(const std::string& message) const {
    throw Error(ErrorKind::bad_input, {name_, line_, {}}, message);
  }

  /// The next word, wherever it stands; empty at the end of the text.
  std::string_view word() {
    while (p_ != end_ && (is_space(*p_) || *p_ == '#')) {
      if (*p_ == '#')
        while (p_ != end_ && *p_ != '\n') ++p_;
      else if (*p_++ == '\n')
        ++line_;
    }
    const char* const begin = p_;
    while (p_ != end_ && !is_space(*p_) && *p_ != '#') ++p_;
    return {begin, static_cast<std::size_t>(p_ - begin)};
  }

  /// Whether something stands on the line after the last word.
  bool line_goes_on() const {
    const char* const p = skip_blanks(p_, end_);
    return p != end_ && *p != '\n' && *p != '#';
  }
  void skip_line() {
    while (p_ != end_ && *p_ != '\n') ++p_;
  }

  double number(const char* what) {
    const std::string_view found = word();
    if (found.empty()) fail(std::string("the file ends where ") + what + " should stand");
    double value = 0;
    const char* const end = found.data() + found.size();
    if (scan_double(found.data(), end, value) != end)
      fail(std::string(what) + ": " + in_quotes(found.substr(0, 40)) + " is not a number");
    if (!(std::abs(value) <= kLargestNumber)) fail(std::string(what) + ": the number is out of range");
    return value;
  }
  Vec3d vector(const char* what) {
    Vec3d v;
    for (int i = 0; i < 3; ++i) v[i] = number(what);
    return v;
  }

 private:
  const char* p_;
  const char* const end_;
  const std::string& name_;
  std::int64_t line_ = 1;
};

/// Spheres and cones as the file has them: far smaller than the shapes that are made of them once the whole file is
/// read, so that a damaged file of tiny parts takes little memory.
struct Sphere {
  Vec3d center;
  double radius;
  std::uint32_t fill, line;  ///< fills before it; where it stands
};
struct CutCone {
  Vec3d base, apex;
  double base_radius, apex_radius;
  std::uint32_t fill, line;
};

/// Polygons that follow each other under one fill, as one mesh.
struct PolygonRun {
  std::deque<Vec3d> positions, normals;  ///< which grow without a copy
  std::deque<std::uint32_t> sizes;
  std::int64_t line = 0;
  std::uint32_t fill = 0;
  bool patches = false;  ///< with normals
};
struct Polygons {
  const char* noun;
  std::uint32_t fill;
  std::int64_t line;
  MeshShape mesh;
};

/// Of lights, and of fills: each takes many times the memory of its few letters.
constexpr std::size_t kMostNames = 1 << 16;

class NffParser {
 public:
  NffParser(std::string_view text, const std::string& name, Warnings& warnings)
      : words_(text, name), name_(name), warnings_(warnings) {
    scene_.name = name;
    scene_.title = std::filesystem::path(name).filename().string();
    scene_.ambient = Rgb();
    scene_.background = ConstantBackground{};
  }

  SceneDescription parse() {
    for (;;) {
      const std::string_view entity = words_.word();
      if (entity.empty()) break;
      read_entity(entity);
    }
    finish_polygons();
    make_shapes();
    if (scene_.cameras.empty())
      throw Error(ErrorKind::bad_input, {name_, 0, {}},
                  "the file has no viewpoint (v, from, at, up, angle, hither, "
                  "resolution)");
    share_light();
    const auto warn = [&](const std::pair<std::int64_t, std::int64_t>& place, const std::string& message) {
      if (place.second > 0) warnings_.push_back({{name_, place.first, {}}, message, place.second});
    };
    warn(skipped_, "lines that are no part of the format skipped");
    warn(inside_out_, "surfaces seen from inside alone (negative radii) are seen from both sides");
    warn(degenerate_, "cones without length or radius, and polygons of fewer than three corners, dropped");
    return std::move(scene_);
  }

 private:
  void read_entity(std::string_view entity) {
    if (entity != "p" && entity != "pp") finish_polygons();
    if (entity == "v") {
      read_viewpoint();
    } else if (entity == "b") {
      scene_.background = ConstantBackground{color("the background's color")};
    } else if (entity == "l") {
      read_light();
    } else if (entity == "f") {
      read_fill();
    } else if (entity == "s") {
      read_sphere();
    } else if (entity == "c") {
      read_cone();
    } else if (entity == "p" || entity == "pp") {
      read_polygon(entity == "pp");
    } else {
      count(skipped_);
      words_.skip_line();
    }
  }

  Rgb color(const char* what) {
    float c[3];
    for (float& x : c) {
      const double value = words_.number(what);
      if (value < 0) words_.fail(std::string(what) + " must not be negative");
      x = static_cast<float>(value);
    }
    return {c[0], c[1], c[2]};
  }
  double not_negative(const char* what) {
    const double value = words_.number(what);
    if (value < 0) words_.fail(std::string(what) + " must not be negative");
    return value;
  }
  void count(std::pair<std::int64_t, std::int64_t>& place) const {
    if (place.second++ == 0) place.first = words_.line();
  }

  void read_viewpoint() {
    CameraDescription camera;
    camera.name = "view";
    double angle = 45;
    for (const char* const key : {"from", "at", "up", "angle", "hither", "resolution"}) {
      const std::string_view found = words_.word();
      if (found != key)
        words_.fail("expected " + std::string(key) + " of the viewpoint, found " + in_quotes(found.substr(0, 40)));
      const std::string_view name(key);
      if (name == "from") camera.position = words_.vector("from");
      if (name == "at") camera.target = words_.vector("at");
      if (name == "up") camera.up = words_.vector("up");
      if (name == "angle") angle = words_.number("angle");
      if (name == "hither") words_.number("hither");  // of hidden-surface programs: rays begin at the eye
      if (name == "resolution") {
        scene_.image.width = pixels();
        scene_.image.height = pixels();
        if (std::int64_t(scene_.image.width) * scene_.image.height > kMaxPixels)
          words_.fail("resolution: more than 2^30 pixels");
      }
    }
    if (!(angle > 0 && angle < 180)) words_.fail("angle must lie between 0 and 180 degrees");
    if ((camera.target - camera.position).length() == 0) words_.fail("from and at are the same point");
    // The angle lies between the centers of the top and the bottom row.
    const double rows = scene_.image.height;
    const double half_height = std::tan(angle * kPi / 360) * (rows > 1 ? rows / (rows - 1) : 1);
    camera.field_of_view = std::atan(half_height) * 360 / kPi;
    scene_.cameras = {camera};
  }

  int pixels() {
    const double value = words_.number("resolution");
    if (value != std::floor(value) || value < 1 || value > 65536)
      words_.fail("resolution: a whole number from 1 to 65536 is needed");
    return static_cast<int>(value);
  }

  void read_light() {
    if (scene_.lights.size() == kMostNames) words_.fail("more than 65536 lights");
    LightDescription light;
    light.name = "light " + std::to_string(scene_.lights.size() + 1);
    PointLight point;
    point.position = words_.vector("the light's place");
    light.kind = point;
    has_color_.push_back(words_.line_goes_on());
    if (has_color_.back()) light.color = color("the light's color");
    scene_.lights.push_back(std::move(light));
  }

  /// Lights of no stated intensity share one picture's exposure: 1 / sqrt(n) each.
  void share_light() {
    const auto intensity = static_cast<float>(1 / std::sqrt(static_cast<double>(scene_.lights.size())));
    for (std::size_t i = 0; i < scene_.lights.size(); ++i)
      if (!has_color_[i]) scene_.lights[i].color = Rgb(intensity);
  }

  void read_fill() {
    if (scene_.materials.size() == kMostNames) words_.fail("more than 65536 fills");
    MaterialDescription material;
    material.name = "fill " + std::to_string(scene_.materials.size() + 1);
    const Rgb fill = color("the fill's color");
    const auto diffuse = static_cast<float>(not_negative("Kd")), specular = static_cast<float>(not_negative("Ks"));
    const double shine = words_.number("Shine");
    const double transmittance = not_negative("T");
    const double index = words_.number("index_of_refraction");
    if (transmittance > 1) words_.fail("T is a share of the light: at most 1");
    material.diffuse = fill * diffuse;
    material.highlight = {Rgb(specular), std::clamp(shine, 1.0, kLargestNumber)};
    material.reflection = Rgb(specular);
    material.transmission = Rgb(static_cast<float>(transmittance));
    if (index > 0) material.index_of_refraction = index;
    if (words_.line_goes_on()) {
      count(skipped_);
      words_.skip_line();
    }
    scene_.materials.push_back(std::move(material));
  }

  std::uint32_t fills() const { return static_cast<std::uint32_t>(scene_.materials.size()); }
  std::uint32_t line() const { return static_cast<std::uint32_t>(words_.line()); }

  void read_sphere() {
    Sphere sphere{{}, 0, fills(), line()};
    sphere.center = words_.vector("the sphere's center");
    sphere.radius = words_.number("the sphere's radius");
    if (sphere.radius == 0) words_.fail("a sphere needs a radius that is not 0");
    if (sphere.radius < 0) count(inside_out_);
    sphere.radius = std::abs(sphere.radius);
    spheres_.push_back(sphere);
  }

  void read_cone() {
    CutCone cone{{}, {}, 0, 0, fills(), line()};
    cone.base = words_.vector("the cone's base");
    cone.base_radius = words_.number("the cone's base radius");
    cone.apex = words_.vector("the cone's apex");
    cone.apex_radius = words_.number("the cone's apex radius");
    if (cone.base_radius < 0 || cone.apex_radius < 0) count(inside_out_);
    cone.base_radius = std::abs(cone.base_radius);
    cone.apex_radius = std::abs(cone.apex_radius);
    if (cone.base == cone.apex || (cone.base_radius == 0 && cone.apex_radius == 0))
      count(degenerate_);
    else
      cones_.push_back(cone);
  }

  void add_shape(const char* noun, std::uint32_t fill, std::int64_t line, ShapeKind kind) {
    ShapeDescription& shape = scene_.shapes.emplace_back();
    shape.name = std::string(noun) + " " + std::to_string(scene_.shapes.size());
    if (fill > 0) shape.material = scene_.materials[fill - 1].name;
    shape.where = {name_, line, {}};
    shape.kind = std::move(kind);
  }

  void make_shapes() {
    for (const Sphere& s : spheres_) add_shape("sphere", s.fill, s.line, SphereShape{s.center, s.radius});
    for (const CutCone& c : cones_)
      add_shape("cone", c.fill, c.line, ConeShape{c.base, c.apex, c.base_radius, c.apex_radius});
    for (Polygons& p : polygons_) add_shape(p.noun, p.fill, p.line, std::move(p.mesh));
  }

  void read_polygon(bool patch) {
    if (run_ && run_->patches != patch) finish_polygons();
    if (!run_) {
      run_.emplace();
      run_->patches = patch;
      run_->line = words_.line();
      run_->fill = fills();
    }
    const double corners = words_.number("the number of corners");
    if (corners != std::floor(corners) || corners < 0 || corners > 0xffffffffu)
      words_.fail("the number of corners is no whole number");
    // Corners are taken one by one, so that a number alone asks for no memory.
    for (double i = 0; i < corners; ++i) {
      run_->positions.push_back(words_.vector("a corner's place"));
      if (patch) run_->normals.push_back(words_.vector("a corner's normal"));
    }
    const auto size = static_cast<std::size_t>(corners);
    if (size < 3) {
      count(degenerate_);
      run_->positions.resize(run_->positions.size() - size);
      if (patch) run_->normals.resize(run_->positions.size());
      return;
    }
    run_->sizes.push_back(static_cast<std::uint32_t>(size));
  }

  void finish_polygons() {
    if (!run_) return;
    PolygonRun run = std::move(*run_);
    run_.reset();
    if (run.sizes.empty()) return;
    auto mesh = std::make_shared<PolygonMesh>();
    mesh->origin = run.positions.front();
    mesh->positions.resize(run.positions.size());
    mesh->corners.resize(run.positions.size());
    for (std::size_t i = 0; i < run.positions.size(); ++i) {
      mesh->positions[i] = Vec3f(run.positions[i] - mesh->origin);
      mesh->corners[i] = static_cast<std::uint32_t>(i);
    }
    const bool triangles =
        std::all_of(run.sizes.begin(), run.sizes.end(), [](std::uint32_t size) { return size == 3; });
    if (!triangles) mesh->face_sizes.assign(run.sizes.begin(), run.sizes.end());
    mesh->normals.assign(run.normals.begin(), run.normals.end());
    MeshShape kind;
    kind.normals = run.patches ? NormalSource::file : NormalSource::flat;
    kind.mesh = std::move(mesh);
    polygons_.push_back({run.patches ? "patches" : "polygons", run.fill, run.line, std::move(kind)});
  }

  WordReader words_;
  const std::string& name_;
  Warnings& warnings_;
  SceneDescription scene_;
  std::vector<bool> has_color_;  ///< [light]
  std::deque<Sphere> spheres_;
  std::deque<CutCone> cones_;
  std::deque<Polygons> polygons_;
  std::optional<PolygonRun> run_;
  using Count = std::pair<std::int64_t, std::int64_t>;  ///< line of the first, how many
  mutable Count skipped_, inside_out_, degenerate_;
};

}  // namespace

SceneDescription read_nff(std::string_view text, const std::string& name, Warnings& warnings) {
  return NffParser(text, name, warnings).parse();
}

SceneDescription read_nff_file(const std::string& path, Warnings& warnings) {
  const MappedFile file(path);
  return read_nff(file.bytes(), path, warnings);
}

}  // namespace raytree
