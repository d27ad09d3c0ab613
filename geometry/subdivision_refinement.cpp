#include "geometry/subdivision_refinement.h"

#include <opensubdiv/bfr/refinerSurfaceFactory.h>
#include <opensubdiv/far/primvarRefiner.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "geometry/osd_topology.h"
#include "geometry/subdivision_surface.h"

namespace raytree {
namespace {

using Level = osd::Far::TopologyLevel;

constexpr double kMostFaces = 1 << 29;  // their corners still fit OpenSubdiv's int
constexpr std::uint32_t kNoSourceFace = 0xffffffffu;

/// interpolate(level, from) gives the values of a level from those of the one before.
template <class Wide, class Narrow, class Interpolate>
Buffer<Narrow> refined_values(const Buffer<Narrow>& source, int levels, const Interpolate& interpolate) {
  std::vector<PrimvarValue<Wide>> values(source.size());
  for (std::size_t i = 0; i < source.size(); ++i) values[i].value = Wide(source[i]);
  for (int level = 1; level <= levels; ++level) values = interpolate(level, values);
  Buffer<Narrow> result(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) result[i] = Narrow(values[i].value);
  return result;
}

class Refinement {
 public:
  Refinement(const PolygonMesh& mesh, const SubdivisionRules& rules, int levels, RefinedPoints points,
             const SourceLocation& where, Warnings& warnings)
      : mesh_(mesh),
        rules_(rules),
        points_(points),
        where_(where),
        refiner_(make_refiner(mesh, rules, where, warnings)) {
    if (levels > 0) {
      osd::Far::TopologyRefiner::UniformOptions options(levels);
      options.fullTopologyInLastLevel = points == RefinedPoints::limit || keeps_rules();
      refiner_->RefineUniform(options);
    }
    refine_values(levels);
    list_faces();
    find_sources(levels);
  }

  /// Only after RefinedPoints::limit.
  void move_to_limit();

  /// The faces that have a surface, in the order of the cage's faces.
  PolygonMesh result() &&;

 private:
  /// Control points with tags are a cage with tags, refined.
  bool keeps_rules() const { return points_ == RefinedPoints::control && mesh_.subdivision; }
  const Level& last_level() const { return refiner_->GetLevel(refiner_->GetMaxLevel()); }

  void refine_values(int levels) {
    const osd::Far::PrimvarRefinerReal<double> refiner(*refiner_);
    cage_.origin = mesh_.origin;
    cage_.positions = refined_values<Vec3d>(mesh_.positions, levels, [&](int level, const auto& from) {
      auto to = from;
      to.resize(static_cast<std::size_t>(refiner_->GetLevel(level).GetNumVertices()));
      refiner.Interpolate(level, from, to);
      return to;
    });
    if (mesh_.texture_coordinates.empty()) return;
    cage_.texture_coordinates =
        refined_values<Vec2d>(mesh_.texture_coordinates, levels, [&](int level, const auto& from) {
          auto to = from;
          to.resize(static_cast<std::size_t>(refiner_->GetLevel(level).GetNumFVarValues(0)));
          refiner.InterpolateFaceVarying(level, from, to, 0);
          return to;
        });
  }

  void list_faces() {
    const Level& level = last_level();
    const bool with_texture = !cage_.texture_coordinates.empty();
    cage_.corners.reserve(static_cast<std::size_t>(level.GetNumFaceVertices()));
    bool only_triangles = true;
    for (int face = 0; face < level.GetNumFaces(); ++face) {
      const auto vertices = level.GetFaceVertices(face);
      only_triangles = only_triangles && vertices.size() == 3;
      cage_.face_sizes.push_back(static_cast<std::uint32_t>(vertices.size()));
      for (const int vertex : vertices) cage_.corners.push_back(static_cast<std::uint32_t>(vertex));
      if (with_texture)
        for (const int value : level.GetFaceFVarValues(face, 0))
          cage_.texture_corners.push_back(static_cast<std::uint32_t>(value));
    }
    if (only_triangles) cage_.face_sizes = {};
  }

