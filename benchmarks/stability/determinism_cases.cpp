// Rows 63 to 65: pictures that must not depend on who made them, nor on numbers that are next to nothing.
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <optional>
#include <random>
#include <set>

#include "benchmarks/samples/scenes.h"
#include "benchmarks/stability/case_pictures.h"
#include "benchmarks/stability/case_tools.h"
#include "benchmarks/stability/picture_parts.h"
#include "renderer/float_mode.h"

namespace raytree::benchmarks {
namespace {

using namespace samples;

// --- rows 63 and 64 ---

/// Two meshes in the same place, told apart by color, mirrored and lit.
SceneDescription coincident_meshes() {
  CameraDescription camera;
  camera.position = {0.5, 1, 4};
  SceneDescription scene = dark_scene(64, camera);
  scene.image = {96, 64};
  scene.background = GradientBackground{};
  scene.materials = {material("red", Rgb(0.8f, 0.1f, 0.1f)), material("blue", Rgb(0.1f, 0.1f, 0.8f))};
  scene.materials[0].reflection = scene.materials[1].reflection = Rgb(0.4f);
  scene.lights = {directional_light({-1, -2, -1}), point_light({3, 4, 5}, Rgb(0.5f))};
  scene.shapes = {mesh_shape(globe_mesh(1, 64, 32), "red"), mesh_shape(globe_mesh(1, 64, 32), "blue"),
                  shape(PlaneShape{{0, -1, 0}, {0, 1, 0}}, "blue")};
  scene.render.antialias = {Antialiasing::Method::grid, 2};
  return scene;
}

std::string bits_of(const Film& film) {
  const auto pixels = std::size_t(film.window().width) * std::size_t(film.window().height);
  std::string bits;
  for (int c = 0; c < 3; ++c)
    bits.append(reinterpret_cast<const char*>(film.plane(ChannelGroup::color, c)), pixels * sizeof(float));
  return bits;
}

constexpr std::size_t kMostThreads = 4;

/// The meshes, their hierarchy built by so many threads.
Film coincident_film(const StabilityRun& run, const char* hierarchy, int threads) {
  PrepareOptions options;
  options.threads = threads;
  options.hierarchy = hierarchy;
  std::optional<Film> film;
  tbb::task_arena arena(threads);
  arena.execute([&] {
    const Scene scene = prepared_for(run, coincident_meshes(), options);
    film = render(scene, {}).film;
  });
  return std::move(*film);
}

StabilityResult coincident_surfaces(const StabilityRun& run) {
  const tbb::global_control allowed(tbb::global_control::max_allowed_parallelism, kMostThreads);
  StabilityResult result;
  std::vector<Film> shown;
  std::string balanced_bits;
  for (const char* const hierarchy : {"balanced", "compact"}) {
    std::set<std::string> pictures;
    for (const int threads : {1, 2, 3, 4}) {
      Film film = coincident_film(run, hierarchy, threads);
      pictures.insert(bits_of(film));
      if (balanced_bits.empty()) balanced_bits = bits_of(film);
      if (run.pictures && threads % 3 == 1) shown.push_back(std::move(film));
    }
    result.figures.push_back(held(std::string(hierarchy) + " hierarchy",
                                  "different pictures of coincident meshes, 1 to 4 threads", double(pictures.size()), 1,
                                  1, "1; the quick hierarchy may make 2 (Embree issue 20)"));
  }
  const Film quick = coincident_film(run, "quick", 1);
  result.figures.push_back(known_failure("one hierarchy beside another",
                                         "different pictures of coincident meshes, balanced and quick, 1 thread",
                                         double(std::set{balanced_bits, bits_of(quick)}.size()), 2, 2,
                                         "2: which of two surfaces in one place is met, the hierarchy says"));
  if (run.pictures) {
    result.pictures = {stability_picture("A red and a blue ball in one place, balanced hierarchy", shown[0]),
                       stability_picture("The quick hierarchy: patches of the other ball", quick),
                       difference_picture("Balanced, built by 1 thread and by 4: no difference, to the bit (blue)",
                                          shown[0], shown[1], 1)};
    for (StabilityPicture& picture : result.pictures) picture.magnified = 2;
  }
  return result;
}

/// A smooth picture of 64 samples a pixel, added up in the order in which they were drawn and in the opposite one.
StabilityPicture unordered_sums_picture() {
  constexpr int kWidth = 96, kHeight = 64;
  std::mt19937 random(640);
  std::uniform_real_distribution<float> noise(0, 1);
  return painted_picture(
      "The same samples added up forwards and backwards: pixels whose bits differ (orange)", kWidth, kHeight,
      [&](int x, int) {
        std::vector<float> samples(64);
        for (float& sample : samples) sample = noise(random) * float(x + 1) / kWidth;
        float forwards = 0, backwards = 0;
        for (std::size_t i = 0; i < samples.size(); ++i) {
          forwards += samples[i];
          backwards += samples[samples.size() - 1 - i];
        }
        return forwards == backwards ? kSoundColor : kFaultColor;
      },
      2);
}

StabilityResult order_of_sums(const StabilityRun& run) {
  const tbb::global_control allowed(tbb::global_control::max_allowed_parallelism, kMostThreads);
  StabilityResult result;
  const Scene scene = prepared_for(run, coincident_meshes());
  std::set<std::string> pictures;
  std::vector<Film> shown;
  for (const int threads : {1, 2, 3, 4})
    for (const std::uint64_t seed : {0u, 1u, 2026u}) {
      RenderOptions options;
      options.threads = threads, options.tile_order_seed = seed, options.stop = run.stop;
      Film film = render(scene, options).film;
      pictures.insert(bits_of(film));
      if (run.pictures && ((threads == 1 && seed == 0) || (threads == 4 && seed == 2026)))
        shown.push_back(std::move(film));
    }
  // A pixel of 64 samples added up in the order in which they are ready, 64 orders.
  std::mt19937 random(64);
  std::uniform_real_distribution<float> radiance(0, 1);
  std::vector<float> samples(64);
  for (float& sample : samples) sample = radiance(random);
  std::set<float> sums;
  for (int order = 0; order < 64; ++order) {
    std::shuffle(samples.begin(), samples.end(), random);
    float sum = 0;
    for (const float sample : samples) sum += sample;
    sums.insert(sum);
  }
  // Partial sums reach 32, where an ulp is 2^-19: 64 roundings of half of it apart at most.
  result.figures.push_back(known_failure("samples added as they are ready", "different sums of 64 samples, 64 orders",
                                         double(sums.size()), 2, 64, "more than 1: float addition is not associative"));
  result.figures.push_back(held("a fixed order a pixel", "different pictures, 1 to 4 threads, 3 orders of tiles",
                                double(pictures.size()), 1, 1, "1, to the bit"));
  if (run.pictures) {
    result.pictures.push_back(unordered_sums_picture());
    result.pictures.push_back(difference_picture(
        "A fixed order a pixel: 1 thread beside 4 in another order of tiles, alike to the bit (blue)", shown[0],
        shown[1], 1, 2));
  }
  return result;
}

// --- row 65 ---

StabilityResult denormal_weights(const StabilityRun& run) {
  StabilityResult result;
  const auto product_is_denormal = [] {
    // Volatile, so that the product is formed here, in this mode of the processor.
    volatile float weight = 1e-20f;
    volatile float square = weight * weight;
    return square != 0;
  };
  // Mirrors of 1e-10: the weight is 1e-40 after four bounces, which floats hold as a denormal number.
  SceneDescription scene = dark_scene(1, front_camera(1, 0.5));
  scene.ambient = Rgb(1);
  scene.materials = {material("mirror", Rgb(1))};
  scene.materials[0].reflection = Rgb(1e-10f);
  scene.shapes = {shape(PlaneShape{{0, 0, 0}, {0, 0, 1}}, "mirror"),
                  shape(PlaneShape{{0, 0, 1}, {0, 0, -1}}, "mirror")};
  scene.render.cutoff = 0;
  scene.render.depth = 20;
  const RenderResult rendered = rendered_for(run, std::move(scene));
  result.figures.push_back(known_failure("the processor as it starts", "1e-20 squared counts as a number (1: yes)",
                                         product_is_denormal(), 1, 1, "1: a denormal, a hundred cycles an operation"));
  result.figures.push_back(held(
      "flushed while tracing", "1e-20 squared counts as a number (1: yes)",
      [&] {
        const FlushDenormals flush;
        return product_is_denormal();
      }(),
      0, 0, "0"));
  result.figures.push_back(held("flushed while tracing", "levels of mirrors of 1e-10, depth 20, nothing cut",
                                rendered.statistics.deepest_level, 1, 4,
                                "4: the fifth level's weight of 1e-40 is none"));
  result.nothing_to_see = "light below 1e-38 is black in every picture; what it would cost is time.";
  return result;
}

}  // namespace

std::vector<StabilityCase> determinism_cases() {
  return {
      {63, "coincident-surfaces", "Surfaces in one place", "two meshes of the same triangles, built by 1 to 4 threads",
       "hierarchies that do not depend on threads", "Embree issue 20", coincident_surfaces},
      {64, "order-of-sums", "Pictures by any number of threads", "1 to 4 threads, tiles in three orders",
       "a fixed order of sums a pixel; off: as samples are ready", "pbrt-v4 issue 85", order_of_sums},
      {65, "denormals", "Weights near nothing", "mirrors of 1e-10 between each other",
       "denormals flushed on every thread that traces", "Embree's readme", denormal_weights}};
}

}  // namespace raytree::benchmarks
