#include "renderer/unseen_surface.h"

#include <algorithm>

namespace raytree {
namespace {

bool leaves_rays(const MaterialDescription& material) {
  return material.conductor || max_channel(material.reflection) > 0 || max_channel(material.transmission) > 0;
}

/// Whether a shape's materials may be known to its mesh file alone.
bool awaits_materials(const ShapeDescription& shape) {
  const auto* const mesh = std::get_if<MeshShape>(&shape.kind);
  return mesh != nullptr && shape.material.empty() &&
         (!mesh->file.empty() || (mesh->mesh != nullptr && !mesh->mesh->groups.empty()));
}

void add_hull(Bounds3d& box, const BezierPatch& patch) {
  for (const Vec3d& point : patch.points) box.extendBy(point);
}

void add_hull(Bounds3d& box, const CoonsPatch& patch) {
  Bounds3d curves;
  for (const BezierCurve* curve : {&patch.bottom, &patch.top, &patch.left, &patch.right})
    for (const Vec3d& point : curve->points) curves.extendBy(point);
  box.extendBy(curves.min - curves.size());
  box.extendBy(curves.max + curves.size());
}

}  // namespace

bool rays_leave_hits(const SceneDescription& scene, const ShapeDescription& assembled) {
  if (scene.render.shadows && !scene.lights.empty()) return true;
  if (scene.render.depth <= 1) return false;
  if (std::any_of(scene.materials.begin(), scene.materials.end(), leaves_rays)) return true;
  const auto may_branch = [&](const std::vector<ShapeDescription>& shapes) {
    return std::any_of(shapes.begin(), shapes.end(),
                       [&](const ShapeDescription& shape) { return &shape != &assembled && awaits_materials(shape); });
  };
  return may_branch(scene.shapes) ||
         std::any_of(scene.groups.begin(), scene.groups.end(),
                     [&](const GroupDescription& group) { return may_branch(group.shapes); });
}

bool outside_frame(const Bounds3d& box, const Matrix44d& to_world, const TessellationView& view) {
  if (view.projection == TessellationView::Projection::any_direction || box.isEmpty()) return false;
  const bool perspective = view.projection == TessellationView::Projection::perspective;
  const double half_width = (view.half_width * (1 + kFrameMargin) + 1) * view.pixel;
  const double half_height = (view.half_height * (1 + kFrameMargin) + 1) * view.pixel;
  // Each border is a plane; where all corners lie beyond one, so does all between them.
  bool behind = true, left = true, right = true, below = true, above = true;
  for (int i = 0; i < 8; ++i) {
    const Vec3d corner(i & 1 ? box.max.x : box.min.x, i & 2 ? box.max.y : box.min.y, i & 4 ? box.max.z : box.min.z);
    const Vec3d p = corner * to_world - view.eye;
    const double x = p.dot(view.right), y = p.dot(view.up), z = p.dot(view.forward);
    const double scale = perspective ? z : 1;
    behind &= z < 0;
    right &= x > half_width * scale;
    left &= -x > half_width * scale;
    above &= y > half_height * scale;
    below &= -y > half_height * scale;
  }
  return behind || left || right || below || above;
}

Bounds3d hull_bounds(const PolygonMesh& cage) {
  Bounds3d box;
  for (const Vec3f& p : cage.positions) box.extendBy(cage.origin + Vec3d(p));
  return box;
}

Bounds3d hull_bounds(std::span<const SurfacePatch> patches) {
  Bounds3d box;
  for (const SurfacePatch& patch : patches) std::visit([&](const auto& one) { add_hull(box, one); }, patch);
  return box;
}

}  // namespace raytree
