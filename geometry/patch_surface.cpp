#include "geometry/patch_surface.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <unordered_map>

#include "geometry/angle.h"

namespace raytree {
namespace {

/// Places along an edge where the normals of both sides are compared, ends included.
constexpr int kCreaseSamples = 9;

std::string patch_name(std::size_t index) { return "patch " + std::to_string(index + 1); }

template <class Function>
void for_each_point(BezierPatch& patch, const Function& function) {
  for (Vec3d& point : patch.points) function(point);
}
template <class Function>
void for_each_point(CoonsPatch& patch, const Function& function) {
  for (BezierCurve* curve : {&patch.bottom, &patch.top, &patch.left, &patch.right})
    for (Vec3d& point : curve->points) function(point);
}

bool weights_are_positive(const BezierPatch& patch) {
  return std::all_of(patch.weights.begin(), patch.weights.end(), [](double w) { return w > 0 && std::isfinite(w); });
}
bool weights_are_positive(const CoonsPatch& patch) {
  const auto positive = [](const BezierCurve& curve) {
    return std::all_of(curve.weights.begin(), curve.weights.end(), [](double w) { return w > 0 && std::isfinite(w); });
  };
  return positive(patch.bottom) && positive(patch.top) && positive(patch.left) && positive(patch.right);
}

bool meets_in_corners(const BezierPatch&) { return true; }
bool meets_in_corners(const CoonsPatch& patch) {
  return patch.bottom.points.front() == patch.left.points.front() &&
         patch.bottom.points.back() == patch.right.points.front() &&
         patch.top.points.front() == patch.left.points.back() && patch.top.points.back() == patch.right.points.back();
}

void check_patch(SurfacePatch& patch, std::size_t index, const SourceLocation& where) {
  const auto require = [&](bool holds, const char* message) {
    if (!holds) throw Error(ErrorKind::bad_input, where, patch_name(index) + ": " + message);
  };
  std::visit(
      [&](auto& kind) {
        bool finite = true;
        for_each_point(
            kind, [&](Vec3d& p) { finite = finite && std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); });
        require(finite, "a control point is not finite");
        require(weights_are_positive(kind), "a weight is not positive and finite");
        require(meets_in_corners(kind), "its boundary curves do not meet in the corners");
      },
      patch);
}

/// Numbers places: those within a tolerance of an earlier one get its number. Places of a new number lie further apart
/// than the tolerance, so that a cell of the grid holds a few of them at most, whatever comes.
class PlaceNumbers {
 public:
  explicit PlaceNumbers(double tolerance) : tolerance_(tolerance), cell_(2 * tolerance) {}

  std::uint32_t number(const Vec3d& p) {
    if (!(tolerance_ > 0)) return 0;  // all points are one
    const Cell home = cell_of(p), near_side = cell_of(p - Vec3d(tolerance_)), far_side = cell_of(p + Vec3d(tolerance_));
    std::uint32_t best = kNone;
    // A cell is twice the tolerance wide: what is near lies in one or two of them along each axis.
    for (std::int64_t x = near_side.x; x <= far_side.x; ++x)
      for (std::int64_t y = near_side.y; y <= far_side.y; ++y)
        for (std::int64_t z = near_side.z; z <= far_side.z; ++z) {
          const auto [begin, end] = cells_.equal_range(Cell{x, y, z});
          for (auto it = begin; it != end; ++it)
            if ((places_[it->second] - p).length() <= tolerance_) best = std::min(best, it->second);
        }
    if (best != kNone) return best;
    places_.push_back(p);
    const auto fresh = static_cast<std::uint32_t>(places_.size() - 1);
    cells_.emplace(home, fresh);
    return fresh;
  }

 private:
  static constexpr std::uint32_t kNone = 0xffffffffu;
  struct Cell {
    std::int64_t x, y, z;
    bool operator==(const Cell&) const = default;
  };
  struct Hash {
    std::size_t operator()(const Cell& cell) const {
      std::uint64_t h = static_cast<std::uint64_t>(cell.x) * 0x9E3779B97F4A7C15u;
      h = (h ^ (h >> 29) ^ static_cast<std::uint64_t>(cell.y)) * 0xBF58476D1CE4E5B9u;
      h = (h ^ (h >> 32) ^ static_cast<std::uint64_t>(cell.z)) * 0x94D049BB133111EBu;
      return static_cast<std::size_t>(h ^ (h >> 31));
    }
  };
  Cell cell_of(const Vec3d& p) const {
    return {static_cast<std::int64_t>(std::floor(p.x / cell_)), static_cast<std::int64_t>(std::floor(p.y / cell_)),
            static_cast<std::int64_t>(std::floor(p.z / cell_))};
  }

