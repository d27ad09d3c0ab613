// Means of square waves and checkers over windows, in closed form: what a pixel sees of a checkered floor or a striped
// wall. Both are +1 and -1 by turns on cells of edge 1; the cell that begins at 0 is +1.
#pragma once

namespace raytree {

/// +1 where floor(x) is even, -1 elsewhere.
double square_wave(double x);

/// Mean of square_wave over an interval of `width` about x.
double square_wave_mean(double x, double width);

/// Mean of square_wave(x + s + t) for s and t in intervals of the two widths about 0: what a parallelogram sees of
/// stripes.
double square_wave_mean(double x, double width, double other_width);

/// An edge of a window in the plane of a checker, or a point in it.
struct PlaneVector {
  double a = 0, b = 0;
};

/// Mean of square_wave(a) square_wave(b) over the parallelogram about `center` with these edges, exact (Green's theorem
/// over its outline). One that reaches over more than kMostCells cells along both axes, or has next to no area, gets
/// the product of the two coordinates' own means, which is exact where the edges lie along the axes.
inline constexpr double kMostCells = 24;
double checker_mean(const PlaneVector& center, const PlaneVector& edge, const PlaneVector& other_edge);

}  // namespace raytree
