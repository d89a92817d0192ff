#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "rhi/device.hpp"
#include "rhi_vulkan/instance.hpp"
#include "rhi_vulkan/vulkan.hpp"

namespace tandem::vulkan {

/// The features that a device is created with: all that Tandem has a use for and the hardware offers.
struct EnabledFeatures {
  vk::PhysicalDeviceFeatures core;
  vk::PhysicalDeviceVulkan11Features vulkan11;
  vk::PhysicalDeviceVulkan12Features vulkan12;
  bool ray_query = false;
  bool ray_tracing_pipeline = false;
  bool trace_rays_indirect = false;  ///< rayTracingPipelineTraceRaysIndirect
  bool primitive_culling = false;    ///< rayTraversalPrimitiveCulling
  bool null_descriptor = false;      ///< VK_EXT_robustness2
};

/// The device extensions that these features come from.
std::vector<const char*> extensions_of(const EnabledFeatures& enabled);

/// A physical device that qualifies, and what creating a logical one from it takes.
struct PhysicalDevice {
  vk::raii::PhysicalDevice handle = nullptr;
  rhi::DeviceInfo info;
  EnabledFeatures features;
  std::uint32_t queue_family = 0;
  std::uint32_t timestamp_valid_bits = 0;        ///< of the queue family, 0 without timestamps
  double timestamp_period = 1;                   ///< nanoseconds in a tick
  std::uint64_t scratch_alignment = 1;           ///< of the scratch memory of a build
  std::uint64_t max_allocation_size = 0;         ///< of one vkAllocateMemory
  std::uint64_t buffer_image_granularity = 1;    ///< a page of memory that holds images holds no buffers
  vk::ShaderStageFlags shader_stages;            ///< that pipelines may have
  std::uint32_t shader_table_alignment = 1;      ///< of the address at which the records of a trace begin
  vk::SubgroupFeatureFlags subgroup_operations;  ///< that compute shaders may use
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