  double tolerance_, cell_;
  std::vector<Vec3d> places_;
  std::unordered_multimap<Cell, std::uint32_t, Hash> cells_;
};

/// What makes two sides one edge: the numbers of their control points and their weights, in the direction that comes
/// first in order.
struct EdgeKey {
  std::array<std::uint32_t, 4> points{};
  std::array<std::int32_t, 4> weights{};  ///< in 2^-20 of the largest
  auto operator<=>(const EdgeKey&) const = default;

  EdgeKey reversed() const {
    EdgeKey key = *this;
    std::reverse(key.points.begin(), key.points.end());
    std::reverse(key.weights.begin(), key.weights.end());
    return key;
  }
};
struct EdgeKeyHash {
  std::size_t operator()(const EdgeKey& key) const {
    std::uint64_t h = 1980;
    for (std::size_t i = 0; i < 4; ++i) {
      h = (h ^ key.points[i]) * 0x9E3779B97F4A7C15u;
      h = (h ^ (h >> 32) ^ static_cast<std::uint64_t>(static_cast<std::uint32_t>(key.weights[i]))) *
          0xBF58476D1CE4E5B9u;
    }
    return static_cast<std::size_t>(h ^ (h >> 31));
  }
};

EdgeKey edge_key(const BezierCurve& curve, PlaceNumbers& numbers) {
  const double largest = *std::max_element(curve.weights.begin(), curve.weights.end());
  EdgeKey key;
  for (std::size_t i = 0; i < 4; ++i) {
    key.points[i] = numbers.number(curve.points[i]);
    key.weights[i] = static_cast<std::int32_t>(std::lround(std::ldexp(curve.weights[i] / largest, 20)));
  }
  return key;
}

}  // namespace

Vec2d side_parameter(std::size_t side, double t) {
  switch (side) {
    case 0:
      return {t, 0};
    case 1:
      return {1, t};
    case 2:
      return {1 - t, 1};
    default:
      return {0, 1 - t};
  }
}

PatchSurface::PatchSurface(std::vector<SurfacePatch> patches, const PatchSurfaceOptions& options,
                           const SourceLocation& where, Warnings& warnings)
    : patches_(std::move(patches)), options_(options) {
  if (patches_.empty()) throw Error(ErrorKind::bad_input, where, "a surface needs at least one patch");
  Bounds3d box;
  for (std::size_t i = 0; i < patches_.size(); ++i) {
    check_patch(patches_[i], i, where);
    std::visit([&](auto& kind) { for_each_point(kind, [&](Vec3d& p) { box.extendBy(p); }); }, patches_[i]);
  }
  // Single precision then holds the surface as well as its extent allows, wherever it lies.
  for (int axis = 0; axis < 3; ++axis) {
    const double extent = box.max[axis] - box.min[axis];
    const double distance = std::max(std::abs(box.min[axis]), std::abs(box.max[axis]));
    origin_[axis] = distance > 2 * extent ? box.min[axis] + extent / 2 : 0;
  }
  scales_.reserve(patches_.size());
  for (SurfacePatch& patch : patches_)
    std::visit(
        [&](auto& kind) {
          for_each_point(kind, [&](Vec3d& p) { p -= origin_; });
          if (options_.flip) kind = transposed(kind);
          scales_.push_back(derivative_scale(kind));
        },
        patch);
  join_patches(where, warnings);
  find_creases();
}

