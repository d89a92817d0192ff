#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <set>
#include <vector>

#include "program/cause/judgement.hpp"
#include "program/lockstep/circumstances.hpp"
#include "program/lockstep/divergence.hpp"
#include "program/lockstep/recorded_execution.hpp"
#include "program/lockstep/recorded_launch.hpp"

/// Two recordings of the same invocations, value by value.
namespace tandem::program {

/// What is known of one instruction, over all invocations.
struct Site {
  const RecordedShader* shader = nullptr;
  std::size_t instruction = 0;
  std::uint64_t executions = 0;
  std::uint64_t differences = 0;
  std::array<std::uint64_t, cause_count> causes = {};  ///< of the differences, by Cause
  Divergence example;                                  ///< the gravest; of equal ones the first
};

struct LockstepComparison {
  std::uint64_t values = 0;      ///< that both devices recorded
  std::vector<Site> sites;       ///< those with differences, gravest first
  std::uint64_t incomplete = 0;  ///< invocations whose record was cut off
  /// Invocations whose segments are not the same on both devices, although decisions were taken over: a ray that runs
  /// another shader, candidates in another order.
  std::uint64_t parted = 0;
};

/// How grave a cause is: a mismatch most.
int gravity(Cause cause);

/// @param a what a device recorded
/// @param b what another one did in its place, forced along it
LockstepComparison compare_lockstep(const RecordedLaunch& launch, const Recording& a, const Recording& b,
                                    const Circumstances& circumstances);

/// The instructions whose results differ.
std::set<SiteKey> differing_sites(const RecordedLaunch& launch, const Recording& a, const Recording& b);

/// Where two executions of an invocation, neither of which is forced, have other bits for the first time.
struct FirstDivergence {
  std::optional<Divergence> value;     ///< the first value
  std::optional<Divergence> decision;  ///< the first one that decides where the shader goes: a branch or a switch
};
FirstDivergence first_divergence(const RecordedLaunch& launch, const Recording& a, const Recording& b, std::size_t slot,
                                 const Circumstances& circumstances);

}  // namespace tandem::program
