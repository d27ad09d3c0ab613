// Writing scenes: random ones read back equal, and numbers are the shortest that do.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "renderer/material.h"
#include "renderer/scene_reader.h"
#include "tests/renderer/scene_equality.h"

namespace raytree {
namespace {

/// Fills every member that the tables know with random values within their ranges.
class Randomizer {
 public:
  explicit Randomizer(unsigned seed) : random_(seed) {}

  template <class Member>
  void operator()(const Field& field, Member& member) {
    ++fields;
    fill(field, member);
  }
  template <class Variant>
  void tagged(const Field&, Variant& variant) {
    const int wanted = whole(0, static_cast<int>(std::variant_size_v<Variant>) - 1);
    int index = 0;
    for_each_alternative<Variant>([&]<class T>(std::in_place_type_t<T>) {
      if (index++ == wanted) variant = T{};
    });
    std::visit([&](auto& alternative) { visit_fields(*this, alternative); }, variant);
  }
  void inlined(MeshShape& shape) {
    if (whole(0, 1) == 0) return;
    shape.file.clear();
    shape.mesh = std::make_shared<PolygonMesh>();
    PolygonMesh& mesh = *shape.mesh;
    fill({}, mesh.origin);
    const std::size_t vertices = 4 + static_cast<std::size_t>(whole(0, 3));
    const auto vector = [&] { return Vec3f(float_number(), float_number(), float_number()); };
    for (std::size_t i = 0; i < vertices; ++i) mesh.positions.push_back(vector());
    const bool triangles = whole(0, 1) == 0;
    if (!triangles) mesh.face_sizes.push_back(4);
    for (int face = 0; face < 3; ++face)
      if (!triangles) mesh.face_sizes.push_back(3);
    const std::size_t corners = triangles ? 9 : 13;
    const auto indices = [&](std::size_t count) {
      Buffer<std::uint32_t> list;
      for (std::size_t i = 0; i < corners; ++i)
        list.push_back(static_cast<std::uint32_t>(whole(0, static_cast<int>(count) - 1)));
      return list;
    };
    mesh.corners = indices(vertices);
    if (whole(0, 1) == 0) {
      for (std::size_t i = 0; i < vertices; ++i) mesh.normals.push_back(vector());
      if (whole(0, 1) == 0) mesh.normal_corners = indices(vertices);
    }
    if (whole(0, 1) == 0) {
      for (std::size_t i = 0; i < vertices; ++i) mesh.texture_coordinates.push_back({float_number(), float_number()});
      if (whole(0, 1) == 0) mesh.texture_corners = indices(vertices);
    }
    if (whole(0, 1) == 0) mesh.groups = {{"a", "x", 0, 1}, {"b \"quoted\"", "", 1, 2}};
  }

  int fields = 0;

 private:
  int whole(int low, int high) { return std::uniform_int_distribution<int>(low, high)(random_); }
  double number(const Range& range = {}) {
    const double low = std::max(range.low, -1e3), high = std::min(range.high, 1e3);
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  float float_number(const Range& range = {}) { return static_cast<float>(number(range)); }

  void fill(const Field&, bool& x) { x = whole(0, 1) == 1; }
  void fill(const Field&, std::optional<bool>& x) {
    const int choice = whole(0, 2);
    x = choice == 2 ? std::nullopt : std::optional(choice == 1);
  }
  void fill(const Field& field, double& x) { x = number(field.range); }
  template <std::integral Integer>
  void fill(const Field& field, Integer& x) {
    x = static_cast<Integer>(std::floor(number(field.range)));
  }
  void fill(const Field& field, std::string& x) {
    // A shape's material is a name of the scene; the caller sets it.
    x = field.key == "material" ? "" : "text \"" + std::to_string(whole(0, 999)) + "\"\t\\ \xC3\xA4\n";
  }
  void fill(const Field&, SceneVersion&) {}
  template <class E>
  requires std::is_enum_v<E>
  void fill(const Field&, E& x) {
    const auto& entries = EnumTable<E>::entries;
    x = entries[static_cast<std::size_t>(whole(0, static_cast<int>(entries.size()) - 1))].value;
  }
  void fill(const Field&, Antialiasing& x) {
    const auto method = static_cast<Antialiasing::Method>(whole(0, 2));
    x = {method, method == Antialiasing::Method::grid ? whole(1, kMaxGridSize) : 1};
  }
  void fill(const Field& field, Vec2d& x) { x = {number(field.range), number(field.range)}; }
  void fill(const Field& field, Vec3d& x) { x = {number(field.range), number(field.range), number(field.range)}; }
  void fill(const Field& field, Rgb& x) {
    x = {float_number(field.range), float_number(field.range), float_number(field.range)};
  }
  void fill(const Field& field, ColorPattern& x) {
    if (whole(0, 1) == 0) {
      Rgb color;
      fill(field, color);
      x = color;
    } else {
      VaryingPattern pattern;
      tagged({}, pattern);
      x = color_pattern(pattern);
    }
  }
  void fill(const Field& field, std::optional<ColorPattern>& x) {
    x.reset();
    if (whole(0, 1) == 0) fill(field, x.emplace());
  }
  template <class T>
  void fill(const Field& field, std::optional<T>& x) {
    x.reset();
    if (whole(0, 1) == 0) fill(field, x.emplace());
  }
  void fill(const Field& field, std::vector<Vec3d>& list) {
    list.resize(4);
    // A radius of a lathe must not be negative.
    for (Vec3d& x : list) x = {number({0}), number(field.range), number(field.range)};
  }
  void fill(const Field& field, std::vector<double>& list) {
    list.assign(4, 0);
    for (double& x : list) x = number(field.range) + 1e-3;
  }
  template <std::size_t Count>
  void fill(const Field&, IndexLists<Count>& lists) {
    lists.resize(static_cast<std::size_t>(whole(1, 3)));
    for (auto& list : lists)
      for (std::uint32_t& index : list) index = static_cast<std::uint32_t>(whole(0, 3));
  }
  template <class T>
  requires std::same_as<T, Crease> || std::same_as<T, SharpCorner> || std::same_as<T, std::uint32_t>
  void fill(const Field& field, std::vector<T>& list) {
    list.clear();
    for (int i = whole(0, 3); i > 0; --i) fill(field, list.emplace_back());
  }
  void fill(const Field&, Background& x) { tagged({}, x); }
  void fill(const Field&, MaterialBase&) {}
  void fill(const Field&, std::vector<AngleWeight>& table) {
    table.clear();
    for (int i = whole(0, 3); i > 0; --i)
      table.push_back(
          {90.0 / i - (90.0 / i - 90.0 / (i + 1)) * number({0, 0.9}), {float_number({0}), float_number({0}), 1}});
  }
  void fill(const Field&, Matrix44d& x) {
    x = Matrix44d();
    if (whole(0, 2) == 0) return;
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 3; ++j) x[i][j] = number();
  }
  template <Named T>
  void fill(const Field&, std::vector<T>& list) {
    list.clear();
    for (int i = 0; i < 4; ++i) {
      T element{};
      element.name = "name " + std::to_string(i) + ".x";
      visit_fields(*this, element);
      if constexpr (std::same_as<T, MaterialDescription>) make_sound(element);
      list.push_back(std::move(element));
    }
  }
  /// What material_problem() refuses cannot be read back.
  static void make_sound(MaterialDescription& material) {
    if (material.conductor || material.one_sided) material.transmission = Rgb();
    if (material.thin) material.absorption = Rgb();
    ASSERT_EQ(material_problem(material), "");
  }
  template <Table T>
  void fill(const Field&, T& object) {
    visit_fields(*this, object);
  }

