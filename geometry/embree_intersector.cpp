#include "geometry/embree_intersector.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "geometry/embree_cones.h"
#include "geometry/embree_packets.h"
#include "geometry/embree_state.h"
#include "geometry/error.h"
#include "geometry/few_shapes.h"
#include "geometry/lanes.h"

namespace raytree {
namespace {

using embree::PacketTypes;
using embree::Query;
using embree::traceable;

/// As one vector: in two halves, as memcpy() may write them, they would not be there yet for who reads all of a
/// packet's lanes at once, and wait for the cache.
template <int Width>
void copy_lanes(void* to, const void* from) {
  typedef float Lanes __attribute__((vector_size(Width * 4), aligned(4), may_alias));
  *static_cast<Lanes*>(to) = *static_cast<const Lanes*>(from);
}

/// The fields of a packet that Embree only reads and that are alike for all rays.
template <int Width, class Ray>
void set_constant_fields(Ray& ray) {
  for (int i = 0; i < Width; ++i) {
    ray.tnear[i] = 0;
    ray.time[i] = 0;
    ray.mask[i] = 0xffffffffu;
    ray.id[i] = 0;
    ray.flags[i] = 0;
  }
}

/// Fills a packet from rays [first, first + Width) and says which lanes are live: inside the batch, finite, with a
/// direction and an end that is not behind the origin. (Debian's Embree 3 aborts the process on others.)
template <int Width, class Ray>
void load_rays(const RayBatch& rays, std::size_t first, const float* max_distance, Ray& ray, int* valid) {
  copy_lanes<Width>(ray.org_x, rays.origin_x + first);
  copy_lanes<Width>(ray.org_y, rays.origin_y + first);
  copy_lanes<Width>(ray.org_z, rays.origin_z + first);
  copy_lanes<Width>(ray.dir_x, rays.direction_x + first);
  copy_lanes<Width>(ray.dir_y, rays.direction_y + first);
  copy_lanes<Width>(ray.dir_z, rays.direction_z + first);
  copy_lanes<Width>(ray.tfar, max_distance + first);
  const int live = static_cast<int>(std::min<std::size_t>(Width, rays.size - first));
  for (int i = 0; i < Width; ++i) {
    const std::int32_t largest =
        std::max(std::max(std::max(embree::size_bits(ray.org_x[i]), embree::size_bits(ray.org_y[i])),
                          std::max(embree::size_bits(ray.org_z[i]), embree::size_bits(ray.dir_x[i]))),
                 std::max(embree::size_bits(ray.dir_y[i]), embree::size_bits(ray.dir_z[i])));
    const bool directed = (ray.dir_x[i] != 0) | (ray.dir_y[i] != 0) | (ray.dir_z[i] != 0);
    valid[i] = ((largest <= embree::kFarthestBits) & directed & (ray.tfar[i] >= 0) & (i < live)) ? -1 : 0;
  }
}

/// By how much, relative to a distance along a ray, bounds are missed before a ray is said to miss them: each distance
/// is off by two roundings, and Embree's own test in its robust mode by a few more.
constexpr float kBoundsSlack = 0x1p-20f;

/// Whether any of a packet's live rays may meet the bounds; never false for one that Embree would find something for.
/// Rays into the open, or whose way ends before what Embree holds, are worth no call.
template <int Width, class Ray>
bool may_meet(const embree::SceneBounds& bounds, const Ray& ray, const int* valid) {
  // Shadow rays and others that leave what Embree holds begin inside: one look settles those.
  if (valid[0] != 0 && bounds.hold(ray.org_x[0], ray.org_y[0], ray.org_z[0])) return true;
  int may = 0;
  for (int i = 0; i < Width; ++i) {
    const float origin[3] = {ray.org_x[i], ray.org_y[i], ray.org_z[i]};
    const float direction[3] = {ray.dir_x[i], ray.dir_y[i], ray.dir_z[i]};
    float enters = 0, leaves = ray.tfar[i];
    for (int axis = 0; axis < 3; ++axis) {
      const float inverse = 1 / direction[axis];
      const float to_least = (bounds.least[axis] - origin[axis]) * inverse,
                  to_most = (bounds.most[axis] - origin[axis]) * inverse;
      // Along a slab's very border 0 times infinity is not a number: it fails all comparisons, and the ray may meet.
      const float first = to_least < to_most ? to_least : to_most, last = to_least < to_most ? to_most : to_least;
      enters = first > enters ? first : enters;
      leaves = last < leaves ? last : leaves;
    }
    const bool misses = enters > leaves + std::abs(leaves) * kBoundsSlack;
    may |= valid[i] & (misses ? 0 : -1);
  }
  return may != 0;
}

/// Embree's id of the instance that was hit, as an index into ShapeSet::instances.
inline InstanceId instance_of(unsigned int embree_id, GeometryId first_instance) {
  return embree_id == RTC_INVALID_GEOMETRY_ID ? kNoInstance : embree_id - first_instance;
}

/// `Instanced`: the scene has instances, the first of them of Embree's id `first_instance`.
template <int Width, bool Instanced>
void intersect_packets(RTCScene scene, const embree::SceneBounds& bounds, const RayBatch& rays, Coherence coherence,
                       const float* max_distance, GeometryId first_instance, HitBatch& hits) noexcept {
  Query query(coherence == Coherence::coherent);
  alignas(64) int valid[Width];
  typename PacketTypes<Width>::RayHit packet;
  set_constant_fields<Width>(packet.ray);
  for (std::size_t first = 0; first < rays.size; first += Width) {
    load_rays<Width>(rays, first, max_distance, packet.ray, valid);
    if (!may_meet<Width>(bounds, packet.ray, valid)) {
      std::fill_n(hits.geometry + first, Width, kNoGeometry);
      std::copy_n(max_distance + first, Width, hits.distance + first);
      if constexpr (Instanced) std::fill_n(hits.instance + first, Width, kNoInstance);
      continue;
    }
    for (int i = 0; i < Width; ++i) embree::clear_hit(packet.hit, i);
    if (coherence == Coherence::mixed) query.set_coherent(embree::runs_alike<Width>(packet.ray, rays.size - first));
    query.intersect(scene, valid, packet);
    copy_lanes<Width>(hits.geometry + first, packet.hit.geomID);
    copy_lanes<Width>(hits.primitive + first, packet.hit.primID);
    copy_lanes<Width>(hits.u + first, packet.hit.u);
    copy_lanes<Width>(hits.v + first, packet.hit.v);
    copy_lanes<Width>(hits.distance + first, packet.ray.tfar);
    if constexpr (Instanced)
      for (int i = 0; i < Width; ++i) hits.instance[first + i] = instance_of(packet.hit.instID[0][i], first_instance);
  }
}

template <int Width>
void occluded_packets(RTCScene scene, const embree::SceneBounds& bounds, const RayBatch& rays, Coherence coherence,
                      std::uint8_t* occluded) noexcept {
  Query query(coherence == Coherence::coherent);
  alignas(64) int valid[Width];
  typename PacketTypes<Width>::Ray packet;
  set_constant_fields<Width>(packet);
  for (std::size_t first = 0; first < rays.size; first += Width) {
    load_rays<Width>(rays, first, rays.max_distance, packet, valid);
    if (!may_meet<Width>(bounds, packet, valid)) {
      std::fill_n(occluded + first, Width, std::uint8_t(0));
      continue;
    }
    if (coherence == Coherence::mixed) query.set_coherent(embree::runs_alike<Width>(packet, rays.size - first));
    query.occluded(scene, valid, packet);
    // Embree marks an occluded ray by tfar = -infinity; a lane that was not live counts as open.
    for (int i = 0; i < Width; ++i) occluded[first + i] = (packet.tfar[i] < 0) & (valid[i] != 0);
  }
}

/// Where Embree found nothing nearer, what the few shapes have: a hit, or none. Embree has set the instances.
void take_where_missed(const FewHits& few, std::size_t count, HitBatch& hits) noexcept {
  // Pointers that nothing else writes to, so that the loop is vectorized.
  GeometryId* __restrict geometries = hits.geometry;
  std::uint32_t* __restrict primitives = hits.primitive;
  float* __restrict u = hits.u, * __restrict v = hits.v;
  const GeometryId* few_geometries = few.geometry.data();
  const std::uint32_t* few_primitives = few.primitive.data();
  for (std::size_t i = 0; i < count; ++i) {
    const bool missed = geometries[i] == kNoGeometry;
    geometries[i] = missed ? few_geometries[i] : geometries[i];
    primitives[i] = missed ? few_primitives[i] : primitives[i];
    u[i] = missed ? 0.0f : u[i];
    v[i] = missed ? 0.0f : v[i];
  }
  // Distances are right already: Embree's rays end where the few shapes are met.
}

RTCBuildQuality embree_quality(EmbreeOptions::Quality quality) {
  if (quality == EmbreeOptions::Quality::low) return RTC_BUILD_QUALITY_LOW;
  return quality == EmbreeOptions::Quality::high ? RTC_BUILD_QUALITY_HIGH : RTC_BUILD_QUALITY_MEDIUM;
}

/// A scene of these shapes, not committed. Embree writes to none of the buffers that it shares. forms: what meshes
/// become; null: what `parts` says. Grids over copied points have ids from first_copied on.
embree::SceneHandle scene_of(RTCDevice device, const BoundedShapes& shapes, const EmbreeOptions& options,
                             const FewShapes& left_out, const embree::SceneParts& parts, const embree::MeshForms* forms,
                             GeometryId first_copied) {
  embree::SceneHandle handle(rtcNewScene(device));
  RTCScene scene = handle.get();
  int flags = RTC_SCENE_FLAG_NONE;
  if (options.robust) flags |= RTC_SCENE_FLAG_ROBUST;
  if (options.compact) flags |= RTC_SCENE_FLAG_COMPACT;
  rtcSetSceneFlags(scene, static_cast<RTCSceneFlags>(flags));
  rtcSetSceneBuildQuality(scene, embree_quality(options.quality));

  const auto attach = [&](RTCGeometryType type, GeometryId id, auto&& set_buffers) {
    embree::Geometry geometry(rtcNewGeometry(device, type));
    if (!geometry) return;
    rtcSetGeometryMask(geometry.get(), 0xffffffffu);  // Embree 4's default meets no ray mask
    rtcSetGeometryBuildQuality(geometry.get(), embree_quality(options.quality));
    set_buffers(geometry.get());
    rtcCommitGeometry(geometry.get());
    rtcAttachGeometryByID(scene, geometry.get(), id);
  };
  const auto share = [](RTCGeometry geometry, RTCBufferType type, RTCFormat format, const auto& array,
                        std::size_t stride, std::size_t count) {
    rtcSetSharedGeometryBuffer(geometry, type, 0, format, array.data(), 0, stride, count);
  };

  if (const SphereArray& spheres = shapes.spheres; !spheres.center_radius.empty() && !left_out.spheres)
    attach(RTC_GEOMETRY_TYPE_SPHERE_POINT, kSphereGeometry, [&](RTCGeometry geometry) {
      share(geometry, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT4, spheres.center_radius, 16,
            spheres.center_radius.size());
    });
  if (const DiscArray& discs = shapes.discs; !discs.center_radius.empty() && !left_out.discs)
    attach(RTC_GEOMETRY_TYPE_ORIENTED_DISC_POINT, kDiscGeometry, [&](RTCGeometry geometry) {
      share(geometry, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT4, discs.center_radius, 16, discs.center_radius.size());
      share(geometry, RTC_BUFFER_TYPE_NORMAL, RTC_FORMAT_FLOAT3, discs.normal, sizeof(Vec3f), discs.normal.size());
    });
  if (const ConeArray& cones = shapes.cones; !cones.shape.empty())
    attach(RTC_GEOMETRY_TYPE_USER, kConeGeometry, [&](RTCGeometry geometry) { embree::set_cones(geometry, cones); });
  for (std::size_t i = 0; i < shapes.meshes.size(); ++i) {
    const TriangleMesh& mesh = shapes.meshes[i].mesh;
    if (mesh.corners.empty()) continue;
    const auto id = static_cast<GeometryId>(i);
    if (forms != nullptr && !forms->grids.empty()) {
      const MeshGrids& grids = forms->grids[i];
      if (!grids.own.empty())
        attach(RTC_GEOMETRY_TYPE_GRID, kFirstMeshGeometry + id,
               [&](RTCGeometry geometry) { embree::share_grids(geometry, mesh.positions, grids.own); });
      if (!grids.copied.empty())
        attach(RTC_GEOMETRY_TYPE_GRID, first_copied + id,
               [&](RTCGeometry geometry) { embree::share_grids(geometry, grids.points, grids.copied); });
      continue;
    }
    const RTCGeometryType type = forms != nullptr ? RTC_GEOMETRY_TYPE_QUAD : parts.mesh_type;
    attach(type, kFirstMeshGeometry + id, [&](RTCGeometry geometry) {
      if (forms != nullptr) {
        embree::share_quads(geometry, mesh, forms->quads[i]);
        return;
      }
      if (parts.set_mesh) {
        parts.set_mesh(geometry, mesh);
        return;
      }
      share(geometry, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, mesh.positions, sizeof(Vec3f), mesh.positions.size());
      share(geometry, RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3, mesh.corners, 12, mesh.triangle_count());
    });
  }
  return handle;
}

/// Of a committed scene.
embree::SceneBounds bounds_of(RTCScene scene) {
  RTCBounds box;
  rtcGetSceneBounds(scene, &box);
  const float least[3] = {box.lower_x, box.lower_y, box.lower_z}, most[3] = {box.upper_x, box.upper_y, box.upper_z};
  embree::SceneBounds bounds;
  for (int axis = 0; axis < 3; ++axis) {
    const float slack = kBoundsSlack * std::max(std::abs(least[axis]), std::abs(most[axis]));
    bounds.least[axis] = least[axis] - slack;
    bounds.most[axis] = most[axis] + slack;
    // An empty scene's bounds are infinite, the wrong way round.
    if (!(least[axis] <= most[axis])) bounds.least[axis] = 1, bounds.most[axis] = -1;
  }
  return bounds;
}

void commit(RTCScene scene, const std::atomic<bool>* stop) {
  if (stop != nullptr)
    rtcSetSceneProgressMonitorFunction(
        scene, [](void* flag, double) { return !static_cast<const std::atomic<bool>*>(flag)->load(); },
        const_cast<std::atomic<bool>*>(stop));
  rtcCommitScene(scene);
}

}  // namespace

void EmbreeIntersector::throw_if_failed(State& state, const std::atomic<bool>* stop) {
  if (stop != nullptr && stop->load()) throw Error(ErrorKind::failure, {}, "interrupted");
  std::lock_guard lock(state.error_mutex);
  if (!state.error.empty()) throw Error(ErrorKind::failure, {}, "Embree: " + state.error);
}

EmbreeIntersector::EmbreeIntersector(const ShapeSet& shapes, const EmbreeOptions& options)
    : EmbreeIntersector(shapes, options, embree::SceneParts()) {}

EmbreeIntersector::EmbreeIntersector(const ShapeSet& shapes, const EmbreeOptions& options,
                                     const embree::SceneParts& parts)
    : state_(std::make_unique<State>()) {
  State& state = *state_;
  state.shapes = &shapes;
  state.few = FewShapes(shapes, options.most_few_shapes);
  std::string config = options.threads > 0 ? "threads=" + std::to_string(options.threads) : std::string();
  if (!parts.isa.empty()) config += (config.empty() ? "isa=" : ",isa=") + parts.isa;
  state.device.reset(rtcNewDevice(config.c_str()));
  if (!state.device)
    throw Error(ErrorKind::failure, {},
                parts.isa.empty() ? "Embree does not start on this processor"
                                  : "Embree's " + parts.isa + " does not run on this processor");
  RTCDevice device = state.device.get();

  rtcSetDeviceErrorFunction(
      device,
      [](void* user, RTCError, const char* text) {
        auto& s = *static_cast<State*>(user);
        std::lock_guard lock(s.error_mutex);
        if (s.error.empty()) s.error = text;
      },
      &state);
  rtcSetDeviceMemoryMonitorFunction(
      device,
      [](void* user, ssize_t bytes, bool) {
        auto& s = *static_cast<State*>(user);
        const std::ptrdiff_t now = s.memory.fetch_add(bytes, std::memory_order_relaxed) + bytes;
        std::ptrdiff_t peak = s.peak_memory.load(std::memory_order_relaxed);
        while (now > peak && !s.peak_memory.compare_exchange_weak(peak, now, std::memory_order_relaxed)) {
        }
        return true;
      },
      &state);
  state.wide = rtcGetDeviceProperty(device, RTC_DEVICE_PROPERTY_NATIVE_RAY8_SUPPORTED) != 0;

  state.primitives = options.primitives;
  if (options.primitives != EmbreeOptions::Primitives::triangles) {
    state.forms.emplace_back(shapes, options.primitives);
    for (const BoundedShapes& group : shapes.groups) state.forms.emplace_back(group, options.primitives);
    for (const embree::MeshForms& forms : state.forms) state.form_bytes += forms.memory_bytes();
  }
  const auto forms = [&](std::size_t at) { return state.forms.empty() ? nullptr : &state.forms[at]; };
  state.first_instance = kFirstMeshGeometry + static_cast<GeometryId>(shapes.meshes.size());
  state.first_copied = {state.first_instance + static_cast<GeometryId>(shapes.instances.size())};
  for (const BoundedShapes& group : shapes.groups)
    state.first_copied.push_back(kFirstMeshGeometry + static_cast<GeometryId>(group.meshes.size()));

  // Instances refer to groups that are built; what nothing uses is not.
  std::vector<bool> used(shapes.groups.size(), false);
  for (const Instance& instance : shapes.instances) used[instance.group] = true;
  state.groups.resize(shapes.groups.size());
  for (std::size_t i = 0; i < shapes.groups.size(); ++i) {
    if (!used[i]) continue;
    state.groups[i] =
        scene_of(device, shapes.groups[i], options, FewShapes(), parts, forms(1 + i), state.first_copied[1 + i]);
    commit(state.groups[i].get(), options.stop);
    throw_if_failed(state, options.stop);
  }

  state.scene = scene_of(device, shapes, options, state.few, parts, forms(0), state.first_copied[0]);
  state.instanced = !shapes.instances.empty();
  state.together = shapes.instances.size() < options.many_instances;
  for (std::size_t i = 0; i < shapes.instances.size(); ++i) {
    const Instance& instance = shapes.instances[i];
    embree::Geometry geometry(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE));
    if (!geometry) break;
    rtcSetGeometryMask(geometry.get(), 0xffffffffu);
    rtcSetGeometryInstancedScene(geometry.get(), state.groups[instance.group].get());
    rtcSetGeometryTransform(geometry.get(), 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, instance.to_scene);
    rtcCommitGeometry(geometry.get());
    rtcAttachGeometryByID(state.scene.get(), geometry.get(), state.first_instance + static_cast<GeometryId>(i));
  }
  if (parts.add) parts.add(device, state.scene.get(), state.first_copied[0]);
  commit(state.scene.get(), options.stop);
  throw_if_failed(state, options.stop);
  state.bounds = bounds_of(state.scene.get());
}

