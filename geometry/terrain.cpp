// The height function of the terrain, evaluated for blocks of points with everything in arrays (so that compilers
// vectorize it), and the one pass over bands of rows that writes positions, normals and corners.
#include "geometry/terrain.h"

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#if defined(__linux__)
#include <sys/mman.h>
#endif

#include "geometry/error.h"

namespace raytree {
namespace {

// --- the surface --------------------------------------------------------------------------------------------

constexpr int kBlock = 128;         ///< points evaluated together; the arrays of a block stay in the first-level cache
constexpr int kMaxOctaves = 16;     ///< the finest grid shows eleven
constexpr float kBaseCells = 2.1f;  ///< noise cells along the square's edge in the first octave
constexpr float kLacunarity = 1.97f;  ///< not 2, so that no two octaves share lattice points
// What follows was chosen by eye: sharp ridges, broad valleys, flanks furrowed downhill.
constexpr float kRidgeWidth = 0.035f;    ///< noise value below which a ridge is rounded, so that slopes are continuous
constexpr float kValleyWidth = 0.45f;    ///< noise value at which a ridge has lost half its height
constexpr float kWarp = 0.025f;          ///< downhill shift of an octave's lattice per accumulated slope
constexpr float kSlopeDamping = 0.02f;   ///< how much steep flanks lose of later octaves
constexpr float kValleyDetail = 0.5f;    ///< share of later octaves' amplitude that deep valleys keep
constexpr float kMeanRidge = 0.66f;      ///< taken off, so that an octave more does not lift the terrain
constexpr double kSamplesPerCell = 2.5;  ///< an octave shows from here on, and fully from twice as many

/// What one octave needs besides the point.
struct Octave {
  float frequency;           ///< noise cells per edge of the square
  float cosine, sine;        ///< turns the lattice, so that no direction stands out
  float offset_x, offset_z;  ///< cells
  std::uint32_t key;         ///< of the hash
  float weight;              ///< 1, less for the finest octave
  float gain;                ///< amplitude over the octave before
};

std::uint32_t mixed(std::uint32_t value) {
  value = (value ^ (value >> 16)) * 0x7feb352du;
  value = (value ^ (value >> 15)) * 0x846ca68bu;
  return value ^ (value >> 16);
}

struct Gradient {
  float x, z;
};

/// The random gradient of a lattice point: two components in [-1, 1).
inline Gradient lattice_gradient(std::uint32_t column, std::uint32_t row) {
  std::uint32_t hash = column ^ row;
  hash = (hash ^ (hash >> 15)) * 0x2c1b3c6du;
  hash = (hash ^ (hash >> 12)) * 0x297a2d39u;
  hash ^= hash >> 15;
  constexpr float kUnit = 1.0f / 32768;
  return {float(std::int32_t(hash) >> 16) * kUnit, float(std::int32_t(hash << 16) >> 16) * kUnit};
}

constexpr std::uint32_t kColumnFactor = 0x9e3779b1u, kRowFactor = 0x85ebca77u;

/// Heights of a block of points, in the function's own unit.
class Surface {
 public:
  /// cell: distance of neighboring samples as a share of the square's edge.
  Surface(std::uint32_t seed, double roughness, double cell) {
    double frequency = kBaseCells;
    for (int i = 0; i < kMaxOctaves; ++i, frequency *= kLacunarity) {
      const double samples_per_cell = 1 / (frequency * cell);
      const double weight = std::clamp(samples_per_cell / kSamplesPerCell - 1, 0.0, 1.0);
      if (i > 0 && weight <= 0) break;
      Octave& octave = octaves_[count_++];
      const std::uint32_t key = mixed(seed + 0x9e3779b9u * std::uint32_t(i + 1));
      const double angle = 0.6435 * i + 6.283185307179586 * (mixed(seed ^ 0x5bd1e995u) / 4294967296.0);
      octave.frequency = float(frequency);
      octave.cosine = float(std::cos(angle));
      octave.sine = float(std::sin(angle));
      octave.offset_x = float(mixed(key ^ 0x68e31da4u) >> 20) / 64;
      octave.offset_z = float(mixed(key ^ 0xb5297a4du) >> 20) / 64;
      octave.key = key;
      octave.weight = i == 0 ? 1.0f : float(weight);
      octave.gain = float(roughness);
    }
  }

  /// x, z: [kBlock] in [-1/2, 1/2], about; height: [kBlock].
  void evaluate(const float* x, const float* z, float* height) const {
    alignas(64) float sum[kBlock], slope_x[kBlock], slope_z[kBlock], amplitude[kBlock], warp_x[kBlock], warp_z[kBlock];
    for (int i = 0; i < kBlock; ++i) {
      sum[i] = slope_x[i] = slope_z[i] = warp_x[i] = warp_z[i] = 0;
      amplitude[i] = 1;
    }
    for (int o = 0; o < count_; ++o)
      add(octaves_[std::size_t(o)], x, z, sum, slope_x, slope_z, amplitude, warp_x, warp_z);
    for (int i = 0; i < kBlock; ++i) height[i] = sum[i];
  }

