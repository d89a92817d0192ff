#pragma once

#include <cstdint>
#include <vector>

#include "pathtracer/scene/scene.hpp"
#include "rhi/device.hpp"
#include "tests/shaders/function_kernel.hpp"

/// Functions of the shaders that read a scene.
namespace tandem::test {

/// As run_bits of function_kernel.hpp, with the buffers of shaders/scene.glsl bound to a scene as the renderer uploads
/// it, and all features on. `render` describes the scene and is the default otherwise; there are no acceleration
/// structures.
std::vector<std::uint32_t> run_bits(rhi::Device& device, const pathtracer::Scene& scene, const FunctionKernel& kernel,
                                    const std::vector<std::uint32_t>& inputs);

}  // namespace tandem::test
