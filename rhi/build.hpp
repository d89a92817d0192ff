#pragma once

#include "rhi/device.hpp"

namespace tandem::rhi {

/// A new bottom level, built by a submission of its own. It is not waited for. Throws Error.
AccelerationStructureHandle build_bottom_level(Device& device, const BottomLevelDesc& desc);

/// A new top level likewise. It keeps no bottom level alive.
AccelerationStructureHandle build_top_level(Device& device, const TopLevelDesc& desc);

}  // namespace tandem::rhi
