#include "geometry/obj_writer.h"

#include <array>
#include <charconv>

namespace raytree {
namespace {

class ObjWriter {
 public:
  explicit ObjWriter(const PolygonMesh& mesh) : mesh_(mesh) {}

  std::string text() {
    text_ = "# written by raytree\n";
    for (const std::string& library : mesh_.material_libraries) text_ += "mtllib " + library + "\n";
    const bool moved = mesh_.origin != Vec3d(0, 0, 0);
    for (const Vec3f& p : mesh_.positions) {
      text_ += 'v';
      for (int axis = 0; axis < 3; ++axis)
        if (moved)
          number(mesh_.origin[axis] + double(p[axis]));
        else
          number(p[axis]);
      text_ += '\n';
    }
    for (const Vec2f& t : mesh_.texture_coordinates) statement("vt", t.x, t.y);
    for (const Vec3f& n : mesh_.normals) statement("vn", n.x, n.y, n.z);
    faces();
    if (mesh_.subdivision) tags(*mesh_.subdivision);
    return std::move(text_);
  }

 private:
  template <class Number>
  void append(Number value) {
    char digits[32];
    text_.append(digits, std::to_chars(digits, digits + sizeof digits, value).ptr);
  }
  template <class Number>
  void number(Number value) {
    text_ += ' ';
    append(value);
  }
  template <class... Number>
  void statement(const char* word, Number... values) {
    text_ += word;
    (number(values), ...);
    text_ += '\n';
  }

  void corner(std::size_t i) {
    number(mesh_.corners[i] + std::uint64_t(1));
    const bool with_texture = !mesh_.texture_coordinates.empty(), with_normals = !mesh_.normals.empty();
    const auto index = [&](const Buffer<std::uint32_t>& own) {
      append((own.empty() ? mesh_.corners : own)[i] + std::uint64_t(1));
    };
    if (!with_texture && !with_normals) return;
    text_ += '/';
    if (with_texture) index(mesh_.texture_corners);
    if (!with_normals) return;
    text_ += '/';
    index(mesh_.normal_corners);
  }

  void faces() {
    std::size_t first = 0, group = 0;
    const std::string *name = nullptr, *material = nullptr;
    for (std::size_t face = 0; face < mesh_.face_count(); ++face) {
      for (; group < mesh_.groups.size() && mesh_.groups[group].first_face == face; ++group) {
        const FaceGroup& next = mesh_.groups[group];
        if (name ? *name != next.name : !next.name.empty()) text_ += "g " + next.name + "\n";
        if (material ? *material != next.material : !next.material.empty()) text_ += "usemtl " + next.material + "\n";
        name = &next.name, material = &next.material;
      }
      const std::size_t size = mesh_.all_triangles() ? 3 : mesh_.face_sizes[face];
      text_ += 'f';
      for (std::size_t i = first; i < first + size; ++i) corner(i);
      text_ += '\n';
      first += size;
    }
  }

  void tags(const SubdivisionRules& rules) {
    const auto choice = [&](const char* tag, int value) {
      text_ += "t " + std::string(tag) + " 1/0/0 " + std::to_string(value) + "\n";
    };
    if (rules.boundary) choice("interpolateboundary", std::array{0, 2, 1}[static_cast<std::size_t>(*rules.boundary)]);
    if (rules.face_varying) choice("facevaryinginterpolateboundary", static_cast<int>(*rules.face_varying));
    if (rules.crease_method)
      text_ += std::string("t creasemethod 0/0/1 ") +
               (*rules.crease_method == CreaseMethod::chaikin ? "chaikin\n" : "normal\n");
    if (rules.triangles)
      text_ += std::string("t smoothtriangles 0/0/1 ") +
               (*rules.triangles == TriangleRule::smooth ? "smooth\n" : "catmark\n");
    for (const Crease& crease : rules.creases)
      for (std::size_t i = 0; i + 1 < crease.vertices.size(); ++i)
        statement("t crease 2/1/0", crease.vertices[i], crease.vertices[i + 1], crease.sharpness);
    for (const SharpCorner& sharp : rules.corners) statement("t corner 1/1/0", sharp.vertex, sharp.sharpness);
    for (const std::uint32_t hole : rules.holes) statement("t hole 1/0/0", hole);
  }

  const PolygonMesh& mesh_;
  std::string text_;
};

}  // namespace

std::string obj_text(const PolygonMesh& mesh) { return ObjWriter(mesh).text(); }

}  // namespace raytree
