#include "rhi_vulkan/physical_device.hpp"

#include <algorithm>
#include <cstring>
#include <optional>
#include <string_view>
#include <utility>

#include "rhi_vulkan/error.hpp"
#include "rhi_vulkan/formats.hpp"

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

vk::ShaderStageFlags stages_of(const EnabledFeatures& enabled) {
  using Stage = vk::ShaderStageFlagBits;
  vk::ShaderStageFlags stages = Stage::eCompute;
  if (enabled.ray_tracing_pipeline.rayTracingPipeline)
    stages |= Stage::eRaygenKHR | Stage::eAnyHitKHR | Stage::eClosestHitKHR | Stage::eMissKHR |
              Stage::eIntersectionKHR | Stage::eCallableKHR;
  return stages;
}

rhi::Capabilities capabilities_of(const EnabledFeatures& enabled) {
  rhi::Capabilities capabilities;
  const vk::PhysicalDeviceVulkan12Features& v12 = enabled.vulkan12;
  capabilities.ray_query = enabled.ray_query.rayQuery;
  capabilities.ray_tracing_pipeline = enabled.ray_tracing_pipeline.rayTracingPipeline;
  capabilities.trace_rays_indirect = enabled.ray_tracing_pipeline.rayTracingPipelineTraceRaysIndirect;
  capabilities.primitive_culling = enabled.ray_tracing_pipeline.rayTraversalPrimitiveCulling;
  capabilities.null_acceleration_structure = enabled.robustness2.nullDescriptor;
  capabilities.buffer_references = v12.bufferDeviceAddress;
  // Arrays of acceleration structures need no feature of their own.
  capabilities.non_uniform_indexing =
      v12.shaderStorageBufferArrayNonUniformIndexing && v12.shaderUniformBufferArrayNonUniformIndexing &&
      v12.shaderStorageImageArrayNonUniformIndexing && v12.shaderSampledImageArrayNonUniformIndexing;
  capabilities.unsized_arrays = v12.runtimeDescriptorArray;
  capabilities.partially_bound = v12.descriptorBindingPartiallyBound;
  capabilities.cube_arrays = enabled.core.imageCubeArray;
  capabilities.scalar_block_layout = v12.scalarBlockLayout;
  capabilities.shader_int8 = v12.shaderInt8 && v12.storageBuffer8BitAccess;
  capabilities.shader_int16 = enabled.core.shaderInt16 && enabled.vulkan11.storageBuffer16BitAccess;
  capabilities.shader_int64 = enabled.core.shaderInt64;
  capabilities.shader_float16 = v12.shaderFloat16 && enabled.vulkan11.storageBuffer16BitAccess;
  capabilities.shader_float64 = enabled.core.shaderFloat64;
  return capabilities;
}

