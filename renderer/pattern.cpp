#include "renderer/pattern.h"

#include <algorithm>
#include <cmath>
#include <variant>

#include "geometry/angle.h"
#include "renderer/noise.h"
#include "renderer/object_space.h"
#include "renderer/square_wave.h"

namespace raytree {
namespace {

// Places are measured from where the pattern begins, in the pattern's space: that of the shape, of the scene, or of
// texture coordinates.

/// A linear function of the place.
struct Coordinate {
  Vec3d direction{0, 0, 0};  ///< its gradient

  double at(const Vec3d& place) const { return place.dot(direction); }
  double over(const Vec3f& edge) const { return Vec3d(edge).dot(direction); }
};

struct Checker {
  Coordinate a, b;  ///< in squares

  double share(const Vec3d& place, const Footprint& footprint) const {
    if (const double sign = cell(place, footprint); sign != 0) return 0.5 + 0.5 * sign;
    return 0.5 + 0.5 * checker_mean({a.at(place), b.at(place)}, over(footprint.edge), over(footprint.other_edge));
  }

  /// 1 or -1 where the footprint counts as a point or lies within one cell; else 0. Without branches, so that a loop
  /// over many samples is vectorized.
  [[gnu::always_inline]] double cell(const Vec3d& place, const Footprint& footprint) const {
    const PlaneVector center{a.at(place), b.at(place)}, edge = over(footprint.edge), other = over(footprint.other_edge);
    const PlaneVector reach{std::abs(edge.a) + std::abs(other.a), std::abs(edge.b) + std::abs(other.b)};
    const bool is_point = ((reach.a == 0) & (reach.b == 0)) | (footprint.leaves_edges & (reach.a < 1) & (reach.b < 1));
    const double sign = square_wave(center.a) * square_wave(center.b);
    const bool fits = fits_cell(center, reach);
    return (is_point | fits) ? sign : 0.0;
  }

 private:
  PlaneVector over(const Vec3f& edge) const { return {a.over(edge), b.over(edge)}; }
};

struct Stripes {
  Coordinate across;  ///< in stripes
  bool smooth = false;

  double share(const Vec3d& place, const Footprint& footprint) const {
    const double x = across.at(place), width = across.over(footprint.edge), other = across.over(footprint.other_edge);
    if (!smooth) {
      const bool as_point = footprint.leaves_edges && std::abs(width) + std::abs(other) < 1;
      return 0.5 + 0.5 * (as_point ? square_wave(x) : square_wave_mean(x, width, other));
    }
    // A sine's mean over an interval is the sine at its middle, less high.
    const auto height = [](double w) {
      const double angle = kPi * 0.5 * w;
      if (!(std::abs(angle) < 1e6)) return 0.0;
      return std::abs(angle) < 1e-4 ? 1.0 : std::sin(angle) / angle;
    };
    const double phase = x - 2 * std::floor(x * 0.5);
    return 0.5 + 0.5 * std::sin(kPi * phase) * height(width) * height(other);
  }
};

struct Noise {
  double cells_per_unit = 1;
  double contrast = 2;
  Octaves octaves;

  double share(const Vec3d& place, const Footprint& footprint) const {
    const double width = footprint.width() * cells_per_unit;
    return 0.5 + 0.5 * contrast * octave_noise(octaves, place * cells_per_unit, width).value;
  }
};

}  // namespace

class VaryingColor {
 public:
  std::variant<Checker, Stripes, Noise> kind;
  bool over_texture = false;
  bool filtered = true;
  SolidOrigin origin;             ///< where it lies over positions
  Vec3d texture_origin{0, 0, 0};  ///< where it lies over texture coordinates

