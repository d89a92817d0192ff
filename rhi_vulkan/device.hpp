#pragma once

#include <vector>

#include "rhi/device.hpp"

/// The interface over Vulkan 1.2 with VK_KHR_acceleration_structure and, where the hardware has them, VK_KHR_ray_query
/// and VK_KHR_ray_tracing_pipeline.
namespace tandem::vulkan {

/// The devices that qualify: Vulkan 1.2, a compute queue, VK_KHR_acceleration_structure, bufferDeviceAddress and
/// timelineSemaphore. Discrete, integrated, virtual GPUs, then CPUs; within each kind as the Vulkan loader lists them.
/// Why one does not qualify, or why there are none (no loader, no driver), is told to `on_message`.
std::vector<rhi::DeviceInfo> enumerate(const rhi::MessageCallback& on_message = {});

/// @param desc.name "vulkan" for the first that qualifies, "vulkan:N" for enumerate()[N]
/// A device that is destroyed waits for what was submitted to it. Destroy it before main returns: when the process
/// exits, drivers and layers take themselves apart. Throws rhi::Error(no_such_device) with the names there are, or why
/// none qualifies.
rhi::DeviceHandle create_device(const rhi::DeviceDesc& desc);

}  // namespace tandem::vulkan
