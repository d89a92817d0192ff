#include "rhi_vulkan/features.hpp"

#include <algorithm>
#include <cstring>
#include <string_view>
#include <utility>

namespace tandem::vulkan {
namespace {

/// Turns on each member of `enabled` that is on in `offered`.
template <typename Features, typename... Members>
void take(Features& enabled, const Features& offered, Members... members) {
  ((enabled.*members = offered.*members), ...);
}

void take_core(vk::PhysicalDeviceFeatures& enabled, const vk::PhysicalDeviceFeatures& offered) {
  using F = vk::PhysicalDeviceFeatures;
  take(enabled, offered, &F::robustBufferAccess, &F::shaderInt16, &F::shaderInt64, &F::shaderFloat64,
       &F::imageCubeArray, &F::shaderImageGatherExtended, &F::shaderResourceMinLod,
       &F::shaderStorageImageExtendedFormats, &F::shaderStorageImageReadWithoutFormat,
       &F::shaderStorageImageWriteWithoutFormat, &F::shaderUniformBufferArrayDynamicIndexing,
       &F::shaderSampledImageArrayDynamicIndexing, &F::shaderStorageBufferArrayDynamicIndexing,
       &F::shaderStorageImageArrayDynamicIndexing);
}

void take_vulkan11(vk::PhysicalDeviceVulkan11Features& enabled, const vk::PhysicalDeviceVulkan11Features& offered) {
  using F = vk::PhysicalDeviceVulkan11Features;
  take(enabled, offered, &F::storageBuffer16BitAccess, &F::uniformAndStorageBuffer16BitAccess,
       &F::storagePushConstant16, &F::variablePointersStorageBuffer, &F::variablePointers);
}

void take_vulkan12(vk::PhysicalDeviceVulkan12Features& enabled, const vk::PhysicalDeviceVulkan12Features& offered) {
  using F = vk::PhysicalDeviceVulkan12Features;
  take(enabled, offered, &F::timelineSemaphore, &F::bufferDeviceAddress, &F::scalarBlockLayout, &F::shaderInt8,
       &F::shaderFloat16, &F::storageBuffer8BitAccess, &F::uniformAndStorageBuffer8BitAccess, &F::storagePushConstant8,
       &F::shaderBufferInt64Atomics, &F::shaderSharedInt64Atomics, &F::vulkanMemoryModel,
       &F::vulkanMemoryModelDeviceScope, &F::samplerMirrorClampToEdge, &F::shaderSubgroupExtendedTypes,
       &F::subgroupBroadcastDynamicId);
  take(enabled, offered, &F::runtimeDescriptorArray, &F::descriptorBindingPartiallyBound,
       &F::shaderUniformBufferArrayNonUniformIndexing, &F::shaderSampledImageArrayNonUniformIndexing,
       &F::shaderStorageBufferArrayNonUniformIndexing, &F::shaderStorageImageArrayNonUniformIndexing,
       &F::shaderUniformTexelBufferArrayDynamicIndexing, &F::shaderStorageTexelBufferArrayDynamicIndexing,
       &F::shaderUniformTexelBufferArrayNonUniformIndexing, &F::shaderStorageTexelBufferArrayNonUniformIndexing);
}

void take_vulkan13(vk::PhysicalDeviceVulkan13Features& enabled, const vk::PhysicalDeviceVulkan13Features& offered) {
  using F = vk::PhysicalDeviceVulkan13Features;
  take(enabled, offered, &F::maintenance4, &F::shaderIntegerDotProduct, &F::subgroupSizeControl,
       &F::computeFullSubgroups, &F::shaderZeroInitializeWorkgroupMemory);
}

template <typename Features>
Features queried(const vk::raii::PhysicalDevice& device) {
  Features features = device.getFeatures2<vk::PhysicalDeviceFeatures2, Features>().template get<Features>();
  features.pNext = nullptr;
  return features;
}

/// Calls visit(extension, features) for the features of each extension.
template <typename Visit>
void for_each_extension(EnabledFeatures& enabled, const Visit& visit) {
  visit(VK_KHR_RAY_QUERY_EXTENSION_NAME, enabled.ray_query);
  visit(VK_KHR_RAY_TRACING_PIPELINE_EXTENSION_NAME, enabled.ray_tracing_pipeline);
  visit(VK_KHR_RAY_TRACING_MAINTENANCE_1_EXTENSION_NAME, enabled.ray_tracing_maintenance1);
  visit(VK_EXT_ROBUSTNESS_2_EXTENSION_NAME, enabled.robustness2);
  visit(VK_KHR_SHADER_CLOCK_EXTENSION_NAME, enabled.shader_clock);
  visit(VK_EXT_SHADER_ATOMIC_FLOAT_EXTENSION_NAME, enabled.atomic_float);
  visit(VK_EXT_SHADER_ATOMIC_FLOAT_2_EXTENSION_NAME, enabled.atomic_float2);
  visit(VK_EXT_SHADER_IMAGE_ATOMIC_INT64_EXTENSION_NAME, enabled.image_atomic_int64);
  visit(VK_KHR_WORKGROUP_MEMORY_EXPLICIT_LAYOUT_EXTENSION_NAME, enabled.explicit_workgroup_layout);
  visit(VK_KHR_SHADER_SUBGROUP_UNIFORM_CONTROL_FLOW_EXTENSION_NAME, enabled.subgroup_uniform_control_flow);
#ifdef VK_KHR_shader_subgroup_rotate
  visit(VK_KHR_SHADER_SUBGROUP_ROTATE_EXTENSION_NAME, enabled.subgroup_rotate);
#endif
#ifdef VK_KHR_shader_maximal_reconvergence
  visit(VK_KHR_SHADER_MAXIMAL_RECONVERGENCE_EXTENSION_NAME, enabled.maximal_reconvergence);
#endif
  // Vulkan forbids the structures beside that of 1.3, which holds the same features.
  if (enabled.has_vulkan13) return;
  visit(VK_EXT_SUBGROUP_SIZE_CONTROL_EXTENSION_NAME, enabled.subgroup_size_control);
  visit(VK_KHR_ZERO_INITIALIZE_WORKGROUP_MEMORY_EXTENSION_NAME, enabled.zero_initialize_workgroup_memory);
}

/// The features of extensions, wherever one is offered: a driver need not know the structure otherwise.
void take_extensions(EnabledFeatures& enabled, const vk::raii::PhysicalDevice& device) {
  const std::vector<vk::ExtensionProperties> extensions = device.enumerateDeviceExtensionProperties();
  const auto take_if = [&]<typename Features>(const char* name, Features& features) {
    if (std::any_of(extensions.begin(), extensions.end(), [name](const vk::ExtensionProperties& extension) {
          return std::strcmp(extension.extensionName, name) == 0;
        }))
      features = queried<Features>(device);
  };
  for_each_extension(enabled, take_if);
  // Only for captures, and slow.
  enabled.ray_tracing_pipeline.rayTracingPipelineShaderGroupHandleCaptureReplay = VK_FALSE;
  enabled.ray_tracing_pipeline.rayTracingPipelineShaderGroupHandleCaptureReplayMixed = VK_FALSE;
  // There are no sparse images here.
  enabled.atomic_float.sparseImageFloat32Atomics = VK_FALSE;
  enabled.atomic_float.sparseImageFloat32AtomicAdd = VK_FALSE;
  enabled.atomic_float2.sparseImageFloat32AtomicMinMax = VK_FALSE;
  enabled.image_atomic_int64.sparseImageInt64Atomics = VK_FALSE;
}

/// An extension and whether one of its features is on.
struct Use {
  const char* extension;
  bool used;
};

std::vector<Use> uses_of(const EnabledFeatures& e) {
  const auto any = [](auto... flags) { return ((flags != VK_FALSE) || ...); };
  return {
      {VK_KHR_RAY_QUERY_EXTENSION_NAME, any(e.ray_query.rayQuery)},
      {VK_KHR_RAY_TRACING_PIPELINE_EXTENSION_NAME, any(e.ray_tracing_pipeline.rayTracingPipeline)},
      {VK_KHR_RAY_TRACING_MAINTENANCE_1_EXTENSION_NAME, any(e.ray_tracing_maintenance1.rayTracingMaintenance1)},
      {VK_EXT_ROBUSTNESS_2_EXTENSION_NAME,
       any(e.robustness2.nullDescriptor, e.robustness2.robustBufferAccess2, e.robustness2.robustImageAccess2)},
      {VK_KHR_SHADER_CLOCK_EXTENSION_NAME, any(e.shader_clock.shaderSubgroupClock, e.shader_clock.shaderDeviceClock)},
      {VK_EXT_SHADER_ATOMIC_FLOAT_EXTENSION_NAME,
       any(e.atomic_float.shaderBufferFloat32Atomics, e.atomic_float.shaderBufferFloat32AtomicAdd,
           e.atomic_float.shaderBufferFloat64Atomics, e.atomic_float.shaderBufferFloat64AtomicAdd,
           e.atomic_float.shaderImageFloat32Atomics, e.atomic_float.shaderImageFloat32AtomicAdd,
           e.atomic_float.shaderSharedFloat32Atomics, e.atomic_float.shaderSharedFloat32AtomicAdd,
           e.atomic_float.shaderSharedFloat64Atomics, e.atomic_float.shaderSharedFloat64AtomicAdd)},
      {VK_EXT_SHADER_ATOMIC_FLOAT_2_EXTENSION_NAME,
       any(e.atomic_float2.shaderBufferFloat16Atomics, e.atomic_float2.shaderBufferFloat16AtomicAdd,
           e.atomic_float2.shaderBufferFloat16AtomicMinMax, e.atomic_float2.shaderBufferFloat32AtomicMinMax,
           e.atomic_float2.shaderBufferFloat64AtomicMinMax, e.atomic_float2.shaderSharedFloat16Atomics,
           e.atomic_float2.shaderSharedFloat16AtomicAdd, e.atomic_float2.shaderSharedFloat16AtomicMinMax,
           e.atomic_float2.shaderSharedFloat32AtomicMinMax, e.atomic_float2.shaderSharedFloat64AtomicMinMax)},
      {VK_EXT_SHADER_IMAGE_ATOMIC_INT64_EXTENSION_NAME, any(e.image_atomic_int64.shaderImageInt64Atomics)},
      {VK_KHR_WORKGROUP_MEMORY_EXPLICIT_LAYOUT_EXTENSION_NAME,
       any(e.explicit_workgroup_layout.workgroupMemoryExplicitLayout)},
      {VK_KHR_SHADER_SUBGROUP_UNIFORM_CONTROL_FLOW_EXTENSION_NAME,
       any(e.subgroup_uniform_control_flow.shaderSubgroupUniformControlFlow)},
      {VK_EXT_SUBGROUP_SIZE_CONTROL_EXTENSION_NAME,
       any(e.subgroup_size_control.subgroupSizeControl, e.subgroup_size_control.computeFullSubgroups)},
      {VK_KHR_ZERO_INITIALIZE_WORKGROUP_MEMORY_EXTENSION_NAME,
       any(e.zero_initialize_workgroup_memory.shaderZeroInitializeWorkgroupMemory)},
#ifdef VK_KHR_shader_subgroup_rotate
      {VK_KHR_SHADER_SUBGROUP_ROTATE_EXTENSION_NAME, has_subgroup_rotate(e)},
#endif
#ifdef VK_KHR_shader_maximal_reconvergence
      {VK_KHR_SHADER_MAXIMAL_RECONVERGENCE_EXTENSION_NAME, has_maximal_reconvergence(e)},
#endif
  };
}

}  // namespace

EnabledFeatures choose_features(const vk::raii::PhysicalDevice& device) {
  EnabledFeatures enabled;
  const auto offered = device.getFeatures2<vk::PhysicalDeviceFeatures2, vk::PhysicalDeviceVulkan11Features,
                                           vk::PhysicalDeviceVulkan12Features>();
  take_core(enabled.core, offered.get<vk::PhysicalDeviceFeatures2>().features);
  take_vulkan11(enabled.vulkan11, offered.get<vk::PhysicalDeviceVulkan11Features>());
  take_vulkan12(enabled.vulkan12, offered.get<vk::PhysicalDeviceVulkan12Features>());
  enabled.has_vulkan13 = device.getProperties().apiVersion >= VK_API_VERSION_1_3;
  if (enabled.has_vulkan13) take_vulkan13(enabled.vulkan13, queried<vk::PhysicalDeviceVulkan13Features>(device));
  take_extensions(enabled, device);
  // Vulkan asks for the one with the other.
  if (!enabled.core.robustBufferAccess) enabled.robustness2.robustBufferAccess2 = VK_FALSE;
  return enabled;
}

bool has_subgroup_size_control(const EnabledFeatures& enabled) {
  return enabled.vulkan13.subgroupSizeControl || enabled.subgroup_size_control.subgroupSizeControl;
}

bool has_full_subgroups(const EnabledFeatures& enabled) {
  return enabled.vulkan13.computeFullSubgroups || enabled.subgroup_size_control.computeFullSubgroups;
}

bool has_zeroed_workgroup_memory(const EnabledFeatures& enabled) {
  return enabled.vulkan13.shaderZeroInitializeWorkgroupMemory ||
         enabled.zero_initialize_workgroup_memory.shaderZeroInitializeWorkgroupMemory;
}

bool has_subgroup_rotate([[maybe_unused]] const EnabledFeatures& enabled) {
#ifdef VK_KHR_shader_subgroup_rotate
  return enabled.subgroup_rotate.shaderSubgroupRotate;
#else
  return false;
#endif
}

bool has_clustered_subgroup_rotate([[maybe_unused]] const EnabledFeatures& enabled) {
#ifdef VK_KHR_shader_subgroup_rotate
  return enabled.subgroup_rotate.shaderSubgroupRotateClustered;
#else
  return false;
#endif
}

bool has_maximal_reconvergence([[maybe_unused]] const EnabledFeatures& enabled) {
#ifdef VK_KHR_shader_maximal_reconvergence
  return enabled.maximal_reconvergence.shaderMaximalReconvergence;
#else
  return false;
#endif
}

void forget_robust_access(EnabledFeatures& enabled) {
  enabled.core.robustBufferAccess = VK_FALSE;
  enabled.robustness2.robustBufferAccess2 = VK_FALSE;
  enabled.robustness2.robustImageAccess2 = VK_FALSE;
}

std::vector<const char*> extensions_of(const EnabledFeatures& enabled) {
  std::vector<const char*> extensions = {VK_KHR_ACCELERATION_STRUCTURE_EXTENSION_NAME,
                                         VK_KHR_DEFERRED_HOST_OPERATIONS_EXTENSION_NAME};
  for (const Use& use : uses_of(enabled))
    if (use.used) extensions.push_back(use.extension);
  return extensions;
}

vk::raii::Device create_logical_device(const vk::raii::PhysicalDevice& device, const EnabledFeatures& enabled,
                                       std::uint32_t queue_family) {
  EnabledFeatures chained = enabled;
  vk::PhysicalDeviceAccelerationStructureFeaturesKHR acceleration_structure = {.accelerationStructure = VK_TRUE};
  vk::PhysicalDeviceFeatures2 features = {.pNext = &acceleration_structure, .features = enabled.core};
  const auto chain = [&acceleration_structure](auto& structure) {
    structure.pNext = std::exchange(acceleration_structure.pNext, &structure);
  };
  const std::vector<const char*> extensions = extensions_of(enabled);
  const auto chain_if = [&](const char* extension, auto& structure) {
    if (std::find(extensions.begin(), extensions.end(), std::string_view(extension)) != extensions.end())
      chain(structure);
  };
  chain(chained.vulkan11);
  chain(chained.vulkan12);
  if (enabled.has_vulkan13) chain(chained.vulkan13);
  for_each_extension(chained, chain_if);

  const float priority = 1;
  const vk::DeviceQueueCreateInfo queue = {
      .queueFamilyIndex = queue_family, .queueCount = 1, .pQueuePriorities = &priority};
  return device.createDevice({.pNext = &features,
                              .queueCreateInfoCount = 1,
                              .pQueueCreateInfos = &queue,
                              .enabledExtensionCount = static_cast<std::uint32_t>(extensions.size()),
                              .ppEnabledExtensionNames = extensions.data()});
}

}  // namespace tandem::vulkan
