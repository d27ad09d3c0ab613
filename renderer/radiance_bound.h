// How bright a branch of the ray tree can be at most: what the cutoff's promise rests on.
#pragma once

#include <span>
#include <vector>

#include "renderer/background.h"
#include "renderer/color.h"
#include "renderer/light.h"
#include "renderer/material.h"

namespace raytree {

/// B[-1] = 0, B[k] = max(background, max over materials (E_m + rho_m B[k-1])): the most that a ray with k levels below
/// it can bring, per channel. rho_m: largest k_s + k_t over angle; E_m: ambient + sum of lights times (k_d + W). Holds
/// when all inputs are >= 0.
class RadianceBound {
 public:
  RadianceBound() = default;
  RadianceBound(std::span<const Material> materials, std::span<const Light> lights, const BackgroundLight& background,
                Rgb ambient, int depth);

  /// Bound for a ray that may still have `levels_below` levels behind its hit; negative: 0. The largest
  /// float where there is no bound.
  Rgb operator()(int levels_below) const {
    if (levels_below < 0) return Rgb();
    const auto k = static_cast<std::size_t>(levels_below);
    return k < table_.size() ? table_[k] : limit_;
  }

 private:
  std::vector<Rgb> table_;
  Rgb limit_;  ///< of the recurrence; the largest float where rho >= 1
};

}  // namespace raytree