rhi::Limits limits_of(const vk::PhysicalDeviceLimits& core,
                      const vk::PhysicalDeviceAccelerationStructurePropertiesKHR& acceleration) {
  // Custom indices and gl_InstanceID have 24 bits to spare at most, whatever the driver claims.
  constexpr std::uint64_t most_instances = (1ull << 24) - 1;
  rhi::Limits limits;
  limits.max_push_constant_size = core.maxPushConstantsSize;
  limits.texel_buffer_offset_alignment = core.minTexelBufferOffsetAlignment;
  limits.max_texel_buffer_elements = core.maxTexelBufferElements;
  limits.max_storage_buffer_range = core.maxStorageBufferRange;
  limits.max_uniform_buffer_range = core.maxUniformBufferRange;
  limits.storage_buffer_offset_alignment = core.minStorageBufferOffsetAlignment;
  limits.uniform_buffer_offset_alignment = core.minUniformBufferOffsetAlignment;
  for (std::size_t i = 0; i < 3; ++i) {
    limits.max_workgroup_size[i] = core.maxComputeWorkGroupSize[i];
    limits.max_workgroup_count[i] = core.maxComputeWorkGroupCount[i];
  }
  limits.max_workgroup_invocations = core.maxComputeWorkGroupInvocations;
  limits.workgroup_memory_size = core.maxComputeSharedMemorySize;
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

void add_workgroup_memory(rhi::Capabilities& capabilities, const EnabledFeatures& enabled) {
  capabilities.zeroed_workgroup_memory = has_zeroed_workgroup_memory(enabled);
  capabilities.workgroup_memory_layout = enabled.explicit_workgroup_layout.workgroupMemoryExplicitLayout;
  capabilities.workgroup_memory_layout_8bit = enabled.explicit_workgroup_layout.workgroupMemoryExplicitLayout8BitAccess;
  capabilities.workgroup_memory_layout_16bit =
      enabled.explicit_workgroup_layout.workgroupMemoryExplicitLayout16BitAccess;
  capabilities.shared_int64_atomics = enabled.vulkan12.shaderSharedInt64Atomics;
  capabilities.shared_float32_atomics = enabled.atomic_float.shaderSharedFloat32Atomics;
  capabilities.shared_float32_atomic_add = enabled.atomic_float.shaderSharedFloat32AtomicAdd;
  capabilities.shared_float32_atomic_min_max = enabled.atomic_float2.shaderSharedFloat32AtomicMinMax;
  capabilities.shared_float64_atomic_add = enabled.atomic_float.shaderSharedFloat64AtomicAdd;
}

void add_subgroup_operations(rhi::Capabilities& capabilities, vk::SubgroupFeatureFlags operations,
                             const EnabledFeatures& enabled) {
  using Operation = vk::SubgroupFeatureFlagBits;
  const auto has = [operations](Operation operation) { return bool(operations & operation); };
  capabilities.subgroup_basic = has(Operation::eBasic);
  capabilities.subgroup_vote = has(Operation::eVote);
  capabilities.subgroup_arithmetic = has(Operation::eArithmetic);
  capabilities.subgroup_ballot = has(Operation::eBallot);
  capabilities.subgroup_shuffle = has(Operation::eShuffle);
  capabilities.subgroup_shuffle_relative = has(Operation::eShuffleRelative);
  capabilities.subgroup_clustered = has(Operation::eClustered);
  capabilities.subgroup_quad = has(Operation::eQuad);
  capabilities.subgroup_rotate = has_subgroup_rotate(enabled);
  capabilities.subgroup_clustered_rotate = has_clustered_subgroup_rotate(enabled);
  capabilities.subgroup_extended_types = enabled.vulkan12.shaderSubgroupExtendedTypes;
  capabilities.full_subgroups = has_full_subgroups(enabled);
  capabilities.subgroup_uniform_control_flow = enabled.subgroup_uniform_control_flow.shaderSubgroupUniformControlFlow;
  capabilities.maximal_reconvergence = has_maximal_reconvergence(enabled);
}

/// What devices say that let a pipeline require the size of its subgroups.
void add_subgroup_sizes(PhysicalDevice& device) {
  if (!has_subgroup_size_control(device.features)) return;
  const auto sizes =
      device.handle.getProperties2<vk::PhysicalDeviceProperties2, vk::PhysicalDeviceSubgroupSizeControlProperties>()
          .get<vk::PhysicalDeviceSubgroupSizeControlProperties>();
  device.info.limits.min_subgroup_size = sizes.minSubgroupSize;
  device.info.limits.max_subgroup_size = sizes.maxSubgroupSize;
  device.info.limits.max_workgroup_subgroups = sizes.maxComputeWorkgroupSubgroups;
  device.info.capabilities.required_subgroup_size =
      bool(sizes.requiredSubgroupSizeStages & vk::ShaderStageFlagBits::eCompute);
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

  const auto features = handle.getFeatures2<vk::PhysicalDeviceFeatures2, vk::PhysicalDeviceVulkan12Features,
                                            vk::PhysicalDeviceAccelerationStructureFeaturesKHR>();
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
  device.features = choose_features(device.handle);
  // SPIR-V 1.6 came with Vulkan 1.3 ("Versions and Formats" of the appendix "Vulkan Environment for SPIR-V").
  device.newest_spirv = device.features.has_vulkan13 ? 0x00010600 : 0x00010500;
  device.vulkan12 = vulkan12_properties;
  device.vulkan12.pNext = nullptr;
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
  add_workgroup_memory(info.capabilities, device.features);
  add_subgroup_operations(info.capabilities, device.subgroup_operations, device.features);
  info.limits = limits_of(core_properties.limits, acceleration);
  info.limits.subgroup_size = vulkan11_properties.subgroupSize;
  info.limits.min_subgroup_size = info.limits.max_subgroup_size = vulkan11_properties.subgroupSize;
  add_subgroup_sizes(device);
  for (std::size_t i = 0; i < info.formats.size(); ++i)
    info.formats[i] = support_of(device.handle, static_cast<rhi::TextureFormat>(i));
  if (device.features.ray_tracing_pipeline.rayTracingPipeline) add_ray_tracing_pipeline_limits(device);
  return device;
}

}  // namespace

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
