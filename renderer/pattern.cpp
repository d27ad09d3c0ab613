#include "renderer/pattern.h"

#include <algorithm>
#include <cmath>
#include <variant>

#include "geometry/angle.h"
#include "renderer/noise.h"
#include "renderer/square_wave.h"

namespace raytree {
namespace {

/// A linear function of the place: position in scene space, or texture coordinates.
struct Coordinate {
  Vec3d origin{0, 0, 0};     ///< where it is 0
  Vec3d direction{0, 0, 0};  ///< its gradient

  double at(const Vec3d& place) const { return (place - origin).dot(direction); }
  double over(const Vec3f& edge) const { return Vec3d(edge).dot(direction); }
};

struct Checker {
  Coordinate a, b;  ///< in squares

  double share(const Vec3d& place, const Footprint& footprint) const {
    const PlaneVector center{a.at(place), b.at(place)};
    const PlaneVector edge{a.over(footprint.edge), b.over(footprint.edge)},
        other{a.over(footprint.other_edge), b.over(footprint.other_edge)};
    const double reach = std::max(std::abs(edge.a) + std::abs(other.a), std::abs(edge.b) + std::abs(other.b));
    if (reach == 0 || (footprint.leaves_edges && reach < 1))
      return 0.5 + 0.5 * square_wave(center.a) * square_wave(center.b);
    return 0.5 + 0.5 * checker_mean(center, edge, other);
  }
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
  Vec3d origin;
  double cells_per_unit = 1;
  double contrast = 2;
  Octaves octaves;

  double share(const Vec3d& place, const Footprint& footprint) const {
    const double width = std::sqrt(std::max<double>(footprint.edge.dot(footprint.edge),  //
                                                    footprint.other_edge.dot(footprint.other_edge)));
    return 0.5 +
           0.5 * contrast * octave_noise(octaves, (place - origin) * cells_per_unit, width * cells_per_unit).value;
  }
};

}  // namespace

class VaryingColor {
 public:
  std::variant<Checker, Stripes, Noise> kind;
  bool over_texture = false;
  bool filtered = true;

  /// Share of `even` in the mixture.
  double share(const SurfacePoint& point, const Footprint& footprint) const {
    const Vec3d place = over_texture ? Vec3d(point.texture.x, point.texture.y, 0) : Vec3d(point.position);
    // How texture coordinates run over the surface is not known here.
    static constexpr Footprint kPoint;
    const Footprint& window = filtered && !over_texture ? footprint : kPoint;
    return std::visit([&](const auto& one) { return one.share(place, window); }, kind);
  }
};

Rgb Pattern::mixed(const SurfacePoint& point, const Footprint& footprint) const {
  const double share = varying->share(point, footprint);
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

  Coordinate coordinate(const Vec3d& direction, const Vec3d& offset) const {
    return {color.over_texture ? offset : offset - scene_origin, direction};
  }

  void operator()(const Rgb& constant) { pattern.even = pattern.odd = constant; }

  void operator()(const CheckerPattern& checker) {
    pattern.even = checker.even, pattern.odd = checker.odd;
    color.filtered = checker.filtered;
    color.over_texture = checker.plane == CheckerPattern::Plane::uv;
    int axis[2] = {0, 1};
    if (checker.plane == CheckerPattern::Plane::xz) axis[1] = 2;
    if (checker.plane == CheckerPattern::Plane::yz) axis[0] = 1, axis[1] = 2;
    Vec3d offset(0, 0, 0), a(0, 0, 0), b(0, 0, 0);
    offset[axis[0]] = checker.offset.x, offset[axis[1]] = checker.offset.y;
    a[axis[0]] = b[axis[1]] = 1 / checker.size;
    color.kind = Checker{coordinate(a, offset), coordinate(b, offset)};
  }

  void operator()(const StripesPattern& stripes) {
    pattern.even = stripes.even, pattern.odd = stripes.odd;
    color.filtered = stripes.filtered;
    color.over_texture = stripes.space == PatternSpace::uv;
    color.kind = Stripes{coordinate(unit(stripes.direction) / stripes.size, stripes.offset), stripes.smooth};
  }

  void operator()(const NoisePattern& noise) {
    pattern.even = noise.high, pattern.odd = noise.low;
    color.filtered = noise.filtered;
    color.over_texture = noise.space == PatternSpace::uv;
    color.kind = Noise{color.over_texture ? noise.offset : noise.offset - scene_origin,
                       1 / noise.size,
                       noise.contrast,
                       {noise.octaves, noise.gain, noise.seed}};
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
