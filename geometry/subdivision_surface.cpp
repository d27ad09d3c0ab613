#include "geometry/subdivision_surface.h"

#include <fmt/format.h>
#include <opensubdiv/far/primvarRefiner.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <optional>

#include "geometry/bezier_patch.h"
#include "geometry/newell.h"
#include "geometry/osd_patches.h"

namespace raytree {
namespace {

/// Two first derivatives count as parallel, or one as vanished, where the sine of their angle times the ratio of their
/// lengths is below this. A float patch's derivatives carry noise of about 2^-24 times its size times 16 (a bicubic's
/// largest weights' sum); 1e-5 is ten times that, and a cell stretched 1 : 1e5 still gets its normal from the
/// expansion, of which its own cross product is the first term.
constexpr float kParallel = 1e-5f;
/// The step of the first-order expansion, in parameters. What is left out is its square.
constexpr float kExpansionStep = 1e-3f;

Vec3f vec(const std::array<float, 4>& v) { return {v[0], v[1], v[2]}; }

struct LimitVertex {
  Vec3f position, normal;
};

using Level = osd::Far::TopologyLevel;

/// Inside the surface, with two faces alone: they share it whole around.
bool is_fold(const Level& level, int vertex) {
  return level.GetVertexFaces(vertex).size() == 2 && !level.IsVertexBoundary(vertex) &&
         !level.IsVertexNonManifold(vertex);
}

bool has_fold(const Level& level) {
  for (int vertex = 0; vertex < level.GetNumVertices(); ++vertex)
    if (is_fold(level, vertex)) return true;
  return false;
}

class SubdivisionSurface final : public ParametricSurface {
 public:
  SubdivisionSurface(const PolygonMesh& mesh, const SubdivisionRules& rules, const osd::Far::TopologyRefiner& refiner,
                     std::size_t point_budget)
      : origin_(mesh.origin), scheme_(refiner.GetSchemeType()) {
    const Level& level = refiner.GetLevel(0);
    PatchFactory::Options options;
    options.SetApproxLevelSmooth(kSmoothApproximationLevel).SetApproxLevelSharp(kSharpApproximationLevel);
    // Before 3.7 a patch beside a fold may be shared with a face that it does not fit (its pull request 1353).
    if (OPENSUBDIV_VERSION_NUMBER < 30700 && has_fold(level)) options.EnableCaching(false);
    const PatchFactory factory(refiner, options);
    std::vector<float> values(&mesh.positions.data()->x, &mesh.positions.data()->x + 3 * mesh.positions.size());
    positions_.emplace(factory, mesh.face_count(), std::move(values), -1, point_budget);
    if (!mesh.texture_coordinates.empty()) {
      values.assign(&mesh.texture_coordinates.data()->x,
                    &mesh.texture_coordinates.data()->x + 2 * mesh.texture_coordinates.size());
      texture_.emplace(factory, mesh.face_count(), std::move(values), 0, point_budget);
    }
    vertex_count_ = mesh.positions.size();
    edge_count_ = static_cast<std::size_t>(level.GetNumEdges());
    fill_sides(level, rules);
    fill_polygon_normals(mesh);
    fill_limit_vertices(level, mesh, refiner);
  }

  Vec3d origin() const override { return origin_; }
  std::size_t face_count() const override { return polygon_normals_.size(); }
  std::size_t edge_count() const override { return edge_count_; }
  std::size_t vertex_count() const override { return vertex_count_; }
  bool has_texture() const override { return texture_.has_value(); }

  FaceDomain domain(std::size_t face) const override {
    switch (parameterization(face).GetType()) {
      case osd::Bfr::Parameterization::TRI:
        return FaceDomain::triangle;
      case osd::Bfr::Parameterization::QUAD_SUBFACES:
        return FaceDomain::quad_subfaces;
      case osd::Bfr::Parameterization::QUAD:
        break;
    }
    return FaceDomain::quad;
  }

  std::span<const FaceEdge> sides(std::size_t face) const override {
    if (!positions_->has_surface(face)) return {};
    return all_sides(face);
  }

  std::uint32_t source_face(std::size_t face) const override { return static_cast<std::uint32_t>(face); }

  bool polynomial_patch(std::size_t face, BezierPatch& patch) const override {
    BicubicControl control;
    if (!positions_->regular_control(face, control)) return false;
    for (std::size_t i = 0; i < 16; ++i)
      patch.points[i] = Vec3d(control[4 * i], control[4 * i + 1], control[4 * i + 2]);
    spline_to_bezier(patch.points);
    patch.weights.fill(1);
    return true;
  }

