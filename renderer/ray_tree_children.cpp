// The reflected and refracted rays that a batch's points spawn, and what of them is cut.
#include <algorithm>

#include "renderer/ray_tree_state.h"

namespace raytree {
namespace {

/// What the two children of a hit may cut off below them, and which of them is itself cut.
struct Shares {
  float reflected, refracted;
  bool cuts_reflected, cuts_refracted;
};

/// Divides a ray's allowance over its children, whose bounds are given (0: no such child). The child with the smaller
/// bound is judged first, and what it leaves of its half passes to the other; so the cuts below a ray never exceed its
/// allowance. An absent child takes nothing, since its bound is 0 and leaves all.
inline Shares divided_allowance(float allowance, float reflected_bound, float refracted_bound) {
  const bool reflected_first = reflected_bound <= refracted_bound;
  const float smaller = reflected_first ? reflected_bound : refracted_bound;
  const float larger = reflected_first ? refracted_bound : reflected_bound;
  const float half = allowance / 2;
  const bool cuts_smaller = smaller <= half;
  const float rest = cuts_smaller ? allowance - smaller : half;
  const bool cuts_larger = larger <= rest;
  if (reflected_first) return {half, rest, cuts_smaller, cuts_larger};
  return {rest, half, cuts_larger, cuts_smaller};
}

}  // namespace

[[gnu::noinline]] void SampleTracer::State::bend_normals() {
  for (const std::uint32_t i : batch_points()) {
    ShadingPoint point = shading_point(i);
    facets->bend(i, point);
    shading.surfaces.shading_normal.set(i, point.surface.shading_normal);
  }
}

void SampleTracer::State::spawn() {
  if (shades_facets()) bend_normals();
  std::uint64_t branches_at_limit = 0;
  bool has_branched = false;
  for (const std::uint32_t i : batch_points()) {
    const Material& material = *shading.materials[i];
    if (!material.has_reflection && !material.has_transmission) continue;
    if ((kFeatures.special_optics || kFeatures.media || kFeatures.rough_surfaces) && material.special_optics) {
      branches_at_limit += spawn_specially(i);
    } else {
      if (!has_branched) shading.branch(rays);
      has_branched = true;
      float share = batch.allowance[i];
      branches_at_limit += spawn_children(i, shading.branches(i), share, kNoMedia, kNoMedia, new_rays);
    }
  }
  statistics.branches_at_depth_limit += branches_at_limit;
}

/// Out of the way of what most scenes are made of.
[[gnu::noinline]] unsigned SampleTracer::State::spawn_specially(std::size_t i) {
  const ShadingPoint point = shading_point(i);
  float share = batch.allowance[i];
  if (tracks_media()) {
    const MediaBoundary& boundary = boundaries[i];
    if (tracks_paths()) return spawn_on_path(i, point, boundary.relative_index, boundary.before, boundary.after);
    return spawn_children(i, branches_between(point, boundary.relative_index), share, boundary.before, boundary.after,
                          new_rays);
  }
  if (tracks_paths()) return spawn_on_path(i, point, plain_relative_index(point), kNoMedia, kNoMedia);
  return spawn_children(i, branches(point), share, kNoMedia, kNoMedia, new_rays);
}

/// In a scene with rough surfaces. The first rough point on a way down the tree is met by rough_samples facets, each of
/// which has an equal part of the ray's weight and of its allowance, and what one leaves of its part passes to the
/// others; so what is cut below the ray stays within its allowance. Later ones are met by one facet.
unsigned SampleTracer::State::spawn_on_path(std::size_t i, const ShadingPoint& point, float relative_index,
                                            MediaId before, MediaId after) {
  const TreePath path = this->path(i);
  const bool rough = point.material->rough, splits = rough && !path.is_split;
  const std::uint32_t samples = static_cast<std::uint32_t>(settings.rough_samples), count = splits ? samples : 1;
  const float share = 1 / static_cast<float>(count);
  NewRays& out = rough || path.is_split ? split_rays : new_rays;
  float rest = batch.allowance[i];
  unsigned at_limit = 0;
  for (std::uint32_t k = 0; k < count; ++k) {
    const std::uint32_t index = splits ? k : path.index;
    Branches children = rough ? rough_branches(point, relative_index, path.key, index, samples)
                              : branches_between(point, relative_index);
    children.reflected_weight *= share;
    children.refracted_weight *= share;
    float part = rest / static_cast<float>(count - k);
    rest -= part;
    at_limit += spawn_children(i, children, part, before, after, out);
    rest += part;
    TreePath own = path;
    own.index = static_cast<std::uint16_t>(index);
    own.is_split |= rough;
    if (out.reflected_paths.size() < out.reflected.size()) out.reflected_paths.push_back(own.child(false));
    if (out.refracted_paths.size() < out.refracted.size()) out.refracted_paths.push_back(own.child(true));
  }
  return at_limit;
}

/// `share`: what may be cut below the two children; what they leave of it is left. `before`, `after`: the media that
/// the reflected and the refracted ray are in. Returns how many branches the tree's depth ended.
[[gnu::always_inline]] inline unsigned SampleTracer::State::spawn_children(std::size_t i, const Branches& children,
                                                                           float& share, MediaId before, MediaId after,
                                                                           NewRays& out) {
  const Rgb own_weight = batch.weight(i);
  const Rgb reflected_weight = own_weight * children.reflected_weight;
  const Rgb refracted_weight = own_weight * children.refracted_weight;
  const bool reflects = !is_black(reflected_weight), refracts = !is_black(refracted_weight);
  const std::uint32_t own_level = batch.level[i];
  if (static_cast<int>(own_level) >= settings.depth) return unsigned(reflects) + unsigned(refracts);
  const Rgb below = scene.bound(settings.depth - static_cast<int>(own_level) - 1);
  const Rgb reflected_bound = reflected_weight * below, refracted_bound = refracted_weight * below;
  const Shares shares = divided_allowance(share, max_channel(reflected_bound), max_channel(refracted_bound));
  // Unless both are cut, one of them takes all that the other leaves.
  share = shares.cuts_reflected && shares.cuts_refracted
              ? std::max(0.0f, share - max_channel(reflected_bound) - max_channel(refracted_bound))
              : 0.0f;
  if (reflects) {
    if (shares.cuts_reflected)
      cut(batch.sample[i], reflected_bound);
    else
      out.reflected.push(child_origin(i, false), children.reflected,
                         {reflected_weight, shares.reflected, own_level + 1, batch.sample[i], before});
  }
  if (refracts) {
    if (shares.cuts_refracted)
      cut(batch.sample[i], refracted_bound);
    else
      out.refracted.push(child_origin(i, true), children.refracted,
                         {refracted_weight, shares.refracted, own_level + 1, batch.sample[i], after});
  }
  return 0;
}

void SampleTracer::State::cut(std::uint32_t sample, const Rgb& bound) {
  if (kFeatures.truncation_channel && records.truncation) results.truncation[sample] += bound;
  ++statistics.branches_cut;
}

}  // namespace raytree
