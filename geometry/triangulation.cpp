// Quads by the better diagonal, polygons that a fan from their first corner covers by that fan, all others by ear
// clipping with a grid over the reflex corners. Faces are independent of each other: parallel over blocks of them.
#include "geometry/triangulation.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "geometry/newell.h"

namespace raytree {
namespace {

constexpr std::size_t kFacesPerTask = 4096;  // faces that one task cuts

/// Twice an area below this part of the polygon's extent squared counts as none. Coordinates are floats, their
/// differences and products in double: an orientation is wrong by at most a few 2^-52 of the extent squared; four
/// digits are left for polygons that are flat only up to the rounding of float coordinates in a turned plane.
constexpr double kNoArea = 1e-11;

/// Corners of a triangle as places in the face.
using Triangle = std::array<std::uint32_t, 3>;

/// Cuts faces; holds the memory that one face after another uses.
class FaceCutter {
 public:
  /// Fills triangles() with size - 2 triangles. False where some overlap or are turned over.
  bool cut(const Vec3f* positions, const std::uint32_t* corners, std::size_t size) {
    triangles_.clear();
    if (size == 4) return cut_quad(positions, corners);
    project(positions, corners, size);
    if (extent_ == 0 || area_ <= kNoArea * extent_ * extent_) {
      fan();
      return areas_agree();  // all in a line, or parts that cancel each other
    }
    if (fan_covers()) {
      fan();
      return true;
    }
    return clip_ears();
  }

  const std::vector<Triangle>& triangles() const { return triangles_; }

 private:
  struct Node {
    double x, y;
    std::uint32_t previous, next;
    bool reflex, removed, listed;
  };

  bool cut_quad(const Vec3f* positions, const std::uint32_t* corners) {
    Vec3d p[4];
    for (int i = 0; i < 4; ++i) p[i] = Vec3d(positions[corners[i]]);
    const Vec3d diagonal02 = p[2] - p[0], diagonal13 = p[3] - p[1];
    const Vec3d normal = diagonal02.cross(diagonal13);
    // Signed areas along Newell's normal of the four triangles that three successive corners make.
    const auto area = [&](int a, int b, int c) { return (p[b] - p[a]).cross(p[c] - p[a]).dot(normal); };
    const double worst02 = std::min(area(0, 1, 2), area(0, 2, 3));
    const double worst13 = std::min(area(1, 2, 3), area(1, 3, 0));
    const double extent2 = std::max(diagonal02.length2(), diagonal13.length2());
    if (normal.length() <= kNoArea * extent2) {
      // Either all corners lie in a line, or two wings of a crossed quad cancel each other.
      triangles_ = {{0, 1, 2}, {0, 2, 3}};
      return (p[1] - p[0]).cross(diagonal02).length() <= kNoArea * extent2;
    }
    const double least = kNoArea * normal.length2();
    bool split02 = worst02 >= worst13;
    if (worst02 > least && worst13 > least) split02 = diagonal02.length2() <= diagonal13.length2();
    if (split02)
      triangles_ = {{0, 1, 2}, {0, 2, 3}};
    else
      triangles_ = {{1, 2, 3}, {1, 3, 0}};
    return std::max(worst02, worst13) >= -least;
  }

  /// Drops the largest axis of Newell's normal: for a flat polygon this is its plane seen at an angle, which keeps
  /// orientations and ratios of areas, and the float coordinates stay exact. Counter-clockwise comes out positive.
  void project(const Vec3f* positions, const std::uint32_t* corners, std::size_t size) {
    const Vec3d normal = newell_normal(positions, corners, size);
    int axis = 2;
    if (std::abs(normal.x) > std::abs(normal.y) && std::abs(normal.x) > std::abs(normal.z))
      axis = 0;
    else if (std::abs(normal.y) > std::abs(normal.z))
      axis = 1;
    int u = (axis + 1) % 3, v = (axis + 2) % 3;
    if (normal[axis] < 0) std::swap(u, v);
    const Vec3d first(positions[corners[0]]);
    nodes_.resize(size);
    low_ = high_ = Vec2d(0, 0);
    for (std::size_t i = 0; i < size; ++i) {
      const Vec3d p = Vec3d(positions[corners[i]]) - first;
      const auto place = static_cast<std::uint32_t>(i), count = static_cast<std::uint32_t>(size);
      nodes_[i] = {p[u],  p[v], place == 0 ? count - 1 : place - 1, place + 1 == count ? 0 : place + 1, false,
                   false, false};
      low_ = {std::min(low_.x, p[u]), std::min(low_.y, p[v])};
      high_ = {std::max(high_.x, p[u]), std::max(high_.y, p[v])};
    }
    extent_ = std::max(high_.x - low_.x, high_.y - low_.y);
    area_ = std::abs(normal[axis]);
  }