EmbreeIntersector::~EmbreeIntersector() = default;

void EmbreeIntersector::name_triangles(std::size_t count, HitBatch& hits) const noexcept {
  if (state_->primitives == EmbreeOptions::Primitives::quads) name_triangles_of_quads(count, hits);
  if (state_->primitives == EmbreeOptions::Primitives::grids) name_triangles_of_grids(count, hits);
}

/// Eight hits at a time.
void EmbreeIntersector::name_triangles_of_quads(std::size_t count, HitBatch& hits) const noexcept {
  const State& state = *state_;
  /// The list that names the triangles of what was hit; null: it is no quad, or nothing.
  const auto quads_at = [&state](GeometryId geometry, InstanceId instance) -> const QuadList* {
    if (geometry < kFirstMeshGeometry || geometry == kNoGeometry) return nullptr;
    const std::size_t space = instance == kNoInstance ? 0 : 1 + state.shapes->instances[instance].group;
    return &state.forms[space].quads[geometry - kFirstMeshGeometry];
  };
  for (std::size_t first = 0; first < count; first += kLanes) {
    IntegerLaneVector triangle = {}, halves = {}, is_quad = {}, primitive;
    std::memcpy(&primitive, hits.primitive + first, sizeof(primitive));
    const auto look_up = [&](std::size_t lane, const QuadList& list) {
      const std::uint32_t quad = hits.primitive[first + lane];
      is_quad[lane] = 1, triangle[lane] = list.first_triangle(quad), halves[lane] = list.halves[quad].bits();
    };
    const GeometryId* const geometry = hits.geometry + first;
    if (!state.instanced && first + kLanes <= count && std::equal(geometry + 1, geometry + kLanes, geometry)) {
      // Neighbors mostly hit one mesh, or nothing.
      const QuadList* const list = quads_at(*geometry, kNoInstance);
      if (list == nullptr) continue;
      if (list->first.empty()) {
        const std::uint32_t* const quad = hits.primitive + first;
        alignas(32) std::uint32_t bits[kLanes];
        for (std::size_t lane = 0; lane < kLanes; ++lane) bits[lane] = list->halves[quad[lane]].bits();
        std::memcpy(&halves, bits, sizeof(halves));
        is_quad += 1u, triangle = 2 * primitive;
      } else {
        for (std::size_t lane = 0; lane < kLanes; ++lane) look_up(lane, *list);
      }
    } else {
      for (std::size_t lane = 0; lane < std::min(kLanes, count - first); ++lane)
        if (const QuadList* const list = quads_at(geometry[lane], hits.instance[first + lane])) look_up(lane, *list);
    }
    LaneVector u, v;
    std::memcpy(&u, hits.u + first, sizeof(u));
    std::memcpy(&v, hits.v + first, sizeof(v));
    LaneVector u_there = u, v_there = v;
    find_triangle_point(halves, triangle, u_there, v_there);
    primitive = is_quad != 0 ? triangle : primitive;
    u = is_quad != 0 ? u_there : u;
    v = is_quad != 0 ? v_there : v;
    std::memcpy(hits.primitive + first, &primitive, sizeof(primitive));
    std::memcpy(hits.u + first, &u, sizeof(u));
    std::memcpy(hits.v + first, &v, sizeof(v));
  }
}