  /// Share of `even` in the mixture.
  double share(const SurfacePoint& point, const Footprint& footprint, const ObjectFrame* frame) const {
    const Vec3d place =
        over_texture ? Vec3d(point.texture.x, point.texture.y, 0) - texture_origin : origin.to(point.position, frame);
    // How texture coordinates run over the surface is not known here.
    const Footprint window = filtered && !over_texture ? origin.window(footprint, frame) : Footprint();
    return std::visit([&](const auto& one) { return one.share(place, window); }, kind);
  }
};

bool Pattern::follows_object() const { return varies() && !varying->over_texture && varying->origin.follows_object(); }

bool Pattern::has_cells() const {
  return varies() && !varying->over_texture && std::holds_alternative<Checker>(varying->kind);
}

void Pattern::find_cells(const SampleLanes& samples, std::int32_t (&cells)[kLanes]) const {
  // Copies, which nothing that is written can change.
  const Checker checker = std::get<Checker>(varying->kind);
  const SolidOrigin origin = varying->origin;
  static constexpr SampleLanes kPoints = {};
  const SampleLanes& windows = varying->filtered ? samples : kPoints;
  double signs[kLanes];
  for (std::size_t i = 0; i < kLanes; ++i)
    signs[i] = checker.cell(origin.to(samples.position[i], nullptr),
                            {windows.edge[i], windows.other_edge[i], windows.leaves_edges[i] != 0});
  for (std::size_t i = 0; i < kLanes; ++i) cells[i] = static_cast<std::int32_t>(signs[i]);
}

Rgb Pattern::mixed(const SurfacePoint& point, const Footprint& footprint, const ObjectFrame* frame) const {
  const double share = varying->share(point, footprint, frame);
  // The two colors themselves come without rounding; NaN, from a place that is not finite, stays in the sum.
  if (share >= 1) return even;
  if (share <= 0) return odd;
  return mix(odd, even, static_cast<float>(share));
}

namespace {

struct Maker {
  const Vec3d& scene_origin;
  Pattern pattern;
  VaryingColor color;

  void begin_at(const Vec3d& offset, PatternSpace space) {
    color.over_texture = space == PatternSpace::uv;
    color.texture_origin = offset;
    color.origin =
        SolidOrigin(space == PatternSpace::object ? SolidSpace::object : SolidSpace::world, offset, scene_origin);
  }

  void operator()(const Rgb& constant) { pattern.even = pattern.odd = constant; }

  void operator()(const CheckerPattern& checker) {
    pattern.even = checker.even, pattern.odd = checker.odd;
    color.filtered = checker.filtered;
    int axis[2] = {0, 1};
    if (checker.plane == CheckerPattern::Plane::xz) axis[1] = 2;
    if (checker.plane == CheckerPattern::Plane::yz) axis[0] = 1, axis[1] = 2;
    Vec3d offset(0, 0, 0), a(0, 0, 0), b(0, 0, 0);
    offset[axis[0]] = checker.offset.x, offset[axis[1]] = checker.offset.y;
    a[axis[0]] = b[axis[1]] = 1 / checker.size;
    color.kind = Checker{{a}, {b}};
    const PatternSpace solid = checker.space == SolidSpace::object ? PatternSpace::object : PatternSpace::world;
    begin_at(offset, checker.plane == CheckerPattern::Plane::uv ? PatternSpace::uv : solid);
  }

  void operator()(const StripesPattern& stripes) {
    pattern.even = stripes.even, pattern.odd = stripes.odd;
    color.filtered = stripes.filtered;
    color.kind = Stripes{{unit(stripes.direction) / stripes.size}, stripes.smooth};
    begin_at(stripes.offset, stripes.space);
  }

  void operator()(const NoisePattern& noise) {
    pattern.even = noise.high, pattern.odd = noise.low;
    color.filtered = noise.filtered;
    color.kind = Noise{1 / noise.size, noise.contrast, {noise.octaves, noise.gain, noise.seed}};
    begin_at(noise.offset, noise.space);
  }
};

}  // namespace

Pattern make_pattern(const ColorPattern& description, const Vec3d& scene_origin) {
  Maker maker{scene_origin, {}, {}};
  std::visit(maker, description);
  if (!std::holds_alternative<Rgb>(description))
    maker.pattern.varying = std::make_shared<const VaryingColor>(std::move(maker.color));
  return maker.pattern;
}

bool needs_texture(const ColorPattern& description) {
  if (const auto* checker = std::get_if<CheckerPattern>(&description))
    return checker->plane == CheckerPattern::Plane::uv;
  if (const auto* stripes = std::get_if<StripesPattern>(&description)) return stripes->space == PatternSpace::uv;
  if (const auto* noise = std::get_if<NoisePattern>(&description)) return noise->space == PatternSpace::uv;
  return false;
}

}  // namespace raytree
