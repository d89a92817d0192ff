#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "program/lockstep/comparison.hpp"
#include "program/lockstep/snapshot.hpp"

namespace tandem::program {

/// The stores and atomics that are to blame where all values agree and memory does not: each that was the last to write
/// bytes of a buffer in which the two devices' outputs differ, as a mismatch of the second one.
/// @param a, b what the buffers hold: of a, and of b with the values of a
/// @param ignored by buffer: its bytes differ for a reason that is known
std::vector<Site> output_sites(const RecordedLaunch& launch, const Recording& recording, const Snapshot& a,
                               const Snapshot& b, std::span<const char> ignored);

}  // namespace tandem::program
