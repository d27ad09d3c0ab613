#include "renderer/surface_tessellation.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <limits>

#include "geometry/angle.h"
#include "geometry/tessellation.h"
#include "geometry/tessellation_rates.h"
#include "renderer/camera.h"
#include "renderer/unseen_surface.h"

namespace raytree {
namespace {

/// The largest factor by which a linear map stretches a length is at most its Frobenius norm, and this is closer where
/// it is nearly orthogonal: the largest sum of a row of the absolute products of its axes (Gershgorin, on M M^T).
double largest_stretch(const Matrix44d& m) {
  const std::array<Vec3d, 3> axes{Vec3d(m[0][0], m[0][1], m[0][2]), Vec3d(m[1][0], m[1][1], m[1][2]),
                                  Vec3d(m[2][0], m[2][1], m[2][2])};
  double largest = 0;
  for (const Vec3d& a : axes) {
    double sum = 0;
    for (const Vec3d& b : axes) sum += std::abs(a.dot(b));
    largest = std::max(largest, sum);
  }
  return std::sqrt(largest);
}

/// Of the surface: the corners of its faces and points between, which is close enough to say how near it is.
Bounds3d rough_bounds(const ParametricSurface& surface) {
  const TriangleMesh mesh = tessellate_uniformly(surface, 2);
  Bounds3d box;
  for (const Vec3f& p : mesh.positions) box.extendBy(mesh.origin + Vec3d(p));
  return box;
}

std::uint64_t bytes_of(const TriangleMesh& mesh) {
  return mesh.positions.size() * sizeof(Vec3f) + mesh.normals.size() * sizeof(Vec3f) +
         mesh.texture_coordinates.size() * sizeof(Vec2f) +
         (mesh.corners.size() + mesh.normal_corners.size() + mesh.texture_corners.size() + mesh.triangle_faces.size()) *
             sizeof(std::uint32_t);
}

}  // namespace

TessellationView world_view(const CameraDescription& camera, const ImageDescription& image,
                            const SourceLocation& where) {
  (void)Camera(camera, image.width, image.height, {0, 0, 0}, where);  // for its checks
  TessellationView view;
  const bool perspective = camera.projection == CameraDescription::Projection::perspective;
  view.projection =
      perspective ? TessellationView::Projection::perspective : TessellationView::Projection::orthographic;
  view.eye = camera.position;
  view.forward = (camera.target - camera.position).normalized();
  view.right = view.forward.cross(camera.up).normalized();
  view.up = view.right.cross(view.forward);
  const double height = perspective ? 2 * std::tan(camera.field_of_view * kPi / 360) : camera.height;
  view.pixel = height / image.height;
  view.half_width = image.width / 2.0;
  view.half_height = image.height / 2.0;
  return view;
}

TessellationView nearest_view(const TessellationView& view, const ListPlaces& places, const Bounds3d& box) {
  if (!places) return view;
  const Vec3d center = box.center();
  const double radius = box.size().length() / 2;
  // Off the axis by an angle a, a pixel at distance d is at least pixel * d * cos^2 a wide in any direction.
  const double tangent_squared =
      (view.half_width * view.half_width + view.half_height * view.half_height) * view.pixel * view.pixel;
  const double widening = (1 + kFrameMargin) * (1 + kFrameMargin) * tangent_squared + 1;
  double pixel = std::numeric_limits<double>::infinity();
  std::uint64_t count = 0;
  Matrix44d only;
  places([&](const Matrix44d& place) {
    if (++count == 1) only = place;
    const double stretch = largest_stretch(place), reach = radius * stretch;
    double use = view.pixel;
    if (view.projection == TessellationView::Projection::perspective) {
      const Vec3d from_eye = center * place - view.eye;
      const double distance = std::max(from_eye.length() - reach, kLeastUseDistance * reach);
      const bool behind = from_eye.dot(view.forward) + reach < 0;
      use = view.pixel * distance * (behind ? kUnseenSlack : 1 / widening);
    }
    if (stretch > 0) pixel = std::min(pixel, use / stretch);
  });
  if (count == 1) {
    TessellationView seen = view;
    seen.to_world = only;
    return seen;
  }
  TessellationView nearest;
  // Without a use, or with uses of no size, nothing is seen; any pixel serves.
  nearest.pixel = std::isfinite(pixel) && pixel > 0 ? pixel : std::max(radius, 1e-30);
  return nearest;
}

SurfaceTessellation::SurfaceTessellation(const SceneDescription& scene, const CameraDescription& camera, bool measure)
    : settings_(scene.render.tessellation),
      view_(world_view(camera, scene.image, {scene.name, 0, "cameras." + camera.name})),
      measure_(measure) {
  if (!(settings_.tolerance > 0) || !std::isfinite(settings_.tolerance))
    throw Error(ErrorKind::bad_input, {scene.name, 0, "render.tessellation"}, "tolerance must be larger than 0");
  if (settings_.rate < 0 || settings_.rate > kLargestRate)
    throw Error(ErrorKind::bad_input, {scene.name, 0, "render.tessellation"},
                fmt::format("rate must lie from 0 to {}, not {}", kLargestRate, settings_.rate));
}

TriangleMesh SurfaceTessellation::make(const ParametricSurface& surface, const ShapeDescription& shape,
                                       const ListPlaces& places, ShapeSummary& summary, Warnings& warnings,
                                       FacetParameters* parameters) const {
  try {
    TessellationView view = view_;
    if (places) {
      Bounds3d box = rough_bounds(surface), moved;
      for (int i = 0; i < 8; ++i)
        moved.extendBy(
            Vec3d(i & 1 ? box.max.x : box.min.x, i & 2 ? box.max.y : box.min.y, i & 4 ? box.max.z : box.min.z) *
            shape.transform);
      view = nearest_view(view_, places, box.isEmpty() ? box : moved);
    }
    view.to_world = shape.transform * view.to_world;
    ViewRates found;
    if (settings_.rate > 0)
      found.rates = uniform_rates(surface, settings_.rate);
    else
      found = rates_for_view(surface, view, settings_.tolerance);
    if (found.coarse_faces > 0)
      warnings.push_back({shape.where,
                          fmt::format("faces that stay coarser than the tolerance of {} pixels, at {} segments a side",
                                      settings_.tolerance, kLargestViewRate),
                          static_cast<std::int64_t>(found.coarse_faces)});
    TriangleMesh mesh = tessellate(surface, found.rates, parameters);
    TessellationSummary& record = summary.tessellation.emplace();
    record.triangles = mesh.triangle_count();
    record.bytes = bytes_of(mesh);
    record.coarse_faces = found.coarse_faces;
    for (std::size_t face = 0; face < surface.face_count(); ++face) record.faces += !surface.sides(face).empty();
    if (measure_) record.measured = measure_tessellation(surface, found.rates, mesh, view, settings_.tolerance);
    if (settings_.rate == 0) record.tolerance = settings_.tolerance;
    return mesh;
  } catch (const Error& error) {
    if (!error.where().file.empty()) throw;
    throw Error(error.kind(), shape.where, error.what());
  }
}

bool SurfaceTessellation::is_outside_frame(const Bounds3d& hull, const ShapeDescription& shape) const {
  return outside_frame(hull, shape.transform, view_);
}

PixelSize SurfaceTessellation::pixel_size(const ListPlaces& places, const Bounds3d& box) const {
  const TessellationView view = nearest_view(view_, places, box);
  Matrix44d to_eye;
  to_eye.setTranslation(-view.eye);
  const bool perspective = view.projection == TessellationView::Projection::perspective;
  const double pixel = view.pixel / largest_stretch(view.to_world);
  return {view.to_world * to_eye, perspective ? pixel : 0, perspective ? 0 : pixel};
}

}  // namespace raytree
