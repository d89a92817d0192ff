#include "rhi_vulkan/ray_tracing_pipeline.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include <spirv/unified1/spirv.hpp11>

#include "rhi_vulkan/shader_module.hpp"

namespace tandem::vulkan {
namespace {

vk::ShaderStageFlagBits stage_of(rhi::ShaderStage stage) {
  switch (stage) {
    case rhi::ShaderStage::ray_generation:
      return vk::ShaderStageFlagBits::eRaygenKHR;
    case rhi::ShaderStage::any_hit:
      return vk::ShaderStageFlagBits::eAnyHitKHR;
    case rhi::ShaderStage::closest_hit:
      return vk::ShaderStageFlagBits::eClosestHitKHR;
    case rhi::ShaderStage::miss:
      return vk::ShaderStageFlagBits::eMissKHR;
    case rhi::ShaderStage::intersection:
      return vk::ShaderStageFlagBits::eIntersectionKHR;
    case rhi::ShaderStage::callable:
      return vk::ShaderStageFlagBits::eCallableKHR;
    default:
      return vk::ShaderStageFlagBits::eCompute;
  }
}

/// The stages and groups of a pipeline; groups name stages by position.
class Groups {
 public:
  Groups(const rhi::RayTracingPipelineDesc& desc, const ContextHandle& context,
         const vk::SpecializationInfo& specialization)
      : shaders_(rhi::shaders_of(desc)) {
    for (const rhi::ShaderModuleHandle& shader : shaders_)
      stages.push_back({.stage = stage_of(shader->reflection().stage),
                        .module = own<ShaderModule>(shader, context, desc.label, "shader module").handle(),
                        .pName = shader->reflection().entry_point.c_str(),
                        .pSpecializationInfo = &specialization});
    for (const rhi::ShaderModuleHandle& shader : desc.ray_generation) add_general(shader);
    for (const rhi::ShaderModuleHandle& shader : desc.miss) add_general(shader);
    for (const rhi::HitGroup& group : desc.hit_groups) add_hit(group);
    for (const rhi::ShaderModuleHandle& shader : desc.callable) add_general(shader);
  }

  std::vector<vk::PipelineShaderStageCreateInfo> stages;
  std::vector<vk::RayTracingShaderGroupCreateInfoKHR> groups;

 private:
  std::uint32_t stage_index(const rhi::ShaderModuleHandle& shader) const {
    if (shader == nullptr) return VK_SHADER_UNUSED_KHR;
    return static_cast<std::uint32_t>(std::find(shaders_.begin(), shaders_.end(), shader) - shaders_.begin());
  }

  void add_general(const rhi::ShaderModuleHandle& shader) {
    groups.push_back({.type = vk::RayTracingShaderGroupTypeKHR::eGeneral,
                      .generalShader = stage_index(shader),
                      .closestHitShader = VK_SHADER_UNUSED_KHR,
                      .anyHitShader = VK_SHADER_UNUSED_KHR,
                      .intersectionShader = VK_SHADER_UNUSED_KHR});
  }

  void add_hit(const rhi::HitGroup& group) {
    groups.push_back({.type = group.intersection == nullptr ? vk::RayTracingShaderGroupTypeKHR::eTrianglesHitGroup
                                                            : vk::RayTracingShaderGroupTypeKHR::eProceduralHitGroup,
                      .generalShader = VK_SHADER_UNUSED_KHR,
                      .closestHitShader = stage_index(group.closest_hit),
                      .anyHitShader = stage_index(group.any_hit),
                      .intersectionShader = stage_index(group.intersection)});
  }

