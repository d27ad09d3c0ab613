// Light through transparent shadows: shadow rays that something stops are followed on, straight through what transmits,
// from nearest hit to nearest hit. What a ray brings depends on the ray alone, not on the batch that it is part of: all
// queries are incoherent ones, which answer a ray the same in any company.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include "geometry/ray_batch.h"
#include "geometry/surface_batch.h"
#include "renderer/media.h"
#include "renderer/scene.h"

namespace raytree {

/// Surfaces that a shadow ray crosses at most; behind more it is dark.
inline constexpr int kMostShadowCrossings = 1024;

/// A shadow ray on its way to the light.
struct ShadowPath {
  ShadowPath() = default;
  ShadowPath(const Vec3f& from, const Vec3f& direction_, float distance_, MediaId media_)
      : origin(from), direction(direction_), distance(distance_), media(media_) {}

  Vec3f origin, direction;     ///< of what is left of it; direction unit
  float distance = 0;          ///< left to the light; infinity: directional
  Rgb transmittance{1, 1, 1};  ///< so far: in [0, 1]
  std::uint32_t ray = 0;       ///< of its batch
  std::uint32_t queries = 0;   ///< nearest hits asked for
  std::uint16_t sample = 0;    ///< as RayBatch has it
  MediaId media = kNoMedia;    ///< that it is in, where media are tracked
  // The surface crossed last.
  GeometryId geometry = kNoGeometry;
  InstanceId instance = kNoInstance;
  bool leaving = false;
  int crossings = 0;
  Vec3f position, normal;
  float clearance = 0;
};

/// Takes the path to and through `hit`, the nearest one. k_t for each surface, exp(-a t) for the way to a surface that
/// is hit from behind; with `media` (null: not tracked) k_t where two media meet, exp(-a t) by the medium that is
/// there. False: the path has ended, and its transmittance is what arrives.
bool follow_shadow(const Scene& scene, MediaTable* media, const Hit& hit, ShadowPath& path);

/// The paths of one batch of shadow rays.
class ShadowPaths {
 public:
  /// `scene` must outlive it.
  ShadowPaths(const Scene& scene, std::size_t capacity);

  void clear() { paths_.clear(); }
  void add(const RayBatch& rays, std::size_t ray, MediaId media);
  /// Follows all paths to their ends.
  void follow(MediaTable* media);

  /// In the order in which they were added.
  const std::vector<ShadowPath>& paths() const { return paths_; }

 private:
  std::size_t take_on(std::size_t first, std::size_t count, std::size_t left, MediaTable* media);

  const Scene& scene_;
  std::vector<ShadowPath> paths_;
  std::vector<std::uint32_t> live_;  ///< into paths_, of those that are not at their end
  RayBatch rays_;
  std::vector<std::uint16_t> samples_;  ///< of rays_
  HitBatch hits_;
  std::unique_ptr<SurfaceBatch> surfaces_;  ///< at hits_ that are gone through
};

}  // namespace raytree