  void evaluate(std::size_t face, std::span<const Vec2f> parameters, std::span<SurfaceSample> samples) const override {
    // Patch points that are not kept live here between the calls of one thread.
    thread_local std::vector<float> position_points;
    FacePatches<3>::Patch patch;
    positions_->prepare(face, patch, position_points);
    PatchValues values;
    for (std::size_t i = 0; i < parameters.size(); ++i) {
      SurfaceSample& sample = samples[i];
      FacePatches<3>::evaluate_first(patch, parameters[i], values);
      sample.position = vec(values.value), sample.du = vec(values.du), sample.dv = vec(values.dv);
      const Vec3f normal = sample.du.cross(sample.dv);
      const float longest = std::max(sample.du.length2(), sample.dv.length2());
      if (is_plain(normal, longest, patch.scale))
        sample.normal = unit_float(normal);
      else
        sample.normal = degenerate_normal(face, patch, parameters[i]);
      if (patch.surface != nullptr) apply_limit_vertex(face, parameters[i], sample);
    }
  }

  void evaluate_texture(std::size_t face, std::span<const Vec2f> parameters,
                        std::span<Vec2f> coordinates) const override {
    if (!texture_) {
      std::fill_n(coordinates.begin(), parameters.size(), Vec2f(0, 0));
      return;
    }
    thread_local std::vector<float> texture_points;
    FacePatches<2>::Patch texture;
    texture_->prepare(face, texture, texture_points);
    PatchValues values;
    for (std::size_t i = 0; i < parameters.size(); ++i) {
      FacePatches<2>::evaluate_value(texture, parameters[i], values);
      coordinates[i] = Vec2f(values.value[0], values.value[1]);
    }
  }

 private:
  osd::Bfr::Parameterization parameterization(std::size_t face) const {
    return {scheme_, static_cast<int>(all_sides(face).size())};
  }

  std::span<const FaceEdge> all_sides(std::size_t face) const {
    return {sides_.data() + first_sides_[face], sides_.data() + first_sides_[face + 1]};
  }

  static Vec3f unit_float(const Vec3f& v) {
    // Cells of 1e-10 units have cross products whose squares leave float.
    const Vec3d wide(v);
    return Vec3f(wide / wide.length());
  }

  /// Whether du x dv says where the surface faces. `longest`: the larger squared length of the two.
  static bool is_plain(const Vec3f& normal, float longest, float scale) {
    return normal.length2() > kParallel * kParallel * longest * longest &&
           longest > kParallel * kParallel * scale * scale && std::isfinite(normal.length2()) &&
           normal.length2() > 1e-30f;
  }

  /// The middle of the domain's part that `at` lies in.
  Vec2f middle(std::size_t face, const Vec2f& at) const {
    const osd::Bfr::Parameterization domain_of = parameterization(face);
    if (domain_of.GetType() == osd::Bfr::Parameterization::QUAD) return {0.5f, 0.5f};
    if (domain_of.GetType() == osd::Bfr::Parameterization::TRI) return {1.0f / 3, 1.0f / 3};
    const float inside[2] = {0.25f, 0.25f};
    Vec2f result;
    domain_of.ConvertSubFaceToCoord(domain_of.GetSubFace(&at.x), inside, &result.x);
    return result;
  }

  /// Catalogue of degenerate corners: a collapsed edge (Pu = 0), parallel derivatives at a smooth corner.
  Vec3f degenerate_normal(std::size_t face, const FacePatches<3>::Patch& patch, const Vec2f& at) const {
    PatchValues values;
    const Vec2f toward = middle(face, at) - at;
    const auto wide = [](const std::array<float, 4>& v) { return Vec3d(v[0], v[1], v[2]); };
    const double size = std::max(patch.scale, std::numeric_limits<float>::min());
    FacePatches<3>::evaluate_second(patch, at, values);
    {
      const Vec3d pu = wide(values.du), pv = wide(values.dv), puu = wide(values.duu), puv = wide(values.duv),
                  pvv = wide(values.dvv);
      const Vec3d by_u = puu.cross(pv) + pu.cross(puv), by_v = puv.cross(pv) + pu.cross(pvv);
      const Vec3d normal = pu.cross(pv) + (by_u * double(toward.x) + by_v * double(toward.y)) * double(kExpansionStep);
      // Its own terms are exact to about kParallel of the size squared.
      if (normal.length() > double(kParallel) * double(kExpansionStep) * size * size) return Vec3f(normal.normalized());
    }
    for (const float step : {0.01f, 0.1f, 0.5f, 1.0f}) {
      FacePatches<3>::evaluate_first(patch, at + toward * step, values);
      const Vec3d pu = wide(values.du), pv = wide(values.dv);
      const Vec3d normal = pu.cross(pv);
      if (normal.length() > double(kParallel) * std::max(pu.length2(), pv.length2()) &&
          normal.length() > double(kParallel) * double(kParallel) * size * size)
        return Vec3f(normal.normalized());
    }
    return polygon_normals_[face];
  }

