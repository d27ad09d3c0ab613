// Batches must yield, bit for bit, what the functions for one hit yield: surfaces, light, children. And queues of rays
// must keep their order.
#include <gtest/gtest.h>

#include <memory>
#include <random>

#include "geometry/surface_batch.h"
#include "renderer/ray_queue.h"
#include "renderer/scene_reader.h"
#include "renderer/shading_batch.h"
#include "tests/renderer/test_scenes.h"

namespace raytree {
namespace {

using namespace test;

/// Eye rays of a block of pixels, then rays all about from where they hit: alike ones and strays, hits and misses.
class Rays {
 public:
  explicit Rays(const Scene& scene) : scene_(scene) {}

  RayBatch batch(int round) {
    const ImageDescription& image = scene_.description.image;
    RayBatch rays(kBatchSize);
    // A size that is no multiple of a register's.
    const std::size_t count = kBatchSize - static_cast<std::size_t>(round % 13);
    std::uniform_real_distribution<float> at(0, 1);
    const float x0 = at(random_) * static_cast<float>(image.width), y0 = at(random_) * static_cast<float>(image.height);
    while (rays.size < count) {
      Vec3f origin, direction;
      scene_.camera.ray(x0 + static_cast<float>(rays.size % 32), y0 + static_cast<float>(rays.size) / 32, origin,
                        direction);
      if (round % 2 == 1) {
        const float distance = free_way(origin, direction);
        origin += direction * (distance * 0.99f);
        direction = stray();
      }
      rays.push(origin, direction, std::numeric_limits<float>::infinity());
    }
    return rays;
  }