  void find_sources(int levels) {
    const osd::Bfr::RefinerSurfaceFactory<> factory(*refiner_);
    sources_.resize(mesh_.face_count());
    for (std::size_t face = 0; face < sources_.size(); ++face)
      sources_[face] =
          factory.FaceHasLimitSurface(static_cast<int>(face)) ? static_cast<std::uint32_t>(face) : kNoSourceFace;
    for (int l = 1; l <= levels; ++l) {
      const Level& level = refiner_->GetLevel(l);
      std::vector<std::uint32_t> children(static_cast<std::size_t>(level.GetNumFaces()));
      for (std::size_t face = 0; face < children.size(); ++face)
        children[face] = sources_[static_cast<std::size_t>(level.GetFaceParentFace(static_cast<int>(face)))];
      sources_.swap(children);
    }
  }

  /// The rules under which the refined cage has the limit of the unrefined one: what is left of each sharpness.
  SubdivisionRules rules_left() const {
    SubdivisionRules result = rules_;
    result.creases.clear(), result.corners.clear(), result.holes.clear();
    result.crease_angle.reset();
    const Level& level = last_level();
    for (int edge = 0; edge < level.GetNumEdges(); ++edge)
      if (const float sharpness = level.GetEdgeSharpness(edge); sharpness > 0 && !level.IsEdgeBoundary(edge)) {
        const auto ends = level.GetEdgeVertices(edge);
        result.creases.push_back(
            {{static_cast<std::uint32_t>(ends[0]), static_cast<std::uint32_t>(ends[1])}, double(sharpness)});
      }
    for (int vertex = 0; vertex < level.GetNumVertices(); ++vertex)
      if (const float sharpness = level.GetVertexSharpness(vertex); sharpness > 0)
        result.corners.push_back({static_cast<std::uint32_t>(vertex), double(sharpness)});
    for (std::size_t face = 0; face < sources_.size(); ++face)
      if (sources_[face] == kNoSourceFace) result.holes.push_back(static_cast<std::uint32_t>(face));
    return result;
  }

