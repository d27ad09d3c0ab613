#include "geometry/embree_bench_scene.h"

#include <Imath/ImathBox.h>

#include <algorithm>
#include <map>

#include "geometry/embree_packets.h"
#include "geometry/embree_state.h"
#include "geometry/quad_grids.h"
#include "geometry/stopwatch.h"

namespace raytree {
namespace {

/// Rays per look at the clock: their packets stay in the first-level cache, and a look (some 25 ns) is under 1 % of
/// what tracing them takes.
constexpr std::size_t kBlockOfRays = 256;

/// Size of the shapes that keep company, as a share of the scene's.
constexpr float kCompanySize = 0x1p-12f;

/// Where no scene reaches, and Embree still takes a ray's origin.
constexpr float kFarAway = 1e18f;

/// Room for one block's packets.
template <int Width>
struct BenchPackets {
  static constexpr std::size_t kPackets = kBlockOfRays / Width;
  alignas(64) int valid[kPackets][Width];
  alignas(64) typename embree::PacketTypes<Width>::RayHit ray_hits[kPackets];
  alignas(64) typename embree::PacketTypes<Width>::Ray rays[kPackets];
};

/// Fills the packets of rays [first, first + size); returns how many there are.
template <int Width, class RayOf>
std::size_t fill_packets(const RayBatch& rays, std::size_t first, std::size_t size, BenchPackets<Width>& work,
                         const RayOf& ray_of) {
  const std::size_t packets = (size + Width - 1) / Width;
  for (std::size_t i = 0; i < packets * Width; ++i) {
    const std::size_t at = first + std::min(i, size - 1);
    const int lane = static_cast<int>(i % Width);
    embree::set_lane(ray_of(i / Width), lane, rays.origin(at), rays.direction(at), rays.max_distance[at]);
    const bool live = i < size && embree::traceable(rays.origin(at), rays.direction(at), rays.max_distance[at]);
    work.valid[i / Width][lane] = live ? -1 : 0;
  }
  return packets;
}

template <int Width>
double intersect_block(RTCScene scene, const RayBatch& rays, std::size_t first, std::size_t size, bool coherent,
                       HitBatch& hits) {
  thread_local BenchPackets<Width> work;
  const std::size_t packets = fill_packets<Width>(
      rays, first, size, work, [&](std::size_t p) -> auto& { return work.ray_hits[p].ray; });
  for (std::size_t i = 0; i < packets * Width; ++i)
    embree::clear_hit(work.ray_hits[i / Width].hit, static_cast<int>(i % Width));
  embree::Query query(coherent);
  const RunningTime time;
  for (std::size_t p = 0; p < packets; ++p) query.intersect(scene, work.valid[p], work.ray_hits[p]);
  const double seconds = time.seconds();
  for (std::size_t i = 0; i < size; ++i) {
    const auto& packet = work.ray_hits[i / Width];
    const std::size_t lane = i % Width;
    hits.set(first + i, {packet.hit.geomID[lane], packet.hit.primID[lane], packet.hit.u[lane], packet.hit.v[lane],
                         packet.ray.tfar[lane], packet.hit.instID[0][lane]});
  }
  return seconds;
}

template <>
double intersect_block<1>(RTCScene scene, const RayBatch& rays, std::size_t first, std::size_t size, bool coherent,
                          HitBatch& hits) {
  alignas(64) thread_local RTCRayHit work[kBlockOfRays];
  for (std::size_t i = 0; i < size; ++i)
    work[i] = embree::single_ray_hit(rays.origin(first + i), rays.direction(first + i), rays.max_distance[first + i]);
  embree::Query query(coherent);
  const RunningTime time;
  for (std::size_t i = 0; i < size; ++i) query.intersect(scene, work[i]);
  const double seconds = time.seconds();
  for (std::size_t i = 0; i < size; ++i)
    hits.set(first + i, {work[i].hit.geomID, work[i].hit.primID, work[i].hit.u, work[i].hit.v, work[i].ray.tfar,
                         work[i].hit.instID[0]});
  return seconds;
}

template <int Width>
double occluded_block(RTCScene scene, const RayBatch& rays, std::size_t first, std::size_t size, bool coherent,
                      std::uint8_t* occluded) {
  thread_local BenchPackets<Width> work;
  const std::size_t packets = fill_packets<Width>(
      rays, first, size, work, [&](std::size_t p) -> auto& { return work.rays[p]; });
  embree::Query query(coherent);
  const RunningTime time;
  for (std::size_t p = 0; p < packets; ++p) query.occluded(scene, work.valid[p], work.rays[p]);
  const double seconds = time.seconds();
  for (std::size_t i = 0; i < size; ++i)
    occluded[first + i] = work.valid[i / Width][i % Width] != 0 && work.rays[i / Width].tfar[i % Width] < 0;
  return seconds;
}

template <>
double occluded_block<1>(RTCScene scene, const RayBatch& rays, std::size_t first, std::size_t size, bool coherent,
                         std::uint8_t* occluded) {
  alignas(64) thread_local RTCRay work[kBlockOfRays];
  for (std::size_t i = 0; i < size; ++i)
    work[i] = embree::single_ray(rays.origin(first + i), rays.direction(first + i), rays.max_distance[first + i]);
  embree::Query query(coherent);
  const RunningTime time;
  for (std::size_t i = 0; i < size; ++i) query.occluded(scene, work[i]);
  const double seconds = time.seconds();
  for (std::size_t i = 0; i < size; ++i) occluded[first + i] = work[i].tfar < 0;
  return seconds;
}

/// Whether every ray may go to Embree: single-ray calls have no lanes to switch off.
bool all_traceable(const RayBatch& rays) {
  for (std::size_t i = 0; i < rays.size; ++i)
    if (!embree::traceable(rays.origin(i), rays.direction(i), rays.max_distance[i])) return false;
  return true;
}

/// A batch with rays that no Embree may have in place of which stand rays that end where they begin.
const RayBatch& made_traceable(const RayBatch& rays) {
  if (all_traceable(rays)) return rays;
  thread_local RayBatch copy(0);
  if (copy.capacity() < rays.size) copy = RayBatch(rays.capacity());
  copy.size = 0;
  for (std::size_t i = 0; i < rays.size; ++i) {
    const bool good = embree::traceable(rays.origin(i), rays.direction(i), rays.max_distance[i]);
    copy.push(good ? rays.origin(i) : Vec3f(kFarAway), good ? rays.direction(i) : Vec3f(1, 0, 0),
              good ? rays.max_distance[i] : 0);
  }
  return copy;
}

Imath::Box3f bounds_of(const BoundedShapes& shapes) {
  Imath::Box3f bounds;
  for (const MeshEntry& entry : shapes.meshes)
    for (const Vec3f& point : entry.mesh.positions) bounds.extendBy(point);
  for (const Imath::V4f& sphere : shapes.spheres.center_radius) bounds.extendBy(Vec3f(sphere.x, sphere.y, sphere.z));
  return bounds;
}

}  // namespace

struct EmbreeBenchScene::Parts {
  std::map<const TriangleMesh*, QuadList> quads;
  std::map<const TriangleMesh*, GridList> grids;
  Buffer<Vec3f> company_points;
  Buffer<std::uint32_t> company_corners;
  Buffer<Imath::V4f> company_sphere;
  double triangles = 0, primitives = 0;

