// Loading: how fast the readers of OBJ and PLY are, and how much memory they take at their peak over the arrays that
// they return. Writes a mesh of about a million triangles in four formats into a temporary folder, reads each several
// times and prints a table, or JSON that `./run measure loading` reads. Exit status 3 when a row of the table falls
// short of its bound, 1 when a mesh comes back wrong.
// Usage: loading_benchmark [REPETITIONS | --json]
#include <malloc.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <new>
#include <string>
#include <thread>
#include <vector>

#include "benchmarks/row_bounds.h"
#include "benchmarks/scratch_folder.h"
#include "geometry/mesh_file.h"
#include "geometry/stopwatch.h"
#include "geometry/vertex_normals.h"

namespace {

// Bytes that the program holds, and their peak: every allocation passes through the operators below.
std::atomic<std::size_t> held_bytes{0};
std::atomic<std::size_t> peak_bytes{0};

void* counted(void* block) {
  if (!block) throw std::bad_alloc();
  const std::size_t now = held_bytes += malloc_usable_size(block);
  std::size_t peak = peak_bytes;
  while (now > peak && !peak_bytes.compare_exchange_weak(peak, now)) {
  }
  return block;
}

void release(void* block) noexcept {
  if (block) held_bytes -= malloc_usable_size(block);
  std::free(block);
}

}  // namespace

void* operator new(std::size_t size) { return counted(std::malloc(std::max<std::size_t>(size, 1))); }
void* operator new(std::size_t size, std::align_val_t alignment) {
  const auto unit = static_cast<std::size_t>(alignment);
  return counted(std::aligned_alloc(unit, (std::max<std::size_t>(size, 1) + unit - 1) / unit * unit));
}
void operator delete(void* block) noexcept { release(block); }
void operator delete(void* block, std::size_t) noexcept { release(block); }
void operator delete(void* block, std::align_val_t) noexcept { release(block); }
void operator delete(void* block, std::size_t, std::align_val_t) noexcept { release(block); }