void EmbreeIntersector::name_triangles_of_grids(std::size_t count, HitBatch& hits) const noexcept {
  for (std::size_t i = 0; i < count; ++i) {
    const GeometryId geometry = hits.geometry[i];
    if (geometry < kFirstMeshGeometry || geometry == kNoGeometry) continue;
    const InstanceId instance = hits.instance[i];
    const std::size_t space = instance == kNoInstance ? 0 : 1 + state_->shapes->instances[instance].group;
    const bool copied = geometry >= state_->first_copied[space];
    const GeometryId mesh = geometry - (copied ? state_->first_copied[space] : kFirstMeshGeometry);
    const BoundedShapes& shapes =
        space == 0 ? static_cast<const BoundedShapes&>(*state_->shapes) : state_->shapes->groups[space - 1];
    const TrianglePoint point = triangle_point(state_->forms[space].grids[mesh], shapes.meshes[mesh].mesh.corners,
                                               copied, hits.primitive[i], hits.u[i], hits.v[i]);
    hits.geometry[i] = kFirstMeshGeometry + mesh;
    hits.primitive[i] = point.triangle, hits.u[i] = point.u, hits.v[i] = point.v;
  }
}

void EmbreeIntersector::nearest_bounded(const RayBatch& rays, Coherence coherence, const float* max_distance,
                                        HitBatch& hits) const noexcept {
  if (state_->instanced)
    hits.begin_instances();
  else
    hits.clear_instances();
  const auto run = state_->wide ? (state_->instanced ? intersect_packets<8, true> : intersect_packets<8, false>)
                                : (state_->instanced ? intersect_packets<4, true> : intersect_packets<4, false>);
  run(state_->scene.get(), state_->bounds, rays, state_->told(coherence), max_distance, state_->first_instance, hits);
  if (!state_->forms.empty()) name_triangles(rays.size, hits);
}

