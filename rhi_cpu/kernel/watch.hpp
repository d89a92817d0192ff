#pragma once

#include <cstdint>

#include "rhi_cpu/kernel/abi.hpp"

/// The end of endless loops, for kernels of devices with a time limit.
namespace tandem::kernel {

/// Rounds of loops of one invocation between two looks at the clock.
inline constexpr std::uint32_t rounds_between_looks = 1u << 16;

/// To be called when the rounds are used up: looks at the clock, and throws what ends the launch when its time is over.
inline std::uint32_t look(const Watch* watch) {
  watch->look(*watch);
  return rounds_between_looks;
}

}  // namespace tandem::kernel
