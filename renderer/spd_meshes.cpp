#include "renderer/spd_meshes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "geometry/angle.h"

namespace raytree {
namespace {

std::shared_ptr<PolygonMesh> triangles_of(std::vector<Vec3f>&& positions, std::vector<std::uint32_t>&& corners) {
  auto mesh = std::make_shared<PolygonMesh>();
  mesh->positions.assign(positions.begin(), positions.end());
  mesh->corners.assign(corners.begin(), corners.end());
  return mesh;
}

/// A Gaussian deviate by Marsaglia's polar method over the congruential generator 8121 x + 28411 mod 134456.
double gaussian(std::int64_t seed) {
  constexpr std::int64_t kModulus = 134456;
  const auto next = [&seed] { return seed = (28411 + 8121 * seed) % kModulus; };
  for (;;) {
    const double v = 2.0 * static_cast<double>(next()) / kModulus - 1;
    const double w = 2.0 * static_cast<double>(next()) / kModulus - 1;
    const double square = v * v + w * w;
    if (square < 1) return v * std::sqrt(-2 * std::log(square) / square);
  }
}

/// Heights of a square grid of 2^size cells over [-1, 1]^2.
class Mountain {
 public:
  explicit Mountain(int size) : size_(size), cells_(1 << size) {
    heights_.resize(std::size_t(row()) * row());
    grow(cells_, 0, 0, {0, 0, 0, 0});
  }

  std::shared_ptr<PolygonMesh> mesh() const {
    std::vector<Vec3f> positions;
    positions.reserve(heights_.size());
    for (int y = 0; y <= cells_; ++y)
      for (int x = 0; x <= cells_; ++x)
        positions.emplace_back(Vec3d(-1 + 2.0 * x / cells_, -1 + 2.0 * y / cells_, height(x, y)));
    std::vector<std::uint32_t> corners;
    corners.reserve(std::size_t(6) * cells_ * cells_);
    add_cells(cells_, 0, 0, corners);
    return triangles_of(std::move(positions), std::move(corners));
  }

 private:
  /// Of a square's corners, counter-clockwise from the lower left.
  using Corners = std::array<double, 4>;

  int row() const { return cells_ + 1; }
  std::size_t index(int x, int y) const { return std::size_t(y) * row() + x; }
  double height(int x, int y) const { return heights_[index(x, y)]; }

  /// 16 bits of the place; a shift by less than nothing, at large sizes, goes the other way.
  std::int64_t hash(int x, int y) const {
    const auto shifted = [this](int value, int bits) {
      const auto wide = static_cast<std::uint64_t>(value);
      return bits >= size_ ? wide << (bits - size_) : wide >> (size_ - bits);
    };
    return static_cast<std::int64_t>((shifted(x, 23) + shifted(y, 15) + shifted(x, 7)) & 0xffff);
  }

  double deviate(int x, int y) const {
    constexpr int kMountain = 21;  // the published one
    return gaussian(kMountain + hash(x, y));
  }

  /// Sets the heights of a square `width` cells wide whose corners' heights are given.
  void grow(int width, int x, int y, const Corners& z) {
    if (width == 1) {
      heights_[index(x, y)] = z[0];
      heights_[index(x + 1, y)] = z[1];
      heights_[index(x + 1, y + 1)] = z[2];
      heights_[index(x, y + 1)] = z[3];
      return;
    }
    // 2 / 2^(1 / (D - 1)) for the fractal dimension D = 2.2.
    static const double ratio = 2 / std::exp2(1 / 1.2), roughness = std::sqrt(ratio * ratio - 1);
    const int half = width / 2;
    const double rise = half * 2.0 / cells_ * roughness;
    const double low = (z[0] + z[1]) / 2 + rise * deviate(x + half, y);
    const double right = (z[1] + z[2]) / 2 + rise * deviate(x + width, y + half);
    const double up = (z[2] + z[3]) / 2 + rise * deviate(x + half, y + width);
    const double left = (z[3] + z[0]) / 2 + rise * deviate(x, y + half);
    const double middle = (z[0] + z[1] + z[2] + z[3]) / 4 + std::numbers::sqrt2 * rise * deviate(x + half, y + half);
    grow(half, x, y, {z[0], low, middle, left});
    grow(half, x + half, y, {low, z[1], right, middle});
    grow(half, x + half, y + half, {middle, right, z[2], up});
    grow(half, x, y + half, {left, middle, up, z[3]});
  }

  /// Two triangles a cell, quadrant after quadrant.
  void add_cells(int width, int x, int y, std::vector<std::uint32_t>& corners) const {
    if (width > 1) {
      const int half = width / 2;
      add_cells(half, x, y, corners);
      add_cells(half, x + half, y, corners);
      add_cells(half, x + half, y + half, corners);
      add_cells(half, x, y + half, corners);
      return;
    }
    const auto at = [&](int i, int j) { return static_cast<std::uint32_t>(index(x + i, y + j)); };
    corners.insert(corners.end(), {at(0, 0), at(1, 0), at(1, 1), at(1, 1), at(0, 1), at(0, 0)});
  }

