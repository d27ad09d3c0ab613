// Rows 20 to 23: what falls between samples. White things on black, one pixel a unit: a pixel's radiance is the share
// of it that they cover.
#include <algorithm>
#include <cmath>
#include <random>

#include "benchmarks/samples/scenes.h"
#include "benchmarks/stability/case_pictures.h"
#include "benchmarks/stability/case_tools.h"

namespace raytree::benchmarks {
namespace {

using namespace samples;

constexpr int kBlock = 4;  ///< pixels each way in which one small thing stands

/// An edge's pixel is off by at most 2^-levels: a straight edge crosses less than 2 * 2^levels of its 4^levels leaves,
/// each off by half of its area.
double largest_edge_error(int levels) { return std::pow(0.5, levels); }

double covered(const Film& film, int x, int y) { return double(color_at(film, x, y).g); }
double covered_in_block(const Film& film, int column, int row) {
  double sum = 0;
  for (int y = 0; y < kBlock; ++y)
    for (int x = 0; x < kBlock; ++x) sum += covered(film, column * kBlock + x, row * kBlock + y);
  return sum;
}

/// Four standard deviations of the share of `count` that happen with chance p each.
double share_noise(double p, double count) { return 4 * std::sqrt(p * (1 - p) / count); }

// --- row 20 ---

/// One sphere in each block, nowhere nearer to the block's border than a pixel.
struct SphereField {
  SceneDescription scene;
  std::vector<double> radii;
};
SphereField sphere_field(int blocks) {
  SphereField field{white_on_black(kBlock * blocks), {}};
  std::mt19937 random(1980);
  std::uniform_real_distribution<double> place(1, 3), radius(0.05, 1);
  for (int row = 0; row < blocks; ++row)
    for (int column = 0; column < blocks; ++column) {
      field.radii.push_back(radius(random));
      const double x = place(random), y = place(random);
      field.scene.shapes.push_back(shape(
          SphereShape{{kBlock * (column - blocks / 2.0) + x, kBlock * (blocks / 2.0 - row) - y, 0}, field.radii.back()},
          "white"));
    }
  return field;
}

/// Share of places of a disc for which no point of a unit lattice lies in it.
double chance_between_points(double r) {
  if (r * r >= 0.5) return 0;
  // Discs about all points of the lattice overlap by two segments a side from r = 1/2 on.
  const double segment = r > 0.5 ? r * r * std::acos(0.5 / r) - 0.5 * std::sqrt(r * r - 0.25) : 0;
  return 1 - (kPi * r * r - 4 * segment);
}

StabilityResult small_objects(const StabilityRun& run) {
  StabilityResult result;
  const int blocks = scaled(run, 64, 20);
  SphereField field = sphere_field(blocks);
  const auto count = static_cast<double>(field.radii.size());
  SceneDescription plain = field.scene;
  plain.render.antialias = {Antialiasing::Method::none, 1};
  const int levels = field.scene.render.adaptive.levels;
  const Film at_centers = rendered_for(run, std::move(plain)).film;
  const Film adaptive = rendered_for(run, std::move(field.scene)).film;
  double lost_plain = 0, lost = 0, area = 0, sum = 0, chance = 0, variance = 0;
  for (int i = 0; i < blocks * blocks; ++i) {
    const double r = field.radii[static_cast<std::size_t>(i)],
                 here = covered_in_block(adaptive, i % blocks, i / blocks);
    lost_plain += covered_in_block(at_centers, i % blocks, i / blocks) <= 0;
    lost += here <= 0;
    sum += here, area += kPi * r * r;
    chance += chance_between_points(r) / count;
    // Some 8 r 2^levels leaves lie on the rim, each off by half of its area at most, as if at random.
    variance += 8 * r * std::pow(2, levels) * 0.25 * std::pow(0.0625, levels);
  }
  result.figures.push_back(known_failure("a sample at each pixel's center", "share of spheres of .05 to 1 pixel lost",
                                         lost_plain / count, chance - share_noise(chance, count),
                                         chance + share_noise(chance, count), "1 - pi r^2 up to r = 1/2"));
  result.figures.push_back(held("Whitted's least radius and areas", "share of spheres of .05 to 1 pixel lost",
                                lost / count, 0, 0, "0 (Whitted 1980, sec. 3)"));
  const double noise = 4 * std::sqrt(variance) / area;
  result.figures.push_back(held("Whitted's least radius and areas", "area seen / pi r^2", sum / area, 1 - noise,
                                1 + noise, "1, four deviations of leaves on the rims"));
  if (run.pictures)
    for (const auto& [caption, film] :
         {std::pair("A sample at each pixel's center: spheres are lost, others are blocks", &at_centers),
          {"Least radius and areas: none is lost, each as bright as it is large", &adaptive}})
      result.pictures.push_back(part_of(stability_picture(caption, *film), {0, 0, 12 * kBlock, 12 * kBlock}, 6));
  return result;
}

// --- row 21 ---

/// A mirror ball as large as the picture; far lamps behind the eye stand so that each block within .85 of its radius
/// shows one of them, `area` pixels large: a ball of radius R turns a solid angle w into an area of R^2 w / 4,
/// wherever.
struct MirroredField {
  SceneDescription scene;
  std::vector<std::pair<int, int>> blocks;  ///< column, row
};
MirroredField mirrored_field(int blocks, double area, int minimum_level) {
  MirroredField field{white_on_black(kBlock * blocks), {}};
  const double ball = kBlock * blocks / 2.0, away = 1e6;
  const double angle = std::sqrt(4 * area / (kPi * ball * ball));
  field.scene.cameras[0].position = {0, 0, 2 * ball};
  field.scene.render.adaptive.minimum_level = minimum_level;
  field.scene.materials.push_back(material("mirror", Rgb(0)));
  field.scene.materials[1].reflection = Rgb(1);
  field.scene.shapes = {shape(SphereShape{{0, 0, 0}, ball}, "mirror")};
  std::mt19937 random(21);
  std::uniform_real_distribution<double> place(1, 3);
  for (int row = 0; row < blocks; ++row)
    for (int column = 0; column < blocks; ++column) {
      const double x = kBlock * (column - blocks / 2.0) + place(random);
      const double y = kBlock * (blocks / 2.0 - row) - place(random);
      const double rho = std::hypot(x, y) / ball;
      if (rho > 0.85) continue;
      const Vec3d normal = Vec3d(x, y, std::sqrt(1 - rho * rho) * ball) / ball;
      const Vec3d mirrored = normal * (2 * normal.z) - Vec3d(0, 0, 1);
      field.scene.shapes.push_back(
          shape(SphereShape{normal * ball + mirrored * away, away * std::sin(angle)}, "white"));
      field.blocks.emplace_back(column, row);
    }
  return field;
}

StabilityResult mirrored_objects(const StabilityRun& run) {
  StabilityResult result;
  const int blocks = scaled(run, 40, 12);
  constexpr double kArea = 0.15;
  for (const int minimum_level : {0, 3}) {
    MirroredField field = mirrored_field(blocks, kArea, minimum_level);
    const Film film = rendered_for(run, std::move(field.scene)).film;
    double lost = 0;
    for (const auto& [column, row] : field.blocks) lost += covered_in_block(film, column, row) <= 0;
    const auto count = static_cast<double>(field.blocks.size());
    const int shown = 12 * kBlock, first = kBlock * ((blocks - 12) / 2);
    if (run.pictures)
      result.pictures.push_back(
          part_of(stability_picture(
                      minimum_level == 0
                          ? "Lamps of .15 pixels in the middle of a mirror ball, least radius alone: most are lost"
                          : "The same, minimum_level 3: each is there",
                      film),
                  {first, first, shown, shown}, 6));
    if (minimum_level == 0)
      result.figures.push_back(
          known_failure("least radius alone", "share of mirrored lamps of .15 pixels lost", lost / count,
                        1 - kArea - share_noise(kArea, count), 1 - kArea + share_noise(kArea, count),
                        "1 - area: the radius guards what is seen straight (Whitted 1980, p. 347)"));
    else
      result.figures.push_back(held("minimum_level 3", "share of mirrored lamps of .15 pixels lost", lost / count, 0, 0,
                                    "0: samples 1/8 apart, images at least .115 in radius"));
  }
  return result;
}

// --- row 22 ---

/// A strip of `width` along (1, slope), through (0, shift).
SceneDescription strip_scene(double width, double slope, double shift, bool adaptive, int size = 50) {
  const Vec3d along = Vec3d(1, slope, 0) * 60.0;
  const Vec3d across = Vec3d(-slope, 1, 0) / std::sqrt(1 + slope * slope) * (width / 2), middle(0, shift, 0);
  SceneDescription scene = white_on_black(size);
  scene.image.height = size / 5 * 2;
  scene.cameras[0].height = scene.image.height;
  if (!adaptive) scene.render.antialias = {Antialiasing::Method::none, 1};
  scene.shapes = {mesh_shape(triangles({Vec3f(middle - along - across), Vec3f(middle + along - across),
                                        Vec3f(middle + along + across), Vec3f(middle - along + across)},
                                       {0, 1, 2, 0, 2, 3}),
                             "white")};
  return scene;
}

StabilityResult thin_strip(const StabilityRun& run) {
  StabilityResult result;
  constexpr double kStripWidth = 0.1, kSlope = 1 / 50.0;
  constexpr int kColumns = 50;  // over which the strip climbs one pixel: it meets every height alike
  double worst_column = 0, least_column = 1, plain_columns = 0, worst_mean = 0;
  int longest_gap = 0;
  const double expected = kStripWidth * std::sqrt(1 + kSlope * kSlope);
  constexpr int kShifts = 16;
  for (int i = 0; i < kShifts; ++i) {
    const double shift = (i + 0.37) / kShifts;
    const Film plain = rendered_for(run, strip_scene(kStripWidth, kSlope, shift, false)).film,
               ours = rendered_for(run, strip_scene(kStripWidth, kSlope, shift, true)).film;
    int gap = 0;
    double mean = 0;
    for (int x = 0; x < kColumns; ++x) {
      double column = 0, samples = 0;
      for (int y = 0; y < ours.window().height; ++y) column += covered(ours, x, y), samples += covered(plain, x, y);
      worst_column = std::max(worst_column, std::abs(column - expected) / expected);
      least_column = std::min(least_column, column);
      mean += column / kColumns;
      plain_columns += samples > 0;
      gap = samples > 0 ? 0 : gap + 1;
      longest_gap = std::max(longest_gap, gap);
    }
    worst_mean = std::max(worst_mean, std::abs(mean - expected));
  }
  // Of 50 heights a fiftieth apart, a strip of a tenth meets five; one more or less by where it begins.
  result.figures.push_back(known_failure("a sample at each pixel's center",
                                         "share of columns that a strip of .1 shows in",
                                         plain_columns / (kShifts * kColumns), 4.0 / 50, 6.0 / 50,
                                         ".1: it is dashes, and vanishes from nine frames in ten"));
  result.figures.push_back(known_failure("a sample at each pixel's center", "longest gap in the strip, pixels",
                                         longest_gap, 44, 46, "(1 - w) / slope = 45"));
  result.figures.push_back(held("Whitted's least radius and areas", "mean of a column less w", worst_mean, 0, 1.0 / 255,
                                "0 (Phong 1973, VI, leaves it open)"));
  result.figures.push_back(held("Whitted's least radius and areas", "a column less w, over w", worst_column, 0, 1e-3,
                                "0: weighed by its outline's area, in single precision"));
  result.figures.push_back(
      held("Whitted's least radius and areas", "darkest column", least_column, expected * 0.999, 1, "w: no gap"));
  if (run.pictures)
    for (const bool adaptive : {false, true})
      result.pictures.push_back(part_of(
          stability_picture(adaptive ? "Weighed by its area: a faint line without a gap"
                                     : "A strip .1 pixels wide, a sample a pixel: dashes, white as if a pixel wide",
                            rendered_for(run, strip_scene(0.1, kSlope, 0.37, adaptive, 160)).film),
          {0, 24, 160, 16}, 4));
  return result;
}

// --- row 23 ---

/// Squares half a pixel wide that stand so that every corner of a pixel is white and half of it black.
SceneDescription fooling_checker(int minimum_level, bool filtered) {
  SceneDescription scene = white_on_black(16);
  CheckerPattern checker;
  checker.plane = CheckerPattern::Plane::xy;
  checker.even = Rgb(1), checker.odd = Rgb(0);
  checker.size = 0.5;
  checker.offset = {-0.25, -0.25};
  checker.filtered = filtered;
  scene.materials = {material("white", checker)};
  scene.shapes = {shape(PlaneShape{{0, 0, 0}, {0, 0, 1}}, "white")};
  scene.render.adaptive.minimum_level = minimum_level;
  return scene;
}

StabilityResult equal_corners(const StabilityRun& run) {
  StabilityResult result;
  const auto off = [&](int minimum_level, bool filtered) {
    const Film film = rendered_for(run, fooling_checker(minimum_level, filtered)).film;
    double worst = 0;
    for (int y = 1; y < 15; ++y)
      for (int x = 1; x < 15; ++x) worst = std::max(worst, std::abs(covered(film, x, y) - 0.5));
    return worst;
  };
  const int levels = AdaptiveSampling().levels;
  result.figures.push_back(known_failure("four corners", "a pixel half black whose corners are white, off by",
                                         off(0, false), 0.5, 0.5, "1/2: all that is black (Whitted 1980, fig. 5)"));
  result.figures.push_back(held("minimum_level 1", "a pixel half black whose corners are white, off by", off(1, false),
                                0, largest_edge_error(levels), "2^-levels"));
  result.figures.push_back(held("filtered pattern", "a pixel half black whose corners are white, off by", off(0, true),
                                0, 1e-6, "0: its exact mean"));
  if (run.pictures) {
    constexpr int kFiner = 12;  // pixels for each
    SceneDescription fine = fooling_checker(0, false);
    fine.image = {16 * kFiner, 16 * kFiner};
    fine.render.antialias = {Antialiasing::Method::none, 1};
    result.pictures.push_back(
        stability_picture("What is there: squares of half a pixel", rendered_for(run, std::move(fine)).film));
    for (const auto& [caption, minimum_level, filtered] : {std::tuple("Four corners: all white", 0, false),
                                                           {"minimum_level 1: half", 1, false},
                                                           {"The pattern's exact mean: half", 0, true}}) {
      StabilityPicture picture =
          stability_picture(caption, rendered_for(run, fooling_checker(minimum_level, filtered)).film);
      picture.magnified = kFiner;
      result.pictures.push_back(std::move(picture));
    }
  }
  return result;
}

}  // namespace

std::vector<StabilityCase> sampling_cases() {
  return {{20, "small-objects", "Things smaller than a pixel", "spheres of .05 to 1 pixel anywhere",
           "a least radius that forces division, and areas of what stays between samples; off: centers of pixels",
           "Whitted 1980, sec. 3", small_objects},
          {21, "mirrored-objects", "Small things in a curved mirror", "far lamps in a mirror ball, .15 pixels large",
           "a least level of division; off: the least radius alone", "Whitted 1980, p. 347", mirrored_objects},
          {22, "thin-strip", "A strip thinner than a pixel", "width .1, slope 1/50, in steps through a pixel",
           "the area of its outline; off: centers of pixels", "Phong 1973, VI", thin_strip},
          {23, "equal-corners", "Four corners that agree and are wrong",
           "a checker of half a pixel, its corners on the pixel's",
           "a least level of division, or a pattern's exact mean; off: corners alone", "Whitted 1980, fig. 5",
           equal_corners}};
}

}  // namespace raytree::benchmarks
