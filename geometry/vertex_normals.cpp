// Vertex normals in three steps: unit face normals, the corners around each vertex (counting sort, corners in file
// order), and per vertex the sums over the corners that belong together. Every sum runs in corner order, so the result
// does not depend on threads.
#include "geometry/vertex_normals.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "geometry/angle.h"
#include "geometry/newell.h"

namespace raytree {
namespace {

constexpr std::size_t kItemsPerTask = 4096;  // vertices or faces that one task takes

/// Added to the cosine of a crease angle: unit normals in float are off by up to 1e-7, the product of two of them by
/// 2e-7 or less; faces that meet at exactly the crease angle count as smooth.
constexpr double kCosineTolerance = 4e-7;

/// Faces as runs of corners: fixed size 3, or sizes with running starts.
class Faces {
 public:
  explicit Faces(const PolygonMesh& mesh) : mesh_(mesh) {
    if (mesh.all_triangles()) return;
    starts_.resize(mesh.face_count() + 1);
    starts_[0] = 0;
    std::inclusive_scan(mesh.face_sizes.begin(), mesh.face_sizes.end(), starts_.begin() + 1);
  }
  std::size_t count() const { return mesh_.face_count(); }
  std::size_t begin(std::size_t face) const { return starts_.empty() ? 3 * face : starts_[face]; }
  std::size_t end(std::size_t face) const { return begin(face + 1); }
  std::size_t of_corner(std::size_t corner) const {
    if (starts_.empty()) return corner / 3;
    return static_cast<std::size_t>(std::upper_bound(starts_.begin(), starts_.end(), corner) - starts_.begin()) - 1;
  }

 private:
  const PolygonMesh& mesh_;
  Buffer<std::uint32_t> starts_;  // [face_count + 1]; empty: triangles
};

/// Unit, or zero for a face without area.
Vec3f unit_face_normal(const PolygonMesh& mesh, std::size_t begin, std::size_t end) {
  const Vec3d normal = newell_normal(mesh.positions.data(), mesh.corners.data() + begin, end - begin);
  const double length = normal.length();
  return length > 0 && std::isfinite(length) ? Vec3f(normal / length) : Vec3f(0, 0, 0);
}

template <class Function>
void for_each_block(std::size_t count, const Function& function) {
  tbb::parallel_for(std::size_t(0), (count + kItemsPerTask - 1) / kItemsPerTask, [&](std::size_t block) {
    function(block, block * kItemsPerTask, std::min(count, (block + 1) * kItemsPerTask));
  });
}

/// Phong 1973, eq. 4.1: the sum of the cross products of successive edges.
Vec3d edge_sum(const PolygonMesh& mesh, std::size_t begin, std::size_t end) {
  const std::size_t count = end - begin;
  const auto point = [&](std::size_t i) { return Vec3d(mesh.positions[mesh.corners[begin + i % count]]); };
  Vec3d sum(0, 0, 0);
  for (std::size_t i = 0; i < count; ++i) sum += (point(i + 1) - point(i)).cross(point(i + 2) - point(i + 1));
  return sum;
}

/// What is known of a mesh before its vertices are looked at.
struct MeshFaces {
  MeshFaces(const PolygonMesh& mesh_, const NormalRules& rules);

  /// The vertex that stands for all of its position, where pieces share normals.
  std::uint32_t vertex(std::uint32_t index) const { return welded.empty() ? index : welded[index]; }

  const PolygonMesh& mesh;
  NormalMethod method;
  Faces faces;
  Buffer<Vec3f> normals;         // [face_count], unit
  Buffer<Vec3d> shares;          // [face_count] what every corner of a face gets of it, where no corner differs
  Buffer<std::uint32_t> welded;  // [vertex_count] lowest index of the position; empty: each vertex for itself
};

Buffer<std::uint32_t> welded_vertices(const Buffer<Vec3f>& positions) {
  Buffer<std::uint32_t> order, welded;
  order.resize(positions.size());
  welded.resize(positions.size());
  std::iota(order.begin(), order.end(), 0u);
  const auto key = [&](std::uint32_t i) {
    const Vec3f& p = positions[i];
    return std::array<float, 3>{p.x + 0.0f, p.y + 0.0f, p.z + 0.0f};  // -0 equals 0
  };
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    const auto ka = key(a), kb = key(b);
    return ka != kb ? ka < kb : a < b;
  });
  for (std::size_t i = 0; i < order.size(); ++i)
    welded[order[i]] = i > 0 && key(order[i]) == key(order[i - 1]) ? welded[order[i - 1]] : order[i];
  return welded;
}

