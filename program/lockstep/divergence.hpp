#pragma once

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "program/cause/judgement.hpp"
#include "program/lockstep/recorded_launch.hpp"

namespace tandem::program {

/// An instruction: its shader, and its position in the module.
using SiteKey = std::pair<const RecordedShader*, std::size_t>;

/// A value that differs, with what the instruction had.
struct Divergence {
  const RecordedShader* shader = nullptr;
  std::size_t instruction = 0;  ///< position in its module's instructions
  std::size_t slot = 0;
  std::size_t position = 0;  ///< of the value in the slot's words
  std::size_t order = 0;     ///< how many values the invocation had recorded before
  bool is_address = false;
  bool parted = false;                                 ///< before it, a ray has run other shaders on the second device
  std::vector<std::optional<RecordedWords>> operands;  ///< by Instruction::used_ids
  RecordedWords a, b;
  Judgement judgement;
};

}  // namespace tandem::program