  const int size_, cells_;
  std::vector<double> heights_;
};

void add_tetrahedra(int size, const Vec3d& center, double half, PolygonList& list) {
  static const std::array<Vec3d, 4> kCorners{Vec3d(-1, -1, 1), Vec3d(-1, 1, -1), Vec3d(1, -1, -1), Vec3d(1, 1, 1)};
  if (size > 1) {
    for (const Vec3d& corner : kCorners) add_tetrahedra(size - 1, center + corner * (half / 2), half / 2, list);
    return;
  }
  constexpr std::array<std::array<std::size_t, 3>, 4> kFaces{{{0, 1, 2}, {3, 2, 1}, {2, 3, 0}, {1, 0, 3}}};
  for (const auto& face : kFaces) {
    std::array<Vec3d, 3> triangle;
    for (std::size_t i = 0; i < 3; ++i) triangle[i] = center + kCorners[face[i]] * half;
    list.add(triangle);
  }
}

}  // namespace

void PolygonList::add(std::span<const Vec3d> corners) {
  mesh_->face_sizes.push_back(static_cast<std::uint32_t>(corners.size()));
  for (const Vec3d& corner : corners) {
    mesh_->corners.push_back(static_cast<std::uint32_t>(mesh_->positions.size()));
    mesh_->positions.push_back(Vec3f(corner));
  }
}

std::shared_ptr<PolygonMesh> PolygonList::mesh() && {
  const bool triangles =
      std::all_of(mesh_->face_sizes.begin(), mesh_->face_sizes.end(), [](std::uint32_t size) { return size == 3; });
  if (triangles) mesh_->face_sizes = {};
  return std::move(mesh_);
}

std::shared_ptr<PolygonMesh> spd_gear(const Vec3d& center, double angle, double outer_radius, double inner_radius,
                                      double thickness) {
  constexpr std::uint32_t kCorners = 4 * kSpdTeeth;
  auto mesh = std::make_shared<PolygonMesh>();
  for (const double z : {center.z, center.z - thickness})
    for (int tooth = 0; tooth < kSpdTeeth; ++tooth)
      for (const auto& [share, radius] : {std::pair{-0.19, outer_radius}, std::pair{0.19, outer_radius},
                                          std::pair{0.3, inner_radius}, std::pair{0.7, inner_radius}}) {
        const double azimuth = angle + (tooth + share) * 2 * kPi / kSpdTeeth;
        mesh->positions.push_back(
            Vec3f(Vec3d(center.x + radius * std::cos(azimuth), center.y + radius * std::sin(azimuth), z)));
      }
  const auto add = [&](std::uint32_t corner) { mesh->corners.push_back(corner); };
  mesh->face_sizes.push_back(kCorners);
  for (std::uint32_t i = 0; i < kCorners; ++i) add(i);
  for (std::uint32_t i = 0; i < kCorners; ++i) {
    const std::uint32_t next = (i + 1) % kCorners;
    mesh->face_sizes.push_back(4);
    for (const std::uint32_t corner : {i, kCorners + i, kCorners + next, next}) add(corner);
  }
  // Clockwise from the first tooth's second corner.
  mesh->face_sizes.push_back(kCorners);
  for (std::uint32_t i = 0; i < kCorners; ++i) add(kCorners + (kCorners + 1 - i) % kCorners);
  return mesh;
}

std::shared_ptr<PolygonMesh> spd_mountain(int size) { return Mountain(size).mesh(); }

std::shared_ptr<PolygonMesh> spd_patches(std::span<const BezierPatch> patches, int size) {
  std::vector<Vec3f> positions, normals;
  std::vector<std::uint32_t> corners;
  const auto row = static_cast<std::uint32_t>(size) + 1;
  for (const BezierPatch& patch : patches) {
    const auto first = static_cast<std::uint32_t>(positions.size());
    std::vector<bool> on_axis;
    for (int j = 0; j <= size; ++j)
      for (int i = 0; i <= size; ++i) {
        const PatchDerivatives at = evaluate(patch, double(i) / size, double(j) / size);
        on_axis.push_back(std::abs(at.position.x) < 1e-4 && std::abs(at.position.y) < 1e-4);
        positions.emplace_back(at.position);
        const Vec3d normal =
            on_axis.back() ? Vec3d(0, 0, at.position.z > 1.5 ? 1 : -1) : at.du.cross(at.dv).normalized();
        normals.emplace_back(normal + Vec3d(0, 0, 0));  // a file would lose the sign of a zero
      }
    for (std::uint32_t j = 0; j + 1 < row; ++j)
      for (std::uint32_t i = 0; i + 1 < row; ++i) {
        const std::uint32_t a = j * row + i, b = a + 1, c = b + row, d = a + row;
        for (const auto& triangle : {std::array{a, b, c}, std::array{c, d, a}}) {
          if (std::count_if(triangle.begin(), triangle.end(), [&](std::uint32_t k) { return on_axis[k]; }) > 1)
            continue;
          for (const std::uint32_t k : triangle) corners.push_back(first + k);
        }
      }
  }
  auto mesh = triangles_of(std::move(positions), std::move(corners));
  mesh->normals.assign(normals.begin(), normals.end());
  return mesh;
}

std::shared_ptr<PolygonMesh> spd_board(int size, bool odd) {
  const auto line = [size](int i) { return 4 * (2.0 * i / size - 1); };
  PolygonList list;
  for (int i = 0; i < size; ++i)
    for (int j = 0; j < size; ++j)
      if (((i + j) % 2 != 0) == odd)
        list.add(std::array{Vec3d(line(i), line(j), 0), Vec3d(line(i + 1), line(j), 0),
                            Vec3d(line(i + 1), line(j + 1), 0), Vec3d(line(i), line(j + 1), 0)});
  return std::move(list).mesh();
}

std::shared_ptr<PolygonMesh> spd_tetrahedra(int size) {
  PolygonList list;
  add_tetrahedra(size, Vec3d(0, 0, 0), 1, list);
  return std::move(list).mesh();
}

}  // namespace raytree
