#include "geometry/sphere_bounded_intersector.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "geometry/error.h"
#include "geometry/instance_transform.h"
#include "geometry/quadric_bounds.h"
#include "geometry/reference_intersector.h"
#include "geometry/sphere_bounded_objects.h"
#include "geometry/sphere_hierarchy.h"

namespace raytree {
namespace {

/// A ray in the group's space. Distances along it stay as they are, in lengths of its direction.
ObjectRay ray_inside(const InstanceTransform& transform, const ObjectRay& ray) {
  return {transform.point_inside(ray.origin), transform.vector_inside(ray.direction)};
}

/// The nearest hit so far.
struct Candidate {
  ObjectHit at;
  InstanceId instance = kNoInstance;
  GeometryId geometry = kNoGeometry;
  std::uint32_t object = 0;  ///< of the list, or the plane

  bool found() const { return geometry != kNoGeometry; }
  /// Of two hits at one distance, which counts. kNoInstance + 1 is 0. Objects of one geometry lie in order.
  bool comes_before(const Candidate& other) const {
    if (instance != other.instance) return instance + 1 < other.instance + 1;
    return geometry != other.geometry ? geometry < other.geometry : object < other.object;
  }
};

}  // namespace

struct SphereBoundedIntersector::State {
  /// One space: the objects in it, the spheres that are searched, and perhaps a hierarchy over them.
  struct Space {
    ObjectList objects;
    std::vector<BoundingSphere> spheres;  ///< of the objects, and behind them of the instances; empty: of objects alone
    SphereHierarchy hierarchy;

    std::span<const BoundingSphere> searched() const { return spheres.empty() ? objects.spheres() : spheres; }
  };

  const ShapeSet& shapes;
  SphereBoundedOptions options;
  std::vector<Space> groups;
  std::vector<Space> scene;  ///< one
  std::size_t peak = 0;

  State(const ShapeSet& set, const SphereBoundedOptions& chosen) : shapes(set), options(chosen) {
    for (const BoundedShapes& group : shapes.groups) {
      groups.push_back({ObjectList(group, options.sphere_pixels), {}, {}});
      finish(groups.back());
    }
    Space& top = scene.emplace_back(Space{ObjectList(shapes, options.sphere_pixels), {}, {}});
    if (!shapes.instances.empty()) {
      std::vector<BoundingSphere> about;  // each group
      for (const Space& group : groups) about.push_back(sphere_about_all(group));
      top.spheres = top.objects.spheres();
      top.spheres.reserve(top.spheres.size() + shapes.instances.size());
      for (const Instance& instance : shapes.instances)
        top.spheres.push_back(sphere_about(InstanceTransform(instance), about[instance.group]));
    }
    finish(top);
  }

  static BoundingSphere sphere_about_all(const Space& space) {
    Bounds3d box;
    for (const BoundingSphere& s : space.objects.spheres()) {
      box.extendBy(s.center - Vec3d(s.radius));
      box.extendBy(s.center + Vec3d(s.radius));
    }
    if (box.isEmpty()) return {};
    BoundingSphere about{box.center(), 0};
    for (const BoundingSphere& s : space.objects.spheres())
      about.radius = std::max(about.radius, (s.center - about.center).length() + s.radius);
    return about;
  }

  void finish(Space& space) {
    if (options.stop != nullptr && options.stop->load()) throw Error(ErrorKind::failure, {}, "interrupted");
    const std::size_t count = space.searched().size();
    const bool builds = options.search == SphereBoundedOptions::Search::hierarchy ||
                        (options.search == SphereBoundedOptions::Search::automatic && count > kMostLinearObjects);
    if (!builds) return;
    space.hierarchy.build(space.searched());
    peak = std::max(peak, held() + SphereHierarchy::build_bytes(count));
  }

  static std::size_t bytes(const Space& space) {
    return space.objects.memory_bytes() + space.spheres.capacity() * sizeof(BoundingSphere) +
           space.hierarchy.memory_bytes();
  }
  std::size_t held() const {
    std::size_t sum = sizeof(State) + (groups.capacity() + scene.capacity()) * sizeof(Space);
    for (const Space& space : groups) sum += bytes(space);
    for (const Space& space : scene) sum += bytes(space);
    return sum;
  }