 private:
  /// To what the ray hits, or 0.
  float free_way(const Vec3f& origin, const Vec3f& direction) const {
    RayBatch ray(1);
    HitBatch hit(1);
    ray.push(origin, direction, std::numeric_limits<float>::infinity());
    scene_.intersector->intersect(ray, Coherence::incoherent, hit);
    return hit.geometry[0] == kNoGeometry ? 0 : hit.distance[0];
  }
  Vec3f stray() {
    std::normal_distribution<float> gauss;
    return unit(Vec3f(gauss(random_), gauss(random_), gauss(random_)));
  }
  const Scene& scene_;
  std::mt19937 random_{11};
};

void expect_same_surface(const SurfacePoint& a, const SurfacePoint& b) {
  ASSERT_EQ(a.position, b.position);
  ASSERT_EQ(a.geometric_normal, b.geometric_normal);
  ASSERT_EQ(a.shading_normal, b.shading_normal);
  ASSERT_EQ(a.clearance, b.clearance);
  ASSERT_EQ(a.distance, b.distance);
  ASSERT_EQ(a.texture, b.texture);
}

void expect_same_light(const LocalLight& a, const LocalLight& b) {
  ASSERT_EQ(a.lit, b.lit);
  if (!a.lit) return;
  ASSERT_EQ(a.diffuse, b.diffuse);
  ASSERT_EQ(a.highlight, b.highlight);
  ASSERT_EQ(a.direction, b.direction);
  ASSERT_EQ(a.distance, b.distance);
}

void expect_same_branches(const Branches& a, const Branches& b) {
  ASSERT_EQ(a.reflected_weight, b.reflected_weight);
  ASSERT_EQ(a.refracted_weight, b.refracted_weight);
  if (!is_black(a.reflected_weight)) {
    ASSERT_EQ(a.reflected, b.reflected);
  }
  if (!is_black(a.refracted_weight)) {
    ASSERT_EQ(a.refracted, b.refracted);
  }
}

/// Scenes of the project that hold every kind of shape, normals, textures, instances, both sorts of light.
class BatchShading : public testing::TestWithParam<const char*> {};

TEST_P(BatchShading, EqualsOneHitAfterTheOther) {
  const Scene scene = prepared(read_scene_file(std::string(RAYTREE_SOURCE_DIR "/scenes/") + GetParam()));
  const auto shading = std::make_unique<ShadingBatch>();
  Rays source(scene);
  HitBatch hits(kBatchSize);
  int points = 0;
  for (int round = 0; round < 24; ++round) {
    const RayBatch rays = source.batch(round);
    scene.intersector->intersect(rays, Coherence::mixed, hits);
    find_surfaces(*scene.shapes, rays, hits, true, shading->surfaces);
    for (std::size_t i = 0; i < rays.size; ++i) {
      if (hits.geometry[i] == kNoGeometry) continue;
      ++points;
      expect_same_surface(shading->surfaces[i],
                          surface_at(*scene.shapes, rays.origin(i), rays.direction(i), hits[i], true));
    }
    shading->turn_to_rays(rays);
    const auto one = [&](std::size_t i) {
      const Material& material = scene.materials[scene.material_at(hits[i])];
      const std::optional<ObjectFrame> frame = scene.frame_at(hits[i], material);
      return shading_point(surface_at(*scene.shapes, rays.origin(i), rays.direction(i), hits[i], true),
                           rays.direction(i), material, {}, frame ? &*frame : nullptr);
    };
    for (std::size_t i = 0; i < rays.size; ++i) {
      if (hits.geometry[i] == kNoGeometry) continue;
      shading->set_material(i, scene.materials[scene.material_at(hits[i])]);
      ShadingPoint point = shading->point(rays, i);
      if (!point.material->is_varied) continue;
      const std::optional<ObjectFrame> frame = scene.frame_at(hits[i], *point.material);
      vary(point, {}, frame ? &*frame : nullptr);
      shading->set_varied(i, point);
    }
    shading->branch(rays);
    for (std::size_t i = 0; i < rays.size; ++i) {
      if (hits.geometry[i] == kNoGeometry) continue;
      ASSERT_EQ(shading->leaving[i] != 0, one(i).leaving);
      expect_same_branches(shading->branches(i), plain_branches(one(i)));
    }
    for (const Light& light : scene.lights)
      for (const HighlightForm form : {HighlightForm::reflected, HighlightForm::halfway}) {
        shading->meet(rays, light, form);
        for (std::size_t i = 0; i < rays.size; ++i)
          if (hits.geometry[i] != kNoGeometry)
            expect_same_light(local_light(shading->meeting(i), *shading->materials[i], shading->diffuse(i), light),
                              local_light(one(i), light, form));
      }
    if (HasFatalFailure()) return;
  }
  EXPECT_GT(points, 5000);
}

INSTANTIATE_TEST_SUITE_P(Scenes, BatchShading,
                         testing::Values("spheres-1980.json", "glass.json", "whitted-fig7.json", "goblet.json",
                                         "forest.json", "rough.json"),
                         [](const auto& scene) {
                           std::string name;
                           for (const char* c = scene.param; *c != '.'; ++c) name += *c == '-' ? '_' : *c;
                           return name;
                         });

RayContext context_of(std::uint32_t number) {
  return {Rgb(static_cast<float>(number)), 0.5f, number, static_cast<std::uint16_t>(number), kNoMedia};
}

TEST(RayQueue, TheNewestComeFirstAndInOrder) {
  RayQueue queue;
  SpawnedRays first, second;
  // More than a batch of them, as rough surfaces spawn.
  constexpr std::uint32_t kFirst = 2500, kSecond = 300;
  for (std::uint32_t i = 0; i < kFirst; ++i)
    first.push(Vec3f(static_cast<float>(i)), Vec3f(0, 0, static_cast<float>(i)), context_of(i));
  EXPECT_EQ(first.size(), kFirst);
  for (std::uint32_t i = kFirst; i < kFirst + kSecond; ++i)
    second.push(Vec3f(static_cast<float>(i)), Vec3f(0, 0, static_cast<float>(i)), context_of(i));
  first.move_to(queue);
  second.move_to(queue);
  EXPECT_TRUE(first.empty());
  ASSERT_EQ(queue.size(), kFirst + kSecond);
  const auto batch = std::make_unique<RayArrays>();
  std::uint32_t left = kFirst + kSecond;
  const RayBatch rays = batch->as_batch();
  while (!queue.empty()) {
    queue.pop(*batch);
    ASSERT_EQ(batch->size, std::min<std::size_t>(kBatchSize, left));
    left -= static_cast<std::uint32_t>(batch->size);
    for (std::size_t i = 0; i < batch->size; ++i) {
      const auto number = static_cast<float>(left + i);
      ASSERT_EQ(batch->level[i], left + i);
      ASSERT_EQ(batch->sample[i], left + i);
      ASSERT_EQ(batch->weight(i), Rgb(number));
      ASSERT_EQ(rays.origin(i), Vec3f(number));
      ASSERT_EQ(rays.direction(i), Vec3f(0, 0, number));
      ASSERT_EQ(rays.max_distance[i], std::numeric_limits<float>::infinity());
      ASSERT_EQ(rays.sample[i], left + i);
    }
  }
  EXPECT_EQ(left, 0u);
}

}  // namespace
}  // namespace raytree
