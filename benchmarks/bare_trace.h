// The bare replay of a record on threads: the time that Embree alone takes for a picture's rays.
#pragma once

#include <string>

#include "geometry/embree_replay.h"

namespace raytree::benchmarks {

/// One pass over the record. Time inside the calls is summed over threads; divided by their number it is the wall time
/// of a pass whose threads wait for nothing but Embree.
ReplayTally replay_pass(const BareReplay& replay, const ReplayCalls& calls, int threads);

/// The fastest call for each class on so many threads, by the best of a few passes each.
ReplayCalls best_calls(const BareReplay& replay, int threads);

/// e.g. "eye rays by coherent packets, ...", for the classes that the record holds.
std::string calls_text(const ReplayCalls& calls, const RayRecord& record);

/// Empty where replay and record agree on how many rays hit, else what differs. Packets of other neighbors, or single
/// rays, may differ by rays that pass within rounding of an edge: robust mode lets one in a million through, and one
/// in ten thousand is allowed, since the rays of a picture meet silhouettes far more often than random ones do.
std::string hit_mismatch(const ReplayTally& tally, const RayRecord& record);

}  // namespace raytree::benchmarks