  std::mt19937 random_;
};

TEST(WriteScene, ReadsBackEqual) {
  for (unsigned seed = 0; seed < 200; ++seed) {
    SceneDescription scene;
    Randomizer randomizer(seed);
    visit_fields(randomizer, scene);
    scene.image.width = std::max(1, scene.image.width);
    // Names that others refer to must exist, and a group may only hold groups behind it.
    const auto mend = [&](std::vector<ShapeDescription>& shapes, std::size_t next_group) {
      const auto use = [&](ShapeDescription& shape, std::string& group) {
        if (next_group < scene.groups.size())
          group = scene.groups[next_group].name;
        else
          shape.kind = SphereShape{};
      };
      for (std::size_t i = 0; i < shapes.size(); ++i) {
        ShapeDescription& shape = shapes[i];
        shape.material = i == 0 ? "" : scene.materials.at(i).name;
        if (auto* mesh = std::get_if<MeshShape>(&shape.kind); mesh && mesh->file.empty() && !mesh->mesh)
          mesh->file = "x.ply";
        if (auto* patches = std::get_if<PatchesShape>(&shape.kind)) {
          // Either a file or what follows it.
          if (i % 2 == 0)
            patches->file.clear();
          else
            patches->positions.clear(), patches->weights.clear(), patches->bezier.clear(), patches->coons.clear(),
                patches->lathe.clear();
        }
        if (std::holds_alternative<PlaneShape>(shape.kind) && next_group > 0) shape.kind = TerrainShape{};
        if (auto* scatter = std::get_if<ScatterShape>(&shape.kind)) {
          shapes[(i + 1) % shapes.size()].kind = TerrainShape{};
          scatter->terrain = shapes[(i + 1) % shapes.size()].name;
          scatter->largest_scale += scatter->least_scale;
          scatter->highest = scatter->lowest + 1;
          use(shape, scatter->group);
        }
        if (auto* instance = std::get_if<InstanceShape>(&shape.kind)) use(shape, instance->group);
      }
      // What became a terrain last may have stood for another one's group.
      for (ShapeDescription& shape : shapes)
        if (auto* scatter = std::get_if<ScatterShape>(&shape.kind))
          if (std::none_of(shapes.begin(), shapes.end(), [&](const ShapeDescription& s) {
                return s.name == scatter->terrain && std::holds_alternative<TerrainShape>(s.kind);
              }))
            shape.kind = SphereShape{};
    };
    mend(scene.shapes, 0);
    for (std::size_t i = 0; i < scene.groups.size(); ++i) mend(scene.groups[i].shapes, i + 1);
    const std::string text = write_scene(scene);
    try {
      const SceneDescription read = read_scene(text, "written", "");
      EXPECT_TRUE(test::equal(read, scene)) << "seed " << seed << "\n" << text;
      EXPECT_EQ(write_scene(read), text) << "seed " << seed;
    } catch (const Error& error) {
      FAIL() << "seed " << seed << ": " << error.what() << "\n" << text;
    }
  }
}

TEST(WriteScene, NumbersAreTheShortestThatReadBack) {
  SceneDescription scene;
  scene.ambient = {0.1f, 1e-7f, 16777216.0f};
  scene.render.cutoff = 0.1;
  const std::string text = write_scene(scene);
  EXPECT_NE(text.find("\"ambient\": [0.1, 1e-07, 16777216]"), std::string::npos) << text;
  EXPECT_NE(text.find("\"cutoff\": 0.1,"), std::string::npos) << text;
}

}  // namespace
}  // namespace raytree
