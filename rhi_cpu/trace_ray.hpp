#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "rhi_cpu/ray_launch.hpp"

namespace tandem::cpu {

/// Runs the ray generation shader of `record` once, and through it all that its rays call: the implementation of
/// kernel::PipelineFunctions. Throws nothing; what goes wrong is noted in the launch's failures. Thread-safe.
void generate_rays(const RayLaunch& launch, const GeneralRecord& record, const std::byte* push_constants,
                   const std::array<std::uint32_t, 3>& id, const std::array<std::uint32_t, 3>& size);

}  // namespace tandem::cpu