 private:
  static void add(const Octave& octave, const float* __restrict x, const float* __restrict z, float* __restrict sum,
                  float* __restrict slope_x, float* __restrict slope_z, float* __restrict amplitude,
                  float* __restrict warp_x, float* __restrict warp_z) {
    const float inverse_frequency = 1 / octave.frequency;
    for (int i = 0; i < kBlock; ++i) {
      const float u = (x[i] - kWarp * warp_x[i]) * octave.frequency;
      const float v = (z[i] - kWarp * warp_z[i]) * octave.frequency;
      const float p = octave.cosine * u - octave.sine * v + octave.offset_x;
      const float q = octave.sine * u + octave.cosine * v + octave.offset_z;
      const float cell_p = std::floor(p), cell_q = std::floor(q);
      const float fp = p - cell_p, fq = q - cell_q;
      const std::uint32_t column = std::uint32_t(std::int32_t(cell_p)) * kColumnFactor;
      const std::uint32_t row = std::uint32_t(std::int32_t(cell_q)) * kRowFactor + octave.key;
      const Gradient g00 = lattice_gradient(column, row);
      const Gradient g10 = lattice_gradient(column + kColumnFactor, row);
      const Gradient g01 = lattice_gradient(column, row + kRowFactor);
      const Gradient g11 = lattice_gradient(column + kColumnFactor, row + kRowFactor);
      const float a = g00.x * fp + g00.z * fq;
      const float b = g10.x * (fp - 1) + g10.z * fq;
      const float c = g01.x * fp + g01.z * (fq - 1);
      const float d = g11.x * (fp - 1) + g11.z * (fq - 1);
      const float wp = fp * fp * fp * (fp * (fp * 6 - 15) + 10), wq = fq * fq * fq * (fq * (fq * 6 - 15) + 10);
      const float rp = fp * (fp - 1), rq = fq * (fq - 1);
      const float dwp = 30 * rp * rp, dwq = 30 * rq * rq;
      const float twist = a - b - c + d;
      const float noise = a + wp * (b - a) + wq * (c - a) + wp * wq * twist;
      const float gx = g00.x + wp * (g10.x - g00.x) + wq * (g01.x - g00.x) + wp * wq * (g00.x - g10.x - g01.x + g11.x);
      const float gz = g00.z + wp * (g10.z - g00.z) + wq * (g01.z - g00.z) + wp * wq * (g00.z - g10.z - g01.z + g11.z);
      const float dp = gx + dwp * (b - a + wq * twist);
      const float dq = gz + dwq * (c - a + wp * twist);
      const float damping = 1 / (1 + kSlopeDamping * (slope_x[i] * slope_x[i] + slope_z[i] * slope_z[i]));
      const float strength = octave.weight * amplitude[i] * damping;
      const float softened = std::sqrt(noise * noise + kRidgeWidth * kRidgeWidth);
      const float fall = 1 / (kValleyWidth + softened);
      const float ridge = kValleyWidth * fall;
      const float turn = -strength * octave.frequency * (1 / kBaseCells) * ridge * fall * noise / softened;
      sum[i] += strength * (ridge - kMeanRidge);
      const float rise_x = turn * (octave.cosine * dp + octave.sine * dq);
      const float rise_z = turn * (octave.cosine * dq - octave.sine * dp);
      slope_x[i] += rise_x;
      slope_z[i] += rise_z;
      warp_x[i] += rise_x * inverse_frequency;
      warp_z[i] += rise_z * inverse_frequency;
      amplitude[i] *= octave.gain * (kValleyDetail + (1 - kValleyDetail) * ridge);
    }
  }

