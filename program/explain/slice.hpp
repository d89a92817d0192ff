#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "program/lockstep/comparison.hpp"

namespace tandem::program {

/// An instruction on which a value depends, with its last result before that value.
struct SliceEntry {
  std::size_t instruction = 0;  ///< position in the module's instructions
  RecordedWords value;
};

/// How the operands of a differing value came about, on the device that was recorded: the instructions that it depends
/// on, through variables too, nearest first. Those that only move values (loads, extracts) are left out where what they
/// move is there.
/// @param most entries
std::vector<SliceEntry> slice_of(const RecordedLaunch& launch, const Recording& recording, const Divergence& difference,
                                 std::size_t most);

}  // namespace tandem::program
