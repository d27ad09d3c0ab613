#include "geometry/embree_kinds.h"

#include <atomic>
#include <chrono>
#include <limits>

#include "geometry/embree_api.h"
#include "geometry/stopwatch.h"

namespace raytree {
namespace {

bool count_bytes(void* total, ssize_t bytes, bool) {
  *static_cast<std::atomic<std::ptrdiff_t>*>(total) += bytes;
  return true;
}

/// Indices of all quads' corners, `kCorners` a primitive: 4 for quads, 3 for their halves.
template <std::size_t kCorners>
void set_indices(RTCGeometry geometry, const SurfaceGrid& grid) {
  const std::size_t quads = grid.triangle_count() / 2, primitives = kCorners == 4 ? quads : 2 * quads;
  auto* out = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0,
                                                                  kCorners == 4 ? RTC_FORMAT_UINT4 : RTC_FORMAT_UINT3,
                                                                  kCorners * sizeof(std::uint32_t), primitives));
  for (std::size_t j = 0; j + 1 < grid.rows; ++j)
    for (std::size_t i = 0; i + 1 < grid.columns; ++i) {
      const auto a = static_cast<std::uint32_t>(j * grid.columns + i), b = a + 1;
      const auto d = static_cast<std::uint32_t>(a + grid.columns), c = d + 1;
      if constexpr (kCorners == 4) {
        for (const std::uint32_t corner : {a, b, c, d}) *out++ = corner;
      } else {
        // As Embree halves a quad.
        for (const std::uint32_t corner : {a, b, d, c, d, b}) *out++ = corner;
      }
    }
}

void set_grids(RTCGeometry geometry, const SurfaceGrid& grid) {
  const std::size_t across = (grid.columns - 1) / kGridSide, along = (grid.rows - 1) / kGridSide;
  auto* out = static_cast<RTCGrid*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_GRID, 0, RTC_FORMAT_GRID, sizeof(RTCGrid), across * along));
  for (std::size_t j = 0; j < along; ++j)
    for (std::size_t i = 0; i < across; ++i)
      *out++ = {static_cast<unsigned>((j * grid.columns + i) * kGridSide), static_cast<unsigned>(grid.columns),
                kGridSide + 1, kGridSide + 1};
}

template <class Packet>
void set_lane(Packet& packet, std::size_t lane, const BareRay& ray) {
  packet.ray.org_x[lane] = ray.origin.x, packet.ray.org_y[lane] = ray.origin.y, packet.ray.org_z[lane] = ray.origin.z;
  packet.ray.dir_x[lane] = ray.direction.x, packet.ray.dir_y[lane] = ray.direction.y;
  packet.ray.dir_z[lane] = ray.direction.z;
  packet.ray.tnear[lane] = 0, packet.ray.tfar[lane] = std::numeric_limits<float>::infinity();
  packet.ray.time[lane] = 0, packet.ray.mask[lane] = 0xffffffffu;
  packet.ray.id[lane] = 0, packet.ray.flags[lane] = 0;
  packet.hit.geomID[lane] = RTC_INVALID_GEOMETRY_ID;
  packet.hit.instID[0][lane] = RTC_INVALID_GEOMETRY_ID;
}

double trace_packets(RTCScene scene, std::span<const BareRay> rays, std::uint64_t& hits) {
  embree::Query query(true);
  RTCRayHit8 packet{};
  alignas(32) int valid[8];
  double seconds = 0;
  for (int& lane : valid) lane = -1;
  const auto start = Clock::now();
  for (std::size_t first = 0; first + 8 <= rays.size(); first += 8) {
    for (std::size_t lane = 0; lane < 8; ++lane) set_lane(packet, lane, rays[first + lane]);
    query.intersect(scene, valid, packet);
    for (const unsigned id : packet.hit.geomID) hits += id != RTC_INVALID_GEOMETRY_ID;
  }
  seconds = seconds_since(start);
  return seconds;
}

double trace_singles(RTCScene scene, std::span<const BareRay> rays, std::uint64_t& hits) {
  embree::Query query(false);
  const auto start = Clock::now();
  for (const BareRay& ray : rays) {
    RTCRayHit one{};
    one.ray.org_x = ray.origin.x, one.ray.org_y = ray.origin.y, one.ray.org_z = ray.origin.z;
    one.ray.dir_x = ray.direction.x, one.ray.dir_y = ray.direction.y, one.ray.dir_z = ray.direction.z;
    one.ray.tfar = std::numeric_limits<float>::infinity();
    one.ray.mask = 0xffffffffu;
    one.hit.geomID = one.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    query.intersect(scene, one);
    hits += one.hit.geomID != RTC_INVALID_GEOMETRY_ID;
  }
  return seconds_since(start);
}

}  // namespace

const char* name_of(EmbreeKind kind) {
  static constexpr const char* kNames[kEmbreeKindCount] = {"triangles", "triangles, compact", "quads", "quads, compact",
                                                           "grids"};
  return kNames[static_cast<std::size_t>(kind)];
}

EmbreeKindFigures measure_kind(EmbreeKind kind, const SurfaceGrid& grid, std::span<const BareRay> coherent,
                               std::span<const BareRay> incoherent) {
  const bool quads = kind == EmbreeKind::quads || kind == EmbreeKind::compact_quads;
  const bool compact = kind == EmbreeKind::compact_triangles || kind == EmbreeKind::compact_quads;
  std::atomic<std::ptrdiff_t> bytes{0};
  const embree::Device device(rtcNewDevice("threads=1"));
  rtcSetDeviceMemoryMonitorFunction(device.get(), count_bytes, &bytes);
  const embree::SceneHandle scene(rtcNewScene(device.get()));
  rtcSetSceneFlags(scene.get(), compact ? RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_COMPACT : RTC_SCENE_FLAG_ROBUST);
  rtcSetSceneBuildQuality(scene.get(), RTC_BUILD_QUALITY_MEDIUM);
  const embree::Geometry geometry(rtcNewGeometry(device.get(), kind == EmbreeKind::grids ? RTC_GEOMETRY_TYPE_GRID
                                                               : quads                   ? RTC_GEOMETRY_TYPE_QUAD
                                                                                         : RTC_GEOMETRY_TYPE_TRIANGLE));
  // Embree reads 16 bytes at the last vertex; vectors are padded here by one point.
  std::vector<Vec3f> points(grid.points);
  points.emplace_back(0, 0, 0);
  rtcSetSharedGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, points.data(), 0,
                             sizeof(Vec3f), grid.points.size());
  if (kind == EmbreeKind::grids)
    set_grids(geometry.get(), grid);
  else if (quads)
    set_indices<4>(geometry.get(), grid);
  else
    set_indices<3>(geometry.get(), grid);
  rtcSetGeometryMask(geometry.get(), 0xffffffffu);
  rtcCommitGeometry(geometry.get());
  rtcAttachGeometry(scene.get(), geometry.get());
  EmbreeKindFigures figures;
  const auto start = Clock::now();
  rtcCommitScene(scene.get());
  figures.build_seconds = seconds_since(start);
  figures.bytes = static_cast<double>(bytes.load());
  figures.packet_seconds = trace_packets(scene.get(), coherent, figures.hits);
  figures.single_seconds = trace_singles(scene.get(), incoherent, figures.hits);
  return figures;
}

}  // namespace raytree