MeshFaces::MeshFaces(const PolygonMesh& mesh_, const NormalRules& rules)
    : mesh(mesh_), method(rules.method), faces(mesh_) {
  const bool shared = method == NormalMethod::area || method == NormalMethod::edges;
  normals.resize(faces.count());
  if (shared) shares.resize(faces.count());
  for_each_block(faces.count(), [&](std::size_t, std::size_t first, std::size_t last) {
    for (std::size_t face = first; face < last; ++face) {
      const std::size_t begin = faces.begin(face), end = faces.end(face);
      normals[face] = unit_face_normal(mesh, begin, end);
      if (!shared) continue;
      if (method == NormalMethod::area)
        shares[face] = newell_normal(mesh.positions.data(), mesh.corners.data() + begin, end - begin);
      else
        shares[face] = edge_sum(mesh, begin, end) / double(end - begin);
    }
  });
  if (rules.across_pieces) welded = welded_vertices(mesh.positions);
}

/// The corners at one vertex, and how they fall into groups that share a normal.
class VertexFan {
 public:
  VertexFan(const MeshFaces& mesh, double crease_cosine) : mesh_(mesh), crease_cosine_(crease_cosine) {}

  /// Gathers the corners [begin, end) of one vertex; with_groups: joins those that meet smoothly across an edge.
  void gather(const std::uint32_t* begin, const std::uint32_t* end, bool with_groups) {
    corners_.clear();
    for (const std::uint32_t* c = begin; c != end; ++c) {
      const PolygonMesh& mesh = mesh_.mesh;
      const std::size_t face = mesh_.faces.of_corner(*c);
      const std::size_t first = mesh_.faces.begin(face), last = mesh_.faces.end(face);
      const std::uint32_t before = mesh.corners[*c == first ? last - 1 : *c - 1];
      const std::uint32_t after = mesh.corners[*c + 1 == last ? first : *c + 1];
      const Vec3f& normal = mesh_.normals[face];
      const Vec3d vertex(mesh.positions[mesh.corners[*c]]);
      const Vec3d to_after = Vec3d(mesh.positions[after]) - vertex, to_before = Vec3d(mesh.positions[before]) - vertex;
      const Vec3d cross = to_after.cross(to_before);
      double angle = std::atan2(cross.length(), to_after.dot(to_before));
      // The inner angle of a reflex corner is beyond pi: its edges turn against the face's normal.
      if (cross.dot(Vec3d(normal)) < 0) angle = 2 * kPi - angle;
      Corner corner;
      corner.normal = normal;
      corner.angle = normal.length2() > 0 ? angle : 0.0;
      corner.share = share(face, cross, corner);
      corner.size = mesh_.method == NormalMethod::angle ? corner.angle : corner.share.length();
      corner.before = mesh_.vertex(before);
      corner.after = mesh_.vertex(after);
      corner.group = static_cast<std::uint32_t>(corners_.size());
      corners_.push_back(corner);
    }
    if (with_groups) join();
  }

  std::size_t size() const { return corners_.size(); }
  std::size_t root(std::size_t i) {
    while (corners_[i].group != i) i = corners_[i].group = corners_[corners_[i].group].group;
    return i;
  }

  /// The unit normal of the group with this root (kAll: of all corners).
  static constexpr std::size_t kAll = static_cast<std::size_t>(-1);
  Vec3f normal(std::size_t group) {
    Vec3d sum(0, 0, 0);
    double largest = -1;
    Vec3f fallback(0, 0, 0);
    for (std::size_t i = 0; i < corners_.size(); ++i) {
      if (group != kAll && root(i) != group) continue;
      sum += corners_[i].share;
      if (corners_[i].size > largest && corners_[i].normal.length2() > 0) {
        largest = corners_[i].size;
        fallback = corners_[i].normal;
      }
    }
    // Faces that cancel each other (the two sides of a sheet) leave rounding only: 1e-6 of the shares is far above it.
    const double length = sum.length();
    if (length > 1e-6 * std::max(largest, 0.0) && length > 0) return Vec3f(sum / length);
    if (fallback.length2() > 0) return fallback;
    return Vec3f(0, 0, 1);  // no face with area here: nothing is seen of it
  }

 private:
  struct Corner {
    Vec3f normal;                 // of the face, unit
    double angle;                 // 0: the face has no area
    Vec3d share;                  // of the vertex's normal
    double size;                  // how much it counts
    std::uint32_t before, after;  // the vertices at the ends of its two edges
    std::uint32_t group;          // parent in the union of groups; a root is the group's first corner
  };