  void prepare(const BoundedShapes& shapes, BenchGeometry geometry) {
    if (geometry == BenchGeometry::triangles) return;
    for (const MeshEntry& entry : shapes.meshes) {
      QuadList list = joined_quads(entry.mesh.corners);
      triangles += static_cast<double>(entry.mesh.triangle_count());
      if (geometry == BenchGeometry::grids) {
        const GridList& made = grids[&entry.mesh] = joined_grids(list, entry.mesh.positions);
        primitives += static_cast<double>(made.tiles.size());
      } else {
        primitives += static_cast<double>(list.size());
        quads[&entry.mesh] = std::move(list);
      }
    }
  }

  void set_grids(RTCGeometry geometry, const TriangleMesh& mesh) const {
    const GridList& list = grids.at(&mesh);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, list.points.data(), 0,
                               sizeof(Vec3f), list.points.size());
    auto* out = static_cast<RTCGrid*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_GRID, 0, RTC_FORMAT_GRID,
                                                              sizeof(RTCGrid), list.tiles.size()));
    if (out == nullptr) return;  // no memory: Embree has said so
    for (const GridTile& tile : list.tiles)
      *out++ = {tile.first_point, tile.width, static_cast<std::uint16_t>(tile.width),
                static_cast<std::uint16_t>(tile.height)};
  }

  void make_company(const ShapeSet& shapes) {
    const Imath::Box3f box = bounds_of(shapes);
    const Vec3f extent = box.isEmpty() ? Vec3f(1) : box.size();
    const float size = kCompanySize * std::max({extent.x, extent.y, extent.z});
    const Vec3f at = box.isEmpty() ? Vec3f(0) : box.max;
    for (const Vec3f& corner : {Vec3f(0, 0, 0), Vec3f(1, 0, 0), Vec3f(1, 0, 1), Vec3f(0, 0, 1)})
      company_points.push_back(at + corner * size);
    for (std::uint32_t corner = 0; corner < 4; ++corner) company_corners.push_back(corner);
    company_sphere.emplace_back(at.x, at.y + 2 * size, at.z, size);
  }

  void attach_company(RTCDevice device, RTCScene scene, GeometryId id, bool sphere) const {
    const embree::Geometry quad(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_QUAD));
    rtcSetGeometryMask(quad.get(), 0xffffffffu);
    rtcSetSharedGeometryBuffer(quad.get(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, company_points.data(), 0,
                               sizeof(Vec3f), company_points.size());
    rtcSetSharedGeometryBuffer(quad.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT4, company_corners.data(), 0,
                               4 * sizeof(std::uint32_t), 1);
    rtcCommitGeometry(quad.get());
    rtcAttachGeometryByID(scene, quad.get(), id);
    if (!sphere) return;
    const embree::Geometry ball(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_SPHERE_POINT));
    rtcSetGeometryMask(ball.get(), 0xffffffffu);
    rtcSetSharedGeometryBuffer(ball.get(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, company_sphere.data(), 0,
                               sizeof(Imath::V4f), 1);
    rtcCommitGeometry(ball.get());
    rtcAttachGeometryByID(scene, ball.get(), id + 1);
  }
};

