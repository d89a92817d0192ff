#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <utility>

#include "program/cause/judgement.hpp"
#include "program/lockstep/divergence.hpp"
#include "program/lockstep/recorded_execution.hpp"
#include "program/lockstep/walk.hpp"

namespace tandem::program {

class RayArbiter;

/// What is known of a launch beside its instructions' operands.
struct Circumstances {
  std::set<SiteKey> order_dependent = {};             ///< give other results when the invocations run in another order
  std::map<SiteKey, WrongDevice> wrong_atomics = {};  ///< AtomicFindings::wrong
  bool same_subgroups = true;                         ///< both devices form subgroups of one size
  std::uint32_t subgroup_size = 0;                    ///< of device a; 0: unknown
  /// Device a forced along its own recording, so that each instruction stands alone as those of device b do: where a
  /// driver combines arithmetic with other instructions, it gives another result than the recorded one. Null: unknown.
  const Recording* alone_a = nullptr;
  const RayArbiter* rays = nullptr;  ///< decides about rays; null: nobody does
};

/// The judgement about a difference of an instruction whose operands do not determine its result: a load, an atomic, an
/// image, a ray, a subgroup operation. Any other difference keeps its judgement.
/// @param walk stands in front of the instruction
Judgement judge_by_circumstances(const Walk& walk, const Divergence& difference, const Circumstances& circumstances);

}  // namespace tandem::program
