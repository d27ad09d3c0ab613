#include "benchmarks/povray_scene.h"

#include <fmt/format.h>

#include <cstdio>
#include <memory>
#include <string_view>
#include <utility>

#include "geometry/error.h"

namespace raytree::benchmarks {
namespace {

[[noreturn]] void refuse(const std::string& what) {
  throw Error(ErrorKind::failure, {}, what + " has no counterpart in POV-Ray that would be measured fairly");
}

template <class Vec>
std::string vector(const Vec& v) {
  return fmt::format("<{},{},{}>", v.x, v.y, v.z);
}
std::string rgb(const Rgb& c) { return fmt::format("rgb <{},{},{}>", c.r, c.g, c.b); }

class Writer {
 public:
  Writer(const std::filesystem::path& path, const Scene& scene, PovrayPicture picture, double reach)
      : file_(std::fopen(path.c_str(), "w")), scene_(scene), picture_(picture), reach_(reach) {
    if (!file_) throw Error(ErrorKind::failure, {path.string(), 0, {}}, "cannot be written");
  }

  void write() {
    const RenderSettings& settings = scene_.description.render;
    put("#version 3.7;\nglobal_settings {{ assumed_gamma 1 max_trace_level {} adc_bailout {} ambient_light {} }}\n",
        settings.depth, settings.cutoff, rgb(scene_.ambient));
    const std::vector<LightDescription>& lights = scene_.description.lights;
    write_camera();
    if (picture_ == PovrayPicture::shaded) {
      write_background();
      for (const LightDescription& light : lights) write_light(light);
    } else if (picture_ == PovrayPicture::lit) {
      if (lights.empty()) refuse("a scene without a light");
      write_light(lights.front());
    }
    write_shapes();
    if (std::fflush(file_.get()) != 0) throw Error(ErrorKind::failure, {}, "POV-Ray's scene cannot be written whole");
  }

 private:
  template <class... Values>
  void put(fmt::format_string<Values...> format, Values&&... values) {
    const std::string text = fmt::format(format, std::forward<Values>(values)...);
    std::fwrite(text.data(), 1, text.size(), file_.get());
  }

  void write_camera() {
    const CameraDescription& camera = scene_.description.cameras.front();
    if (camera.projection != CameraDescription::Projection::perspective) refuse("an orthographic camera");
    const Vec3d forward = (camera.target - camera.position).normalized();
    const Vec3d right = forward.cross(camera.up).normalized(), up = right.cross(forward);
    const double height = 2 * std::tan(camera.field_of_view * std::acos(-1.0) / 360);
    const ImageDescription& image = scene_.description.image;
    put("camera {{ perspective location {} direction {} right {} up {} }}\n", vector(camera.position), vector(forward),
        vector(right * (height * image.width / image.height)), vector(up * height));
  }

  void write_background() {
    if (const auto* constant = std::get_if<ConstantBackground>(&scene_.description.background)) {
      put("background {{ {} }}\n", rgb(constant->color));
      return;
    }
    const auto& gradient = std::get<GradientBackground>(scene_.description.background);
    put("sky_sphere {{ pigment {{ gradient y color_map {{ [0 {}] [0.5 {}] [1 {}] }} scale 2 translate -y }} }}\n",
        rgb(gradient.bottom), rgb(gradient.horizon), rgb(gradient.top));
  }

  void write_light(const LightDescription& light) {
    if (const auto* sun = std::get_if<DirectionalLight>(&light.kind)) {
      const Vec3d from = scene_.shapes->origin - sun->direction.normalized() * 1e6;
      put("light_source {{ {} {} parallel point_at {} }}\n", vector(from), rgb(light.color),
          vector(scene_.shapes->origin));
      return;
    }
    const auto* point = std::get_if<PointLight>(&light.kind);
    if (point == nullptr || point->falloff != Falloff::none) refuse("a light with falloff or cone");
    put("light_source {{ {} {} }}\n", vector(point->position), rgb(light.color));
  }

  /// `to_world`: of the shape that the material is of.
  void write_material(const MaterialDescription& material, const Matrix44d& to_world) {
    if (picture_ == PovrayPicture::nearness) {
      // 1 - distance / reach within the sphere of that radius about the eye.
      put("texture {{ pigment {{ spherical color_map {{ [0 rgb 0] [1 rgb 1] }} scale {} translate {} }} "
          "finish {{ ambient 0 diffuse 0 emission 1 }} }}",
          reach_, vector(scene_.description.cameras.front().position));
      return;
    }
    if (picture_ == PovrayPicture::lit) {
      put("texture {{ pigment {{ rgb 1 }} finish {{ ambient 0 diffuse 1 }} }}");
      return;
    }
    const bool transmits = !is_black(material.transmission);
    const bool fresnel = material.fresnel.value_or(scene_.description.render.fresnel);
    if (const auto* color = std::get_if<Rgb>(&material.diffuse)) {
      if (transmits && !(is_black(*color) && material.transmission == Rgb(1)))
        refuse("a transparent material that is not clear");
      put("texture {{ pigment {{ {} }} ", transmits ? "rgbt <1,1,1,1>" : rgb(*color));
    } else {
      const auto* checker = std::get_if<CheckerPattern>(&material.diffuse);
      if (checker == nullptr || checker->plane != CheckerPattern::Plane::xz || transmits)
        refuse("a pattern of this kind");
      // POV-Ray's checker has cubes: half a cube down, a floor at height 0 lies amid one.
      put("texture {{ pigment {{ checker {} {} translate <0,-0.5,0> scale {} translate <{},0,{}> ", rgb(checker->even),
          rgb(checker->odd), checker->size, checker->offset.x, checker->offset.y);
      if (checker->space == SolidSpace::object && to_world != Matrix44d()) write_matrix(to_world);
      put("}} ");
    }
    const Rgb& weight = material.highlight.weight;
    if (weight.r != weight.g || weight.g != weight.b) refuse("a colored highlight");
    put("finish {{ ambient {} diffuse {} phong {} phong_size {} ", transmits ? 0 : 1, transmits ? 0 : 1, weight.r,
        material.highlight.exponent);
    if (!is_black(material.reflection))
      put("reflection {{ {} {} }} {}", fresnel ? "rgb 0," : "",
          rgb(material.reflection) + (fresnel ? " fresnel on" : ""), fresnel ? "conserve_energy " : "");
    put("}} }} ");
    if (transmits || fresnel) put("interior {{ ior {} }} ", material.index_of_refraction);
  }

