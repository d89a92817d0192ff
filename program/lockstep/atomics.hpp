#pragma once

#include <map>
#include <set>

#include "program/lockstep/divergence.hpp"
#include "program/lockstep/recorded_execution.hpp"

namespace tandem::program {

/// What the old values that atomics returned say. Those that the invocations got from one place in memory, whatever
/// their order, form a chain: each is what the operation before it left.
struct AtomicFindings {
  /// Instructions of which one device cannot be right: the old values of the other form chains, and its own do not. It
  /// has missed an operation, or done another one.
  std::map<SiteKey, WrongDevice> wrong;
  /// Instructions at places that take several operations, with chains on both devices: which invocation comes first is
  /// open, and may be another one in every run.
  std::set<SiteKey> contended;
};

/// @param launch both recordings are of all of its invocations, b's with the operands of a
AtomicFindings judge_atomics(const RecordedLaunch& launch, const Recording& a, const Recording& b);

/// The variables (by shader and id) that these instructions write.
std::set<std::pair<const RecordedShader*, std::uint32_t>> variables_of(const std::map<SiteKey, WrongDevice>& atomics);

}  // namespace tandem::program