  /// `cross`: of the corner's two edges.
  Vec3d share(std::size_t face, const Vec3d& cross, const Corner& corner) const {
    if (corner.angle == 0) return {0, 0, 0};
    switch (mesh_.method) {
      case NormalMethod::angle:
        break;
      case NormalMethod::unit:
        return Vec3d(corner.normal);
      case NormalMethod::area:
      case NormalMethod::edges:
        return mesh_.shares[face];
      case NormalMethod::terminating_edges:
        return cross;
      case NormalMethod::corners:
        return cross.length() > 0 ? cross / cross.length() : Vec3d(0, 0, 0);
    }
    return Vec3d(corner.normal) * corner.angle;
  }

  bool is_smooth(const Corner& a, const Corner& b) const {
    return Vec3d(a.normal).dot(Vec3d(b.normal)) >= crease_cosine_ && a.normal.length2() > 0 && b.normal.length2() > 0;
  }
  void unite(std::size_t a, std::size_t b) {
    a = root(a);
    b = root(b);
    if (a != b) corners_[std::max(a, b)].group = static_cast<std::uint32_t>(std::min(a, b));
  }

  void join() {
    edges_.clear();
    for (std::uint32_t i = 0; i < corners_.size(); ++i) {
      edges_.push_back({corners_[i].before, i});
      edges_.push_back({corners_[i].after, i});
    }
    std::sort(edges_.begin(), edges_.end());
    const auto for_each_run = [&](const auto& function) {
      for (std::size_t first = 0, last = 0; first < edges_.size(); first = last) {
        for (last = first + 1; last < edges_.size() && edges_[last].first == edges_[first].first;) ++last;
        function(first, last);
      }
    };
    // An edge of very many faces is no surface: beyond kMaxPairs only successive ones are compared, to stay linear.
    constexpr std::size_t kMaxPairs = 16;
    bool has_flat = false;
    for_each_run([&](std::size_t first, std::size_t last) {
      for (std::size_t i = first; i < last; ++i)
        for (std::size_t k = i + 1; k < last && k <= i + (last - first <= kMaxPairs ? kMaxPairs : 1); ++k) {
          const Corner &a = corners_[edges_[i].second], &b = corners_[edges_[k].second];
          if (is_smooth(a, b)) unite(edges_[i].second, edges_[k].second);
          has_flat = has_flat || a.angle == 0 || b.angle == 0;
        }
    });
    if (!has_flat) return;
    // A face without area parts nothing: it joins the first neighbor with area, and joins the neighbors on its two
    // sides where they would be smooth without it.
    partner_.assign(corners_.size(), kNone);
    for_each_run([&](std::size_t first, std::size_t last) {
      for (std::size_t i = first; i < last; ++i)
        for (std::size_t k = first; k < last && k < first + kMaxPairs; ++k) {
          const std::uint32_t flat = edges_[i].second, other = edges_[k].second;
          if (corners_[flat].angle != 0 || corners_[other].angle == 0) continue;
          if (partner_[flat] == kNone) {
            partner_[flat] = other;
            unite(flat, other);
          } else if (is_smooth(corners_[partner_[flat]], corners_[other])) {
            unite(partner_[flat], other);
          }
        }
    });
  }

  static constexpr std::uint32_t kNone = 0xffffffffu;
  const MeshFaces& mesh_;
  double crease_cosine_;
  std::vector<Corner> corners_;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges_;  // other end, corner
  std::vector<std::uint32_t> partner_;
};

}  // namespace