  void write_material_of(ShapeId shape) {
    const std::uint32_t index = scene_.shape_materials[shape];
    const auto& materials = scene_.description.materials;
    write_material(index < materials.size() ? materials[index] : MaterialDescription(),
                   scene_.description.shapes[shape].transform);
  }

  /// Row vectors, as here: three axes, then where they meet.
  void write_matrix(const Matrix44d& m) {
    put("matrix <");
    for (int row = 0; row < 4; ++row)
      for (int column = 0; column < 3; ++column) put("{}{}", row + column > 0 ? "," : "", m[row][column]);
    put("> ");
  }

  void write_mesh(const MeshEntry& entry) {
    const TriangleMesh& mesh = entry.mesh;
    const Vec3d& origin = scene_.shapes->origin;
    const auto write_faces = [&](const char* name, const auto& corners) {
      put("{} {{ {}", name, corners.size() / 3);
      for (std::size_t i = 0; i + 2 < corners.size(); i += 3)
        put(",<{},{},{}>", corners[i], corners[i + 1], corners[i + 2]);
      put(" }}\n");
    };
    put("mesh2 {{ vertex_vectors {{ {}", mesh.positions.size());
    for (const Vec3f& p : mesh.positions) put(",{}", vector(Vec3d(p) + origin));
    put(" }}\n");
    const bool smooth = !mesh.normals.empty() && picture_ != PovrayPicture::lit;
    if (smooth) {
      put("normal_vectors {{ {}", mesh.normals.size());
      for (const Vec3f& n : mesh.normals) put(",{}", vector(n));
      put(" }}\n");
    }
    write_faces("face_indices", mesh.corners);
    if (smooth && !mesh.normal_corners.empty()) write_faces("normal_indices", mesh.normal_corners);
    write_material_of(entry.shape);
    put("}}\n");
  }

  void write_shapes() {
    const ShapeSet& shapes = *scene_.shapes;
    for (std::size_t i = 0; i < shapes.spheres.shape.size(); ++i) {
      const Imath::V4f& sphere = shapes.spheres.center_radius[i];
      put("sphere {{ {}, {} ", vector(Vec3d(sphere.x, sphere.y, sphere.z) + shapes.origin), sphere.w);
      write_material_of(shapes.spheres.shape[i]);
      put("}}\n");
    }
    for (std::size_t i = 0; i < shapes.discs.shape.size(); ++i) {
      const Imath::V4f& disc = shapes.discs.center_radius[i];
      put("disc {{ {}, {}, {} ", vector(Vec3d(disc.x, disc.y, disc.z) + shapes.origin), vector(shapes.discs.normal[i]),
          disc.w);
      write_material_of(shapes.discs.shape[i]);
      put("}}\n");
    }
    for (std::size_t i = 0; i < shapes.cones.shape.size(); ++i) {
      const Imath::V4f &base = shapes.cones.base_radius[i], &apex = shapes.cones.apex_radius[i];
      put("cone {{ {}, {}, {}, {} open ", vector(Vec3d(base.x, base.y, base.z) + shapes.origin), base.w,
          vector(Vec3d(apex.x, apex.y, apex.z) + shapes.origin), apex.w);
      write_material_of(shapes.cones.shape[i]);
      put("}}\n");
    }
    for (const Plane& plane : shapes.planes) {
      put("plane {{ {}, {} ", vector(plane.normal), plane.normal.dot(plane.point + shapes.origin));
      write_material_of(plane.shape);
      put("}}\n");
    }
    for (const MeshEntry& entry : shapes.meshes) write_mesh(entry);
  }

  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::unique_ptr<std::FILE, Close> file_;
  const Scene& scene_;
  const PovrayPicture picture_;
  const double reach_;
};

/// The number after `key` behind the last `section` of the text.
double number_after(const std::string& text, const std::string& section, const std::string& key) {
  const std::size_t begin = text.rfind(section);
  const std::size_t at = begin == std::string::npos ? begin : text.find(key, begin);
  double value = 0;
  if (at == std::string::npos || std::sscanf(text.c_str() + at + key.size(), "%lf", &value) != 1)
    throw Error(ErrorKind::failure, {}, "POV-Ray's report lacks \"" + key + "\"");
  return value;
}

}  // namespace

void write_povray_scene(const std::filesystem::path& path, const Scene& scene, PovrayPicture picture, double reach) {
  Writer(path, scene, picture, reach).write();
}

PovrayStatistics parse_povray_statistics(const std::string& report) {
  return {number_after(report, "Trace Time:", "thread(s) with "), number_after(report, "Render Statistics", "Rays:")};
}

}  // namespace raytree::benchmarks