void PatchSurface::join_patches(const SourceLocation& where, Warnings& warnings) {
  Bounds3d box;
  for (SurfacePatch& patch : patches_)
    std::visit([&](auto& kind) { for_each_point(kind, [&](Vec3d& p) { box.extendBy(p); }); }, patch);
  const Vec3d extent = box.size();
  PlaceNumbers numbers(std::max({extent.x, extent.y, extent.z}) * 0x1p-23);

  struct Seen {
    std::uint32_t edge;
    std::array<std::uint32_t, 2> uses;  ///< along the edge's direction, and against it
  };
  std::unordered_map<EdgeKey, Seen, EdgeKeyHash> edges;
  std::unordered_map<std::uint32_t, std::uint32_t> vertices;  // of a place's number
  std::int64_t inside_out = 0;
  sides_.resize(patches_.size());
  for (std::size_t face = 0; face < patches_.size(); ++face)
    for (std::size_t side = 0; side < 4; ++side) {
      const BezierCurve curve =
          std::visit([&](const auto& kind) { return side_curve(kind, static_cast<int>(side)); }, patches_[face]);
      const EdgeKey key = edge_key(curve, numbers);
      FaceEdge& out = sides_[face][side];
      out.vertex = vertices.emplace(key.points[0], static_cast<std::uint32_t>(vertices.size())).first->second;
      out.collapsed = std::all_of(key.points.begin(), key.points.end(),
                                  [&](std::uint32_t number) { return number == key.points[0]; });
      if (out.collapsed) {
        out.edge = static_cast<std::uint32_t>(edge_count_++);
        continue;
      }
      const EdgeKey backwards = key.reversed();
      const bool turned = backwards < key;
      const auto [found, fresh] =
          edges.emplace(turned ? backwards : key, Seen{static_cast<std::uint32_t>(edge_count_), {0, 0}});
      if (fresh) ++edge_count_;
      Seen& seen = found->second;
      // A curve that is the same both ways round is taken as a neighbor would.
      const bool against = key == backwards ? seen.uses[0] > seen.uses[1] : turned;
      if (seen.uses[against] > 0) ++inside_out;
      ++seen.uses[against];
      out.edge = seen.edge;
      out.reversed = against;
    }
  vertex_count_ = vertices.size();
  if (inside_out > 0)
    warnings.push_back(
        {where,
         "edges along which two patches run in the same direction: one of them is inside out, or more than two meet",
         inside_out});
}

void PatchSurface::find_creases() {
  struct Use {
    std::uint32_t face, side;
  };
  std::vector<std::vector<Use>> edges(edge_count_), corners(vertex_count_);
  for (std::uint32_t face = 0; face < sides_.size(); ++face)
    for (std::uint32_t side = 0; side < 4; ++side) {
      edges[sides_[face][side].edge].push_back({face, side});
      corners[sides_[face][side].vertex].push_back({face, side});
    }
  const double least_cosine = std::cos(options_.crease_angle * kDegree);
  // A normal that was not found, (0, 0, 0), has cosine 0 with all others and is thus nobody else's.
  const auto differ = [&](const Vec3d& a, const Vec3d& b) { return !(a.dot(b) >= least_cosine); };
  tbb::parallel_for(std::size_t(0), edges.size(), [&](std::size_t edge) {
    const std::vector<Use>& uses = edges[edge];
    const auto side_of = [&](const Use& use) -> FaceEdge& { return sides_[use.face][use.side]; };
    const auto normal_on = [&](const Use& use, int i) {
      const double t = double(i) / (kCreaseSamples - 1);
      const Vec2d at = side_parameter(use.side, side_of(use).reversed ? 1 - t : t);
      return normal_at(use.face, at.x, at.y);
    };
    // A boundary's one face has normals of its own. Along a collapsed edge the tip's are compared, elsewhere those of
    // all faces at each place.
    bool sharp = uses.size() < 2 && !side_of(uses[0]).collapsed;
    Vec3d first(0, 0, 0);
    for (int i = 0; i < kCreaseSamples && !sharp; ++i)
      for (std::size_t k = 0; k < uses.size() && !sharp; ++k) {
        const Vec3d normal = normal_on(uses[k], i);
        if (k == 0 && (i == 0 || !side_of(uses[0]).collapsed))
          first = normal;
        else
          sharp = differ(first, normal);
      }
    for (const Use& use : uses) side_of(use).sharp_edge = sharp;
  });
  // A vertex has one normal where those of all its faces agree; for the end of a collapsed edge that is the tip.
  tbb::parallel_for(std::size_t(0), corners.size(), [&](std::size_t vertex) {
    Vec3d first(0, 0, 0);
    bool sharp = false;
    for (std::size_t k = 0; k < corners[vertex].size() && !sharp; ++k) {
      const auto [face, side] = corners[vertex][k];
      const Vec2d at = side_parameter(side, 0);
      const Vec3d normal = normal_at(face, at.x, at.y);
      if (k == 0)
        first = normal;
      else
        sharp = differ(first, normal);
    }
    for (const auto& [face, side] : corners[vertex]) sides_[face][side].sharp_vertex = sharp;
  });
}

