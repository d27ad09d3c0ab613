#include "benchmarks/curved_picture_scenes.h"

#include <fmt/format.h>

#include <cstdint>
#include <set>
#include <utility>

#include "benchmarks/bumpy_torus.h"
#include "benchmarks/samples/cages.h"
#include "geometry/mesh_file.h"
#include "geometry/obj_writer.h"
#include "renderer/atomic_file.h"
#include "renderer/builtin_scenes.h"
#include "renderer/mesh_scene.h"
#include "renderer/scene_reader.h"

namespace raytree::benchmarks {
namespace {

constexpr const char* kCagePath = "shapes.object.subdivision";  ///< of a mesh's own scene, as `--set` takes it
constexpr const char* kCageRules = "{}";
constexpr int kTenMillionRate = 23;  ///< 10,086 faces of 2 x 23 x 23 triangles

bool is_closed(const PolygonMesh& cage) {
  std::set<std::pair<std::uint32_t, std::uint32_t>> open;
  std::size_t first = 0;
  for (std::size_t face = 0; face < cage.face_count(); ++face) {
    const std::size_t size = cage.all_triangles() ? 3 : cage.face_sizes[face];
    for (std::size_t i = 0; i < size; ++i) {
      const std::uint32_t a = cage.corners[first + i], b = cage.corners[first + (i + 1) % size];
      if (open.erase({b, a}) == 0) open.insert({a, b});
    }
    first += size;
  }
  return open.empty();
}

CurvedPicture cage_picture(const std::string& name, const std::filesystem::path& file, int rate) {
  CurvedPicture picture;
  picture.name = name;
  picture.words = {file.string(), "--set", fmt::format("{}={}", kCagePath, kCageRules)};
  if (rate > 0) picture.words.insert(picture.words.end(), {"--rate", std::to_string(rate)});
  picture.rate = rate;
  Warnings warnings;
  picture.closed = is_closed(read_mesh_file(file.string(), warnings));
  picture.make = [file, rate] {
    Warnings of_scene;
    const ImageDescription image{kCurvedPictureWidth, kCurvedPictureHeight};
    SceneDescription scene = mesh_scene(file.string(), of_scene, image);
    set_scene_value(scene, kCagePath, kCageRules);
    scene.render.tessellation.rate = rate;
    return scene;
  };
  return picture;
}

CurvedPicture own_cage_picture(const std::string& name, const PolygonMesh& cage, const std::filesystem::path& file,
                               int rate) {
  const std::string text = obj_text(cage);
  write_file_atomically(file.string(), text.data(), text.size());
  return cage_picture(name, file, rate);
}

CurvedPicture teapot_picture() {
  CurvedPicture picture;
  picture.name = "teapot";
  picture.words = {"teapot"};
  picture.make = [] {
    SceneDescription scene = builtin_scene("teapot");
    scene.image = {kCurvedPictureWidth, kCurvedPictureHeight};
    return scene;
  };
  return picture;
}

PolygonMesh creased_cube() {
  PolygonMesh cage = samples::cube_cage();
  SubdivisionRules rules;
  rules.creases = {{{4, 5, 7, 6, 4}, 2.5}};
  cage.subdivision = rules;
  return cage;
}

}  // namespace

std::vector<CurvedPicture> curved_pictures(const std::filesystem::path& data, const std::filesystem::path& scratch) {
  struct Others {
    const char *name, *file;
    const char* stand_in_name;
    PolygonMesh stand_in;
  };
  const Others others[] = {
      {"Spot", "subdiv/spot/spot_control_mesh.obj", "a cube with a semi-sharp crease", creased_cube()},
      {"the car", "subdiv/osd_shapes/catmark_car.obj", "a star of valence 7", samples::star_cage(7)},
  };
  std::vector<CurvedPicture> pictures;
  for (const Others& one : others) {
    const std::filesystem::path file = data / one.file;
    if (std::filesystem::exists(file)) {
      pictures.push_back(cage_picture(one.name, file, 0));
    } else {
      const std::string name = fmt::format("{} ({}'s file is not there)", one.stand_in_name, one.name);
      const std::string own = fmt::format("cage-{}.obj", pictures.size());
      pictures.push_back(own_cage_picture(name, one.stand_in, scratch / own, 0));
    }
  }
  pictures.push_back(teapot_picture());
  pictures.push_back(own_cage_picture("a bumpy torus, irregular vertices at each face", irregular_torus_cage(false),
                                      scratch / "torus.obj", kTenMillionRate));
  return pictures;
}

SceneDescription curved_shapes_alone(SceneDescription scene) {
  std::erase_if(scene.shapes, [](const ShapeDescription& shape) {
    const auto* mesh = std::get_if<MeshShape>(&shape.kind);
    return !(mesh != nullptr && mesh->subdivision) && !std::holds_alternative<PatchesShape>(shape.kind);
  });
  return scene;
}

}  // namespace raytree::benchmarks