  double orientation(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
    const Node &p = nodes_[a], &q = nodes_[b], &r = nodes_[c];
    return (q.x - p.x) * (r.y - p.y) - (q.y - p.y) * (r.x - p.x);
  }

  /// A fan from the first corner covers a simple polygon exactly if all its triangles turn the right way and the
  /// directions from that corner to the others span less than a full turn: the side of the first edge on which they lie
  /// then changes once at most.
  bool fan_covers() const {
    bool behind = false;
    for (std::uint32_t i = 2; i < nodes_.size(); ++i) {
      if (orientation(0, i - 1, i) <= kNoArea * extent_ * extent_) return false;
      const bool is_behind = orientation(0, 1, i) < 0;
      if (behind && !is_behind) return false;
      behind = is_behind;
    }
    return true;
  }

  void fan() {
    for (std::uint32_t i = 2; i < nodes_.size(); ++i) triangles_.push_back({0, i - 1, i});
  }

  void classify(std::uint32_t i) {
    Node& node = nodes_[i];
    node.reflex = orientation(node.previous, i, node.next) <= 0;
  }

  // ---- grid over the corners that are not convex: only they can lie in an ear

  void build_grid(std::uint32_t start, std::size_t remaining) {
    std::size_t reflex = 0;
    std::uint32_t i = start;
    for (std::size_t k = 0; k < remaining; ++k, i = nodes_[i].next) reflex += nodes_[i].reflex;
    grid_size_ = std::clamp<std::size_t>(static_cast<std::size_t>(std::sqrt(static_cast<double>(reflex))), 1, 1024);
    cell_starts_.assign(grid_size_ * grid_size_ + 1, 0);
    for (std::size_t k = 0; k < remaining; ++k, i = nodes_[i].next)
      if (nodes_[i].reflex) ++cell_starts_[cell_of(nodes_[i]) + 1];
    for (std::size_t c = 1; c < cell_starts_.size(); ++c) cell_starts_[c] += cell_starts_[c - 1];
    cell_items_.resize(reflex);
    cell_fill_.assign(cell_starts_.begin(), cell_starts_.end() - 1);
    for (std::size_t k = 0; k < remaining; ++k, i = nodes_[i].next)
      if (nodes_[i].reflex) cell_items_[cell_fill_[cell_of(nodes_[i])]++] = i;
    grid_remaining_ = remaining;
  }

  std::size_t column(double value, double low, double high) const {
    if (!(high > low)) return 0;
    const double place = (value - low) / (high - low) * static_cast<double>(grid_size_);
    return place <= 0 ? 0 : std::min(static_cast<std::size_t>(place), grid_size_ - 1);
  }
  std::size_t cell_of(const Node& n) const {
    return column(n.y, low_.y, high_.y) * grid_size_ + column(n.x, low_.x, high_.x);
  }

  /// How strictly an ear is judged; each later stage is for polygons that the one before cannot finish.
  enum class Stage { proper, touching, flat, anything };

