// Parallel checks of a parsed mesh; the compaction that follows a bad face is sequential, being rare.
#include "geometry/mesh_checks.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/newell.h"

namespace raytree {
namespace {

using IndexRange = tbb::blocked_range<std::size_t>;
constexpr std::size_t kGrain = 65536;

bool is_finite(const Vec3f& p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }

template <class Predicate>
bool any_of_parallel(std::size_t count, const Predicate& predicate) {
  return tbb::parallel_reduce(
      IndexRange(0, count, kGrain), false,
      [&](const IndexRange& range, bool found) {
        for (std::size_t i = range.begin(); i != range.end() && !found; ++i) found = predicate(i);
        return found;
      },
      [](bool a, bool b) { return a || b; });
}

/// Removes corners that repeat their predecessor (the first's is the last); `kept` receives what stays. Returns their
/// number, 0 if the face is to be dropped.
std::size_t distinct_corners(const std::uint32_t* corners, std::size_t size, std::vector<std::uint32_t>& kept) {
  kept.clear();
  for (std::size_t i = 0; i < size; ++i)
    if (kept.empty() || corners[kept.back()] != corners[i]) kept.push_back(static_cast<std::uint32_t>(i));
  while (kept.size() > 1 && corners[kept.back()] == corners[kept.front()]) kept.pop_back();
  if (kept.size() < 3) return 0;
  if (kept.size() == 4 && (corners[kept[0]] == corners[kept[2]] || corners[kept[1]] == corners[kept[3]])) return 0;
  return kept.size();
}

bool is_plain(const std::uint32_t* c, std::size_t size) {
  if (size < 3) return false;
  if (size == 3) return c[0] != c[1] && c[1] != c[2] && c[2] != c[0];
  for (std::size_t i = 0; i < size; ++i)
    if (c[i] == c[i + 1 == size ? 0 : i + 1]) return false;
  return size != 4 || (c[0] != c[2] && c[1] != c[3]);
}

bool has_bad_face(const PolygonMesh& mesh, bool all_finite) {
  const auto uses_bad_position = [&](std::size_t i) { return !is_finite(mesh.positions[mesh.corners[i]]); };
  if (!all_finite && any_of_parallel(mesh.corners.size(), uses_bad_position)) return true;
  if (mesh.all_triangles())
    return any_of_parallel(mesh.face_count(), [&](std::size_t f) { return !is_plain(&mesh.corners[3 * f], 3); });
  std::size_t first = 0;
  for (const std::uint32_t size : mesh.face_sizes) {
    if (!is_plain(mesh.corners.data() + first, size)) return true;
    first += size;
  }
  return false;
}

struct OddityTally {
  std::int64_t count = 0;
  std::size_t first = 0;
  void add(std::size_t element) {
    if (count++ == 0) first = element;
  }
};

void warn(const OddityTally& tally, const std::function<SourceLocation(std::size_t)>& locate, const char* message,
          Warnings& warnings) {
  if (tally.count > 0) warnings.push_back({locate(tally.first), message, tally.count});
}

/// "1 face", "2 faces".
std::string counted_faces(std::int64_t count) { return std::to_string(count) + (count == 1 ? " face" : " faces"); }

/// Why no face is left, at the first element that is at fault. `bad_vertex`: the first of a face that is not finite.
[[noreturn]] void fail_empty(const PolygonMesh& mesh, std::size_t bad_vertex, const OddityTally& not_finite,
                             const OddityTally& degenerate, const MeshLocator& locate) {
  constexpr const char* kNoneLeft = ", so no face is left";
  if (not_finite.count == 0)
    throw Error(ErrorKind::bad_input, locate.face(degenerate.first),
                "fewer than three distinct corners; " + counted_faces(degenerate.count) +
                    (degenerate.count == 1 ? " was" : " of this kind were") + " dropped" + kNoneLeft);
  const Vec3f& position = mesh.positions[bad_vertex];
  const bool is_nan = std::isnan(position.x) || std::isnan(position.y) || std::isnan(position.z);
  SourceLocation where = locate.vertex(bad_vertex);
  where.object.clear();  // the message names it
  std::string message = "vertex " + std::to_string(bad_vertex + 1) + " is not finite (" +
                        (is_nan ? "nan" : "beyond the largest 32-bit float") + "); ";
  message += not_finite.count == 1 ? "its 1 face was dropped"
                                   : counted_faces(not_finite.count) + " with such vertices were dropped";
  if (degenerate.count > 0)
    message += ", and " + counted_faces(degenerate.count) + " with fewer than three distinct corners";
  throw Error(ErrorKind::bad_input, where, message + kNoneLeft);
}

}  // namespace

Vec3d mesh_origin(const Bounds3d& box) {
  constexpr double kLargeCoordinate = 1024;
  if (box.isEmpty()) return Vec3d(0, 0, 0);
  double largest = 0, extent = 0;
  for (int axis = 0; axis < 3; ++axis) {
    largest = std::max({largest, std::abs(box.min[axis]), std::abs(box.max[axis])});
    extent = std::max(extent, box.max[axis] - box.min[axis]);
  }
  if (largest < kLargeCoordinate || largest <= extent) return Vec3d(0, 0, 0);
  const auto center = [&](int axis) { return std::round(box.min[axis] + (box.max[axis] - box.min[axis]) / 2); };
  return Vec3d(center(0), center(1), center(2));
}

void settle_mesh(PolygonMesh& mesh, const std::string& name, const MeshLocator& locate, Warnings& warnings) {
  if (mesh.face_count() == 0) throw Error(ErrorKind::bad_input, {name, 0, {}}, "no faces in this file");
  const bool all_finite =
      !any_of_parallel(mesh.positions.size(), [&](std::size_t i) { return !is_finite(mesh.positions[i]); });

  if (has_bad_face(mesh, all_finite)) {
    OddityTally mended, dropped, not_finite;
    std::size_t bad_vertex = 0;  // the first one of the first face that is not finite
    std::vector<std::uint32_t> kept;
    std::size_t read = 0, write = 0, face_write = 0, group = 0;
    bool only_triangles = true;
    std::vector<FaceGroup> groups;
    std::vector<std::uint32_t>* const holes = mesh.subdivision ? &mesh.subdivision->holes : nullptr;
    std::vector<std::uint32_t> new_faces;  // for holes alone, which are named by number
    const std::size_t faces = mesh.face_count();
    const bool with_sizes = !mesh.face_sizes.empty();
    for (std::size_t face = 0; face < faces; ++face) {
      while (group < mesh.groups.size() && mesh.groups[group].first_face == face) {
        groups.push_back(std::move(mesh.groups[group++]));
        groups.back().first_face = static_cast<std::uint32_t>(face_write);
        groups.back().face_count = 0;
      }
      const std::size_t size = with_sizes ? mesh.face_sizes[face] : 3;
      const std::uint32_t* const corners = mesh.corners.data() + read;
      bool finite = all_finite;
      if (!finite) {
        const auto bad =
            std::find_if(corners, corners + size, [&](std::uint32_t c) { return !is_finite(mesh.positions[c]); });
        finite = bad == corners + size;
        if (!finite && not_finite.count == 0) bad_vertex = *bad;
      }
      std::size_t kept_size = 0;
      if (!finite) {
        not_finite.add(face);
      } else {
        kept_size = distinct_corners(corners, size, kept);
        if (kept_size == 0)
          dropped.add(face);
        else if (kept_size != size)
          mended.add(face);
      }
      for (std::size_t i = 0; i < kept_size; ++i) {
        mesh.corners[write + i] = mesh.corners[read + kept[i]];
        if (!mesh.normal_corners.empty()) mesh.normal_corners[write + i] = mesh.normal_corners[read + kept[i]];
        if (!mesh.texture_corners.empty()) mesh.texture_corners[write + i] = mesh.texture_corners[read + kept[i]];
      }
      if (holes != nullptr && !holes->empty())
        new_faces.push_back(kept_size > 0 ? static_cast<std::uint32_t>(face_write) : kNoIndex);
      if (kept_size > 0) {
        if (with_sizes) mesh.face_sizes[face_write] = static_cast<std::uint32_t>(kept_size);
        only_triangles = only_triangles && kept_size == 3;
        ++face_write;
        if (!groups.empty()) ++groups.back().face_count;
      }
      read += size;
      write += kept_size;
    }
    std::erase_if(groups, [](const FaceGroup& g) { return g.face_count == 0; });
    mesh.groups = std::move(groups);
    if (!new_faces.empty()) {
      for (std::uint32_t& hole : *holes) hole = new_faces[hole];
      std::erase(*holes, kNoIndex);
    }
    mesh.corners.resize(write);
    if (!mesh.normal_corners.empty()) mesh.normal_corners.resize(write);
    if (!mesh.texture_corners.empty()) mesh.texture_corners.resize(write);
    if (only_triangles)
      mesh.face_sizes = {};
    else
      mesh.face_sizes.resize(face_write);
    if (face_write == 0) fail_empty(mesh, bad_vertex, not_finite, dropped, locate);
    warn(mended, locate.face, "repeated corners removed from faces", warnings);
    warn(dropped, locate.face, "faces with fewer than three distinct corners dropped", warnings);
    warn(not_finite, locate.face, "faces with a vertex that is not finite dropped", warnings);
  }

  if (!all_finite) {
    OddityTally replaced;
    const auto good = std::find_if(mesh.positions.begin(), mesh.positions.end(), is_finite);
    const Vec3f substitute = good == mesh.positions.end() ? Vec3f(0, 0, 0) : *good;
    for (std::size_t i = 0; i < mesh.positions.size(); ++i)
      if (!is_finite(mesh.positions[i])) {
        mesh.positions[i] = substitute;
        replaced.add(i);
      }
    warn(replaced, locate.vertex, "vertices that are not finite dropped", warnings);
  }
}

void complete_corners(PolygonMesh& mesh, const MeshLocator& locate, Warnings& warnings) {
  const auto is_missing = [](const Buffer<std::uint32_t>& indices) {
    return any_of_parallel(indices.size(), [&](std::size_t i) { return indices[i] == kNoIndex; });
  };
  const auto simplify = [&](Buffer<std::uint32_t>& indices, std::size_t value_count) {
    if (indices.empty() || value_count != mesh.positions.size()) return;
    if (!any_of_parallel(indices.size(), [&](std::size_t i) { return indices[i] != mesh.corners[i]; })) indices = {};
  };
  const auto too_many = [&] {
    throw Error(ErrorKind::bad_input, locate.face(0), "more normals or texture coordinates than 32-bit indices reach");
  };

  if (is_missing(mesh.normal_corners)) {
    OddityTally faces_without;
    const std::size_t faces = mesh.face_count();
    std::size_t first = 0;
    // Two rounds: the first counts, so that the array grows once.
    for (const bool fill : {false, true}) {
      std::size_t next = mesh.normals.size();
      if (fill) {
        if (next + static_cast<std::size_t>(faces_without.count) >= kNoIndex) too_many();
        mesh.normals.resize(next + static_cast<std::size_t>(faces_without.count));
      }
      first = 0;
      for (std::size_t face = 0; face < faces; ++face) {
        const std::size_t size = mesh.all_triangles() ? 3 : mesh.face_sizes[face];
        std::uint32_t* const begin = mesh.normal_corners.data() + first;
        if (std::find(begin, begin + size, kNoIndex) != begin + size) {
          if (!fill) {
            faces_without.add(face);
          } else {
            Vec3d normal = newell_normal(mesh.positions.data(), mesh.corners.data() + first, size);
            normal.normalize();
            mesh.normals[next] = Vec3f(normal);
            std::replace(begin, begin + size, kNoIndex, static_cast<std::uint32_t>(next++));
          }
        }
        first += size;
      }
    }
    warn(faces_without, locate.face, "faces without normals, in a file with normals, take their own", warnings);
  }
  if (is_missing(mesh.texture_corners)) {
    OddityTally faces_without;
    const std::size_t faces = mesh.face_count();
    const std::size_t added = mesh.texture_coordinates.size();
    if (added + 1 >= kNoIndex) too_many();
    mesh.texture_coordinates.push_back(Vec2f(0, 0));
    std::size_t first = 0;
    for (std::size_t face = 0; face < faces; ++face) {
      const std::size_t size = mesh.all_triangles() ? 3 : mesh.face_sizes[face];
      std::uint32_t* const begin = mesh.texture_corners.data() + first;
      if (std::find(begin, begin + size, kNoIndex) != begin + size) {
        faces_without.add(face);
        std::replace(begin, begin + size, kNoIndex, static_cast<std::uint32_t>(added));
      }
      first += size;
    }
    warn(faces_without, locate.face, "faces without texture coordinates, in a file with them, take (0, 0)", warnings);
  }
  simplify(mesh.normal_corners, mesh.normals.size());
  simplify(mesh.texture_corners, mesh.texture_coordinates.size());
}

}  // namespace raytree
