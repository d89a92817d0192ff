#include "rhi_vulkan/physical_device.hpp"

#include <algorithm>
#include <cstring>
#include <optional>
#include <string_view>
#include <utility>

#include "rhi_vulkan/error.hpp"

namespace tandem::vulkan {
namespace {

using OfferedExtensions = std::vector<vk::ExtensionProperties>;

bool offers(const OfferedExtensions& extensions, const char* name) {
  return std::any_of(extensions.begin(), extensions.end(), [name](const vk::ExtensionProperties& extension) {
    return std::strcmp(extension.extensionName, name) == 0;
  });
}

rhi::DeviceKind kind_of(vk::PhysicalDeviceType type) {
  switch (type) {
    case vk::PhysicalDeviceType::eDiscreteGpu:
      return rhi::DeviceKind::discrete_gpu;
    case vk::PhysicalDeviceType::eIntegratedGpu:
      return rhi::DeviceKind::integrated_gpu;
    case vk::PhysicalDeviceType::eCpu:
      return rhi::DeviceKind::cpu;
    default:
      return rhi::DeviceKind::virtual_gpu;
  }
}

std::string version_text(std::uint32_t version) {
  return std::to_string(VK_API_VERSION_MAJOR(version)) + "." + std::to_string(VK_API_VERSION_MINOR(version)) + "." +
         std::to_string(VK_API_VERSION_PATCH(version));
}

/// The first family that computes and keeps time, else the first that computes. Drivers list their universal family
/// first, which reaches the whole device.
std::optional<std::uint32_t> compute_queue_family(const std::vector<vk::QueueFamilyProperties>& families) {
  std::optional<std::uint32_t> found;
  for (std::uint32_t i = 0; i < families.size(); ++i) {
    if (!(families[i].queueFlags & vk::QueueFlagBits::eCompute)) continue;
    if (families[i].timestampValidBits > 0) return i;
    if (!found) found = i;
  }
  return found;
}

/// Members of `offered` that Tandem has a use for; everything else stays off.
EnabledFeatures choose_features(const vk::PhysicalDeviceFeatures& core, const vk::PhysicalDeviceVulkan11Features& v11,
                                const vk::PhysicalDeviceVulkan12Features& v12) {
  EnabledFeatures enabled;
  enabled.core.shaderInt16 = core.shaderInt16;
  enabled.core.shaderInt64 = core.shaderInt64;
  enabled.core.shaderFloat64 = core.shaderFloat64;
  enabled.core.shaderStorageBufferArrayDynamicIndexing = core.shaderStorageBufferArrayDynamicIndexing;
  enabled.core.shaderUniformBufferArrayDynamicIndexing = core.shaderUniformBufferArrayDynamicIndexing;
  enabled.core.shaderStorageImageArrayDynamicIndexing = core.shaderStorageImageArrayDynamicIndexing;
  enabled.core.shaderStorageImageExtendedFormats = core.shaderStorageImageExtendedFormats;
  enabled.core.shaderStorageImageReadWithoutFormat = core.shaderStorageImageReadWithoutFormat;
  enabled.core.shaderStorageImageWriteWithoutFormat = core.shaderStorageImageWriteWithoutFormat;
  enabled.vulkan11.storageBuffer16BitAccess = v11.storageBuffer16BitAccess;
  enabled.vulkan11.uniformAndStorageBuffer16BitAccess = v11.uniformAndStorageBuffer16BitAccess;
  enabled.vulkan12.timelineSemaphore = v12.timelineSemaphore;
  enabled.vulkan12.bufferDeviceAddress = v12.bufferDeviceAddress;
  enabled.vulkan12.scalarBlockLayout = v12.scalarBlockLayout;
  enabled.vulkan12.shaderInt8 = v12.shaderInt8;
  enabled.vulkan12.shaderFloat16 = v12.shaderFloat16;
  enabled.vulkan12.storageBuffer8BitAccess = v12.storageBuffer8BitAccess;
  enabled.vulkan12.uniformAndStorageBuffer8BitAccess = v12.uniformAndStorageBuffer8BitAccess;
  enabled.vulkan12.shaderBufferInt64Atomics = v12.shaderBufferInt64Atomics;
  enabled.vulkan12.shaderSharedInt64Atomics = v12.shaderSharedInt64Atomics;
  enabled.vulkan12.shaderStorageBufferArrayNonUniformIndexing = v12.shaderStorageBufferArrayNonUniformIndexing;
  enabled.vulkan12.shaderUniformBufferArrayNonUniformIndexing = v12.shaderUniformBufferArrayNonUniformIndexing;
  enabled.vulkan12.shaderStorageImageArrayNonUniformIndexing = v12.shaderStorageImageArrayNonUniformIndexing;
  enabled.vulkan12.vulkanMemoryModel = v12.vulkanMemoryModel;
  enabled.vulkan12.vulkanMemoryModelDeviceScope = v12.vulkanMemoryModelDeviceScope;
  return enabled;
}

/// The features of extensions. A structure is only asked for where its extension is offered: a driver need not know it
/// otherwise.
void choose_extensions(const vk::raii::PhysicalDevice& handle, const OfferedExtensions& offered,
                       EnabledFeatures& enabled) {
  if (offers(offered, VK_KHR_RAY_QUERY_EXTENSION_NAME)) {
    enabled.ray_query = handle.getFeatures2<vk::PhysicalDeviceFeatures2, vk::PhysicalDeviceRayQueryFeaturesKHR>()
                            .get<vk::PhysicalDeviceRayQueryFeaturesKHR>()
                            .rayQuery;
  }
  if (offers(offered, VK_KHR_RAY_TRACING_PIPELINE_EXTENSION_NAME)) {
    const auto pipeline =
        handle.getFeatures2<vk::PhysicalDeviceFeatures2, vk::PhysicalDeviceRayTracingPipelineFeaturesKHR>()
            .get<vk::PhysicalDeviceRayTracingPipelineFeaturesKHR>();
    enabled.ray_tracing_pipeline = pipeline.rayTracingPipeline;
    enabled.trace_rays_indirect = pipeline.rayTracingPipeline && pipeline.rayTracingPipelineTraceRaysIndirect;
    enabled.primitive_culling = pipeline.rayTracingPipeline && pipeline.rayTraversalPrimitiveCulling;
  }
  if (offers(offered, VK_EXT_ROBUSTNESS_2_EXTENSION_NAME)) {
    enabled.null_descriptor =
        handle.getFeatures2<vk::PhysicalDeviceFeatures2, vk::PhysicalDeviceRobustness2FeaturesEXT>()
            .get<vk::PhysicalDeviceRobustness2FeaturesEXT>()
            .nullDescriptor;
  }
}

vk::ShaderStageFlags stages_of(const EnabledFeatures& enabled) {
  using Stage = vk::ShaderStageFlagBits;
  vk::ShaderStageFlags stages = Stage::eCompute;
  if (enabled.ray_tracing_pipeline)
    stages |= Stage::eRaygenKHR | Stage::eAnyHitKHR | Stage::eClosestHitKHR | Stage::eMissKHR |
              Stage::eIntersectionKHR | Stage::eCallableKHR;
  return stages;
}

rhi::Capabilities capabilities_of(const EnabledFeatures& enabled) {
  rhi::Capabilities capabilities;
  capabilities.ray_query = enabled.ray_query;
  capabilities.ray_tracing_pipeline = enabled.ray_tracing_pipeline;
  capabilities.trace_rays_indirect = enabled.trace_rays_indirect;
  capabilities.primitive_culling = enabled.primitive_culling;
  capabilities.null_acceleration_structure = enabled.null_descriptor;
  capabilities.buffer_references = enabled.vulkan12.bufferDeviceAddress;
  // Arrays of acceleration structures need no feature of their own.
  capabilities.non_uniform_indexing = enabled.vulkan12.shaderStorageBufferArrayNonUniformIndexing &&
                                      enabled.vulkan12.shaderUniformBufferArrayNonUniformIndexing &&
                                      enabled.vulkan12.shaderStorageImageArrayNonUniformIndexing;
  capabilities.scalar_block_layout = enabled.vulkan12.scalarBlockLayout;
  capabilities.shader_int64 = enabled.core.shaderInt64;
  capabilities.shader_float64 = enabled.core.shaderFloat64;
  return capabilities;
}

rhi::Limits limits_of(const vk::PhysicalDeviceLimits& core,
                      const vk::PhysicalDeviceAccelerationStructurePropertiesKHR& acceleration) {
  // Custom indices and gl_InstanceID have 24 bits to spare at most, whatever the driver claims.
  constexpr std::uint64_t most_instances = (1ull << 24) - 1;
  rhi::Limits limits;
  limits.max_push_constant_size = core.maxPushConstantsSize;
  limits.max_storage_buffer_range = core.maxStorageBufferRange;
  limits.max_uniform_buffer_range = core.maxUniformBufferRange;
  limits.storage_buffer_offset_alignment = core.minStorageBufferOffsetAlignment;
  limits.uniform_buffer_offset_alignment = core.minUniformBufferOffsetAlignment;
  for (std::size_t i = 0; i < 3; ++i) {
    limits.max_workgroup_size[i] = core.maxComputeWorkGroupSize[i];
    limits.max_workgroup_count[i] = core.maxComputeWorkGroupCount[i];
  }
  limits.max_workgroup_invocations = core.maxComputeWorkGroupInvocations;
  limits.max_bind_groups = core.maxBoundDescriptorSets;
  limits.max_geometry_count = acceleration.maxGeometryCount;
  limits.max_primitive_count = acceleration.maxPrimitiveCount;
  limits.max_instance_count = std::min<std::uint64_t>(acceleration.maxInstanceCount, most_instances);
  limits.max_texture_size = {core.maxImageDimension1D,   core.maxImageDimension2D, core.maxImageDimension3D,
                             core.maxImageDimensionCube, core.maxImageDimension1D, core.maxImageDimension2D,
                             core.maxImageDimensionCube};
  limits.max_texture_layers = core.maxImageArrayLayers;
  return limits;
}

/// What only devices with VK_KHR_ray_tracing_pipeline say.
void add_ray_tracing_pipeline_limits(PhysicalDevice& device) {
  const auto pipeline =
      device.handle.getProperties2<vk::PhysicalDeviceProperties2, vk::PhysicalDeviceRayTracingPipelinePropertiesKHR>()
          .get<vk::PhysicalDeviceRayTracingPipelinePropertiesKHR>();
  device.shader_table_alignment = pipeline.shaderGroupBaseAlignment;
  rhi::Limits& limits = device.info.limits;
  limits.max_ray_recursion_depth = pipeline.maxRayRecursionDepth;
  limits.max_ray_invocations = pipeline.maxRayDispatchInvocationCount;
  limits.shader_record_alignment = pipeline.shaderGroupHandleAlignment;
  limits.max_shader_record_stride = pipeline.maxShaderGroupStride;
  limits.shader_handle_size = pipeline.shaderGroupHandleSize;
  limits.max_hit_attribute_size = pipeline.maxRayHitAttributeSize;
}

/// The device, or why it does not qualify.
std::optional<PhysicalDevice> examine(vk::raii::PhysicalDevice handle, std::string& refusal) {
  const vk::PhysicalDeviceProperties core_properties = handle.getProperties();
  const std::string name(core_properties.deviceName.data());
  const auto refuse = [&](const std::string& why) {
    refusal = name + " " + why;
    return std::nullopt;
  };
  if (core_properties.apiVersion < VK_API_VERSION_1_2)
    return refuse("has Vulkan " + version_text(core_properties.apiVersion) + ", but 1.2 is needed");

  const OfferedExtensions offered = handle.enumerateDeviceExtensionProperties();
  for (const char* needed :
       {VK_KHR_ACCELERATION_STRUCTURE_EXTENSION_NAME, VK_KHR_DEFERRED_HOST_OPERATIONS_EXTENSION_NAME})
    if (!offers(offered, needed)) return refuse(std::string("lacks the extension ") + needed);

  const auto features =
      handle.getFeatures2<vk::PhysicalDeviceFeatures2, vk::PhysicalDeviceVulkan11Features,
                          vk::PhysicalDeviceVulkan12Features, vk::PhysicalDeviceAccelerationStructureFeaturesKHR>();
  const auto& vulkan12 = features.get<vk::PhysicalDeviceVulkan12Features>();
  if (!features.get<vk::PhysicalDeviceAccelerationStructureFeaturesKHR>().accelerationStructure)
    return refuse("lacks the feature accelerationStructure");
  if (!vulkan12.bufferDeviceAddress) return refuse("lacks the feature bufferDeviceAddress");
  if (!vulkan12.timelineSemaphore) return refuse("lacks the feature timelineSemaphore");

  const std::vector<vk::QueueFamilyProperties> families = handle.getQueueFamilyProperties();
  const std::optional<std::uint32_t> family = compute_queue_family(families);
  if (!family) return refuse("has no queue that computes");

  const auto properties =
      handle
          .getProperties2<vk::PhysicalDeviceProperties2, vk::PhysicalDeviceVulkan11Properties,
                          vk::PhysicalDeviceVulkan12Properties, vk::PhysicalDeviceAccelerationStructurePropertiesKHR>();
  const auto& vulkan11_properties = properties.get<vk::PhysicalDeviceVulkan11Properties>();
  const auto& vulkan12_properties = properties.get<vk::PhysicalDeviceVulkan12Properties>();
  const auto& acceleration = properties.get<vk::PhysicalDeviceAccelerationStructurePropertiesKHR>();

  PhysicalDevice device;
  device.handle = std::move(handle);
  device.features = choose_features(features.get<vk::PhysicalDeviceFeatures2>().features,
                                    features.get<vk::PhysicalDeviceVulkan11Features>(), vulkan12);
  choose_extensions(device.handle, offered, device.features);
  device.queue_family = *family;
  device.timestamp_valid_bits = families[*family].timestampValidBits;
  device.timestamp_period = core_properties.limits.timestampPeriod;
  device.scratch_alignment = acceleration.minAccelerationStructureScratchOffsetAlignment;
  device.shader_stages = stages_of(device.features);
  device.max_allocation_size = vulkan11_properties.maxMemoryAllocationSize;
  device.buffer_image_granularity = core_properties.limits.bufferImageGranularity;
  if (vulkan11_properties.subgroupSupportedStages & vk::ShaderStageFlagBits::eCompute)
    device.subgroup_operations = vulkan11_properties.subgroupSupportedOperations;

  rhi::DeviceInfo& info = device.info;
  info.backend = "vulkan";
  info.description = name;
  info.driver = std::string(vulkan12_properties.driverName.data()) + " " + vulkan12_properties.driverInfo.data();
  info.api = "Vulkan " + version_text(core_properties.apiVersion);
  info.kind = kind_of(core_properties.deviceType);
  info.capabilities = capabilities_of(device.features);
  info.capabilities.timestamps = device.timestamp_valid_bits > 0;
  info.limits = limits_of(core_properties.limits, acceleration);
  if (device.features.ray_tracing_pipeline) add_ray_tracing_pipeline_limits(device);
  return device;
}

}  // namespace

std::vector<const char*> extensions_of(const EnabledFeatures& enabled) {
  std::vector<const char*> extensions = {VK_KHR_ACCELERATION_STRUCTURE_EXTENSION_NAME,
                                         VK_KHR_DEFERRED_HOST_OPERATIONS_EXTENSION_NAME};
  if (enabled.ray_query) extensions.push_back(VK_KHR_RAY_QUERY_EXTENSION_NAME);
  if (enabled.ray_tracing_pipeline) extensions.push_back(VK_KHR_RAY_TRACING_PIPELINE_EXTENSION_NAME);
  if (enabled.null_descriptor) extensions.push_back(VK_EXT_ROBUSTNESS_2_EXTENSION_NAME);
  return extensions;
}

PhysicalDevices find_physical_devices(const Instance& instance) {
  return translating_errors("", "list the Vulkan devices", [&] {
    PhysicalDevices found;
    for (vk::raii::PhysicalDevice& handle : instance.handle().enumeratePhysicalDevices()) {
      std::string refusal;
      if (std::optional<PhysicalDevice> device = examine(std::move(handle), refusal))
        found.qualifying.push_back(std::move(*device));
      else
        found.refusals.push_back(std::move(refusal));
    }
    std::stable_sort(found.qualifying.begin(), found.qualifying.end(),
                     [](const PhysicalDevice& a, const PhysicalDevice& b) { return a.info.kind < b.info.kind; });
    for (std::size_t i = 0; i < found.qualifying.size(); ++i)
      found.qualifying[i].info.name = "vulkan:" + std::to_string(i);
    return found;
  });
}

}  // namespace tandem::vulkan