  bool is_ear(std::uint32_t b, Stage stage) const {
    const std::uint32_t a = nodes_[b].previous, c = nodes_[b].next;
    const double turn = orientation(a, b, c);
    if (stage == Stage::flat) return std::abs(turn) <= kNoArea * extent_ * extent_;
    if (turn <= 0) return false;
    if (stage == Stage::anything) return true;
    const Node &p = nodes_[a], &q = nodes_[b], &r = nodes_[c];
    const std::size_t x0 = column(std::min({p.x, q.x, r.x}), low_.x, high_.x);
    const std::size_t x1 = column(std::max({p.x, q.x, r.x}), low_.x, high_.x);
    const std::size_t y0 = column(std::min({p.y, q.y, r.y}), low_.y, high_.y);
    const std::size_t y1 = column(std::max({p.y, q.y, r.y}), low_.y, high_.y);
    const auto same_place = [](const Node& m, const Node& n) { return m.x == n.x && m.y == n.y; };
    for (std::size_t y = y0; y <= y1; ++y) {
      // The cells of one row lie side by side, and so do their items.
      const std::size_t first = cell_starts_[y * grid_size_ + x0], last = cell_starts_[y * grid_size_ + x1 + 1];
      for (std::size_t k = first; k < last; ++k) {
        const std::uint32_t i = cell_items_[k];
        const Node& n = nodes_[i];
        if (n.removed || !n.reflex || i == a || i == b || i == c) continue;
        const double ab = orientation(a, b, i), bc = orientation(b, c, i), ca = orientation(c, a, i);
        if (stage == Stage::proper) {
          // Corners that share a place with the ear's own (a bridge to a hole visits it twice) do not block it.
          if (ab >= 0 && bc >= 0 && ca >= 0 && !same_place(n, p) && !same_place(n, q) && !same_place(n, r))
            return false;
        } else if (ab > 0 && bc > 0 && ca > 0) {
          return false;
        }
      }
    }
    return true;
  }

  /// Passes over the corners that may have become ears. Cutting off an ear makes no other corner an ear but its two
  /// neighbors, so 3 n tests are enough for a simple polygon. A corner whose neighbor went in the same pass waits for
  /// the next one: ears are then taken all around, which keeps triangles short and their boxes small.
  bool clip_ears() {
    const auto size = static_cast<std::uint32_t>(nodes_.size());
    for (std::uint32_t i = 0; i < size; ++i) classify(i);
    std::size_t remaining = size;
    std::uint32_t some = 0;  // a corner that is still there
    build_grid(some, remaining);
    bool forced = false;
    Stage stage = Stage::proper;
    const auto list_all = [&] {
      waiting_.clear();
      std::uint32_t i = some;
      for (std::size_t k = 0; k < remaining; ++k, i = nodes_[i].next) list(i);
    };
    list_all();
    constexpr int kMaxRounds = 64;  // of stages; a polygon that needs more crosses itself again and again
    int rounds = 0;
    bool progress = false;
    while (remaining > 3) {
      if (waiting_.empty()) {
        if (stage == Stage::anything) break;
        ++rounds;
        stage = rounds > kMaxRounds                  ? Stage::anything
                : progress && stage != Stage::proper ? Stage::proper
                                                     : static_cast<Stage>(static_cast<int>(stage) + 1);
        progress = false;
        list_all();
      }
      now_.swap(waiting_);
      waiting_.clear();
      for (const std::uint32_t i : now_) nodes_[i].listed = false;
      for (const std::uint32_t i : now_) {
        // Listed again by a neighbor that went: waits.
        if (remaining == 3 || nodes_[i].removed || nodes_[i].listed || !is_ear(i, stage)) continue;
        const std::uint32_t a = nodes_[i].previous, c = nodes_[i].next;
        forced = forced || stage == Stage::anything;
        progress = true;
        triangles_.push_back({a, i, c});
        nodes_[i].removed = true;
        nodes_[a].next = c;
        nodes_[c].previous = a;
        classify_again(a);
        classify_again(c);
        list(a);
        list(c);
        some = c;
        if (--remaining < grid_remaining_ / 2) build_grid(some, remaining);
      }
    }
    // Where nothing turns the right way what is left is turned over, and a fan is as good as anything.
    forced = forced || remaining > 3;
    for (std::uint32_t last = nodes_[some].next; remaining > 2; --remaining, last = nodes_[last].next)
      triangles_.push_back({some, last, nodes_[last].next});
    return !forced && areas_agree();
  }

  void list(std::uint32_t i) {
    if (nodes_[i].listed) return;
    nodes_[i].listed = true;
    waiting_.push_back(i);
  }

  /// A convex corner stays convex while ears are cut off a simple polygon; a rounding or a self-intersection may turn
  /// it reflex, where the grid does not know it: areas_agree() notices what comes of that.
  void classify_again(std::uint32_t i) {
    if (nodes_[i].reflex) classify(i);
  }

