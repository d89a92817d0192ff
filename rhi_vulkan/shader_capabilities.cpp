#include "rhi_vulkan/shader_capabilities.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include <spirv/unified1/spirv.hpp11>

#include "rhi/error.hpp"
#include "rhi/spirv/names.hpp"

namespace tandem::vulkan {
namespace {

using spv::Capability;

constexpr std::size_t header_words = 5;

/// A capability, and whether a device lets shaders use it. From "Runtime Environment for SPIR-V", Vulkan appendix A.
struct Rule {
  Capability capability;
  bool (*allowed)(const PhysicalDevice& device);
};

constexpr auto always = [](const PhysicalDevice&) { return true; };

template <vk::Bool32 vk::PhysicalDeviceFeatures::*feature>
constexpr auto core = [](const PhysicalDevice& device) { return device.features.core.*feature == VK_TRUE; };

template <vk::Bool32 vk::PhysicalDeviceVulkan11Features::*feature>
constexpr auto vulkan11 = [](const PhysicalDevice& device) { return device.features.vulkan11.*feature == VK_TRUE; };

template <vk::Bool32 vk::PhysicalDeviceVulkan12Features::*... feature>
constexpr auto vulkan12 =
    [](const PhysicalDevice& device) { return ((device.features.vulkan12.*feature == VK_TRUE) || ...); };

template <vk::Bool32 vk::PhysicalDeviceVulkan13Features::*feature>
constexpr auto vulkan13 = [](const PhysicalDevice& device) { return device.features.vulkan13.*feature == VK_TRUE; };

/// One of several float widths is enough: an execution mode names the width, and the validator checks it.
template <vk::Bool32 vk::PhysicalDeviceVulkan12Properties::*... property>
constexpr auto float_control =
    [](const PhysicalDevice& device) { return ((device.vulkan12.*property == VK_TRUE) || ...); };

template <auto extension, auto... feature>
constexpr auto extension_feature =
    [](const PhysicalDevice& device) { return (((device.features.*extension).*feature == VK_TRUE) || ...); };

template <vk::SubgroupFeatureFlagBits operation>
constexpr auto subgroup = [](const PhysicalDevice& device) { return bool(device.subgroup_operations & operation); };

constexpr auto primitive_culling = [](const PhysicalDevice& device) {
  return device.features.ray_query.rayQuery || device.features.ray_tracing_pipeline.rayTraversalPrimitiveCulling;
};

using E = EnabledFeatures;
using AtomicFloat = vk::PhysicalDeviceShaderAtomicFloatFeaturesEXT;
using AtomicFloat2 = vk::PhysicalDeviceShaderAtomicFloat2FeaturesEXT;
using ExplicitLayout = vk::PhysicalDeviceWorkgroupMemoryExplicitLayoutFeaturesKHR;
using P12 = vk::PhysicalDeviceVulkan12Properties;
using V13 = vk::PhysicalDeviceVulkan13Features;
using Core = vk::PhysicalDeviceFeatures;
using V11 = vk::PhysicalDeviceVulkan11Features;
using V12 = vk::PhysicalDeviceVulkan12Features;
using Subgroup = vk::SubgroupFeatureFlagBits;

constexpr std::array rules = {
    Rule{Capability::Matrix, always},
    Rule{Capability::Shader, always},
    Rule{Capability::Sampled1D, always},
    Rule{Capability::Image1D, always},
    Rule{Capability::SampledBuffer, always},
    Rule{Capability::ImageBuffer, always},
    Rule{Capability::ImageQuery, always},
    Rule{Capability::Int8, vulkan12<&V12::shaderInt8>},
    Rule{Capability::Int16, core<&Core::shaderInt16>},
    Rule{Capability::Int64, core<&Core::shaderInt64>},
    Rule{Capability::Float16, vulkan12<&V12::shaderFloat16>},
    Rule{Capability::Float64, core<&Core::shaderFloat64>},
    Rule{Capability::Int64Atomics, vulkan12<&V12::shaderBufferInt64Atomics, &V12::shaderSharedInt64Atomics>},
    Rule{Capability::StorageBuffer8BitAccess, vulkan12<&V12::storageBuffer8BitAccess>},
    Rule{Capability::UniformAndStorageBuffer8BitAccess, vulkan12<&V12::uniformAndStorageBuffer8BitAccess>},
    Rule{Capability::StorageBuffer16BitAccess, vulkan11<&V11::storageBuffer16BitAccess>},
    Rule{Capability::UniformAndStorageBuffer16BitAccess, vulkan11<&V11::uniformAndStorageBuffer16BitAccess>},
    Rule{Capability::StorageBufferArrayDynamicIndexing, core<&Core::shaderStorageBufferArrayDynamicIndexing>},
    Rule{Capability::UniformBufferArrayDynamicIndexing, core<&Core::shaderUniformBufferArrayDynamicIndexing>},
    Rule{Capability::StorageImageArrayDynamicIndexing, core<&Core::shaderStorageImageArrayDynamicIndexing>},
    Rule{Capability::StorageImageArrayNonUniformIndexing, vulkan12<&V12::shaderStorageImageArrayNonUniformIndexing>},
    Rule{Capability::StorageImageExtendedFormats, core<&Core::shaderStorageImageExtendedFormats>},
    Rule{Capability::StorageImageReadWithoutFormat, core<&Core::shaderStorageImageReadWithoutFormat>},
    Rule{Capability::StorageImageWriteWithoutFormat, core<&Core::shaderStorageImageWriteWithoutFormat>},
    Rule{Capability::ShaderNonUniform, always},
    Rule{Capability::StorageBufferArrayNonUniformIndexing, vulkan12<&V12::shaderStorageBufferArrayNonUniformIndexing>},
    Rule{Capability::UniformBufferArrayNonUniformIndexing, vulkan12<&V12::shaderUniformBufferArrayNonUniformIndexing>},
    Rule{Capability::PhysicalStorageBufferAddresses, vulkan12<&V12::bufferDeviceAddress>},
    Rule{Capability::VulkanMemoryModel, vulkan12<&V12::vulkanMemoryModel>},
    Rule{Capability::VulkanMemoryModelDeviceScope, vulkan12<&V12::vulkanMemoryModelDeviceScope>},
    Rule{Capability::GroupNonUniform, subgroup<Subgroup::eBasic>},
    Rule{Capability::GroupNonUniformVote, subgroup<Subgroup::eVote>},
    Rule{Capability::GroupNonUniformArithmetic, subgroup<Subgroup::eArithmetic>},
    Rule{Capability::GroupNonUniformBallot, subgroup<Subgroup::eBallot>},
    Rule{Capability::GroupNonUniformShuffle, subgroup<Subgroup::eShuffle>},
    Rule{Capability::GroupNonUniformShuffleRelative, subgroup<Subgroup::eShuffleRelative>},
    Rule{Capability::GroupNonUniformClustered, subgroup<Subgroup::eClustered>},
    Rule{Capability::GroupNonUniformQuad, subgroup<Subgroup::eQuad>},
    // That of the clusters of a rotation is told by its operands, which the validation layer looks at.
    Rule{Capability::GroupNonUniformRotateKHR,
         [](const PhysicalDevice& device) { return has_subgroup_rotate(device.features); }},
    Rule{Capability::RayQueryKHR, extension_feature<&E::ray_query, &vk::PhysicalDeviceRayQueryFeaturesKHR::rayQuery>},
    Rule{Capability::RayTraversalPrimitiveCullingKHR, primitive_culling},
    Rule{Capability::RayTracingKHR,
         extension_feature<&E::ray_tracing_pipeline,
                           &vk::PhysicalDeviceRayTracingPipelineFeaturesKHR::rayTracingPipeline>},
    Rule{Capability::RayCullMaskKHR,
         extension_feature<&E::ray_tracing_maintenance1,
                           &vk::PhysicalDeviceRayTracingMaintenance1FeaturesKHR::rayTracingMaintenance1>},
    Rule{Capability::SampledCubeArray, core<&Core::imageCubeArray>},
    Rule{Capability::ImageCubeArray, core<&Core::imageCubeArray>},
    Rule{Capability::ImageGatherExtended, core<&Core::shaderImageGatherExtended>},
    Rule{Capability::MinLod, core<&Core::shaderResourceMinLod>},
    Rule{Capability::SampledImageArrayDynamicIndexing, core<&Core::shaderSampledImageArrayDynamicIndexing>},
    Rule{Capability::RuntimeDescriptorArray, vulkan12<&V12::runtimeDescriptorArray>},
    Rule{Capability::SampledImageArrayNonUniformIndexing, vulkan12<&V12::shaderSampledImageArrayNonUniformIndexing>},
    Rule{Capability::UniformTexelBufferArrayDynamicIndexing,
         vulkan12<&V12::shaderUniformTexelBufferArrayDynamicIndexing>},
    Rule{Capability::StorageTexelBufferArrayDynamicIndexing,
         vulkan12<&V12::shaderStorageTexelBufferArrayDynamicIndexing>},
    Rule{Capability::UniformTexelBufferArrayNonUniformIndexing,
         vulkan12<&V12::shaderUniformTexelBufferArrayNonUniformIndexing>},
    Rule{Capability::StorageTexelBufferArrayNonUniformIndexing,
         vulkan12<&V12::shaderStorageTexelBufferArrayNonUniformIndexing>},
    Rule{Capability::StoragePushConstant8, vulkan12<&V12::storagePushConstant8>},
    Rule{Capability::StoragePushConstant16, vulkan11<&V11::storagePushConstant16>},
    Rule{Capability::VariablePointers, vulkan11<&V11::variablePointers>},
    Rule{Capability::VariablePointersStorageBuffer, vulkan11<&V11::variablePointersStorageBuffer>},
    Rule{Capability::DenormPreserve, float_control<&P12::shaderDenormPreserveFloat16, &P12::shaderDenormPreserveFloat32,
                                                   &P12::shaderDenormPreserveFloat64>},
    Rule{Capability::DenormFlushToZero,
         float_control<&P12::shaderDenormFlushToZeroFloat16, &P12::shaderDenormFlushToZeroFloat32,
                       &P12::shaderDenormFlushToZeroFloat64>},
    Rule{Capability::SignedZeroInfNanPreserve,
         float_control<&P12::shaderSignedZeroInfNanPreserveFloat16, &P12::shaderSignedZeroInfNanPreserveFloat32,
                       &P12::shaderSignedZeroInfNanPreserveFloat64>},
    Rule{Capability::RoundingModeRTE,
         float_control<&P12::shaderRoundingModeRTEFloat16, &P12::shaderRoundingModeRTEFloat32,
                       &P12::shaderRoundingModeRTEFloat64>},
    Rule{Capability::RoundingModeRTZ,
         float_control<&P12::shaderRoundingModeRTZFloat16, &P12::shaderRoundingModeRTZFloat32,
                       &P12::shaderRoundingModeRTZFloat64>},
    Rule{Capability::ShaderClockKHR,
         extension_feature<&E::shader_clock, &vk::PhysicalDeviceShaderClockFeaturesKHR::shaderSubgroupClock,
                           &vk::PhysicalDeviceShaderClockFeaturesKHR::shaderDeviceClock>},
    Rule{Capability::DotProduct, vulkan13<&V13::shaderIntegerDotProduct>},
    Rule{Capability::DotProductInputAll, vulkan13<&V13::shaderIntegerDotProduct>},
    Rule{Capability::DotProductInput4x8Bit, vulkan13<&V13::shaderIntegerDotProduct>},
    Rule{Capability::DotProductInput4x8BitPacked, vulkan13<&V13::shaderIntegerDotProduct>},
    Rule{Capability::AtomicFloat32AddEXT,
         extension_feature<&E::atomic_float, &AtomicFloat::shaderBufferFloat32AtomicAdd,
                           &AtomicFloat::shaderSharedFloat32AtomicAdd, &AtomicFloat::shaderImageFloat32AtomicAdd>},
    Rule{Capability::AtomicFloat64AddEXT,
         extension_feature<&E::atomic_float, &AtomicFloat::shaderBufferFloat64AtomicAdd,
                           &AtomicFloat::shaderSharedFloat64AtomicAdd>},
    Rule{Capability::AtomicFloat16AddEXT,
         extension_feature<&E::atomic_float2, &AtomicFloat2::shaderBufferFloat16AtomicAdd,
                           &AtomicFloat2::shaderSharedFloat16AtomicAdd>},
    Rule{Capability::AtomicFloat16MinMaxEXT,
         extension_feature<&E::atomic_float2, &AtomicFloat2::shaderBufferFloat16AtomicMinMax,
                           &AtomicFloat2::shaderSharedFloat16AtomicMinMax>},
    Rule{Capability::AtomicFloat32MinMaxEXT,
         extension_feature<&E::atomic_float2, &AtomicFloat2::shaderBufferFloat32AtomicMinMax,
                           &AtomicFloat2::shaderSharedFloat32AtomicMinMax,
                           &AtomicFloat2::shaderImageFloat32AtomicMinMax>},
    Rule{Capability::AtomicFloat64MinMaxEXT,
         extension_feature<&E::atomic_float2, &AtomicFloat2::shaderBufferFloat64AtomicMinMax,
                           &AtomicFloat2::shaderSharedFloat64AtomicMinMax>},
    Rule{Capability::Int64ImageEXT,
         extension_feature<&E::image_atomic_int64,
                           &vk::PhysicalDeviceShaderImageAtomicInt64FeaturesEXT::shaderImageInt64Atomics>},
    Rule{Capability::WorkgroupMemoryExplicitLayoutKHR,
         extension_feature<&E::explicit_workgroup_layout, &ExplicitLayout::workgroupMemoryExplicitLayout>},
    Rule{Capability::WorkgroupMemoryExplicitLayout8BitAccessKHR,
         extension_feature<&E::explicit_workgroup_layout, &ExplicitLayout::workgroupMemoryExplicitLayout8BitAccess>},
    Rule{Capability::WorkgroupMemoryExplicitLayout16BitAccessKHR,
         extension_feature<&E::explicit_workgroup_layout, &ExplicitLayout::workgroupMemoryExplicitLayout16BitAccess>},
};

/// An extension of SPIR-V that has no capability of its own, but execution modes for which Vulkan has a feature.
struct ExtensionRule {
  std::string_view name;
  bool (*allowed)(const PhysicalDevice& device);
};

constexpr std::array extension_rules = {
    ExtensionRule{
        "SPV_KHR_subgroup_uniform_control_flow",
        extension_feature<
            &E::subgroup_uniform_control_flow,
            &vk::PhysicalDeviceShaderSubgroupUniformControlFlowFeaturesKHR::shaderSubgroupUniformControlFlow>},
    ExtensionRule{"SPV_KHR_maximal_reconvergence",
                  [](const PhysicalDevice& device) { return has_maximal_reconvergence(device.features); }},
};

/// "the SPIR-V capability X", for one that the device does not offer; empty for one that it does.
std::string missing(Capability capability, const PhysicalDevice& device) {
  for (const Rule& rule : rules)
    if (rule.capability == capability && rule.allowed(device)) return {};
  return "the SPIR-V capability " + rhi::capability_name(static_cast<std::uint32_t>(capability));
}

/// The text that begins at this operand.
std::string_view literal_string(std::span<const std::uint32_t> operand) {
  const std::string_view text(reinterpret_cast<const char*>(operand.data()), operand.size_bytes());
  return text.substr(0, text.find('\0'));
}

/// What of an instruction that is not OpCapability needs a feature that the device lacks; empty: nothing.
std::string missing(std::span<const std::uint32_t> instruction, const PhysicalDevice& device) {
  constexpr std::size_t words_with_initializer = 5;
  const auto op = static_cast<spv::Op>(instruction[0] & 0xffff);
  if (op == spv::Op::OpExtension) {
    const std::string_view name = literal_string(instruction.subspan(1));
    for (const ExtensionRule& rule : extension_rules)
      if (rule.name == name && !rule.allowed(device)) return "the SPIR-V extension " + std::string(name);
  }
  if (op == spv::Op::OpVariable && instruction.size() == words_with_initializer &&
      instruction[3] == static_cast<std::uint32_t>(spv::StorageClass::Workgroup) &&
      !has_zeroed_workgroup_memory(device.features))
    return "workgroup memory that is initialized";
  return {};
}

std::string version_text(std::uint32_t version) {
  return std::to_string(version >> 16 & 0xff) + "." + std::to_string(version >> 8 & 0xff);
}

}  // namespace

std::vector<std::uint32_t> known_capabilities() {
  std::vector<std::uint32_t> numbers;
  for (const Rule& rule : rules) numbers.push_back(static_cast<std::uint32_t>(rule.capability));
  std::sort(numbers.begin(), numbers.end());
  return numbers;
}

std::vector<std::uint32_t> offered_capabilities(const PhysicalDevice& device) {
  std::vector<std::uint32_t> numbers;
  for (const Rule& rule : rules)
    if (rule.allowed(device)) numbers.push_back(static_cast<std::uint32_t>(rule.capability));
  std::sort(numbers.begin(), numbers.end());
  return numbers;
}

std::vector<std::string> missing_capabilities(std::span<const std::uint32_t> spirv, const PhysicalDevice& device) {
  std::vector<std::string> all;
  if (spirv[1] > device.newest_spirv)
    all.push_back("SPIR-V " + version_text(spirv[1]) + " (it takes at most " + version_text(device.newest_spirv) + ")");
  for (std::size_t i = header_words; i + 1 < spirv.size();) {
    const std::size_t length = std::clamp<std::size_t>(spirv[i] >> 16, 1, spirv.size() - i);
    const std::span<const std::uint32_t> instruction = spirv.subspan(i, length);
    const auto op = static_cast<spv::Op>(instruction[0] & 0xffff);
    // Functions come last and declare nothing of the module's.
    if (op == spv::Op::OpFunction) break;
    std::string what = op == spv::Op::OpCapability && length > 1
                           ? missing(static_cast<Capability>(instruction[1]), device)
                           : missing(instruction, device);
    if (!what.empty() && std::find(all.begin(), all.end(), what) == all.end()) all.push_back(std::move(what));
    i += length;
  }
  return all;
}

void check_shader_capabilities(std::span<const std::uint32_t> spirv, const PhysicalDevice& device,
                               std::string_view label) {
  const std::vector<std::string> all = missing_capabilities(spirv, device);
  if (all.empty()) return;
  std::string list;
  for (std::size_t i = 0; i < all.size(); ++i) list += (i == 0 ? "" : i + 1 == all.size() ? " and " : ", ") + all[i];
  throw rhi::Error(rhi::ErrorCode::unsupported, label,
                   "the shader needs " + list + ", which device '" + device.info.name + "' does not offer");
}

}  // namespace tandem::vulkan
