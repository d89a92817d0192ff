#pragma once

#include <span>
#include <string>

#include "rhi/device.hpp"

namespace tandem {

/// What shaders may use on these devices, as the Markdown document docs/results/shader-support.md: capabilities, image
/// formats, and what else the CPU devices know by name.
std::string shader_support_markdown(std::span<const rhi::DeviceInfo> devices);

}  // namespace tandem
