// The samples that a level of adaptive division makes, by their place on the lattice of half squares.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace raytree {

/// A map from lattice places to samples. Where most places of the level may be asked for it is an array of them, else
/// open addressing.
class SampleLattice {
 public:
  static constexpr std::uint32_t kNoSample = ~0u;

  /// Empty, for places whose coordinates are multiples of `step`, a power of two, from 0 to step * count, of which at
  /// most `most` are taken.
  void begin(unsigned step, std::size_t count, std::size_t most) {
    shift_ = static_cast<unsigned>(std::countr_zero(step));
    stride_ = count + 1;
    const std::size_t slots = std::bit_ceil(2 * most + 1);
    whole_ = stride_ * stride_ <= slots;
    samples_.assign(whole_ ? stride_ * stride_ : slots, kNoSample);
    if (!whole_) places_.resize(slots);
  }

  /// The sample at a place, or kNoSample.
  std::uint32_t find(int x, int y) const { return samples_[slot_of(x, y)]; }

  /// The sample at a place; where there is none, the one that make() returns.
  template <class Make>
  std::uint32_t at(int x, int y, Make&& make) {
    const std::size_t slot = slot_of(x, y);
    if (samples_[slot] == kNoSample) {
      samples_[slot] = make();
      if (!whole_) places_[slot] = place_of(x, y);
    }
    return samples_[slot];
  }

 private:
  /// Both coordinates up to 2^16.
  static std::uint32_t place_of(int x, int y) {
    return static_cast<std::uint32_t>(y) << 16 | static_cast<std::uint32_t>(x);
  }

  /// The slot of a place, or the one that it would take.
  std::size_t slot_of(int x, int y) const {
    if (whole_) return (static_cast<std::size_t>(y) >> shift_) * stride_ + (static_cast<std::size_t>(x) >> shift_);
    const std::uint32_t place = place_of(x, y);
    const std::size_t mask = samples_.size() - 1;
    std::size_t i = (place * 0x9E3779B1u >> 8) & mask;
    while (samples_[i] != kNoSample && places_[i] != place) i = (i + 1) & mask;
    return i;
  }

  bool whole_ = true;
  unsigned shift_ = 0;
  std::size_t stride_ = 0;
  std::vector<std::uint32_t> samples_, places_;
};

}  // namespace raytree