  const PolygonMesh& mesh_;
  const SubdivisionRules& rules_;
  const RefinedPoints points_;
  const SourceLocation& where_;
  std::unique_ptr<osd::Far::TopologyRefiner> refiner_;
  PolygonMesh cage_;  // refined, with all faces
  std::vector<std::uint32_t>
      sources_;  // [faces of cage_] the face that each came from; kNoSourceFace: it has no surface
};

void Refinement::move_to_limit() {
  Warnings known_already;
  const std::unique_ptr<ParametricSurface> surface =
      make_subdivision_surface(cage_, rules_left(), where_, known_already);
  Buffer<Vec3f> positions = cage_.positions;
  Buffer<Vec2f> texture = cage_.texture_coordinates;
  const Buffer<std::uint32_t>& texture_corners = cage_.texture_corners.empty() ? cage_.corners : cage_.texture_corners;
  Buffer<std::uint32_t> normal_corners = cage_.corners;
  Buffer<Vec3f> normals(cage_.positions.size());
  std::fill(normals.begin(), normals.end(), Vec3f(0, 1, 0));
  std::vector<Vec2f> parameters;
  std::vector<SurfaceSample> samples;
  std::vector<Vec2f> coordinates;
  std::size_t first = 0;
  for (std::size_t face = 0; face < sources_.size(); ++face) {
    const std::size_t size = cage_.all_triangles() ? 3 : cage_.face_sizes[face];
    const std::span<const FaceEdge> sides = surface->sides(face);
    if (!sides.empty()) {
      const osd::Bfr::Parameterization domain(refiner_->GetSchemeType(), static_cast<int>(size));
      parameters.resize(size), samples.resize(size), coordinates.resize(size);
      for (std::size_t i = 0; i < size; ++i) domain.GetVertexCoord(static_cast<int>(i), &parameters[i].x);
      surface->evaluate(face, parameters, samples);
      if (!texture.empty()) surface->evaluate_texture(face, parameters, coordinates);
      for (std::size_t i = 0; i < size; ++i) {
        const std::uint32_t vertex = cage_.corners[first + i];
        positions[vertex] = samples[i].position;
        if (!texture.empty()) texture[texture_corners[first + i]] = coordinates[i];
        if (!sides[i].sharp_vertex) {
          normals[vertex] = samples[i].normal;
          continue;
        }
        normal_corners[first + i] = static_cast<std::uint32_t>(normals.size());
        normals.push_back(samples[i].normal);
      }
    }
    first += size;
  }
  cage_.positions = std::move(positions);
  cage_.texture_coordinates = std::move(texture);
  if (normals.size() > cage_.positions.size()) cage_.normal_corners = std::move(normal_corners);
  cage_.normals = std::move(normals);
}

PolygonMesh Refinement::result() && {
  if (keeps_rules()) {
    cage_.subdivision = rules_left();
    cage_.subdivision->holes.clear();  // they are left out
  }
  std::vector<std::size_t> first_corners(sources_.size() + 1, 0);
  std::vector<std::uint32_t> order;
  for (std::size_t face = 0; face < sources_.size(); ++face) {
    first_corners[face + 1] = first_corners[face] + (cage_.all_triangles() ? 3 : cage_.face_sizes[face]);
    if (sources_[face] != kNoSourceFace) order.push_back(static_cast<std::uint32_t>(face));
  }
  if (order.empty())
    throw Error(ErrorKind::bad_input, where_,
                "subdivision cage: no face has a surface: all are holes or at the boundary");
  std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return sources_[a] < sources_[b]; });
  const auto gather = [&](Buffer<std::uint32_t>& corners) {
    if (corners.empty()) return;
    Buffer<std::uint32_t> kept;
    kept.reserve(corners.size());
    for (const std::uint32_t face : order)
      kept.insert(kept.end(), corners.begin() + static_cast<std::ptrdiff_t>(first_corners[face]),
                  corners.begin() + static_cast<std::ptrdiff_t>(first_corners[face + 1]));
    corners = std::move(kept);
  };
  gather(cage_.corners);
  gather(cage_.normal_corners);
  gather(cage_.texture_corners);
  if (!cage_.all_triangles()) {
    Buffer<std::uint32_t> sizes;
    for (const std::uint32_t face : order) sizes.push_back(cage_.face_sizes[face]);
    cage_.face_sizes = std::move(sizes);
  }
  for (const FaceGroup& group : mesh_.groups) {
    const auto place = [&](std::uint64_t source) {
      return static_cast<std::uint32_t>(
          std::lower_bound(order.begin(), order.end(), source, [&](auto face, auto s) { return sources_[face] < s; }) -
          order.begin());
    };
    FaceGroup run = group;
    run.first_face = place(group.first_face);
    run.face_count = place(std::uint64_t(group.first_face) + group.face_count) - run.first_face;
    if (run.face_count > 0) cage_.groups.push_back(std::move(run));
  }
  cage_.material_libraries = mesh_.material_libraries;
  return std::move(cage_);
}

void check_size(const PolygonMesh& mesh, const SubdivisionRules& rules, int levels, const SourceLocation& where) {
  if (levels < 0 || levels > kMaxRefinementLevels)
    throw Error(ErrorKind::bad_input, where, "a cage is refined 0 to 15 times");
  if (levels == 0) return;
  const bool loop = rules.scheme.value_or(kDefaultScheme) == SubdivisionScheme::loop;
  const double first = loop ? 4 * double(mesh.face_count()) : double(mesh.corners.size());
  if (first * std::pow(4.0, levels - 1) > kMostFaces)
    throw Error(ErrorKind::bad_input, where,
                "subdivision cage: " + std::to_string(levels) + " refinements would make more than 536870912 faces");
}

}  // namespace

PolygonMesh refine_uniformly(const PolygonMesh& mesh, const SubdivisionRules& rules, int levels, RefinedPoints points,
                             const SourceLocation& where, Warnings& warnings) {
  check_cage(mesh, rules, where);
  check_size(mesh, rules, levels, where);
  Refinement refinement(mesh, rules, levels, points, where, warnings);
  if (points == RefinedPoints::limit) refinement.move_to_limit();
  return std::move(refinement).result();
}

}  // namespace raytree