namespace raytree {
namespace {

constexpr std::size_t kSide = 708;  // vertices along a side: 2 x 707^2 triangles

PolygonMesh waves() {
  PolygonMesh mesh;
  for (std::size_t i = 0; i < kSide; ++i)
    for (std::size_t k = 0; k < kSide; ++k) {
      const double x = double(k) / kSide - 0.5, z = double(i) / kSide - 0.5;
      mesh.positions.push_back(Vec3f(Vec3d(x, 0.05 * std::sin(40 * x) * std::cos(31 * z), z)));
    }
  for (std::size_t i = 0; i + 1 < kSide; ++i)
    for (std::size_t k = 0; k + 1 < kSide; ++k) {
      const auto at = static_cast<std::uint32_t>(i * kSide + k);
      const auto below = static_cast<std::uint32_t>(at + kSide);
      mesh.corners.insert(mesh.corners.end(), {at, below, at + 1, at + 1, below, below + 1});
    }
  return mesh;
}

template <class T>
void put_binary(std::string& out, T value, bool swap) {
  char raw[sizeof(T)];
  std::memcpy(raw, &value, sizeof(T));
  if (swap) std::reverse(raw, raw + sizeof(T));
  out.append(raw, sizeof(T));
}

void put_text(std::string& out, auto value, char after) {
  char text[64];
  const auto end = std::to_chars(text, text + sizeof text, value).ptr;
  out.append(text, end);
  out += after;
}

enum class Kind { ply_little, ply_big, ply_ascii, obj };

std::string file_bytes(const PolygonMesh& mesh, Kind kind) {
  std::string out;
  if (kind != Kind::obj) {
    const char* const formats[] = {"binary_little_endian", "binary_big_endian", "ascii"};
    out = std::string("ply\nformat ") + formats[static_cast<int>(kind)] + " 1.0\nelement vertex " +
          std::to_string(mesh.positions.size()) +
          "\nproperty float x\nproperty float y\nproperty float z\nelement face " + std::to_string(mesh.face_count()) +
          "\nproperty list uchar int vertex_indices\nend_header\n";
  }
  const bool is_text = kind == Kind::obj || kind == Kind::ply_ascii;
  for (const Vec3f& p : mesh.positions)
    if (is_text) {
      if (kind == Kind::obj) out += "v ";
      put_text(out, p.x, ' ');
      put_text(out, p.y, ' ');
      put_text(out, p.z, '\n');
    } else {
      for (const float c : {p.x, p.y, p.z}) put_binary(out, c, kind == Kind::ply_big);
    }
  for (std::size_t f = 0; f < mesh.corners.size(); f += 3)
    if (is_text) {
      out += kind == Kind::obj ? "f " : "3 ";
      for (std::size_t k = 0; k < 3; ++k)
        put_text(out, mesh.corners[f + k] + (kind == Kind::obj ? 1u : 0u), k == 2 ? '\n' : ' ');
    } else {
      out += '\3';
      for (std::size_t k = 0; k < 3; ++k) put_binary(out, mesh.corners[f + k], kind == Kind::ply_big);
    }
  return out;
}

struct Row {
  const char* name;
  const char* file;
  Kind kind;
  double least_speed;  // MB/s, 0: no bound
};

/// Samples as one object of the JSON array that `./run measure loading` reads.
void print_json(bool first, const std::string& what, const char* unit, const std::vector<double>& samples,
                const char* bound_name, double bound) {
  std::printf("%s{\"what\": \"%s\", \"unit\": \"%s\", \"%s\": %g, \"samples\": [", first ? "[" : ",\n ", what.c_str(),
              unit, bound_name, bound);
  for (std::size_t i = 0; i < samples.size(); ++i) std::printf("%s%g", i == 0 ? "" : ", ", samples[i]);
  std::printf("]}");
}

int run(int repetitions, bool json) {
  const Row rows[] = {{"PLY binary, little-endian", "little.ply", Kind::ply_little, benchmarks::kLeastPlySpeed},
                      {"PLY binary, big-endian", "big.ply", Kind::ply_big, benchmarks::kLeastPlySpeed},
                      {"PLY ascii", "ascii.ply", Kind::ply_ascii, 0},
                      {"OBJ", "waves.obj", Kind::obj, benchmarks::kLeastObjSpeed}};
  const PolygonMesh mesh = waves();
  const benchmarks::ScratchFolder folder;
  if (!json) {
    std::printf("%zu triangles, %u hardware threads, best of %d\n", mesh.face_count(),
                std::thread::hardware_concurrency(), repetitions);
    std::printf("%-28s %8s %9s %9s %9s  %s\n", "file", "MB", "ms", "MB/s", "peak/kept", "bounds");
  }
  bool short_of = false;
  for (const Row& row : rows) {
    const std::string path = (folder.path() / row.file).string();
    {
      const std::string bytes = file_bytes(mesh, row.kind);
      std::ofstream(path, std::ios::binary) << bytes;
    }
    const double megabytes = static_cast<double>(std::filesystem::file_size(path)) * 1e-6;
    double best = 1e9, ratio = 0;
    std::vector<double> speeds;
    for (int i = 0; i < repetitions; ++i) {
      Warnings warnings;
      const std::size_t before = held_bytes;
      peak_bytes = before;
      const auto start = Clock::now();
      const PolygonMesh read = read_mesh_file(path, warnings);
      const double seconds = seconds_since(start);
      best = std::min(best, seconds);
      speeds.push_back(megabytes / seconds);
      ratio = std::max(ratio, static_cast<double>(peak_bytes - before) / static_cast<double>(memory_bytes(read)));
      // Shortest decimal notation gives every float back: the mesh must come back in bits.
      if (read.corners != mesh.corners || read.positions != mesh.positions || !warnings.empty()) {
        std::fprintf(stderr, "%s: the mesh came back wrong\n", row.name);
        return 1;
      }
    }
    if (json) {
      const std::string name = std::string("reading ") + row.name + ", 1M triangles";
      print_json(&row == rows, name, "MB/s", speeds, "at_least", row.least_speed);
      print_json(false, name + ": peak memory / arrays kept", "", {ratio}, "at_most", benchmarks::kMostLoadingMemory);
      continue;
    }
    const double speed = megabytes / best;
    const bool good = speed >= row.least_speed && ratio <= benchmarks::kMostLoadingMemory;
    short_of = short_of || !good;
    std::printf("%-28s %8.1f %9.1f %9.0f %9.2f  >= %.0f MB/s, <= %.1f: %s\n", row.name, megabytes, best * 1e3, speed,
                ratio, row.least_speed, benchmarks::kMostLoadingMemory, good ? "ok" : "SHORT");
  }
  if (json) {
    std::printf("]\n");
    return 0;
  }
  // What follows loading, for the same mesh; no bounds of its own beyond the goal for normals.
  constexpr double kMostNormalSeconds = 0.3;
  for (const double crease : {3.2, 0.7}) {
    double best = 1e9;
    std::size_t peak = 0;
    PolygonMesh copy = mesh;
    for (int i = 0; i < repetitions; ++i) {
      copy.normals = {};
      copy.normal_corners = {};
      const std::size_t before = held_bytes;
      peak_bytes = before;
      const auto start = Clock::now();
      compute_vertex_normals(copy, crease);
      best = std::min(best, seconds_since(start));
      peak = peak_bytes - before;
    }
    const bool good = best <= kMostNormalSeconds;
    short_of = short_of || !good;
    std::printf("%-28s %8s %9.1f %9s %9.2f  <= %.0f ms: %s\n",
                crease > 3.15 ? "vertex normals, smooth" : "vertex normals, crease", "", best * 1e3, "",
                static_cast<double>(peak) / static_cast<double>(memory_bytes(mesh)), kMostNormalSeconds * 1e3,
                good ? "ok" : "SHORT");
  }
  return short_of ? 3 : 0;
}

}  // namespace
}  // namespace raytree

int main(int count, char** arguments) {
  try {
    const bool json = count > 1 && std::strcmp(arguments[1], "--json") == 0;
    return raytree::run(count > 1 && !json ? std::max(1, std::atoi(arguments[1])) : 7, json);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "loading_benchmark: %s\n", error.what());
    return 1;
  }
}
