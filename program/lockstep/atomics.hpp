#pragma once

#include <map>
#include <set>

#include "program/lockstep/divergence.hpp"
#include "program/lockstep/recorded_execution.hpp"

namespace tandem::program {

/// Atomic instructions of which one device cannot be right. The old values that the invocations got from one place in
/// memory, whatever their order, form a chain: each is what the operation before it left. Where those of one device do
/// and those of the other do not, the other has missed an operation, or done another one.
/// @param launch both recordings are of all of its invocations, b's with the operands of a
std::map<SiteKey, WrongDevice> wrong_atomics(const RecordedLaunch& launch, const Recording& a, const Recording& b);

/// The variables (by shader and id) that these instructions write.
std::set<std::pair<const RecordedShader*, std::uint32_t>> variables_of(const std::map<SiteKey, WrongDevice>& atomics);

}  // namespace tandem::program