  std::vector<rhi::ShaderModuleHandle> shaders_;
};

bool executes_callables(const rhi::ShaderModule& shader) {
  constexpr std::size_t header_words = 5;
  const std::span<const std::uint32_t> spirv = shader.spirv();
  for (std::size_t i = header_words; i < spirv.size(); i += std::max(spirv[i] >> 16, 1u))
    if ((spirv[i] & 0xffff) == static_cast<std::uint32_t>(spv::Op::OpExecuteCallableKHR)) return true;
  return false;
}

/// The driver's own stack has room for two callable shaders in flight (Vulkan: "Ray Tracing Pipeline Stack").
bool needs_stack_size(const rhi::RayTracingPipelineDesc& desc) {
  return std::any_of(desc.callable.begin(), desc.callable.end(),
                     [](const rhi::ShaderModuleHandle& shader) { return executes_callables(*shader); });
}

}  // namespace

RayTracingPipeline::RayTracingPipeline(ContextHandle context, const rhi::RayTracingPipelineDesc& desc)
    : rhi::RayTracingPipeline(desc), context_(std::move(context)) {
  translating_errors(desc.label, "create the ray tracing pipeline", [&] {
    layout_.emplace(*context_, interface());
    const Specialization specialization(desc.specialization, rhi::shaders_of(desc));
    const Groups groups(desc, context_, specialization.info());
    constexpr vk::DynamicState stack_size = vk::DynamicState::eRayTracingPipelineStackSizeKHR;
    const vk::PipelineDynamicStateCreateInfo dynamic_state = {.dynamicStateCount = needs_stack_size(desc) ? 1u : 0u,
                                                              .pDynamicStates = &stack_size};
    pipeline_ =
        context_->device.createRayTracingPipelineKHR(nullptr, nullptr,
                                                     {.stageCount = static_cast<std::uint32_t>(groups.stages.size()),
                                                      .pStages = groups.stages.data(),
                                                      .groupCount = static_cast<std::uint32_t>(groups.groups.size()),
                                                      .pGroups = groups.groups.data(),
                                                      .maxPipelineRayRecursionDepth = desc.max_recursion_depth,
                                                      .pDynamicState = &dynamic_state,
                                                      .layout = layout_->handle()});
    context_->name(pipeline_, desc.label);
    const auto group_count = static_cast<std::uint32_t>(groups.groups.size());
    group_handles_ = pipeline_.getRayTracingShaderGroupHandlesKHR<std::byte>(
        0, group_count, std::size_t{group_count} * context_->physical.info.limits.shader_handle_size);
    if (needs_stack_size(desc)) stack_size_ = needed_stack_size();
  });
}

std::span<const std::byte> RayTracingPipeline::group_handle(GroupKind kind, std::uint32_t position) const {
  const std::size_t size = context_->physical.info.limits.shader_handle_size;
  return std::span(group_handles_).subspan(group_index(kind, position) * size, size);
}

std::uint32_t RayTracingPipeline::group_index(GroupKind kind, std::uint32_t position) const {
  const std::array<std::size_t, 3> counts = {desc().ray_generation.size(), desc().miss.size(),
                                             desc().hit_groups.size()};
  std::size_t index = position;
  for (std::size_t before = 0; before < static_cast<std::size_t>(kind); ++before) index += counts[before];
  return static_cast<std::uint32_t>(index);
}

/// The formula of "Ray Tracing Pipeline Stack", with room for max_callable_depth callable shaders in place of two.
std::uint32_t RayTracingPipeline::needed_stack_size() const {
  using Shader = vk::ShaderGroupShaderKHR;
  const auto size = [this](GroupKind kind, std::size_t position, Shader shader) {
    return static_cast<std::uint32_t>(pipeline_.getRayTracingShaderGroupStackSizeKHR(
        group_index(kind, static_cast<std::uint32_t>(position)), shader));
  };
  const auto largest = [&size](GroupKind kind, std::size_t count) {
    std::uint32_t result = 0;
    for (std::size_t i = 0; i < count; ++i) result = std::max(result, size(kind, i, Shader::eGeneral));
    return result;
  };
  std::uint32_t closest_hit = 0, any_hit = 0, intersection = 0;
  for (std::size_t i = 0; i < desc().hit_groups.size(); ++i) {
    const rhi::HitGroup& group = desc().hit_groups[i];
    if (group.closest_hit) closest_hit = std::max(closest_hit, size(GroupKind::hit, i, Shader::eClosestHit));
    if (group.any_hit) any_hit = std::max(any_hit, size(GroupKind::hit, i, Shader::eAnyHit));
    if (group.intersection) intersection = std::max(intersection, size(GroupKind::hit, i, Shader::eIntersection));
  }
  const std::uint32_t depth = desc().max_recursion_depth;
  const std::uint32_t tracing = std::max(closest_hit, largest(GroupKind::miss, desc().miss.size()));
  return largest(GroupKind::ray_generation, desc().ray_generation.size()) +
         std::min(depth, 1u) * std::max(tracing, intersection + any_hit) + (std::max(depth, 1u) - 1) * tracing +
         rhi::max_callable_depth * largest(GroupKind::callable, desc().callable.size());
}

}  // namespace tandem::vulkan