  void fill_sides(const Level& level, const SubdivisionRules& rules) {
    const bool faceted = rules.scheme.value_or(kDefaultScheme) == SubdivisionScheme::bilinear;
    const std::size_t faces = static_cast<std::size_t>(level.GetNumFaces());
    first_sides_.resize(faces + 1, 0);
    for (std::size_t face = 0; face < faces; ++face)
      first_sides_[face + 1] =
          first_sides_[face] + static_cast<std::size_t>(level.GetFaceVertices(static_cast<int>(face)).size());
    sides_.resize(first_sides_.back());
    const bool folds = has_fold(level);
    // Two faces that share a vertex whole around may lie back to back.
    const auto is_folded = [&](int edge) {
      const auto ends = level.GetEdgeVertices(edge);
      return folds && (is_fold(level, ends[0]) || is_fold(level, ends[1]));
    };
    const auto is_sharp_edge = [&](int edge) {
      return faceted || is_folded(edge) || level.IsEdgeBoundary(edge) || level.IsEdgeInfSharp(edge) ||
             level.IsEdgeNonManifold(edge);
    };
    const auto is_sharp_vertex = [&](int vertex) {
      if (faceted || (folds && is_fold(level, vertex)) || level.IsVertexInfSharp(vertex) ||
          level.IsVertexNonManifold(vertex) || level.IsVertexBoundary(vertex))
        return true;
      int sharp = 0;  // one alone is a dart's end, where the normals of both sides agree
      for (const int edge : level.GetVertexEdges(vertex)) sharp += is_sharp_edge(edge);
      return sharp > 1;
    };
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, faces, 1024), [&](const auto& range) {
      for (std::size_t face = range.begin(); face != range.end(); ++face) {
        const auto vertices = level.GetFaceVertices(static_cast<int>(face));
        const auto edges = level.GetFaceEdges(static_cast<int>(face));
        for (int i = 0; i < vertices.size(); ++i)
          sides_[first_sides_[face] + static_cast<std::size_t>(i)] = {
              static_cast<std::uint32_t>(edges[i]), static_cast<std::uint32_t>(vertices[i]),
              level.GetEdgeVertices(edges[i])[0] != vertices[i], is_sharp_edge(edges[i]), is_sharp_vertex(vertices[i])};
      }
    });
  }

  void fill_polygon_normals(const PolygonMesh& mesh) {
    polygon_normals_.resize(mesh.face_count());
    for (std::size_t face = 0; face < polygon_normals_.size(); ++face) {
      const Vec3d normal = newell_normal(mesh.positions.data(), mesh.corners.data() + first_sides_[face],
                                         first_sides_[face + 1] - first_sides_[face]);
      // A polygon without area faces up, as anything else would do.
      polygon_normals_[face] = normal.length() > 0 ? Vec3f(normal.normalized()) : Vec3f(0, 1, 0);
    }
  }

  /// Whether the limit masks of smooth extraordinary vertices hold at a vertex: all faces around it regular in size.
  bool has_limit_mask(const Level& level, int vertex) const {
    const int valence = level.GetVertexEdges(vertex).size();
    const bool loop = scheme_ == osd::Sdc::SCHEME_LOOP;
    if (scheme_ == osd::Sdc::SCHEME_BILINEAR || valence < 3 || valence == (loop ? 6 : 4)) return false;
    if (level.IsVertexBoundary(vertex) || level.IsVertexNonManifold(vertex) ||
        level.GetVertexRule(vertex) != osd::Sdc::Crease::RULE_SMOOTH)
      return false;
    for (const int face : level.GetVertexFaces(vertex))
      if (level.GetFaceVertices(face).size() != (loop ? 3 : 4)) return false;
    return true;
  }

