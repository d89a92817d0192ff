#include "rhi_vulkan/shader_capabilities.hpp"

#include <array>
#include <string>

#include <spirv/unified1/spirv.hpp11>

#include "rhi/error.hpp"

namespace tandem::vulkan {
namespace {

using spv::Capability;

constexpr std::uint32_t newest_spirv = 0x00010500;  // what Vulkan 1.2 requires devices to take
constexpr std::size_t header_words = 5;

/// A capability, and whether a device lets shaders use it. From "Runtime Environment for SPIR-V", Vulkan appendix A.
struct Rule {
  Capability capability;
  const char* name;
  bool (*allowed)(const PhysicalDevice& device);
};

constexpr auto always = [](const PhysicalDevice&) { return true; };

template <vk::Bool32 vk::PhysicalDeviceFeatures::*feature>
constexpr auto core = [](const PhysicalDevice& device) { return device.features.core.*feature == VK_TRUE; };

template <vk::Bool32 vk::PhysicalDeviceVulkan11Features::*feature>
constexpr auto vulkan11 = [](const PhysicalDevice& device) { return device.features.vulkan11.*feature == VK_TRUE; };

template <vk::Bool32 vk::PhysicalDeviceVulkan12Features::*feature>
constexpr auto vulkan12 = [](const PhysicalDevice& device) { return device.features.vulkan12.*feature == VK_TRUE; };

template <vk::SubgroupFeatureFlagBits operation>
constexpr auto subgroup = [](const PhysicalDevice& device) { return bool(device.subgroup_operations & operation); };

constexpr auto ray_query = [](const PhysicalDevice& device) { return device.features.ray_query; };
constexpr auto ray_tracing_pipeline = [](const PhysicalDevice& device) { return device.features.ray_tracing_pipeline; };
constexpr auto primitive_culling = [](const PhysicalDevice& device) {
  return device.features.ray_query || device.features.primitive_culling;
};

using Core = vk::PhysicalDeviceFeatures;
using V11 = vk::PhysicalDeviceVulkan11Features;
using V12 = vk::PhysicalDeviceVulkan12Features;
using Subgroup = vk::SubgroupFeatureFlagBits;

constexpr std::array rules = {
    Rule{Capability::Matrix, "Matrix", always},
    Rule{Capability::Shader, "Shader", always},
    Rule{Capability::Sampled1D, "Sampled1D", always},
    Rule{Capability::Image1D, "Image1D", always},
    Rule{Capability::SampledBuffer, "SampledBuffer", always},
    Rule{Capability::ImageBuffer, "ImageBuffer", always},
    Rule{Capability::ImageQuery, "ImageQuery", always},
    Rule{Capability::Int8, "Int8", vulkan12<&V12::shaderInt8>},
    Rule{Capability::Int16, "Int16", core<&Core::shaderInt16>},
    Rule{Capability::Int64, "Int64", core<&Core::shaderInt64>},
    Rule{Capability::Float16, "Float16", vulkan12<&V12::shaderFloat16>},
    Rule{Capability::Float64, "Float64", core<&Core::shaderFloat64>},
    Rule{Capability::Int64Atomics, "Int64Atomics", vulkan12<&V12::shaderBufferInt64Atomics>},
    Rule{Capability::StorageBuffer8BitAccess, "StorageBuffer8BitAccess", vulkan12<&V12::storageBuffer8BitAccess>},
    Rule{Capability::UniformAndStorageBuffer8BitAccess, "UniformAndStorageBuffer8BitAccess",
         vulkan12<&V12::uniformAndStorageBuffer8BitAccess>},
    Rule{Capability::StorageBuffer16BitAccess, "StorageBuffer16BitAccess", vulkan11<&V11::storageBuffer16BitAccess>},
    Rule{Capability::UniformAndStorageBuffer16BitAccess, "UniformAndStorageBuffer16BitAccess",
         vulkan11<&V11::uniformAndStorageBuffer16BitAccess>},
    Rule{Capability::StorageBufferArrayDynamicIndexing, "StorageBufferArrayDynamicIndexing",
         core<&Core::shaderStorageBufferArrayDynamicIndexing>},
    Rule{Capability::UniformBufferArrayDynamicIndexing, "UniformBufferArrayDynamicIndexing",
         core<&Core::shaderUniformBufferArrayDynamicIndexing>},
    Rule{Capability::StorageImageArrayDynamicIndexing, "StorageImageArrayDynamicIndexing",
         core<&Core::shaderStorageImageArrayDynamicIndexing>},
    Rule{Capability::StorageImageArrayNonUniformIndexing, "StorageImageArrayNonUniformIndexing",
         vulkan12<&V12::shaderStorageImageArrayNonUniformIndexing>},
    Rule{Capability::StorageImageExtendedFormats, "StorageImageExtendedFormats",
         core<&Core::shaderStorageImageExtendedFormats>},
    Rule{Capability::StorageImageReadWithoutFormat, "StorageImageReadWithoutFormat",
         core<&Core::shaderStorageImageReadWithoutFormat>},
    Rule{Capability::StorageImageWriteWithoutFormat, "StorageImageWriteWithoutFormat",
         core<&Core::shaderStorageImageWriteWithoutFormat>},
    Rule{Capability::ShaderNonUniform, "ShaderNonUniform", always},
    Rule{Capability::StorageBufferArrayNonUniformIndexing, "StorageBufferArrayNonUniformIndexing",
         vulkan12<&V12::shaderStorageBufferArrayNonUniformIndexing>},
    Rule{Capability::UniformBufferArrayNonUniformIndexing, "UniformBufferArrayNonUniformIndexing",
         vulkan12<&V12::shaderUniformBufferArrayNonUniformIndexing>},
    Rule{Capability::PhysicalStorageBufferAddresses, "PhysicalStorageBufferAddresses",
         vulkan12<&V12::bufferDeviceAddress>},
    Rule{Capability::VulkanMemoryModel, "VulkanMemoryModel", vulkan12<&V12::vulkanMemoryModel>},
    Rule{Capability::VulkanMemoryModelDeviceScope, "VulkanMemoryModelDeviceScope",
         vulkan12<&V12::vulkanMemoryModelDeviceScope>},
    Rule{Capability::GroupNonUniform, "GroupNonUniform", subgroup<Subgroup::eBasic>},
    Rule{Capability::GroupNonUniformVote, "GroupNonUniformVote", subgroup<Subgroup::eVote>},
    Rule{Capability::GroupNonUniformArithmetic, "GroupNonUniformArithmetic", subgroup<Subgroup::eArithmetic>},
    Rule{Capability::GroupNonUniformBallot, "GroupNonUniformBallot", subgroup<Subgroup::eBallot>},
    Rule{Capability::GroupNonUniformShuffle, "GroupNonUniformShuffle", subgroup<Subgroup::eShuffle>},
    Rule{Capability::GroupNonUniformShuffleRelative, "GroupNonUniformShuffleRelative",
         subgroup<Subgroup::eShuffleRelative>},
    Rule{Capability::GroupNonUniformClustered, "GroupNonUniformClustered", subgroup<Subgroup::eClustered>},
    Rule{Capability::GroupNonUniformQuad, "GroupNonUniformQuad", subgroup<Subgroup::eQuad>},
    Rule{Capability::RayQueryKHR, "RayQueryKHR", ray_query},
    Rule{Capability::RayTraversalPrimitiveCullingKHR, "RayTraversalPrimitiveCullingKHR", primitive_culling},
    Rule{Capability::RayTracingKHR, "RayTracingKHR", ray_tracing_pipeline},
};

void check_capability(Capability capability, const PhysicalDevice& device, std::string_view label) {
  std::string name = std::to_string(static_cast<std::uint32_t>(capability));
  for (const Rule& rule : rules) {
    if (rule.capability != capability) continue;
    if (rule.allowed(device)) return;
    name = rule.name;
  }
  throw rhi::Error(
      rhi::ErrorCode::unsupported, label,
      "the shader needs the SPIR-V capability " + name + ", which device '" + device.info.name + "' does not offer");
}

}  // namespace

void check_shader_capabilities(std::span<const std::uint32_t> spirv, const PhysicalDevice& device,
                               std::string_view label) {
  if (spirv[1] > newest_spirv)
    throw rhi::Error(rhi::ErrorCode::unsupported, label,
                     "the shader is SPIR-V " + std::to_string(spirv[1] >> 16 & 0xff) + "." +
                         std::to_string(spirv[1] >> 8 & 0xff) + ", but Vulkan 1.2 takes at most 1.5");
  // Capabilities come first in a module, so the first other instruction ends them.
  for (std::size_t i = header_words; i + 1 < spirv.size(); i += spirv[i] >> 16) {
    if ((spirv[i] & 0xffff) != static_cast<std::uint32_t>(spv::Op::OpCapability)) break;
    check_capability(static_cast<Capability>(spirv[i + 1]), device, label);
  }
}

}  // namespace tandem::vulkan
