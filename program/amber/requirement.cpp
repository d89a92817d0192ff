#include "program/amber/requirement.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <functional>
#include <utility>
#include <vector>

namespace tandem::program::amber {
namespace {

using rhi::Capabilities;
using rhi::DeviceInfo;

using Test = bool (*)(const DeviceInfo&);

struct Named {
  std::string_view name;
  Test has;
};

bool always(const DeviceInfo&) { return true; }
bool never(const DeviceInfo&) { return false; }

// Of SPIR-V; DeviceInfo::spirv_capabilities has the numbers.
constexpr std::uint32_t variable_pointers_storage_buffer = 4441;
constexpr std::uint32_t variable_pointers = 4442;
constexpr std::uint32_t vulkan_memory_model = 5345;
constexpr std::uint32_t vulkan_memory_model_device_scope = 5346;
constexpr std::uint32_t image_gather_extended = 25;
constexpr std::uint32_t storage_image_extended_formats = 49;
constexpr std::uint32_t storage_image_read_without_format = 55;
constexpr std::uint32_t storage_image_write_without_format = 56;
constexpr std::uint32_t min_lod = 42;
constexpr std::uint32_t storage_buffer_16bit = 4433;
constexpr std::uint32_t uniform_and_storage_buffer_16bit = 4434;
constexpr std::uint32_t storage_push_constant_16 = 4435;
constexpr std::uint32_t storage_buffer_8bit = 4448;
constexpr std::uint32_t uniform_and_storage_buffer_8bit = 4449;
constexpr std::uint32_t storage_push_constant_8 = 4450;
constexpr std::uint32_t denorm_preserve = 4464;
constexpr std::uint32_t denorm_flush_to_zero = 4465;
constexpr std::uint32_t signed_zero_inf_nan_preserve = 4466;
constexpr std::uint32_t rounding_mode_rte = 4467;
constexpr std::uint32_t rounding_mode_rtz = 4468;

template <std::uint32_t capability>
bool spirv(const DeviceInfo& device) {
  return std::binary_search(device.spirv_capabilities.begin(), device.spirv_capabilities.end(), capability);
}

template <bool Capabilities::*member>
bool capability(const DeviceInfo& device) {
  return device.capabilities.*member;
}

bool subgroup_sizes(const DeviceInfo& device) { return device.capabilities.required_subgroup_size; }

const std::vector<Named>& features() {
  static const std::vector<Named> list = {
      // Accesses out of bounds are Vulkan's robustBufferAccess2 on every device (DeviceDesc::robust_access).
      {"robustBufferAccess", always},
      {"imageCubeArray", capability<&Capabilities::cube_arrays>},
      {"shaderImageGatherExtended", spirv<image_gather_extended>},
      {"shaderStorageImageExtendedFormats", spirv<storage_image_extended_formats>},
      {"shaderStorageImageReadWithoutFormat", spirv<storage_image_read_without_format>},
      {"shaderStorageImageWriteWithoutFormat", spirv<storage_image_write_without_format>},
      {"shaderUniformBufferArrayDynamicIndexing", always},
      {"shaderSampledImageArrayDynamicIndexing", always},
      {"shaderStorageBufferArrayDynamicIndexing", always},
      {"shaderStorageImageArrayDynamicIndexing", always},
      {"shaderFloat64", capability<&Capabilities::shader_float64>},
      {"shaderInt64", capability<&Capabilities::shader_int64>},
      {"shaderInt16", capability<&Capabilities::shader_int16>},
      {"shaderResourceMinLod", spirv<min_lod>},
      {"VariablePointerFeatures.variablePointers", spirv<variable_pointers>},
      {"VariablePointerFeatures.variablePointersStorageBuffer", spirv<variable_pointers_storage_buffer>},
      {"Float16Int8Features.shaderFloat16", capability<&Capabilities::shader_float16>},
      {"Float16Int8Features.shaderInt8", capability<&Capabilities::shader_int8>},
      {"VulkanMemoryModelFeatures.vulkanMemoryModel", spirv<vulkan_memory_model>},
      {"VulkanMemoryModelFeatures.vulkanMemoryModelDeviceScope", spirv<vulkan_memory_model_device_scope>},
      {"ZeroInitializeWorkgroupMemoryFeatures.shaderZeroInitializeWorkgroupMemory",
       capability<&Capabilities::zeroed_workgroup_memory>},
      {"Storage8BitFeatures.storageBuffer8BitAccess", spirv<storage_buffer_8bit>},
      {"Storage8BitFeatures.uniformAndStorageBuffer8BitAccess", spirv<uniform_and_storage_buffer_8bit>},
      {"Storage8BitFeatures.storagePushConstant8", spirv<storage_push_constant_8>},
      {"Storage16BitFeatures.storageBuffer16BitAccess", spirv<storage_buffer_16bit>},
      {"Storage16BitFeatures.uniformAndStorageBuffer16BitAccess", spirv<uniform_and_storage_buffer_16bit>},
      {"Storage16BitFeatures.storagePushConstant16", spirv<storage_push_constant_16>},
      {"SubgroupSizeControl.subgroupSizeControl", subgroup_sizes},
      {"SubgroupSizeControl.computeFullSubgroups", capability<&Capabilities::full_subgroups>},
      {"SubgroupSupportedOperations.basic", capability<&Capabilities::subgroup_basic>},
      {"SubgroupSupportedOperations.vote", capability<&Capabilities::subgroup_vote>},
      {"SubgroupSupportedOperations.arithmetic", capability<&Capabilities::subgroup_arithmetic>},
      {"SubgroupSupportedOperations.ballot", capability<&Capabilities::subgroup_ballot>},
      {"SubgroupSupportedOperations.shuffle", capability<&Capabilities::subgroup_shuffle>},
      {"SubgroupSupportedOperations.shuffleRelative", capability<&Capabilities::subgroup_shuffle_relative>},
      {"SubgroupSupportedOperations.clustered", capability<&Capabilities::subgroup_clustered>},
      {"SubgroupSupportedOperations.quad", capability<&Capabilities::subgroup_quad>},
      {"SubgroupSupportedStages.compute", capability<&Capabilities::subgroup_basic>},
      {"ShaderSubgroupExtendedTypesFeatures.shaderSubgroupExtendedTypes",
       capability<&Capabilities::subgroup_extended_types>},
      {"RayTracingPipelineFeaturesKHR.rayTracingPipeline", capability<&Capabilities::ray_tracing_pipeline>},
      {"AccelerationStructureFeaturesKHR.accelerationStructure",
       [](const DeviceInfo& device) {
         return device.capabilities.ray_query || device.capabilities.ray_tracing_pipeline;
       }},
      {"RayQueryFeaturesKHR.rayQuery", capability<&Capabilities::ray_query>},
      {"BufferDeviceAddressFeatures.bufferDeviceAddress", capability<&Capabilities::buffer_references>},
  };
  return list;
}

/// Features that are of graphics pipelines, or that the rhi has nothing for.
constexpr std::array absent_features = {
    std::string_view("fullDrawIndexUint32"),
    std::string_view("independentBlend"),
    std::string_view("geometryShader"),
    std::string_view("tessellationShader"),
    std::string_view("sampleRateShading"),
    std::string_view("dualSrcBlend"),
    std::string_view("logicOp"),
    std::string_view("multiDrawIndirect"),
    std::string_view("drawIndirectFirstInstance"),
    std::string_view("depthClamp"),
    std::string_view("depthBiasClamp"),
    std::string_view("fillModeNonSolid"),
    std::string_view("depthBounds"),
    std::string_view("wideLines"),
    std::string_view("largePoints"),
    std::string_view("alphaToOne"),
    std::string_view("multiViewport"),
    std::string_view("samplerAnisotropy"),
    std::string_view("textureCompressionETC2"),
    std::string_view("textureCompressionASTC_LDR"),
    std::string_view("textureCompressionBC"),
    std::string_view("occlusionQueryPrecise"),
    std::string_view("pipelineStatisticsQuery"),
    std::string_view("vertexPipelineStoresAndAtomics"),
    std::string_view("fragmentStoresAndAtomics"),
    std::string_view("shaderTessellationAndGeometryPointSize"),
    std::string_view("shaderStorageImageMultisample"),
    std::string_view("shaderClipDistance"),
    std::string_view("shaderCullDistance"),
    std::string_view("shaderResourceResidency"),
    std::string_view("sparseBinding"),
    std::string_view("sparseResidencyBuffer"),
    std::string_view("sparseResidencyImage2D"),
    std::string_view("sparseResidencyImage3D"),
    std::string_view("sparseResidency2Samples"),
    std::string_view("sparseResidency4Samples"),
    std::string_view("sparseResidency8Samples"),
    std::string_view("sparseResidency16Samples"),
    std::string_view("sparseResidencyAliased"),
    std::string_view("variableMultisampleRate"),
    std::string_view("inheritedQueries"),
    std::string_view("Storage16BitFeatures.storageInputOutput16"),
    std::string_view("DepthClampZeroOneFeatures.depthClampZeroOne"),
    std::string_view("SubgroupSupportedStages.vertex"),
    std::string_view("SubgroupSupportedStages.tessellationControl"),
    std::string_view("SubgroupSupportedStages.tessellationEvaluation"),
    std::string_view("SubgroupSupportedStages.geometry"),
    std::string_view("SubgroupSupportedStages.fragment"),
    std::string_view("IndexTypeUint8Features.indexTypeUint8"),
    std::string_view("CooperativeMatrixFeaturesKHR.cooperativeMatrix"),
    std::string_view("ShaderLongVectorFeaturesEXT.longVector"),
};

/// FloatControlsProperties.shaderDenormPreserveFloat16 and so on: each is a capability, for three widths.
constexpr std::array float_controls = {Named{"shaderSignedZeroInfNanPreserve", spirv<signed_zero_inf_nan_preserve>},
                                       Named{"shaderDenormPreserve", spirv<denorm_preserve>},
                                       Named{"shaderDenormFlushToZero", spirv<denorm_flush_to_zero>},
                                       Named{"shaderRoundingModeRTE", spirv<rounding_mode_rte>},
                                       Named{"shaderRoundingModeRTZ", spirv<rounding_mode_rtz>}};

Test property(std::string_view name) {
  constexpr std::string_view group = "FloatControlsProperties.";
  if (!name.starts_with(group)) return nullptr;
  name.remove_prefix(group.size());
  for (const Named& each : float_controls) {
    if (!name.starts_with(each.name)) continue;
    const std::string_view width = name.substr(each.name.size());
    if (width == "Float16" || width == "Float32" || width == "Float64") return each.has;
  }
  return nullptr;
}

/// Extensions that a shader or a command of ours can need. What became part of Vulkan 1.2 every device has.
const std::vector<Named>& device_extensions() {
  static const std::vector<Named> list = {
      {"VK_KHR_storage_buffer_storage_class", always},
      {"VK_KHR_spirv_1_4", always},
      {"VK_KHR_16bit_storage", capability<&Capabilities::shader_int16>},
      {"VK_KHR_8bit_storage", capability<&Capabilities::shader_int8>},
      {"VK_KHR_shader_float16_int8", capability<&Capabilities::shader_int8>},
      {"VK_KHR_shader_float_controls", always},
      {"VK_KHR_shader_atomic_int64", capability<&Capabilities::shader_int64>},
      {"VK_KHR_shader_subgroup_extended_types", capability<&Capabilities::subgroup_extended_types>},
      {"VK_KHR_shader_subgroup_uniform_control_flow", capability<&Capabilities::subgroup_uniform_control_flow>},
      {"VK_KHR_shader_maximal_reconvergence", capability<&Capabilities::maximal_reconvergence>},
      {"VK_KHR_shader_subgroup_rotate", capability<&Capabilities::subgroup_rotate>},
      {"VK_KHR_variable_pointers", spirv<variable_pointers_storage_buffer>},
      {"VK_KHR_vulkan_memory_model", spirv<vulkan_memory_model>},
      {"VK_KHR_zero_initialize_workgroup_memory", capability<&Capabilities::zeroed_workgroup_memory>},
      {"VK_KHR_workgroup_memory_explicit_layout", capability<&Capabilities::workgroup_memory_layout>},
      {"VK_KHR_relaxed_block_layout", always},
      {"VK_KHR_uniform_buffer_standard_layout", always},
      {"VK_EXT_scalar_block_layout", capability<&Capabilities::scalar_block_layout>},
      {"VK_EXT_descriptor_indexing", capability<&Capabilities::non_uniform_indexing>},
      {"VK_EXT_subgroup_size_control", subgroup_sizes},
      {"VK_KHR_buffer_device_address", capability<&Capabilities::buffer_references>},
      {"VK_KHR_acceleration_structure",
       [](const DeviceInfo& device) {
         return device.capabilities.ray_query || device.capabilities.ray_tracing_pipeline;
       }},
      {"VK_KHR_ray_query", capability<&Capabilities::ray_query>},
      {"VK_KHR_ray_tracing_pipeline", capability<&Capabilities::ray_tracing_pipeline>},
      {"VK_KHR_ray_tracing_position_fetch", capability<&Capabilities::position_fetch>},
      // A pipeline of a script takes the groups of its libraries itself.
      {"VK_KHR_pipeline_library", capability<&Capabilities::ray_tracing_pipeline>},
      {"VK_KHR_deferred_host_operations", always},
      {"VK_KHR_get_memory_requirements2", always},
      {"VK_KHR_maintenance1", always},
      {"VK_KHR_maintenance2", always},
      {"VK_KHR_maintenance3", always},
      {"VK_KHR_shader_non_semantic_info", always},
      {"VK_KHR_non_semantic_info", always},
      {"VK_GOOGLE_decorate_string", always},
      {"VK_GOOGLE_hlsl_functionality1", always},
      {"VK_EXT_robustness2", always},
  };
  return list;
}

Test find(const std::vector<Named>& list, std::string_view name) {
  const auto found = std::find_if(list.begin(), list.end(), [&](const Named& each) { return each.name == name; });
  return found == list.end() ? nullptr : found->has;
}

Test test_of(const Requirement& requirement) {
  switch (requirement.kind) {
    case Requirement::Kind::feature:
      return find(features(), requirement.name);
    case Requirement::Kind::property:
      return property(requirement.name);
    case Requirement::Kind::device_extension:
      return find(device_extensions(), requirement.name);
    case Requirement::Kind::instance_extension:
      // Part of Vulkan 1.1.
      return requirement.name == "VK_KHR_get_physical_device_properties2" ? always : never;
  }
  return nullptr;
}

std::string_view word_of(Requirement::Kind kind) {
  switch (kind) {
    case Requirement::Kind::feature:
      return "device feature";
    case Requirement::Kind::property:
      return "device property";
    case Requirement::Kind::device_extension:
      return "device extension";
    case Requirement::Kind::instance_extension:
      return "instance extension";
  }
  return "";
}

}  // namespace

bool is_known(Requirement::Kind kind, std::string_view name) {
  if (kind == Requirement::Kind::property) return property(name) != nullptr;
  return find(features(), name) != nullptr ||
         std::find(absent_features.begin(), absent_features.end(), name) != absent_features.end();
}

std::string missing(std::span<const Requirement> requirements, const rhi::DeviceInfo& device) {
  for (const Requirement& requirement : requirements) {
    const Test has = test_of(requirement);
    if (has == nullptr || !has(device))
      return fmt::format("it needs the {} {}", word_of(requirement.kind), requirement.name);
  }
  return "";
}

}  // namespace tandem::program::amber
