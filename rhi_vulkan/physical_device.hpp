#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "rhi/device.hpp"
#include "rhi_vulkan/features.hpp"
#include "rhi_vulkan/instance.hpp"
#include "rhi_vulkan/vulkan.hpp"

namespace tandem::vulkan {

/// A physical device that qualifies, and what creating a logical one from it takes.
struct PhysicalDevice {
  vk::raii::PhysicalDevice handle = nullptr;
  rhi::DeviceInfo info;
  EnabledFeatures features;
  std::uint32_t queue_family = 0;
  std::uint32_t timestamp_valid_bits = 0;         ///< of the queue family, 0 without timestamps
  double timestamp_period = 1;                    ///< nanoseconds in a tick
  std::uint64_t scratch_alignment = 1;            ///< of the scratch memory of a build
  std::uint64_t max_allocation_size = 0;          ///< of one vkAllocateMemory
  std::uint64_t buffer_image_granularity = 1;     ///< a page of memory that holds images holds no buffers
  vk::ShaderStageFlags shader_stages;             ///< that pipelines may have
  std::uint32_t shader_table_alignment = 1;       ///< of the address at which the records of a trace begin
  vk::SubgroupFeatureFlags subgroup_operations;   ///< that compute shaders may use
  vk::PhysicalDeviceVulkan12Properties vulkan12;  ///< float controls among others
  std::uint32_t newest_spirv = 0;                 ///< as the version word of a module
};

/// What `enumerate` finds: the devices that qualify, and a sentence for each that does not.
struct PhysicalDevices {
  std::vector<PhysicalDevice> qualifying;
  std::vector<std::string> refusals;
};

/// A device qualifies with Vulkan 1.2, a compute queue, VK_KHR_acceleration_structure and the features
/// accelerationStructure, bufferDeviceAddress and timelineSemaphore. Order, which numbers "vulkan:N": discrete,
/// integrated, virtual GPUs, then CPUs; within each kind as the loader lists them.
PhysicalDevices find_physical_devices(const Instance& instance);

}  // namespace tandem::vulkan