EmbreeBenchScene::EmbreeBenchScene(const ShapeSet& shapes, const BenchSceneOptions& options)
    : shapes_(shapes), compact_(options.compact) {
  auto parts = std::make_unique<Parts>();
  parts->prepare(shapes, options.geometry);
  for (const BoundedShapes& group : shapes.groups) parts->prepare(group, options.geometry);
  if (parts->primitives > 0) triangles_per_primitive_ = parts->triangles / parts->primitives;
  if (options.company != BenchCompany::none) parts->make_company(shapes);
  embree::SceneParts scene_parts;
  const Parts* kept = parts.get();
  if (options.geometry == BenchGeometry::quads) {
    scene_parts.mesh_type = RTC_GEOMETRY_TYPE_QUAD;
    scene_parts.set_mesh = [kept](RTCGeometry geometry, const TriangleMesh& mesh) {
      embree::share_quads(geometry, mesh, kept->quads.at(&mesh));
    };
  } else if (options.geometry == BenchGeometry::grids) {
    scene_parts.mesh_type = RTC_GEOMETRY_TYPE_GRID;
    scene_parts.set_mesh = [kept](RTCGeometry geometry, const TriangleMesh& mesh) { kept->set_grids(geometry, mesh); };
  }
  if (options.company != BenchCompany::none)
    scene_parts.add = [kept, &options](RTCDevice device, RTCScene scene, GeometryId id) {
      kept->attach_company(device, scene, id, options.company == BenchCompany::quad_and_sphere);
    };
  scene_parts.isa = options.isa;
  parts_ = std::move(parts);
  EmbreeOptions embree_options;
  embree_options.threads = options.threads;
  embree_options.robust = options.robust, embree_options.compact = options.compact;
  embree_options.quality = options.quality;
  embree_options.most_few_shapes = 0;
  embree_options.stop = options.stop;
  const auto start = Clock::now();
  tracer_.reset(new EmbreeIntersector(shapes, embree_options, scene_parts));
  build_seconds_ = seconds_since(start);
}