Vec3d PatchSurface::normal_at(std::size_t face, double u, double v) const {
  return std::visit(
      [&](const auto& patch) {
        return patch_normal(patch, raytree::evaluate(patch, u, v), u, v, scales_[face], options_.degenerate_normals);
      },
      patches_[face]);
}

/// Where a patch has no normal at all, having no area or being told to do without: that of its four corners' polygon.
Vec3f PatchSurface::mean_normal(std::size_t face) const {
  std::array<Vec3d, 4> corners;
  for (int side = 0; side < 4; ++side)
    corners[static_cast<std::size_t>(side)] =
        std::visit([&](const auto& kind) { return side_curve(kind, side).points[0]; }, patches_[face]);
  const Vec3d normal = (corners[2] - corners[0]).cross(corners[3] - corners[1]);
  const double length = normal.length();
  return length > 0 ? Vec3f(normal / length) : Vec3f(0, 0, 1);
}

void PatchSurface::evaluate(std::size_t face, std::span<const Vec2f> parameters,
                            std::span<SurfaceSample> samples) const {
  std::visit(
      [&](const auto& patch) {
        for (std::size_t i = 0; i < parameters.size(); ++i) {
          const double u = parameters[i].x, v = parameters[i].y;
          PatchDerivatives at = raytree::evaluate(patch, u, v);
          const Vec3d normal = patch_normal(patch, at, u, v, scales_[face], options_.degenerate_normals);
          // Sums of equal points differ in their last bits: on a collapsed side every point is its corner.
          const std::array<bool, 4> on_side{v == 0, u == 1, v == 1, u == 0};
          for (std::size_t side = 0; side < 4; ++side)
            if (on_side[side] && sides_[face][side].collapsed)
              at.position = side_curve(patch, static_cast<int>(side)).points[0];
          SurfaceSample& out = samples[i];
          out.position = Vec3f(at.position);
          out.normal = normal == Vec3d(0, 0, 0) ? mean_normal(face) : Vec3f(normal);
          out.du = Vec3f(at.du);
          out.dv = Vec3f(at.dv);
        }
      },
      patches_[face]);
}

bool PatchSurface::polynomial_patch(std::size_t face, BezierPatch& patch) const {
  for (const FaceEdge& side : sides_[face])
    if (side.collapsed) return false;
  if (const auto* bezier = std::get_if<BezierPatch>(&patches_[face])) {
    patch = *bezier;
  } else {
    const std::optional<BezierPatch> same = as_bezier_patch(std::get<CoonsPatch>(patches_[face]));
    if (!same) return false;
    patch = *same;
  }
  return std::all_of(patch.weights.begin(), patch.weights.end(), [&](double w) { return w == patch.weights[0]; });
}

std::vector<LimitPatch> PatchSurface::limit_patches() const {
  std::vector<LimitPatch> result(patches_.size());
  for (std::size_t face = 0; face < patches_.size(); ++face) {
    result[face].face = static_cast<std::uint32_t>(face);
    if (const auto* bezier = std::get_if<BezierPatch>(&patches_[face]))
      result[face].patch = *bezier;
    else if (const std::optional<BezierPatch> same = as_bezier_patch(std::get<CoonsPatch>(patches_[face])))
      result[face].patch = *same;
    else
      return {};
  }
  return result;
}

void PatchSurface::evaluate_texture(std::size_t, std::span<const Vec2f> parameters,
                                    std::span<Vec2f> coordinates) const {
  for (std::size_t i = 0; i < parameters.size(); ++i)
    coordinates[i] = options_.flip ? Vec2f(parameters[i].y, parameters[i].x) : parameters[i];
}

}  // namespace raytree
