// What EmbreeIntersector holds; shared with the bare replay, which calls Embree on the same scene.
#pragma once

#include <atomic>
#include <mutex>
#include <string>

#include "geometry/embree_api.h"
#include "geometry/embree_intersector.h"

namespace raytree {

struct EmbreeIntersector::State {
  const ShapeSet* shapes = nullptr;
  std::atomic<std::ptrdiff_t> memory{0};
  std::atomic<std::ptrdiff_t> peak_memory{0};
  std::mutex error_mutex;
  std::string error;  ///< first one Embree reported
  embree::Device device;
  embree::SceneHandle scene;
  bool wide = true;  ///< 8-wide packets; else 4
};

}  // namespace raytree