  std::array<Octave, kMaxOctaves> octaves_{};
  int count_ = 0;
};

// --- from the surface's unit to the scene's ------------------------------------------------------------------

struct HeightRange {
  float lowest = std::numeric_limits<float>::max(), highest = std::numeric_limits<float>::lowest();
};

/// Range over a fixed grid with the large octaves alone, so that it does not depend on the triangle count.
HeightRange height_range(std::uint32_t seed, double roughness) {
  constexpr int kRangeRows = 256, kRangeBlocks = 2, kRangeColumns = kRangeBlocks * kBlock;
  const Surface surface(seed, roughness, 1.0 / kRangeColumns);
  return tbb::parallel_reduce(
      tbb::blocked_range<int>(0, kRangeRows, 16), HeightRange{},
      [&](const tbb::blocked_range<int>& rows, HeightRange range) {
        alignas(64) float x[kBlock], z[kBlock], height[kBlock];
        for (int row = rows.begin(); row < rows.end(); ++row)
          for (int block = 0; block < kRangeBlocks; ++block) {
            for (int i = 0; i < kBlock; ++i) {
              x[i] = float(block * kBlock + i) / float(kRangeColumns - 1) - 0.5f;
              z[i] = float(row) / float(kRangeRows - 1) - 0.5f;
            }
            surface.evaluate(x, z, height);
            for (const float h : height) {
              range.lowest = std::min(range.lowest, h);
              range.highest = std::max(range.highest, h);
            }
          }
        return range;
      },
      [](const HeightRange& a, const HeightRange& b) {
        return HeightRange{std::min(a.lowest, b.lowest), std::max(a.highest, b.highest)};
      });
}

// --- the mesh ------------------------------------------------------------------------------------------------

/// A buffer of that many elements on huge pages where the system has them on offer: page faults of a large terrain
/// otherwise cost as much as its heights.
template <class T>
void allocate(Buffer<T>& buffer, std::size_t count) {
  buffer.reserve(count);
#if defined(__linux__) && defined(MADV_HUGEPAGE)
  constexpr std::uintptr_t kHugePage = std::uintptr_t(1) << 21;
  const auto begin = reinterpret_cast<std::uintptr_t>(buffer.data());
  const std::uintptr_t first = (begin + kHugePage - 1) & ~(kHugePage - 1);
  const std::uintptr_t last = (begin + count * sizeof(T)) & ~(kHugePage - 1);
  // Advice only: where it is refused, small pages serve.
  if (last > first) (void)madvise(reinterpret_cast<void*>(first), last - first, MADV_HUGEPAGE);
#endif
  buffer.resize(count);
}

/// Writes rows of the mesh. The sizes of all arrays are fixed beforehand, so bands of rows are independent.
class Weaver {
 public:
  Weaver(const TerrainParameters& parameters, const TerrainGrid& grid, TriangleMesh& mesh)
      : grid_(grid),
        mesh_(mesh),
        size_(parameters.size),
        surface_(parameters.seed, parameters.roughness, 1.0 / double(std::max(grid.columns, grid.rows))) {
    const HeightRange range = height_range(parameters.seed, parameters.roughness);
    lowest_ = range.lowest;
    scale_ = parameters.height / (double(range.highest) - range.lowest);
  }

  /// Vertex rows [begin, end), and the cells between each of them and the next row.
  void weave(std::int64_t begin, std::int64_t end) const {
    // Three rows of heights, each with one column more at both ends, roll along; what lies outside the square is the
    // same surface, so borders need no case of their own.
    const std::size_t width = std::size_t(grid_.columns) + 3;
    const std::size_t padded = (width + kBlock - 1) / kBlock * kBlock;
    std::vector<float> heights(3 * padded);
    float* below = heights.data();
    float* here = below + padded;
    float* above = here + padded;
    fill_row(begin - 1, below, padded);
    fill_row(begin, here, padded);
    for (std::int64_t row = begin; row < end; ++row) {
      fill_row(row + 1, above, padded);
      write_vertices(row, below, here, above);
      if (row < grid_.rows) write_corners(row, here, above);
      float* const oldest = below;
      below = here;
      here = above;
      above = oldest;
    }
  }

 private:
  /// Position along an edge, as a share of it, from the middle.
  static double share(std::int64_t index, std::int64_t cells) { return double(index) / double(cells) - 0.5; }

  void fill_row(std::int64_t row, float* heights, std::size_t padded) const {
    alignas(64) float x[kBlock], z[kBlock];
    std::fill(z, z + kBlock, float(share(row, grid_.rows)));
    const double step = 1.0 / double(grid_.columns);
    for (std::size_t start = 0; start < padded; start += kBlock) {
      const auto first = double(std::int64_t(start) - 1);
      for (int i = 0; i < kBlock; ++i) x[i] = float((first + i) * step - 0.5);
      surface_.evaluate(x, z, heights + start);
      for (int i = 0; i < kBlock; ++i)
        heights[start + std::size_t(i)] = float((double(heights[start + std::size_t(i)]) - lowest_) * scale_);
    }
  }

