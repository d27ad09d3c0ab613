// The limit patches of all faces for one kind of value: positions (three floats) or texture coordinates (two). Regular
// patches are evaluated here, as uniform bicubic B-splines, also at boundaries and infinitely sharp creases; all others
// by Bfr. Included by subdivision_surface.cpp.
#pragma once

#include <opensubdiv/bfr/refinerSurfaceFactory.h>
#include <opensubdiv/bfr/surface.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <mutex>
#include <optional>
#include <shared_mutex>
#include <vector>

#include "geometry/bicubic_spline.h"
#include "geometry/osd_topology.h"
#include "geometry/vec.h"

namespace raytree {

/// Threads that make patches share the irregular ones.
using PatchCache = osd::Bfr::SurfaceFactoryCacheThreaded<std::shared_mutex, std::shared_lock<std::shared_mutex>,
                                                         std::unique_lock<std::shared_mutex>>;
using PatchFactory = osd::Bfr::RefinerSurfaceFactory<PatchCache>;

/// Values at one parameter; each padded to four floats.
struct PatchValues {
  alignas(16) std::array<float, 4> value, du, dv, duu, duv, dvv;
};

template <int kWidth>
class FacePatches {
 public:
  using Surface = osd::Bfr::Surface<float>;

  /// values: [count][kWidth], kept. channel: of the face-varying values, -1 for vertices.
  FacePatches(const PatchFactory& factory, std::size_t face_count, std::vector<float>&& values, int channel,
              std::size_t point_budget)
      : values_(std::move(values)), face_slots_(face_count, kNone), chunks_((face_count + kChunk - 1) / kChunk) {
    tbb::parallel_for(std::size_t(0), chunks_.size(), [&](std::size_t c) {
      Surface surface;
      const std::size_t end = std::min(face_count, (c + 1) * kChunk);
      for (std::size_t face = c * kChunk; face < end; ++face) {
        const int index = static_cast<int>(face);
        if (!factory.FaceHasLimitSurface(index)) continue;
        const bool made = channel < 0 ? factory.InitVertexSurface(index, &surface)
                                      : factory.InitFaceVaryingSurface(index, &surface, channel);
        if (made) face_slots_[face] = chunks_[c].add(surface);
      }
    });
    // Kept in the order of faces, as long as the budget lasts.
    for (Chunk& chunk : chunks_) {
      std::size_t floats = 0;
      for (const Surface& surface : chunk.general) {
        chunk.first_points.push_back(floats);
        floats += static_cast<std::size_t>(surface.GetNumPatchPoints()) * kWidth;
      }
      chunk.keeps_points = floats * sizeof(float) <= point_budget;
      if (!chunk.keeps_points) continue;
      point_budget -= floats * sizeof(float);
      chunk.points.resize(floats);
    }
    tbb::parallel_for(std::size_t(0), chunks_.size(), [&](std::size_t c) {
      Chunk& chunk = chunks_[c];
      for (std::size_t i = 0; i < chunk.general.size() && chunk.keeps_points; ++i)
        prepare_points(chunk.general[i], chunk.points.data() + chunk.first_points[i]);
    });
  }

  bool has_surface(std::size_t face) const { return face_slots_[face] != kNone; }

  /// Of a regular face: for BicubicControl. False for all others.
  bool regular_control(std::size_t face, BicubicControl& control) const {
    const std::uint16_t slot = face_slots_[face];
    if (slot >= kGeneral) return false;
    const RegularPatch& regular = chunks_[face / kChunk].regular[slot];
    for (std::size_t i = 0; i < 16; ++i) {
      const float* const value = &values_[static_cast<std::size_t>(regular.indices[i]) * kWidth];
      for (std::size_t k = 0; k < 4; ++k) control[4 * i + k] = k < kWidth ? value[k] : 0.0f;
    }
    if (regular.sides != 0) end_at_sides(control, regular.sides);
    return true;
  }

  /// One face made ready: its own control points in a row.
  struct Patch {
    const Surface* surface = nullptr;    ///< null: regular
    const float* points = nullptr;       ///< of the surface, [..][kWidth]
    float scale = 0;                     ///< largest distance along an axis from the first control point to another one
    alignas(16) BicubicControl control;  ///< regular
  };

  /// `scratch` holds points that are not kept; it must outlive the patch. The face must have a surface.
  void prepare(std::size_t face, Patch& patch, std::vector<float>& scratch) const {
    const Chunk& chunk = chunks_[face / kChunk];
    const std::uint16_t slot = face_slots_[face];
    if (regular_control(face, patch.control)) {
      patch.surface = nullptr;
      patch.scale = extent(patch.control.data(), 16, 4);
      return;
    }
    const std::size_t index = slot - kGeneral;
    patch.surface = &chunk.general[index];
    if (chunk.keeps_points) {
      patch.points = chunk.points.data() + chunk.first_points[index];
    } else {
      scratch.resize(static_cast<std::size_t>(patch.surface->GetNumPatchPoints()) * kWidth);
      prepare_points(*patch.surface, scratch.data());
      patch.points = scratch.data();
    }
    patch.scale = extent(patch.points, static_cast<std::size_t>(patch.surface->GetNumControlPoints()), kWidth);
  }

