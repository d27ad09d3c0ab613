#include "geometry/subdivision_cage.h"

#include <algorithm>
#include <cmath>

#include "geometry/polygon_mesh.h"

namespace raytree {
namespace {

/// OpenSubdiv counts neighbours in 16 bits (Far::VALENCE_LIMIT).
constexpr std::uint32_t kLargestValence = 65535;

class CageCheck {
 public:
  CageCheck(const PolygonMesh& mesh, const SubdivisionRules& rules, const SourceLocation& where)
      : mesh_(mesh), rules_(rules), where_(where) {}

  void run() const {
    check_faces();
    check_values();
    check_creases();
    for (const SharpCorner& corner : rules_.corners) {
      if (corner.vertex >= mesh_.positions.size()) fail_vertex("a sharp corner", corner.vertex);
      check_sharpness("the sharp corner at vertex " + std::to_string(corner.vertex), corner.sharpness);
    }
    for (const std::uint32_t hole : rules_.holes)
      if (hole >= mesh_.face_count())
        fail("a hole is named as face " + std::to_string(hole) + "; there are " + std::to_string(mesh_.face_count()) +
             " faces, counted from 0");
    if (rules_.crease_angle && !(*rules_.crease_angle >= 0 && *rules_.crease_angle <= 180))
      fail("a crease angle lies between 0 and 180 degrees");
  }

 private:
  [[noreturn]] void fail(const std::string& message) const {
    throw Error(ErrorKind::bad_input, where_, "subdivision cage: " + message);
  }
  [[noreturn]] void fail_face(std::size_t face, const std::string& message) const {
    fail("face " + std::to_string(face) + " (counted from 0) " + message);
  }
  [[noreturn]] void fail_vertex(const std::string& what, std::uint32_t vertex) const {
    fail(what + " names vertex " + std::to_string(vertex) + "; there are " + std::to_string(mesh_.positions.size()) +
         ", counted from 0");
  }

  void check_faces() const {
    if (mesh_.face_count() == 0) fail("there are no faces");
    const bool loop = rules_.scheme.value_or(kDefaultScheme) == SubdivisionScheme::loop;
    if (mesh_.all_triangles() && mesh_.corners.size() % 3 != 0) fail("the last triangle lacks corners");
    for (const Buffer<std::uint32_t>* corners : {&mesh_.texture_corners, &mesh_.normal_corners})
      if (!corners->empty() && corners->size() != mesh_.corners.size())
        fail("an index array of texture coordinates or normals does not fit the faces");
    std::vector<std::uint32_t> faces_at(mesh_.positions.size(), 0), sorted;
    std::size_t first = 0;
    for (std::size_t face = 0; face < mesh_.face_count(); ++face) {
      const std::size_t size = mesh_.all_triangles() ? 3 : mesh_.face_sizes[face];
      if (size < 3) fail_face(face, "has " + std::to_string(size) + " corners; 3 is the least");
      if (size > kLargestValence) fail_face(face, "has " + std::to_string(size) + " corners; 65535 is the most");
      if (loop && size != 3)
        fail_face(face, "has " + std::to_string(size) + " corners; the scheme loop takes triangles alone");
      if (size > mesh_.corners.size() - first) fail_face(face, "reaches past the end of the corners");
      sorted.assign(mesh_.corners.begin() + static_cast<std::ptrdiff_t>(first),
                    mesh_.corners.begin() + static_cast<std::ptrdiff_t>(first + size));
      for (const std::uint32_t vertex : sorted) {
        if (vertex >= mesh_.positions.size())
          fail_face(face, "refers to vertex " + std::to_string(vertex) + "; there are " +
                              std::to_string(mesh_.positions.size()) + ", counted from 0");
        if (++faces_at[vertex] > kLargestValence)
          fail_face(face, "is the 65536th at vertex " + std::to_string(vertex) + "; 65535 is the most");
      }
      std::sort(sorted.begin(), sorted.end());
      if (const auto twice = std::adjacent_find(sorted.begin(), sorted.end()); twice != sorted.end())
        fail_face(face, "uses vertex " + std::to_string(*twice) + " twice");
      for (std::size_t corner = first; corner < first + size && !mesh_.texture_coordinates.empty(); ++corner) {
        const std::uint32_t value =
            mesh_.texture_corners.empty() ? mesh_.corners[corner] : mesh_.texture_corners[corner];
        if (value >= mesh_.texture_coordinates.size())
          fail_face(face, "refers to texture coordinates " + std::to_string(value) + "; there are " +
                              std::to_string(mesh_.texture_coordinates.size()) + ", counted from 0");
      }
      first += size;
    }
    if (first != mesh_.corners.size()) fail("the faces use fewer corners than there are");
  }

  void check_values() const {
    for (std::size_t i = 0; i < mesh_.positions.size(); ++i)
      if (const Vec3f& p = mesh_.positions[i]; !std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
        fail("vertex " + std::to_string(i) + " (counted from 0) is not finite");
    for (std::size_t i = 0; i < mesh_.texture_coordinates.size(); ++i)
      if (const Vec2f& t = mesh_.texture_coordinates[i]; !std::isfinite(t.x) || !std::isfinite(t.y))
        fail("texture coordinates " + std::to_string(i) + " (counted from 0) are not finite");
  }

  void check_creases() const {
    for (std::size_t i = 0; i < rules_.creases.size(); ++i) {
      const Crease& crease = rules_.creases[i];
      const std::string name = "crease " + std::to_string(i) + " (counted from 0)";
      if (crease.vertices.size() < 2) fail(name + " needs two vertices or more");
      for (std::size_t k = 0; k < crease.vertices.size(); ++k) {
        if (crease.vertices[k] >= mesh_.positions.size()) fail_vertex(name, crease.vertices[k]);
        if (k > 0 && crease.vertices[k] == crease.vertices[k - 1])
          fail(name + " goes from vertex " + std::to_string(crease.vertices[k]) + " to itself");
      }
      check_sharpness(name, crease.sharpness);
    }
  }

  void check_sharpness(const std::string& what, double sharpness) const {
    // NaN fails the comparison.
    if (!(sharpness >= 0)) fail(what + " has a sharpness that is negative or no number");
  }

  const PolygonMesh& mesh_;
  const SubdivisionRules& rules_;
  const SourceLocation& where_;
};

}  // namespace

SubdivisionRules joined(SubdivisionRules weaker, const SubdivisionRules& stronger) {
  const auto prefer = [](auto& value, const auto& better) {
    if (better) value = better;
  };
  prefer(weaker.scheme, stronger.scheme);
  prefer(weaker.boundary, stronger.boundary);
  prefer(weaker.face_varying, stronger.face_varying);
  prefer(weaker.crease_method, stronger.crease_method);
  prefer(weaker.triangles, stronger.triangles);
  prefer(weaker.crease_angle, stronger.crease_angle);
  const auto append = [](auto& list, const auto& more) { list.insert(list.end(), more.begin(), more.end()); };
  append(weaker.creases, stronger.creases);
  append(weaker.corners, stronger.corners);
  append(weaker.holes, stronger.holes);
  return weaker;
}

void check_cage(const PolygonMesh& mesh, const SubdivisionRules& rules, const SourceLocation& where) {
  CageCheck(mesh, rules, where).run();
}

}  // namespace raytree
