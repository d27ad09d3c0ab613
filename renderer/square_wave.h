// Means of square waves and checkers over windows, in closed form: what a pixel sees of a checkered floor or a striped
// wall. Both are +1 and -1 by turns on cells of edge 1; the cell that begins at 0 is +1.
#pragma once

#include <cmath>

namespace raytree {

/// x less the even number at or below it: in [0, 2).
inline double within_period(double x) { return x - 2 * std::floor(x * 0.5); }

/// +1 where floor(x) is even, -1 elsewhere.
inline double square_wave(double x) { return within_period(x) < 1 ? 1 : -1; }

/// Mean of square_wave over an interval of `width` about x.
double square_wave_mean(double x, double width);

/// Mean of square_wave(x + s + t) for s and t in intervals of the two widths about 0: what a parallelogram sees of
/// stripes.
double square_wave_mean(double x, double width, double other_width);

/// An edge of a window in the plane of a checker, or a point in it.
struct PlaneVector {
  double a = 0, b = 0;
};

/// Whether a window about `center` that reaches as far as `reach` along the two axes lies within one cell. Written so
/// that g++ vectorizes a loop over many windows: it cannot choose between two truth values.
inline bool fits_cell(const PlaneVector& center, const PlaneVector& reach) {
  const auto room = [](double x, double width) {
    const double t = within_period(x), inside = t - (t < 1 ? 0.0 : 1.0);
    const double below = inside - width * 0.5, above = 1 - (inside + width * 0.5);
    return below < above ? below : above;
  };
  const double room_a = room(center.a, reach.a), room_b = room(center.b, reach.b);
  return (room_a >= 0) & (room_b >= 0);
}

/// Mean of square_wave(a) square_wave(b) over the parallelogram about `center` with these edges, exact (Green's theorem
/// over its outline). One that reaches over more than kMostCells cells along both axes, or has next to no area, gets
/// the product of the two coordinates' own means, which is exact where the edges lie along the axes.
inline constexpr double kMostCells = 24;
double checker_mean(const PlaneVector& center, const PlaneVector& edge, const PlaneVector& other_edge);

}  // namespace raytree