void compute_vertex_normals(PolygonMesh& mesh, const NormalRules& rules) {
  mesh.normals = {};
  mesh.normal_corners = {};
  const std::size_t vertex_count = mesh.positions.size(), corner_count = mesh.corners.size();
  const MeshFaces mesh_faces(mesh, rules);

  // Corners sorted by vertex: starts[v] .. starts[v + 1] in `around`.
  Buffer<std::uint32_t> starts, around;
  starts.resize(vertex_count + 2);
  std::fill(starts.begin(), starts.end(), 0u);
  around.resize(corner_count);
  for (const std::uint32_t corner : mesh.corners) ++starts[mesh_faces.vertex(corner) + 2];
  std::inclusive_scan(starts.begin(), starts.end(), starts.begin());
  // Shifted by one place, the running starts of the fill become the starts themselves.
  for (std::size_t corner = 0; corner < corner_count; ++corner)
    around[starts[mesh_faces.vertex(mesh.corners[corner]) + 1]++] = static_cast<std::uint32_t>(corner);

  if (rules.crease_angle >= kPi) {
    mesh.normals.resize(vertex_count);
    for_each_block(vertex_count, [&](std::size_t, std::size_t first, std::size_t last) {
      VertexFan fan(mesh_faces, -1);
      for (std::size_t v = first; v < last; ++v) {
        fan.gather(&around[starts[v]], &around[0] + starts[v + 1], false);
        mesh.normals[v] = fan.normal(VertexFan::kAll);
      }
    });
    for (std::size_t v = 0; v < mesh_faces.welded.size(); ++v) mesh.normals[v] = mesh.normals[mesh_faces.welded[v]];
    return;
  }

  const double crease_cosine = std::cos(std::max(rules.crease_angle, 0.0)) - kCosineTolerance;
  const std::size_t blocks = (vertex_count + kItemsPerTask - 1) / kItemsPerTask;
  std::vector<std::vector<Vec3f>> block_normals(blocks);
  mesh.normal_corners.resize(corner_count);
  for_each_block(vertex_count, [&](std::size_t block, std::size_t first, std::size_t last) {
    VertexFan fan(mesh_faces, crease_cosine);
    std::vector<Vec3f>& normals = block_normals[block];
    normals.reserve(last - first);
    std::vector<std::uint32_t> numbers;  // of the groups, at their roots
    for (std::size_t v = first; v < last; ++v) {
      const std::uint32_t* const begin = around.data() + starts[v];
      fan.gather(begin, around.data() + starts[v + 1], true);
      numbers.resize(fan.size());
      for (std::size_t i = 0; i < fan.size(); ++i) {
        const std::size_t root = fan.root(i);
        if (root == i) {
          numbers[i] = static_cast<std::uint32_t>(normals.size());
          normals.push_back(fan.normal(i));
        }
        mesh.normal_corners[begin[i]] = numbers[root];
      }
      if (fan.size() == 0) normals.push_back(Vec3f(0, 0, 1));  // keeps one normal per position possible
    }
  });

  std::vector<std::uint32_t> block_starts(blocks + 1, 0);
  for (std::size_t block = 0; block < blocks; ++block)
    block_starts[block + 1] = block_starts[block] + static_cast<std::uint32_t>(block_normals[block].size());
  mesh.normals.resize(block_starts[blocks]);
  for_each_block(vertex_count, [&](std::size_t block, std::size_t, std::size_t) {
    std::copy(block_normals[block].begin(), block_normals[block].end(), mesh.normals.begin() + block_starts[block]);
    block_normals[block] = {};
  });
  if (mesh.normals.size() == vertex_count && !rules.across_pieces) {
    mesh.normal_corners = {};
    return;
  }
  for_each_block(corner_count, [&](std::size_t, std::size_t first, std::size_t last) {
    for (std::size_t c = first; c < last; ++c)
      mesh.normal_corners[c] += block_starts[mesh_faces.vertex(mesh.corners[c]) / kItemsPerTask];
  });
}

std::int64_t normalize_vertex_normals(PolygonMesh& mesh) {
  const std::size_t count = mesh.normals.size();
  std::vector<std::vector<std::uint32_t>> block_bad((count + kItemsPerTask - 1) / kItemsPerTask);
  for_each_block(count, [&](std::size_t block, std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      const Vec3d normal(mesh.normals[i]);
      const double length = normal.length();
      if (length > 0 && std::isfinite(length))
        mesh.normals[i] = Vec3f(normal / length);
      else
        block_bad[block].push_back(static_cast<std::uint32_t>(i));
    }
  });
  std::vector<std::uint32_t> bad;
  for (const auto& part : block_bad) bad.insert(bad.end(), part.begin(), part.end());
  if (bad.empty()) return 0;

  std::vector<bool> is_bad(count, false);
  for (const std::uint32_t i : bad) {
    is_bad[i] = true;
    mesh.normals[i] = Vec3f(0, 0, 1);  // stays where no face with area uses it
  }
  const Buffer<std::uint32_t>& indices = mesh.normal_corners.empty() ? mesh.corners : mesh.normal_corners;
  const Faces faces(mesh);
  for (std::size_t face = 0; face < faces.count(); ++face)
    for (std::size_t c = faces.begin(face); c < faces.end(face); ++c) {
      if (!is_bad[indices[c]]) continue;
      const Vec3f normal = unit_face_normal(mesh, faces.begin(face), faces.end(face));
      if (normal.length2() == 0) break;
      mesh.normals[indices[c]] = normal;
      is_bad[indices[c]] = false;
    }
  return static_cast<std::int64_t>(bad.size());
}

}  // namespace raytree