  bool areas_agree() const {
    double sum = 0;
    for (const Triangle& t : triangles_) sum += std::abs(orientation(t[0], t[1], t[2]));
    return sum - area_ <= kNoArea * extent_ * extent_ * static_cast<double>(triangles_.size());
  }

  std::vector<Triangle> triangles_;
  std::vector<Node> nodes_;
  std::vector<std::uint32_t> waiting_, now_;
  Vec2d low_, high_;
  double extent_ = 0;
  double area_ = 0;  // twice the projected area
  std::size_t grid_size_ = 1, grid_remaining_ = 0;
  std::vector<std::uint32_t> cell_starts_, cell_fill_, cell_items_;
};

}  // namespace

TriangleMesh triangulate(PolygonMesh&& mesh, const SourceLocation& where, Warnings& warnings) {
  TriangleMesh result;
  result.origin = mesh.origin;
  result.positions = std::move(mesh.positions);
  result.normals = std::move(mesh.normals);
  result.texture_coordinates = std::move(mesh.texture_coordinates);
  const std::size_t faces = mesh.face_sizes.size();
  if (std::all_of(mesh.face_sizes.begin(), mesh.face_sizes.end(), [](std::uint32_t size) { return size == 3; })) {
    result.corners = std::move(mesh.corners);
    result.normal_corners = std::move(mesh.normal_corners);
    result.texture_corners = std::move(mesh.texture_corners);
    return result;
  }

  const std::size_t blocks = (faces + kFacesPerTask - 1) / kFacesPerTask;
  std::vector<std::size_t> corner_starts(blocks + 1, 0), triangle_starts(blocks + 1, 0);
  for (std::size_t block = 0; block < blocks; ++block) {
    std::size_t corners = 0, triangles = 0;
    for (std::size_t face = block * kFacesPerTask; face < std::min(faces, (block + 1) * kFacesPerTask); ++face) {
      corners += mesh.face_sizes[face];
      triangles += mesh.face_sizes[face] < 3 ? 0 : mesh.face_sizes[face] - 2;
    }
    corner_starts[block + 1] = corner_starts[block] + corners;
    triangle_starts[block + 1] = triangle_starts[block] + triangles;
  }
  const std::size_t triangles = triangle_starts.back();
  result.corners.resize(3 * triangles);
  if (!mesh.normal_corners.empty()) result.normal_corners.resize(3 * triangles);
  if (!mesh.texture_corners.empty()) result.texture_corners.resize(3 * triangles);
  result.triangle_faces.resize(triangles);
  std::vector<std::pair<std::int64_t, std::size_t>> bad(blocks, {0, 0});  // faces cut badly, and the first of them

  tbb::parallel_for(std::size_t(0), blocks, [&](std::size_t block) {
    FaceCutter cutter;
    std::size_t corner = corner_starts[block], triangle = triangle_starts[block];
    const auto write = [&](std::size_t face, const Triangle& t) {
      for (std::size_t k = 0; k < 3; ++k) {
        result.corners[3 * triangle + k] = mesh.corners[corner + t[k]];
        if (!mesh.normal_corners.empty()) result.normal_corners[3 * triangle + k] = mesh.normal_corners[corner + t[k]];
        if (!mesh.texture_corners.empty())
          result.texture_corners[3 * triangle + k] = mesh.texture_corners[corner + t[k]];
      }
      result.triangle_faces[triangle++] = static_cast<std::uint32_t>(face);
    };
    for (std::size_t face = block * kFacesPerTask; face < std::min(faces, (block + 1) * kFacesPerTask); ++face) {
      const std::size_t size = mesh.face_sizes[face];
      if (size == 3) {
        write(face, {0, 1, 2});
      } else if (size > 3) {
        if (!cutter.cut(result.positions.data(), &mesh.corners[corner], size) && bad[block].first++ == 0)
          bad[block].second = face;
        for (const Triangle& t : cutter.triangles()) write(face, t);
      }
      corner += size;
    }
  });

  std::int64_t count = 0;
  std::size_t first = 0;
  for (const auto& [block_count, block_first] : bad) {
    if (count == 0) first = block_first;
    count += block_count;
  }
  if (count > 0)
    warnings.push_back(
        {where, "faces that cross themselves cut as best they can be, the first is face " + std::to_string(first + 1),
         count});
  mesh = {};
  return result;
}

}  // namespace raytree