  static void evaluate_value(const Patch& patch, const Vec2f& at, PatchValues& out) {
    if (patch.surface != nullptr) {
      patch.surface->Evaluate(&at.x, patch.points, kWidth, out.value.data());
      return;
    }
    const CubicWeights u(at.x), v(at.y);
    out.value = weighted_sum(patch.control, u.value, v.value);
  }

  /// Value and first derivatives.
  static void evaluate_first(const Patch& patch, const Vec2f& at, PatchValues& out) {
    if (patch.surface != nullptr) {
      patch.surface->Evaluate(&at.x, patch.points, kWidth, out.value.data(), out.du.data(), out.dv.data());
      return;
    }
    const CubicWeights u(at.x), v(at.y);
    std::array<float, 4> value{}, du{}, dv{};
    for (std::size_t row = 0; row < 4; ++row) {
      std::array<float, 4> along, slope;
      const float* const c = &patch.control[16 * row];
      for (std::size_t k = 0; k < 4; ++k) {
        along[k] = u.value[0] * c[k] + u.value[1] * c[4 + k] + u.value[2] * c[8 + k] + u.value[3] * c[12 + k];
        slope[k] = u.first[0] * c[k] + u.first[1] * c[4 + k] + u.first[2] * c[8 + k] + u.first[3] * c[12 + k];
      }
      for (std::size_t k = 0; k < 4; ++k) {
        value[k] += v.value[row] * along[k];
        du[k] += v.value[row] * slope[k];
        dv[k] += v.first[row] * along[k];
      }
    }
    out.value = value, out.du = du, out.dv = dv;
  }

  /// All of it.
  static void evaluate_second(const Patch& patch, const Vec2f& at, PatchValues& out) {
    if (patch.surface != nullptr) {
      patch.surface->Evaluate(&at.x, patch.points, kWidth, out.value.data(), out.du.data(), out.dv.data(),
                              out.duu.data(), out.duv.data(), out.dvv.data());
      return;
    }
    const CubicWeights u(at.x), v(at.y);
    evaluate_first(patch, at, out);
    out.duu = weighted_sum(patch.control, u.second, v.value);
    out.duv = weighted_sum(patch.control, u.first, v.first);
    out.dvv = weighted_sum(patch.control, u.value, v.second);
  }

 private:
  static constexpr std::size_t kChunk = 1024;                        // faces that one task prepares
  static constexpr std::uint16_t kNone = 0xffff, kGeneral = kChunk;  // slots below kGeneral are regular

  struct RegularPatch {
    std::array<int, 16> indices;
    std::uint8_t sides = 0;  ///< for end_at_sides()
  };

  struct Chunk {
    std::vector<RegularPatch> regular;
    std::vector<Surface> general;
    std::vector<std::size_t> first_points;
    std::vector<float> points;
    bool keeps_points = false;

    std::uint16_t add(const Surface& surface) {
      if (const std::optional<std::uint8_t> sides = bicubic_sides(surface)) {
        RegularPatch& patch = regular.emplace_back();
        surface.GetControlPointIndices(patch.indices.data());
        patch.sides = *sides;
        return static_cast<std::uint16_t>(regular.size() - 1);
      }
      general.push_back(surface);
      return static_cast<std::uint16_t>(kGeneral + general.size() - 1);
    }
  };

  /// For which end_at_sides() makes the surface a bicubic B-spline; nothing: it is not one. Bfr does not say, so one
  /// point over control points without any pattern is compared with what each set of sides makes of them.
  static std::optional<std::uint8_t> bicubic_sides(const Surface& surface) {
    if (!surface.IsRegular() || surface.GetNumControlPoints() != 16) return std::nullopt;
    static constexpr float kAt[2] = {0.3f, 0.4f};
    struct Trial {
      std::array<float, 16> points;
      std::array<float, kSideSets> expected;
      Trial() {
        for (std::size_t i = 0; i < 16; ++i) points[i] = static_cast<float>((4 * i * i + 23 * i) % 31);
        for (std::size_t sides = 0; sides < kSideSets; ++sides) {
          BicubicControl control{};
          for (std::size_t i = 0; i < 16; ++i) control[4 * i] = points[i];
          end_at_sides(control, static_cast<std::uint8_t>(sides));
          expected[sides] = weighted_sum(control, CubicWeights(kAt[0]).value, CubicWeights(kAt[1]).value)[0];
        }
      }
    };
    static const Trial trial;
    float found = 0;
    surface.Evaluate(kAt, trial.points.data(), 1, &found);
    for (std::size_t sides = 0; sides < kSideSets; ++sides)
      if (std::abs(found - trial.expected[sides]) < kSame) return static_cast<std::uint8_t>(sides);
    return std::nullopt;
  }
  /// Roundings of sums of 16 numbers up to 31 differ by some 1e-5, those of two sets of sides by more than 0.1.
  static constexpr float kSame = 1e-3f;

  void prepare_points(const Surface& surface, float* points) const {
    surface.PreparePatchPoints(values_.data(), kWidth, points, kWidth);
  }

  static float extent(const float* points, std::size_t count, std::size_t stride) {
    float result = 0;
    for (std::size_t i = 1; i < count; ++i)
      for (std::size_t k = 0; k < kWidth; ++k) result = std::max(result, std::abs(points[i * stride + k] - points[k]));
    return result;
  }

  std::vector<float> values_;
  std::vector<std::uint16_t> face_slots_;  // within the face's chunk
  std::vector<Chunk> chunks_;
};

}  // namespace raytree
