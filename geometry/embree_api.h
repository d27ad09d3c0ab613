// Embree 3.13 and 4.x under one set of calls: the one file that knows the difference. Included by the sources of
// EmbreeIntersector and of the bare replay alone.
#pragma once

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <cstddef>
#include <memory>
#include <type_traits>

namespace raytree::embree {

struct ReleaseDevice {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
};
struct ReleaseScene {
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};
struct ReleaseGeometry {
  void operator()(RTCGeometry geometry) const { rtcReleaseGeometry(geometry); }
};
using Device = std::unique_ptr<std::remove_pointer_t<RTCDevice>, ReleaseDevice>;
using SceneHandle = std::unique_ptr<std::remove_pointer_t<RTCScene>, ReleaseScene>;
using Geometry = std::unique_ptr<std::remove_pointer_t<RTCGeometry>, ReleaseGeometry>;

/// Whether packets of 16 that ask for occlusion may be followed together in scenes that are compact or have instances.
/// Embree 3.13 never comes back from some of those calls (seen with AVX-512: compact, for spheres, quads and triangles,
/// robust and not; among 16,000 instances).
inline constexpr bool kFollowsWideOcclusionEverywhere = RTC_VERSION_MAJOR >= 4;

#if RTC_VERSION_MAJOR >= 4

/// Arguments of one call, made once for a batch.
class Query {
 public:
  explicit Query(bool coherent) {
    rtcInitIntersectArguments(&intersect_);
    rtcInitOccludedArguments(&occluded_);
    set_coherent(coherent);
  }
  void set_coherent(bool coherent) {
    intersect_.flags = occluded_.flags = coherent ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT;
  }
  void intersect(RTCScene scene, RTCRayHit& ray) { rtcIntersect1(scene, &ray, &intersect_); }
  void intersect(RTCScene scene, const int* valid, RTCRayHit4& rays) {
    rtcIntersect4(valid, scene, &rays, &intersect_);
  }
  void intersect(RTCScene scene, const int* valid, RTCRayHit8& rays) {
    rtcIntersect8(valid, scene, &rays, &intersect_);
  }
  void intersect(RTCScene scene, const int* valid, RTCRayHit16& rays) {
    rtcIntersect16(valid, scene, &rays, &intersect_);
  }
  void occluded(RTCScene scene, RTCRay& ray) { rtcOccluded1(scene, &ray, &occluded_); }
  void occluded(RTCScene scene, const int* valid, RTCRay4& rays) { rtcOccluded4(valid, scene, &rays, &occluded_); }
  void occluded(RTCScene scene, const int* valid, RTCRay8& rays) { rtcOccluded8(valid, scene, &rays, &occluded_); }
  void occluded(RTCScene scene, const int* valid, RTCRay16& rays) { rtcOccluded16(valid, scene, &rays, &occluded_); }

 private:
  RTCIntersectArguments intersect_;
  RTCOccludedArguments occluded_;
};

#else

class Query {
 public:
  explicit Query(bool coherent) {
    rtcInitIntersectContext(&context_);
    set_coherent(coherent);
  }
  void set_coherent(bool coherent) {
    context_.flags = coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
  }
  void intersect(RTCScene scene, RTCRayHit& ray) { rtcIntersect1(scene, &context_, &ray); }
  void intersect(RTCScene scene, const int* valid, RTCRayHit4& rays) { rtcIntersect4(valid, scene, &context_, &rays); }
  void intersect(RTCScene scene, const int* valid, RTCRayHit8& rays) { rtcIntersect8(valid, scene, &context_, &rays); }
  void intersect(RTCScene scene, const int* valid, RTCRayHit16& rays) {
    rtcIntersect16(valid, scene, &context_, &rays);
  }
  void occluded(RTCScene scene, RTCRay& ray) { rtcOccluded1(scene, &context_, &ray); }
  void occluded(RTCScene scene, const int* valid, RTCRay4& rays) { rtcOccluded4(valid, scene, &context_, &rays); }
  void occluded(RTCScene scene, const int* valid, RTCRay8& rays) { rtcOccluded8(valid, scene, &context_, &rays); }
  void occluded(RTCScene scene, const int* valid, RTCRay16& rays) { rtcOccluded16(valid, scene, &context_, &rays); }

 private:
  RTCIntersectContext context_;
};

#endif

}  // namespace raytree::embree
