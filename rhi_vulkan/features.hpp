#pragma once

#include <vector>

#include "rhi_vulkan/vulkan.hpp"

namespace tandem::vulkan {

/// The features that a device is created with: all that Tandem has a use for and the hardware offers. What belongs to
/// an extension is all false where the device lacks it.
struct EnabledFeatures {
  vk::PhysicalDeviceFeatures core;
  vk::PhysicalDeviceVulkan11Features vulkan11;
  vk::PhysicalDeviceVulkan12Features vulkan12;
  bool has_vulkan13 = false;
  vk::PhysicalDeviceVulkan13Features vulkan13;
  vk::PhysicalDeviceRayQueryFeaturesKHR ray_query;
  vk::PhysicalDeviceRayTracingPipelineFeaturesKHR ray_tracing_pipeline;
  vk::PhysicalDeviceRayTracingMaintenance1FeaturesKHR ray_tracing_maintenance1;
  vk::PhysicalDeviceRobustness2FeaturesEXT robustness2;
  vk::PhysicalDeviceShaderClockFeaturesKHR shader_clock;
  vk::PhysicalDeviceShaderAtomicFloatFeaturesEXT atomic_float;
  vk::PhysicalDeviceShaderAtomicFloat2FeaturesEXT atomic_float2;
  vk::PhysicalDeviceShaderImageAtomicInt64FeaturesEXT image_atomic_int64;
  vk::PhysicalDeviceWorkgroupMemoryExplicitLayoutFeaturesKHR explicit_workgroup_layout;
  vk::PhysicalDeviceShaderSubgroupUniformControlFlowFeaturesKHR subgroup_uniform_control_flow;
  // Of devices with Vulkan 1.2: `vulkan13` has them otherwise.
  vk::PhysicalDeviceSubgroupSizeControlFeatures subgroup_size_control;
  vk::PhysicalDeviceZeroInitializeWorkgroupMemoryFeatures zero_initialize_workgroup_memory;
// Headers of Vulkan 1.3.239, which are those of Debian 12, do not know the extensions below.
#ifdef VK_KHR_shader_subgroup_rotate
  vk::PhysicalDeviceShaderSubgroupRotateFeaturesKHR subgroup_rotate;
#endif
#ifdef VK_KHR_shader_maximal_reconvergence
  vk::PhysicalDeviceShaderMaximalReconvergenceFeaturesKHR maximal_reconvergence;
#endif
};

/// What comes from one of several structures, or from one that the headers may not know.
bool has_subgroup_size_control(const EnabledFeatures& enabled);
bool has_full_subgroups(const EnabledFeatures& enabled);
bool has_zeroed_workgroup_memory(const EnabledFeatures& enabled);
bool has_subgroup_rotate(const EnabledFeatures& enabled);
bool has_clustered_subgroup_rotate(const EnabledFeatures& enabled);
bool has_maximal_reconvergence(const EnabledFeatures& enabled);

EnabledFeatures choose_features(const vk::raii::PhysicalDevice& device);

/// Turns off what makes accesses outside of buffers and images defined.
void forget_robust_access(EnabledFeatures& enabled);

/// The device extensions that these features come from.
std::vector<const char*> extensions_of(const EnabledFeatures& enabled);

/// A device with one queue of the family and these features.
vk::raii::Device create_logical_device(const vk::raii::PhysicalDevice& device, const EnabledFeatures& enabled,
                                       std::uint32_t queue_family);

}  // namespace tandem::vulkan