  /// Calls offer(candidate) for what the ray meets within [0, limit], in any order, until it returns true. `limit` may
  /// fall meanwhile.
  template <class Offer>
  bool search(const ObjectRay& ray, const double& limit, const Offer& offer) const {
    for (std::uint32_t i = 0; i < shapes.planes.size(); ++i) {
      const Plane& plane = shapes.planes[i];
      const double distance = (plane.point - ray.origin).dot(plane.normal) / ray.direction.dot(plane.normal);
      // Infinite or NaN where the ray runs along it.
      if (distance >= 0 && distance <= limit && std::isfinite(distance) &&
          offer(Candidate{{distance, 0, 0}, kNoInstance, kPlaneGeometry, i}))
        return true;
    }
    const Space& top = scene[0];
    return search(top, ray, kNoInstance, limit, offer);
  }

  template <class Offer>
  bool search(const Space& space, const ObjectRay& ray, InstanceId instance, const double& limit,
              const Offer& offer) const {
    return space.hierarchy.search(
        space.searched(), ray.sphere, limit, [&](std::uint32_t object, const RayInterval& interval) {
          if (object >= space.objects.size()) {
            const auto use = static_cast<InstanceId>(object - space.objects.size());
            const ObjectRay inside = ray_inside(InstanceTransform(shapes.instances[use]), ray);
            return search(groups[shapes.instances[use].group], inside, use, limit, offer);
          }
          Candidate candidate{{}, instance, space.objects.geometry_of(object), object};
          return space.objects.intersect(object, ray, interval, limit, candidate.at) && offer(candidate);
        });
  }

  ReferenceHit describe(const Candidate& nearest, const ObjectRay& ray) const {
    if (nearest.geometry == kPlaneGeometry) {
      ReferenceHit hit;
      hit.geometry = kPlaneGeometry;
      hit.primitive = nearest.object;
      hit.distance = nearest.at.distance;
      hit.normal = shapes.planes[nearest.object].normal;
      return hit;
    }
    if (nearest.instance == kNoInstance) return scene[0].objects.describe(nearest.object, ray, nearest.at);
    const Instance& instance = shapes.instances[nearest.instance];
    const InstanceTransform transform(instance);
    ReferenceHit hit = groups[instance.group].objects.describe(nearest.object, ray_inside(transform, ray), nearest.at);
    hit.instance = nearest.instance;
    hit.normal = transform.normal(hit.normal).normalized();
    return hit;
  }
};

SphereBoundedIntersector::SphereBoundedIntersector(const ShapeSet& shapes, const SphereBoundedOptions& options)
    : state_(std::make_unique<State>(shapes, options)) {}

SphereBoundedIntersector::~SphereBoundedIntersector() = default;

ReferenceHit SphereBoundedIntersector::nearest(const Vec3d& origin, const Vec3d& direction, double max_distance) const {
  const ObjectRay ray(origin, direction);
  Candidate nearest;
  double limit = max_distance;
  state_->search(ray, limit, [&](const Candidate& candidate) {
    if (candidate.at.distance < limit || !nearest.found() || candidate.comes_before(nearest))
      nearest = candidate, limit = candidate.at.distance;
    return false;
  });
  return nearest.found() ? state_->describe(nearest, ray) : ReferenceHit{};
}

bool SphereBoundedIntersector::is_occluded(const Vec3d& origin, const Vec3d& direction, double max_distance) const {
  return state_->search(ObjectRay(origin, direction), max_distance, [](const Candidate&) { return true; });
}

void SphereBoundedIntersector::intersect(const RayBatch& rays, Coherence, HitBatch& hits) const noexcept {
  intersect_one_by_one(*this, rays, hits);
}

void SphereBoundedIntersector::occluded(const RayBatch& rays, Coherence, std::uint8_t* occluded) const noexcept {
  occluded_one_by_one(*this, rays, occluded);
}

std::size_t SphereBoundedIntersector::memory_bytes() const noexcept { return state_->held(); }
std::size_t SphereBoundedIntersector::peak_memory_bytes() const noexcept {
  return std::max(state_->peak, state_->held());
}

std::size_t SphereBoundedIntersector::object_count() const noexcept {
  std::size_t sum = state_->scene[0].searched().size();
  for (const auto& group : state_->groups) sum += group.objects.size();
  return sum;
}

bool SphereBoundedIntersector::uses_hierarchy() const noexcept { return state_->scene[0].hierarchy.built(); }

}  // namespace raytree
