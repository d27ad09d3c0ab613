#include "geometry/facet_record.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "geometry/buffer.h"
#include "geometry/facet_pattern.h"

namespace raytree {
namespace {

class ParametricNormals final : public TrueSurface {
 public:
  ParametricNormals(std::shared_ptr<const ParametricSurface> surface, FacetParameters parameters)
      : surface_(std::move(surface)), parameters_(std::move(parameters)) {}

  Vec3d normal(const TriangleMesh&, std::uint32_t triangle, float u, float v) const override {
    const std::size_t face = parameters_.faces[triangle];
    const Vec2f* corner = &parameters_.corners[3 * std::size_t(triangle)];
    const std::array<Vec2f, 3> corners{corner[0], corner[1], corner[2]};
    // Hits may lie a little beyond an edge; parameters must not.
    const double b = std::clamp(double(u), 0.0, 1.0), c = std::clamp(double(v), 0.0, 1.0 - b);
    const std::array<std::array<double, 3>, 1> weights{{{1 - b - c, b, c}}};
    Vec2f place;
    parameters_in_facet(surface_->domain(face), surface_->sides(face).size(), corners, weights, &place);
    SurfaceSample sample;
    surface_->evaluate(face, {&place, 1}, {&sample, 1});
    return Vec3d(sample.normal);
  }
  std::size_t memory_bytes() const override {
    return array_bytes(parameters_.faces) + array_bytes(parameters_.corners);
  }

 private:
  std::shared_ptr<const ParametricSurface> surface_;
  FacetParameters parameters_;
};

/// Vertices stay where the surface is: any affine map of the mesh keeps barycentrics.
class QuadricNormals : public TrueSurface {
 public:
  explicit QuadricNormals(const PolygonMesh& mesh) : positions_(mesh.positions) {}
  std::size_t memory_bytes() const override { return array_bytes(positions_); }

 protected:
  Vec3d point(const TriangleMesh& mesh, std::uint32_t triangle, float u, float v) const {
    const std::uint32_t* corner = &mesh.corners[3 * std::size_t(triangle)];
    return Vec3d(positions_[corner[0]]) * (1.0 - double(u) - double(v)) + Vec3d(positions_[corner[1]]) * double(u) +
           Vec3d(positions_[corner[2]]) * double(v);
  }

 private:
  Buffer<Vec3f> positions_;  ///< relative to the mesh's origin
};

class SphereNormals final : public QuadricNormals {
 public:
  using QuadricNormals::QuadricNormals;
  Vec3d normal(const TriangleMesh& mesh, std::uint32_t triangle, float u, float v) const override {
    return point(mesh, triangle, u, v);
  }
};

class ConeNormals final : public QuadricNormals {
 public:
  ConeNormals(const PolygonMesh& mesh, const Cone& cone)
      : QuadricNormals(mesh), frame_(Cone{{0, 0, 0}, cone.apex - cone.base, cone.base_radius, cone.apex_radius}) {}
  Vec3d normal(const TriangleMesh& mesh, std::uint32_t triangle, float u, float v) const override {
    return cone_normal(frame_, point(mesh, triangle, u, v));
  }

 private:
  ConeFrame frame_;
};

Vec3f facet_normal(const TriangleMesh& mesh, std::size_t triangle) {
  const std::uint32_t* corner = &mesh.corners[3 * triangle];
  const Vec3d a(mesh.positions[corner[0]]);
  const Vec3d normal = (Vec3d(mesh.positions[corner[1]]) - a).cross(Vec3d(mesh.positions[corner[2]]) - a);
  const double length = normal.length();
  return length > 0 ? Vec3f(normal / length) : Vec3f(0, 0, 0);
}

}  // namespace

std::unique_ptr<TrueSurface> true_surface(std::shared_ptr<const ParametricSurface> surface,
                                          FacetParameters parameters) {
  return std::make_unique<ParametricNormals>(std::move(surface), std::move(parameters));
}
std::unique_ptr<TrueSurface> true_sphere(const PolygonMesh& mesh) { return std::make_unique<SphereNormals>(mesh); }
std::unique_ptr<TrueSurface> true_cone(const PolygonMesh& mesh, const Cone& cone) {
  return std::make_unique<ConeNormals>(mesh, cone);
}

std::size_t FacetRecord::memory_bytes() const {
  return array_bytes(starts) + array_bytes(corners) + array_bytes(normal_corners) + array_bytes(least_cosines) +
         (surface ? surface->memory_bytes() : 0);
}

void note_polygons(const PolygonMesh& mesh, FacetRecord& record) {
  if (mesh.all_triangles()) return;
  record.starts.resize(mesh.face_sizes.size() + 1);
  record.starts[0] = 0;
  for (std::size_t face = 0; face < mesh.face_sizes.size(); ++face)
    record.starts[face + 1] = record.starts[face] + mesh.face_sizes[face];
  record.corners = mesh.corners;
  record.normal_corners = mesh.normal_corners;
}

void find_least_cosines(const TriangleMesh& mesh, FacetRecord& record) {
  record.least_cosines.assign(mesh.normals.size(), 1.0f);
  const Buffer<std::uint32_t>& indices = mesh.normal_corners.empty() ? mesh.corners : mesh.normal_corners;
  for (std::size_t triangle = 0; triangle < mesh.triangle_count(); ++triangle) {
    const Vec3f normal = facet_normal(mesh, triangle);
    if (normal.length2() == 0) continue;  // nothing is seen of it
    for (std::size_t c = 3 * triangle; c < 3 * triangle + 3; ++c) {
      float& least = record.least_cosines[indices[c]];
      least = std::min(least, mesh.normals[indices[c]].dot(normal));
    }
  }
}

void append_corners(const TriangleMesh& mesh, const FacetRecord& record, const Hit& hit,
                    std::vector<ShadedCorner>& corners) {
  const auto add = [&](std::uint32_t position, std::uint32_t normal) {
    ShadedCorner corner;
    corner.position = mesh.positions[position];
    corner.normal = mesh.normals.empty() ? facet_normal(mesh, hit.primitive) : mesh.normals[normal];
    if (!record.least_cosines.empty()) corner.least_cosine = record.least_cosines[normal];
    corners.push_back(corner);
  };
  if (!record.starts.empty()) {
    const std::uint32_t face = mesh.triangle_faces.empty() ? hit.primitive : mesh.triangle_faces[hit.primitive];
    const std::uint32_t* normals = (record.normal_corners.empty() ? record.corners : record.normal_corners).data();
    for (std::uint32_t c = record.starts[face]; c < record.starts[face + 1]; ++c) add(record.corners[c], normals[c]);
    return;
  }
  const std::size_t first = 3 * std::size_t(hit.primitive);
  const std::uint32_t* normals = (mesh.normal_corners.empty() ? mesh.corners : mesh.normal_corners).data();
  for (std::size_t c = first; c < first + 3; ++c) add(mesh.corners[c], normals[c]);
}

Vec3f true_normal(const TriangleMesh& mesh, const FacetRecord& record, const Hit& hit) {
  Vec3d normal =
      record.surface->normal(mesh, hit.primitive, record.reversed ? hit.v : hit.u, record.reversed ? hit.u : hit.v);
  record.surface_normal_to_mesh.multDirMatrix(Vec3d(normal), normal);
  const double length = normal.length();
  return length > 0 && std::isfinite(length) ? Vec3f(normal / length) : Vec3f(0, 0, 0);
}

}  // namespace raytree
