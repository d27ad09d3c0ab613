// A set of Bezier and Coons patches as one surface: which patches share corners and edges, where an edge is a point,
// where the surface is smooth across an edge. Tessellation and reading are others'.
#pragma once

#include <array>
#include <variant>
#include <vector>

#include "geometry/bezier_patch.h"
#include "geometry/coons_patch.h"
#include "geometry/error.h"
#include "geometry/limit_patch.h"
#include "geometry/parametric_surface.h"

namespace raytree {

using SurfacePatch = std::variant<BezierPatch, CoonsPatch>;

/// Degrees; see PatchSurfaceOptions::crease_angle.
inline constexpr double kPatchCreaseAngle = 1;

struct PatchSurfaceOptions {
  /// Where the normals of two patches differ by more than this, in degrees, anywhere along their common edge, each has
  /// its own there; elsewhere both take one's.
  double crease_angle = kPatchCreaseAngle;
  bool flip = false;  ///< the outside is where P_v x P_u points
  DegenerateNormal degenerate_normals = DegenerateNormal::limit;
};

/// Faces are the patches in their order, quads over (u, v) of the file, which are their texture coordinates. Two sides
/// are one edge when their control points are the same, in either direction, and so are the proportions of their
/// weights. Points are the same when single precision cannot tell them apart over the extent of the whole: within 2^-23
/// of its largest extent. A side whose control points are all the same is an edge of one face alone, both of whose ends
/// are one vertex; every point of it evaluates to the same bits.
class PatchSurface final : public ParametricSurface {
 public:
  /// Patches must be finite and weights positive, the curves of Coons patches meet in their corners: throws Error
  /// (bad_input) that names the patch, counted from 1, at `where`. Warns of edges along which two patches run in the
  /// same direction, so that one of them is inside out or a third one meets them.
  PatchSurface(std::vector<SurfacePatch> patches, const PatchSurfaceOptions& options, const SourceLocation& where,
               Warnings& warnings);

  Vec3d origin() const override { return origin_; }
  std::size_t face_count() const override { return patches_.size(); }
  std::size_t edge_count() const override { return edge_count_; }
  std::size_t vertex_count() const override { return vertex_count_; }
  bool has_texture() const override { return true; }
  FaceDomain domain(std::size_t) const override { return FaceDomain::quad; }
  std::span<const FaceEdge> sides(std::size_t face) const override { return sides_[face]; }
  void evaluate(std::size_t face, std::span<const Vec2f> parameters, std::span<SurfaceSample> samples) const override;
  void evaluate_texture(std::size_t face, std::span<const Vec2f> parameters,
                        std::span<Vec2f> coordinates) const override;
  bool polynomial_patch(std::size_t face, BezierPatch& patch) const override;
  std::uint32_t source_face(std::size_t face) const override { return static_cast<std::uint32_t>(face); }

  /// Each face as one Bezier patch, relative to origin(). Empty where some face is none: a Coons patch over rational
  /// curves.
  std::vector<LimitPatch> limit_patches() const;

 private:
  void join_patches(const SourceLocation& where, Warnings& warnings);
  void find_creases();
  Vec3d normal_at(std::size_t face, double u, double v) const;
  Vec3f mean_normal(std::size_t face) const;

  std::vector<SurfacePatch> patches_;  ///< relative to origin_; transposed where flipped
  std::vector<double> scales_;         ///< derivative_scale of each
  std::vector<std::array<FaceEdge, 4>> sides_;
  PatchSurfaceOptions options_;
  Vec3d origin_{0, 0, 0};
  std::size_t edge_count_ = 0, vertex_count_ = 0;
};

/// Where a point of side 0 to 3 lies in the unit square, t in [0, 1] along the side.
Vec2d side_parameter(std::size_t side, double t);

}  // namespace raytree