  void write_vertices(std::int64_t row, const float* below, const float* here, const float* above) const {
    const std::size_t first = std::size_t(row) * std::size_t(grid_.columns + 1);
    Vec3f* const positions = mesh_.positions.data() + first;
    Vec3f* const normals = mesh_.normals.data() + first;
    const auto z = float(share(row, grid_.rows) * size_);
    const double step = size_ / double(grid_.columns);
    const auto inverse_x = float(double(grid_.columns) / (2 * size_));
    const auto inverse_z = float(double(grid_.rows) / (2 * size_));
    for (std::int64_t i = 0; i <= grid_.columns; ++i) {
      positions[i] = Vec3f(float(double(i) * step - size_ / 2), here[i + 1], z);
      const float dx = (here[i + 2] - here[i]) * inverse_x, dz = (above[i + 1] - below[i + 1]) * inverse_z;
      const float inverse = 1 / std::sqrt(dx * dx + dz * dz + 1);
      normals[i] = Vec3f(-dx * inverse, inverse, -dz * inverse);
    }
  }

  void write_corners(std::int64_t row, const float* here, const float* above) const {
    std::uint32_t* corner = mesh_.corners.data() + 6 * std::size_t(row) * std::size_t(grid_.columns);
    const auto stride = std::uint32_t(grid_.columns + 1);
    auto a = std::uint32_t(row) * stride;  // of the cell a b / c d, with c and d one row further along z
    for (std::int64_t i = 0; i < grid_.columns; ++i, ++a, corner += 6) {
      const std::uint32_t b = a + 1, c = a + stride, d = c + 1;
      const bool along_ad = std::abs(here[i + 1] - above[i + 2]) <= std::abs(here[i + 2] - above[i + 1]);
      corner[0] = a;
      corner[1] = c;
      corner[2] = along_ad ? d : b;
      corner[3] = along_ad ? a : b;
      corner[4] = along_ad ? d : c;
      corner[5] = along_ad ? b : d;
    }
  }

  TerrainGrid grid_;
  TriangleMesh& mesh_;
  double size_;
  Surface surface_;
  double lowest_ = 0, scale_ = 1;
};

[[noreturn]] void refuse_terrain(const std::string& message) {
  throw Error(ErrorKind::bad_input, {"", 0, "terrain"}, message);
}

void check(const TerrainParameters& parameters) {
  // Beyond these, squares of lengths leave the range of floats somewhere between here and the image.
  constexpr double kLeastSize = 1e-12, kMostSize = 1e12;
  if (!(parameters.size >= kLeastSize && parameters.size <= kMostSize))
    refuse_terrain(fmt::format("size must be from {} to {}, not {}", kLeastSize, kMostSize, parameters.size));
  if (!(parameters.height >= 0 && parameters.height <= kMostSize))
    refuse_terrain(fmt::format("height must be from 0 to {}, not {}", kMostSize, parameters.height));
  if (!(parameters.roughness > 0 && parameters.roughness < 1))
    refuse_terrain(fmt::format("roughness must be between 0 and 1, not {}", parameters.roughness));
}

}  // namespace

TerrainGrid terrain_grid(std::int64_t triangles) {
  if (triangles < kLeastTerrainTriangles || triangles > kMostTerrainTriangles)
    refuse_terrain(fmt::format("triangles must be from {} to {}, not {}", kLeastTerrainTriangles, kMostTerrainTriangles,
                               triangles));
  TerrainGrid best;
  std::int64_t best_miss = std::numeric_limits<std::int64_t>::max();
  const auto square = std::int64_t(std::ceil(std::sqrt(double(triangles) / 2))) + 1;
  for (std::int64_t rows = square; rows >= 1; --rows) {
    const std::int64_t most = std::max(rows + 1, rows * 105 / 100);
    if (2 * rows * most < triangles - best_miss) break;  // and every smaller number of rows misses by more
    const std::int64_t nearest = triangles / (2 * rows);
    for (const std::int64_t wished : {nearest, nearest + 1}) {
      const std::int64_t columns = std::clamp(wished, rows, most);
      const std::int64_t miss = std::abs(2 * rows * columns - triangles);
      if (miss < best_miss) {
        best_miss = miss;
        best = {columns, rows};
      }
    }
  }
  return best;
}

TriangleMesh make_terrain(const TerrainParameters& parameters) {
  const TerrainGrid grid = terrain_grid(parameters.triangles);
  check(parameters);
  TriangleMesh mesh;
  const auto vertices = std::size_t(grid.vertex_count());
  allocate(mesh.positions, vertices);
  allocate(mesh.normals, vertices);
  allocate(mesh.corners, 3 * std::size_t(grid.triangle_count()));
  const Weaver weaver(parameters, grid, mesh);
  // Bands of a fixed number of rows: two rows of each are evaluated twice, 4 % here.
  constexpr std::int64_t kBandRows = 48;
  const std::int64_t bands = (grid.rows + kBandRows) / kBandRows;
  tbb::parallel_for(std::int64_t(0), bands, [&](std::int64_t band) {
    weaver.weave(band * kBandRows, std::min((band + 1) * kBandRows, grid.rows + 1));
  });
  return mesh;
}

}  // namespace raytree
