#include "renderer/bump.h"

#include <cmath>

#include "geometry/angle.h"
#include "geometry/surface.h"

namespace raytree {

Bump::Bump(const BumpDescription& description, const Vec3d& scene_origin)
    : kind_(description.kind),
      amplitude_(description.amplitude),
      frequency_(1 / description.size),
      origin_(description.space, description.offset, scene_origin),
      direction_(unit(description.direction)),
      octaves_{description.octaves, description.gain, description.seed} {}

Height Bump::height(const Vec3d& from_origin, double width) const {
  const Vec3d place = from_origin * frequency_;
  width *= frequency_;
  Height height;
  // A wave along `toward`, 1 long and from -1 to 1 high, `phase` periods on.
  const auto wave = [&](double phase, const Vec3d& toward) {
    const double angle = 2 * kPi * (phase - std::floor(phase));
    const double weight = octave_weight(width, 0.5);
    height = {weight * std::sin(angle), toward * (weight * 2 * kPi * std::cos(angle))};
  };
  switch (kind_) {
    case BumpDescription::Kind::noise:
      height = octave_noise(octaves_, place, width);
      break;
    case BumpDescription::Kind::wrinkles:
      height = ridged_noise(octaves_, place, width);
      break;
    case BumpDescription::Kind::ripples: {
      const double radius = place.length();
      // A quarter period on: level at the center, where all directions meet.
      wave(radius + 0.25, radius > 0 ? place / radius : Vec3d(0, 0, 0));
      break;
    }
    case BumpDescription::Kind::stripes:
      wave(place.dot(direction_), direction_);
      break;
  }
  return {height.value * amplitude_, height.gradient * (amplitude_ * frequency_)};
}

Vec3f Bump::bent(const Vec3f& normal, const Vec3f& side, const Vec3f& to_viewer, bool inward, const Vec3f& position,
                 const Footprint& footprint, const ObjectFrame* frame) const {
  const ObjectFrame* own = origin_.frame(frame);
  Vec3d n(normal);
  if (own != nullptr) n = unit(own->normal(n));
  const Vec3d gradient = height(origin_.to(position, frame), origin_.window(footprint, frame).width()).gradient;
  const Vec3d rise = gradient - n * gradient.dot(n);
  Vec3d turned = inward ? n + rise : n - rise;
  double square = turned.dot(turned);
  // A slope that is no number, or leaves every range, bends nothing.
  if (!(square < 1e30)) return normal;
  if (own != nullptr) {
    turned = own->scene_normal(turned);
    square = turned.dot(turned);
    if (!std::isnormal(square)) return normal;
  }
  Vec3f bent(turned * (1 / std::sqrt(square)));
  const auto face = [&](const Vec3f& direction) {
    const float missing = kLeastFacing - bent.dot(direction);
    if (missing > 0) bent += direction * missing;
  };
  // The viewer stands on that side too, so what is added toward it takes nothing from the other.
  face(side);
  face(to_viewer);
  return unit(bent);
}

}  // namespace raytree
