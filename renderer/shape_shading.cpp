#include "renderer/shape_shading.h"

#include <utility>

#include "geometry/angle.h"
#include "geometry/error.h"
#include "geometry/vertex_normals.h"

namespace raytree {
namespace {

bool flat_by_its_normals(const ShapeDescription& shape) {
  const auto* mesh = std::get_if<MeshShape>(&shape.kind);
  return mesh != nullptr && mesh->normals == NormalSource::flat;
}

NormalRules rules_of(const Smoothing& normals) {
  const auto method = [&] {
    switch (normals.method) {
      case Smoothing::Method::unit:
        return NormalMethod::unit;
      case Smoothing::Method::area:
        return NormalMethod::area;
      case Smoothing::Method::edges:
        return NormalMethod::edges;
      case Smoothing::Method::terminating_edges:
        return NormalMethod::terminating_edges;
      case Smoothing::Method::corners:
        return NormalMethod::corners;
      case Smoothing::Method::angle:
      case Smoothing::Method::analytic:
        break;
    }
    return NormalMethod::angle;
  };
  return {method(), normals.crease_angle * kDegree, normals.across_pieces};
}

bool wants_averages(const ShapeDescription& shape) {
  return shape.smoothing && shape.smoothing->method != Smoothing::Method::analytic;
}

}  // namespace

ShadingMethod shading_of(const ShapeDescription& shape, const FacetSettings& settings) {
  if (settings.shading) return *settings.shading;
  if (shape.shading) return *shape.shading;
  return flat_by_its_normals(shape) ? ShadingMethod::flat : ShadingMethod::phong;
}

void check_shading(const ShapeDescription& shape) {
  if (shape.half_distance > 0 && shading_of(shape, {}) != ShadingMethod::flat)
    throw Error(ErrorKind::bad_input, shape.where, "half_distance is for flat shading: add \"shading\": \"flat\"");
}

void set_vertex_normals(PolygonMesh& mesh, const ShapeDescription& shape, ShadingMethod method, bool analytic) {
  if (shape.smoothing && !analytic && !wants_averages(shape))
    throw Error(ErrorKind::bad_input, shape.where,
                "smoothing by \"analytic\" is for curved surfaces and for round shapes with sides: these polygons have "
                "no surface to take them from");
  if (method == ShadingMethod::flat) {
    mesh.normals = {};
    mesh.normal_corners = {};
  } else if (wants_averages(shape)) {
    compute_vertex_normals(mesh, rules_of(*shape.smoothing));
  }
}

void set_vertex_normals(TriangleMesh& mesh, const ShapeDescription& shape, ShadingMethod method) {
  PolygonMesh view;
  view.normals = std::move(mesh.normals);
  view.normal_corners = std::move(mesh.normal_corners);
  view.positions = std::move(mesh.positions);
  view.corners = std::move(mesh.corners);
  set_vertex_normals(view, shape, method, true);
  mesh.normals = std::move(view.normals);
  mesh.normal_corners = std::move(view.normal_corners);
  mesh.positions = std::move(view.positions);
  mesh.corners = std::move(view.corners);
}

std::unique_ptr<FacetRecord> begin_record(const ShapeDescription& shape, ShadingMethod method,
                                          const FacetSettings& settings) {
  const bool interpolates = method == ShadingMethod::gouraud || method == ShadingMethod::phong;
  const bool remedied = method != ShadingMethod::flat && (settings.shadow_terminator != ShadowTerminator::classic ||
                                                          settings.reflections == FacetReflections::consistent);
  const bool fades = method == ShadingMethod::flat && shape.half_distance > 0;
  const FacetInterpolation interpolation = interpolates ? shape.interpolation : FacetInterpolation::barycentric;
  const bool by_light = method == ShadingMethod::gouraud, by_surface = method == ShadingMethod::limit;
  if (!by_light && !by_surface && !remedied && !fades && interpolation == FacetInterpolation::barycentric)
    return nullptr;
  auto record = std::make_unique<FacetRecord>();
  record->interpolation = interpolation;
  return record;
}

void finish_record(const TriangleMesh& mesh, const ShapeDescription& shape, ShadingMethod method,
                   const FacetSettings& settings, FacetRecord& record) {
  record.surface_normal_to_mesh = shape.transform.inverse().transposed();
  if (method != ShadingMethod::flat && settings.reflections == FacetReflections::consistent)
    find_least_cosines(mesh, record);
}

}  // namespace raytree