void EmbreeIntersector::intersect(const RayBatch& rays, Coherence coherence, HitBatch& hits) const noexcept {
  if (!state_->few.any()) {
    nearest_bounded(rays, coherence, rays.max_distance, hits);
    return;
  }
  // The few first: Embree then looks no further than they are.
  thread_local FewHits few;
  intersect_few(state_->few, rays, few);
  nearest_bounded(rays, coherence, few.distance.data(), hits);
  take_where_missed(few, rays.size, hits);
}

void EmbreeIntersector::occluded(const RayBatch& rays, Coherence coherence, std::uint8_t* occluded) const noexcept {
  const auto run = state_->wide ? occluded_packets<8> : occluded_packets<4>;
  run(state_->scene.get(), state_->bounds, rays, state_->told(coherence), occluded);
  if (!state_->few.any()) return;
  thread_local FewHits few;
  intersect_few(state_->few, rays, few);
  for (std::size_t i = 0; i < rays.size; ++i) occluded[i] |= few.geometry[i] != kNoGeometry;
}

Hit EmbreeIntersector::intersect_one(const Vec3f& origin, const Vec3f& direction, float max_distance) const noexcept {
  Hit nearest;
  nearest.distance = max_distance;
  if (!traceable(origin, direction, max_distance)) return nearest;
  nearest = intersect_few(state_->few, origin, direction, max_distance);
  Query query(false);
  RTCRayHit ray = embree::single_ray_hit(origin, direction, nearest.distance);
  query.intersect(state_->scene.get(), ray);
  if (ray.hit.geomID != RTC_INVALID_GEOMETRY_ID)
    nearest = {ray.hit.geomID, ray.hit.primID, ray.hit.u,
               ray.hit.v,      ray.ray.tfar,   instance_of(ray.hit.instID[0], state_->first_instance)};
  if (ray.hit.geomID != RTC_INVALID_GEOMETRY_ID && !state_->forms.empty()) {
    thread_local HitBatch one(1);
    one.set(0, nearest);
    name_triangles(1, one);
    nearest = one[0];
  }
  return nearest;
}

bool EmbreeIntersector::occluded_one(const Vec3f& origin, const Vec3f& direction, float max_distance) const noexcept {
  if (!traceable(origin, direction, max_distance)) return false;
  if (intersect_few(state_->few, origin, direction, max_distance).geometry != kNoGeometry) return true;
  Query query(false);
  RTCRay ray = embree::single_ray(origin, direction, max_distance);
  query.occluded(state_->scene.get(), ray);
  return ray.tfar < 0;
}

bool EmbreeIntersector::follows_packets_together() const noexcept { return state_->together; }

std::size_t EmbreeIntersector::memory_bytes() const noexcept {
  return static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, state_->memory.load())) + state_->form_bytes;
}
std::size_t EmbreeIntersector::peak_memory_bytes() const noexcept {
  return static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, state_->peak_memory.load())) + state_->form_bytes;
}

std::string EmbreeIntersector::version() { return "Embree " RTC_VERSION_STRING; }

}  // namespace raytree