  void fill_limit_vertices(const Level& level, const PolygonMesh& mesh, const osd::Far::TopologyRefiner& refiner) {
    std::vector<int> extraordinary;
    for (int vertex = 0; vertex < level.GetNumVertices(); ++vertex)
      if (has_limit_mask(level, vertex)) extraordinary.push_back(vertex);
    if (extraordinary.empty()) return;
    std::vector<PrimvarValue<Vec3d>> points(mesh.positions.size()), limits(points.size()), along(points.size()),
        across(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) points[i].value = Vec3d(mesh.positions[i]);
    osd::Far::PrimvarRefinerReal<double>(refiner).Limit(points, limits, along, across);
    limit_slots_.resize(points.size(), kNoLimit);
    for (const int vertex : extraordinary) {
      const auto v = static_cast<std::size_t>(vertex);
      const Vec3d normal = along[v].value.cross(across[v].value);
      // A cage flat or folded here: the patch decides.
      if (!(normal.length() > double(kParallel) * std::max(along[v].value.length2(), across[v].value.length2())))
        continue;
      limit_slots_[v] = static_cast<std::uint32_t>(limit_vertices_.size());
      limit_vertices_.push_back({Vec3f(limits[v].value), Vec3f(normal.normalized())});
    }
  }

  void apply_limit_vertex(std::size_t face, const Vec2f& at, SurfaceSample& sample) const {
    if (limit_slots_.empty() || at.x != std::floor(at.x) || at.y != std::floor(at.y)) return;
    const osd::Bfr::Parameterization domain_of = parameterization(face);
    const std::span<const FaceEdge> corners = all_sides(face);
    for (std::size_t i = 0; i < corners.size(); ++i) {
      Vec2f corner;
      domain_of.GetVertexCoord(static_cast<int>(i), &corner.x);
      if (corner != at) continue;
      if (const std::uint32_t slot = limit_slots_[corners[i].vertex]; slot != kNoLimit) {
        sample.position = limit_vertices_[slot].position;
        sample.normal = limit_vertices_[slot].normal;
      }
      return;
    }
  }

  static constexpr std::uint32_t kNoLimit = 0xffffffffu;

  Vec3d origin_;
  osd::Sdc::SchemeType scheme_;
  std::size_t edge_count_ = 0, vertex_count_ = 0;
  std::optional<FacePatches<3>> positions_;
  std::optional<FacePatches<2>> texture_;
  std::vector<std::size_t> first_sides_;  // [face_count + 1]
  std::vector<FaceEdge> sides_;
  std::vector<Vec3f> polygon_normals_;
  std::vector<std::uint32_t> limit_slots_;  // [vertex_count], empty: no vertex has one
  std::vector<LimitVertex> limit_vertices_;
};

/// Refuses faces on which OpenSubdiv's Bfr reads or writes memory that is not its own: those with a fold and, up
/// to 3.5, a crease at some corner; in 3.6 those whose fold ends one infinitely sharp crease (its pull requests 1301
/// and 1336).
void refuse_creased_folds(const Level& level, const SourceLocation& where) {
  const auto counts = [&](int edge) {
    return level.GetEdgeSharpness(edge) > 0 && !level.IsEdgeBoundary(edge) && !level.IsEdgeNonManifold(edge);
  };
  const auto refuse = [&](int face, int fold, int creased) {
    throw Error(
        ErrorKind::bad_input, where,
        fmt::format("subdivision cage: face {} (counted from 0) has vertex {}, which two faces alone share whole "
                    "around, and a crease at vertex {}: OpenSubdiv {}.{} has no limit surface there; leave the "
                    "crease out, or split one of the two faces at that vertex",
                    face, fold, creased, OPENSUBDIV_VERSION_MAJOR, OPENSUBDIV_VERSION_MINOR));
  };
  for (int vertex = 0; vertex < level.GetNumVertices(); ++vertex) {
    if (!is_fold(level, vertex)) continue;
    if constexpr (OPENSUBDIV_VERSION_NUMBER >= 30600) {
      int sharp = 0;
      for (const int edge : level.GetVertexEdges(vertex)) sharp += counts(edge) && level.IsEdgeInfSharp(edge);
      if (OPENSUBDIV_VERSION_NUMBER < 30700 && sharp == 1) refuse(level.GetVertexFaces(vertex)[0], vertex, vertex);
      continue;
    }
    for (const int face : level.GetVertexFaces(vertex))
      for (const int corner : level.GetFaceVertices(face))
        for (const int edge : level.GetVertexEdges(corner))
          if (counts(edge)) refuse(face, vertex, corner);
  }
}

}  // namespace

std::unique_ptr<ParametricSurface> make_subdivision_surface(const PolygonMesh& mesh, const SubdivisionRules& rules,
                                                            const SourceLocation& where, Warnings& warnings,
                                                            std::size_t point_budget) {
  check_cage(mesh, rules, where);
  const std::unique_ptr<osd::Far::TopologyRefiner> refiner = make_refiner(mesh, rules, where, warnings);
  refuse_creased_folds(refiner->GetLevel(0), where);
  return std::make_unique<SubdivisionSurface>(mesh, rules, *refiner, point_budget);
}

}  // namespace raytree