EmbreeBenchScene::~EmbreeBenchScene() = default;

std::size_t EmbreeBenchScene::memory_bytes() const noexcept { return tracer_->memory_bytes(); }
std::size_t EmbreeBenchScene::peak_memory_bytes() const noexcept { return tracer_->peak_memory_bytes(); }

int EmbreeBenchScene::widest_call(const std::string& isa) {
  const std::string config = isa.empty() ? "threads=1" : "threads=1,isa=" + isa;
  const embree::Device device(rtcNewDevice(config.c_str()));
  int widest = 1;
  for (const auto& [width, property] : {std::pair(4, RTC_DEVICE_PROPERTY_NATIVE_RAY4_SUPPORTED),
                                        {8, RTC_DEVICE_PROPERTY_NATIVE_RAY8_SUPPORTED},
                                        {16, RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED}})
    if (device && rtcGetDeviceProperty(device.get(), property) != 0) widest = width;
  return widest;
}

bool EmbreeBenchScene::has_own_surface() const noexcept { return !parts_->grids.empty(); }

ShapeSet EmbreeBenchScene::surface() const {
  if (!has_own_surface()) return shapes_;
  const auto halved = [&](const BoundedShapes& shapes, BoundedShapes& result) {
    result.origin = shapes.origin;
    result.spheres = shapes.spheres, result.discs = shapes.discs, result.cones = shapes.cones;
    for (const MeshEntry& entry : shapes.meshes)
      result.meshes.emplace_back().mesh = halved_grids(parts_->grids.at(&entry.mesh));
  };
  ShapeSet result;
  halved(shapes_, result);
  for (const BoundedShapes& group : shapes_.groups) halved(group, result.groups.emplace_back());
  result.instances = shapes_.instances;
  result.planes = shapes_.planes;
  return result;
}

Imath::Box3f EmbreeBenchScene::company_bounds() const noexcept {
  Imath::Box3f bounds;
  for (const Vec3f& point : parts_->company_points) bounds.extendBy(point);
  for (const Imath::V4f& sphere : parts_->company_sphere)
    for (const float side : {-sphere.w, sphere.w}) bounds.extendBy(Vec3f(sphere.x, sphere.y, sphere.z) + Vec3f(side));
  return bounds;
}

double EmbreeBenchScene::intersect(const RayBatch& given, BenchCall call, HitBatch& hits) const noexcept {
  const RayBatch& rays = call.width == 1 ? made_traceable(given) : given;
  const auto run = call.width == 1   ? intersect_block<1>
                   : call.width == 4 ? intersect_block<4>
                   : call.width == 8 ? intersect_block<8>
                                     : intersect_block<16>;
  double seconds = 0;
  for (std::size_t first = 0; first < rays.size; first += kBlockOfRays)
    seconds +=
        run(tracer_->state_->scene.get(), rays, first, std::min(kBlockOfRays, rays.size - first), call.coherent, hits);
  return seconds;
}

double EmbreeBenchScene::occluded(const RayBatch& given, BenchCall call, std::uint8_t* occluded) const noexcept {
  const RayBatch& rays = call.width == 1 ? made_traceable(given) : given;
  const auto run = call.width == 1   ? occluded_block<1>
                   : call.width == 4 ? occluded_block<4>
                   : call.width == 8 ? occluded_block<8>
                                     : occluded_block<16>;
  const bool comes_back =
      call.width < 16 || embree::kFollowsWideOcclusionEverywhere || !(compact_ || tracer_->state_->instanced);
  double seconds = 0;
  for (std::size_t first = 0; first < rays.size; first += kBlockOfRays)
    seconds += run(tracer_->state_->scene.get(), rays, first, std::min(kBlockOfRays, rays.size - first),
                   call.coherent && comes_back, occluded);
  return seconds;
}

}  // namespace raytree
