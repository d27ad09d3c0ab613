#include "renderer/square_wave.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace raytree {
namespace {

/// Windows narrower than this, in cells, are as good as points: differences of integrals would have no digits left.
constexpr double kNarrow = 1e-5;
/// Beyond, the mean is 0 to six digits whatever the window covers.
constexpr double kWide = 1e6;

/// Integral of square_wave without a constant part: a triangle wave between -1/2 and 1/2.
double triangle_wave(double x) {
  const double t = within_period(x);
  return t < 1 ? t - 0.5 : 1.5 - t;
}

/// Integral of triangle_wave from 0: between -1/8 and 1/8, 0 at whole numbers.
double triangle_integral(double x) {
  const double t = within_period(x);
  return t < 1 ? t * (t - 1) * 0.5 : (t - 1) * (2 - t) * 0.5;
}

double in_range(double mean) { return std::clamp(mean, -1.0, 1.0); }

/// Integral of triangle_wave(a) square_wave(b) db along the line from p to q.
double edge_integral(const PlaneVector& p, const PlaneVector& q) {
  const double along = q.a - p.a, up = q.b - p.b;
  if (up == 0) return 0;
  // The line is cut where b is whole; between the cuts square_wave(b) is constant.
  const double step = up > 0 ? 1 : -1;
  double cut = up > 0 ? std::floor(p.b) + 1 : std::ceil(p.b) - 1;
  double sign = square_wave(cut - step * 0.5);
  double sum = 0, begin = 0;
  while (begin < 1) {
    const double end = std::clamp((cut - p.b) / up, begin, 1.0);
    const double a0 = p.a + along * begin, a1 = p.a + along * end;
    const double part = std::abs(along) > kNarrow ? (triangle_integral(a1) - triangle_integral(a0)) / along
                                                  : triangle_wave((a0 + a1) * 0.5) * (end - begin);
    sum += sign * part;
    begin = end;
    cut += step;
    sign = -sign;
  }
  return sum * up;
}

}  // namespace

double square_wave_mean(double x, double width) {
  width = std::abs(width);
  if (!(width < kWide)) return 0;
  const double t = within_period(x), half = width * 0.5;
  // Within one cell nothing needs rounding.
  const double inside = t < 1 ? t : t - 1;
  if (width < kNarrow || (inside - half >= 0 && inside + half <= 1)) return square_wave(t);
  return in_range((triangle_wave(t + half) - triangle_wave(t - half)) / width);
}

double square_wave_mean(double x, double width, double other_width) {
  double narrow = std::abs(width), wide = std::abs(other_width);
  if (!(narrow <= wide)) std::swap(narrow, wide);
  if (!(wide < kWide)) return 0;
  if (narrow < kNarrow) return square_wave_mean(x, wide);
  const double t = within_period(x), far = (wide + narrow) * 0.5, near = (wide - narrow) * 0.5;
  const double inside = t < 1 ? t : t - 1;
  if (inside - far >= 0 && inside + far <= 1) return square_wave(t);
  return in_range((triangle_integral(t + far) - triangle_integral(t + near) - triangle_integral(t - near) +
                   triangle_integral(t - far)) /
                  (narrow * wide));
}

double checker_mean(const PlaneVector& center, const PlaneVector& edge, const PlaneVector& other_edge) {
  const double reach_a = std::abs(edge.a) + std::abs(other_edge.a), reach_b = std::abs(edge.b) + std::abs(other_edge.b);
  if (!(reach_a < kWide && reach_b < kWide)) return 0;
  if (fits_cell(center, {reach_a, reach_b})) return square_wave(center.a) * square_wave(center.b);

  // The sum of cells' signs is what counts: both coordinates lose even numbers.
  const PlaneVector middle{within_period(center.a), within_period(center.b)};
  const double area = edge.a * other_edge.b - edge.b * other_edge.a;
  const double longest = std::max(reach_a, reach_b);
  constexpr double kLeastAreaShare = 1e-7;
  const bool is_exact = std::min(reach_a, reach_b) <= kMostCells && longest > 64 * kNarrow &&
                        std::abs(area) > kLeastAreaShare * longest * longest && longest <= 1 / kLeastAreaShare;
  if (!is_exact)
    return square_wave_mean(middle.a, edge.a, other_edge.a) * square_wave_mean(middle.b, edge.b, other_edge.b);

  const auto corner = [&](double s, double t) {
    PlaneVector c{middle.a + s * edge.a + t * other_edge.a, middle.b + s * edge.b + t * other_edge.b};
    // The outline is walked along the axis on which it is shorter; a checker is the same with its axes exchanged.
    if (reach_a < reach_b) std::swap(c.a, c.b);
    return c;
  };
  const PlaneVector corners[4] = {corner(-0.5, -0.5), corner(0.5, -0.5), corner(0.5, 0.5), corner(-0.5, 0.5)};
  double sum = 0;
  for (int i = 0; i < 4; ++i) sum += edge_integral(corners[i], corners[(i + 1) % 4]);
  return in_range(sum / (reach_a < reach_b ? -area : area));
}

}  // namespace raytree
