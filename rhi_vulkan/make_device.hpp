#pragma once

#include <memory>

#include "rhi/device.hpp"
#include "rhi_vulkan/instance.hpp"
#include "rhi_vulkan/physical_device.hpp"

namespace tandem::vulkan {

/// The device over one of the instance's physical devices, with the features that it has switched on.
rhi::DeviceHandle make_device(std::unique_ptr<Instance> instance, PhysicalDevice physical);

}  // namespace tandem::vulkan
