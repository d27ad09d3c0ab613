// Shading of a batch's hits, a register of them at a time: normals turned to the ray, what lights and children need of
// directions. Bit for bit what shading.h yields one by one; weights and colors, which differ from hit to hit, are left
// to its functions.
#pragma once

#include <cstddef>
#include <cstdint>

#include "geometry/surface_batch.h"
#include "renderer/color.h"
#include "renderer/light.h"
#include "renderer/material.h"
#include "renderer/shading.h"

namespace raytree {

/// Everything stands at the index of its ray; where a ray missed, nothing is defined. Arrays lie at fixed places, so
/// that one register reaches all of them: it is made on the heap.
class ShadingBatch {
  static constexpr std::size_t kSize = Vec3Array::kSize;

 public:
  SurfaceBatch surfaces = {};                     ///< after turn_to_rays(), normals turned to the ray's side
  const Material* materials[kSize] = {};          ///< set by set_material()
  alignas(32) std::uint32_t leaving[kSize] = {};  ///< 1: the ray hit the surface from behind, 0: from before

  /// Turns normals to the rays' side, which geometric normals decide, and notes which rays leave.
  void turn_to_rays(const RayBatch& rays);
  void set_material(std::size_t i, const Material& material) {
    materials[i] = &material;
    diffuse_[i] = material.diffuse.even;
    eta_[i] = leaving[i] ? material.index : material.inverse_index;
    relative_index_[i] = leaving[i] ? material.inverse_index : material.index;
  }
  const Rgb& diffuse(std::size_t i) const { return diffuse_[i]; }  ///< k_d there

  /// One hit by itself, and back after its diffuse color or its shading normal changed.
  ShadingPoint point(const RayBatch& rays, std::size_t i) const;
  void set_varied(std::size_t i, const ShadingPoint& point);
  void set_diffuse(std::size_t i, const Rgb& diffuse) { diffuse_[i] = diffuse; }

  /// What samples look at through `window`, of the block from `first` on.
  SampleLanes samples(const RayBatch& rays, const SampleWindow& window, std::size_t first) const;

  /// How `light` stands to every hit; then for one of them.
  void meet(const RayBatch& rays, const Light& light, HighlightForm form);
  LightMeeting meeting(std::size_t i) const {
    return {light_direction_[i], light_distance_[i], light_cosine_[i], light_highlight_[i], before_light_[i] != 0};
  }
  bool is_before_light(std::size_t i) const { return before_light_[i] != 0; }

  /// R and P at every hit, where it separates its material's inside from empty space; then plain_branches() of one.
  void branch(const RayBatch& rays);
  Branches branches(std::size_t i) const {
    return weighted_branches(*materials[i], reflected_[i], {refracted_[i], reflectance_[i], refracts_[i] != 0});
  }

 private:
  void face(const Light& light, std::size_t first);
  template <HighlightForm form>
  void meet_block(const RayBatch& rays, std::size_t first);

  Rgb diffuse_[kSize] = {};
  alignas(32) float eta_[kSize] = {};
  float relative_index_[kSize] = {};
  Vec3Array light_direction_ = {};
  float light_distance_[kSize] = {}, light_cosine_[kSize] = {}, light_highlight_[kSize] = {};
  std::uint32_t before_light_[kSize] = {};
  Vec3Array reflected_ = {}, refracted_ = {};
  float reflectance_[kSize] = {};
  std::uint32_t refracts_[kSize] = {};
};

/// In which cells of their materials' checkers a batch's hits lie: found block by block, when the first of a block is
/// asked for. What it is made of must outlive it.
class CheckerCells {
 public:
  CheckerCells(const ShadingBatch& shading, const RayBatch& rays, const SampleWindow& window)
      : shading_(shading), rays_(rays), window_(window) {}

  /// 1, -1 or 0, as Pattern::find_cells() has it, of a hit whose material is in_cells.
  std::int32_t at(std::size_t i) {
    const std::size_t first = i / kLanes * kLanes;
    if (first != first_ || shading_.materials[i] != material_) {
      first_ = first, material_ = shading_.materials[i];
      material_->diffuse.find_cells(shading_.samples(rays_, window_, first), cells_);
    }
    return cells_[i - first];
  }

 private:
  const ShadingBatch& shading_;
  const RayBatch& rays_;
  const SampleWindow& window_;
  std::size_t first_ = 0;
  const Material* material_ = nullptr;  ///< that cells_ are of; null: none yet
  std::int32_t cells_[kLanes] = {};
};

}  // namespace raytree
