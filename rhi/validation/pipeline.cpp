#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <string>

#include "rhi/validation.hpp"
#include "rhi/validation/require.hpp"

namespace tandem::rhi::validation {
namespace {

using std::to_string;

/// Each id is given once, and declared by one of the shaders.
void check_specialization(const std::vector<SpecializationValue>& values, std::span<const ShaderModuleHandle> shaders,
                          const std::string& label) {
  const auto declares = [](const ShaderModuleHandle& shader, std::uint32_t id) {
    const auto& constants = shader->reflection().specialization_constants;
    return std::any_of(constants.begin(), constants.end(),
                       [id](const SpecializationConstant& constant) { return constant.id == id; });
  };
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::uint32_t id = values[i].id;
    const bool declared = std::any_of(shaders.begin(), shaders.end(),
                                      [&](const ShaderModuleHandle& shader) { return declares(shader, id); });
    const std::string who = shaders.size() == 1 ? "the shader '" + shaders[0]->label() + "' has" : "no shader has a";
    require(declared, label,
            who + (shaders.size() == 1 ? " no specialisation constant " : " specialisation constant ") + to_string(id));
    for (std::size_t j = 0; j < i; ++j)
      require(values[j].id != id, label, "specialisation constant " + to_string(id) + " is given twice");
  }
}

/// What of the interface the device has no room for, whatever the pipeline's kind.
std::vector<Error> interface_errors(const PipelineInterface& interface, const std::string& label,
                                    const DeviceInfo& device) {
  std::vector<Error> errors;
  const Limits& limits = device.limits;
  if (interface.push_constant_size > limits.max_push_constant_size)
    errors.emplace_back(ErrorCode::invalid_argument, label,
                        "the shader's push constants have " + to_string(interface.push_constant_size) +
                            " bytes, more than the device's " + to_string(limits.max_push_constant_size));
  for (const ShaderBinding& binding : interface.bindings) {
    if (binding.set >= limits.max_bind_groups)
      errors.emplace_back(ErrorCode::invalid_argument, label,
                          "the shader uses descriptor set " + to_string(binding.set) + ", but the device has " +
                              to_string(limits.max_bind_groups));
    if (binding.count == 0 && !device.capabilities.unsized_arrays)
      errors.emplace_back(ErrorCode::unsupported, label,
                          "the shader declares '" + binding.name +
                              "', an array of descriptors without a length, which device '" + device.name +
                              "' does not support");
  }
  return errors;
}

void check_interface(const PipelineInterface& interface, const std::string& label, const DeviceInfo& device) {
  const std::vector<Error> errors = interface_errors(interface, label, device);
  if (!errors.empty()) throw errors.front();
}

/// Empty: the size is one that the device has.
std::string workgroup_problem(const std::array<std::uint32_t, 3>& size, const Limits& limits) {
  std::uint64_t invocations = 1;
  for (std::size_t i = 0; i < 3; ++i) {
    if (size[i] == 0 || size[i] > limits.max_workgroup_size[i])
      return "a workgroup size of " + to_string(size[i]) + " in dimension " + to_string(i) +
             ", where the device allows 1 to " + to_string(limits.max_workgroup_size[i]);
    invocations *= size[i];
  }
  if (invocations <= limits.max_workgroup_invocations) return {};
  return to_string(invocations) + " invocations in a workgroup are more than the device's " +
         to_string(limits.max_workgroup_invocations);
}

void require_offered(bool offered, const std::string& label, const DeviceInfo& device, const std::string& what) {
  if (!offered) throw Error(ErrorCode::unsupported, label, "device '" + device.name + "' does not offer " + what);
}

/// From this version on the device may choose a subgroup size by the shader (SPIR-V 1.6, Vulkan: VaryingSubgroupSize).
constexpr std::uint32_t first_varying_spirv = 0x00010600;

void check_subgroups(const ComputePipelineDesc& desc, const std::array<std::uint32_t, 3>& workgroup_size,
                     const DeviceInfo& device) {
  const Limits& limits = device.limits;
  const std::uint32_t required = desc.required_subgroup_size;
  if (required != 0) {
    require_offered(device.capabilities.required_subgroup_size, desc.label, device, "required subgroup sizes");
    require(
        std::has_single_bit(required) && required >= limits.min_subgroup_size && required <= limits.max_subgroup_size,
        desc.label,
        "a required subgroup size of " + to_string(required) + ", where the device allows powers of two from " +
            to_string(limits.min_subgroup_size) + " to " + to_string(limits.max_subgroup_size));
    const std::uint64_t invocations = std::uint64_t{workgroup_size[0]} * workgroup_size[1] * workgroup_size[2];
    require(invocations <= std::uint64_t{required} * limits.max_workgroup_subgroups, desc.label,
            to_string(invocations) + " invocations in a workgroup are more than the device's " +
                to_string(limits.max_workgroup_subgroups) + " subgroups of the required size " + to_string(required));
  }
  if (!desc.full_subgroups) return;
  require_offered(device.capabilities.full_subgroups, desc.label, device, "full subgroups");
  const bool varying = desc.shader->spirv()[1] >= first_varying_spirv;
  const std::uint32_t size = required != 0 ? required : varying ? limits.max_subgroup_size : limits.subgroup_size;
  require(workgroup_size[0] % size == 0, desc.label,
          "full subgroups need a workgroup size in dimension 0 that is a multiple of the subgroup size " +
              to_string(size) + ", which " + to_string(workgroup_size[0]) + " is not");
}

void check_stage(const ShaderModuleHandle& shader, ShaderStage stage, const std::string& label,
                 const std::string& what) {
  require(shader != nullptr, label, what + " names no shader");
  require(shader->reflection().stage == stage, label,
          what + ": the shader '" + shader->label() + "' is of another stage");
}

void check_optional_stage(const ShaderModuleHandle& shader, ShaderStage stage, const std::string& label,
                          const std::string& what) {
  if (shader != nullptr) check_stage(shader, stage, label, what);
}

/// The bytes of data that a record of this shader has to hold.
std::uint32_t wanted_data(const ShaderModuleHandle& shader) {
  return shader != nullptr ? shader->reflection().shader_record_size : 0;
}

std::uint32_t wanted_data(const HitGroup& group) {
  return std::max({wanted_data(group.closest_hit), wanted_data(group.any_hit), wanted_data(group.intersection)});
}

template <typename Shaders>
void check_records(const ShaderRecords& records, const Shaders& shaders, const std::string& kind,
                   const std::string& label, const Limits& limits) {
  std::uint64_t largest = 0;
  for (std::size_t i = 0; i < records.records.size(); ++i) {
    const ShaderRecord& record = records.records[i];
    const std::string what = kind + " record " + to_string(i);
    largest = std::max<std::uint64_t>(largest, record.data.size());
    if (record.shader == no_shader) continue;
    require(
        record.shader < shaders.size(), label,
        what + " names shader " + to_string(record.shader) + " of a pipeline that has " + to_string(shaders.size()));
    const std::uint32_t wanted = wanted_data(shaders[record.shader]);
    require(
        record.data.size() >= wanted, label,
        what + " has " + to_string(record.data.size()) + " bytes of data, but its shader reads " + to_string(wanted));
  }
  require_limit(largest + limits.shader_handle_size, limits.max_shader_record_stride, label,
                "bytes of a " + kind + " record");
  if (records.stride == 0) return;
  require(records.stride % limits.shader_record_alignment == 0, label,
          "the stride of the " + kind + " records, " + to_string(records.stride) + ", is no multiple of the device's " +
              to_string(limits.shader_record_alignment));
  require(records.stride >= largest + limits.shader_handle_size, label,
          "the stride of the " + kind + " records, " + to_string(records.stride) + ", is less than the " +
              to_string(largest + limits.shader_handle_size) + " bytes of the largest");
  require_limit(records.stride, limits.max_shader_record_stride, label, "bytes of stride of the " + kind + " records");
}

}  // namespace

std::vector<std::string> refusals(const ShaderModuleHandle& shader, const DeviceInfo& device) {
  std::vector<std::string> reasons;
  const ShaderReflection& reflection = shader->reflection();
  for (const Error& error : interface_errors(combined_interface({&shader, 1}, ""), "", device))
    reasons.emplace_back(error.what());
  if (reflection.stage != ShaderStage::compute) {
    if (!device.capabilities.ray_tracing_pipeline)
      reasons.push_back("device '" + device.name + "' has no ray tracing pipelines");
    return reasons;
  }
  // What a constant sets is only known when a pipeline is made.
  std::array<std::uint32_t, 3> size = reflection.workgroup_size;
  for (std::size_t i = 0; i < 3; ++i)
    if (reflection.workgroup_size_constant[i]) size[i] = 1;
  if (const std::string problem = workgroup_problem(size, device.limits); !problem.empty()) reasons.push_back(problem);
  return reasons;
}

void check(const ComputePipelineDesc& desc, const DeviceInfo& device) {
  require(desc.shader != nullptr, desc.label, "a compute pipeline needs a shader");
  require(desc.shader->reflection().stage == ShaderStage::compute, desc.label,
          "the shader '" + desc.shader->label() + "' is not a compute shader");
  check_specialization(desc.specialization, {&desc.shader, 1}, desc.label);
  std::array<std::uint32_t, 3> size = desc.shader->reflection().workgroup_size;
  for (std::size_t i = 0; i < 3; ++i)
    for (const SpecializationValue& given : desc.specialization)
      if (desc.shader->reflection().workgroup_size_constant[i] == given.id)
        size[i] = static_cast<std::uint32_t>(given.value);
  const std::string problem = workgroup_problem(size, device.limits);
  require(problem.empty(), desc.label, problem);
  check_subgroups(desc, size, device);
  check_interface(combined_interface({&desc.shader, 1}, desc.label, desc.unsized_array_length), desc.label, device);
}

void check(const RayTracingPipelineDesc& desc, const DeviceInfo& device) {
  if (!device.capabilities.ray_tracing_pipeline)
    throw Error(ErrorCode::unsupported, desc.label, "device '" + device.name + "' has no ray tracing pipelines");
  require(!desc.ray_generation.empty(), desc.label, "a ray tracing pipeline needs a ray generation shader");
  for (const ShaderModuleHandle& shader : desc.ray_generation)
    check_stage(shader, ShaderStage::ray_generation, desc.label, "ray generation");
  for (const ShaderModuleHandle& shader : desc.miss) check_stage(shader, ShaderStage::miss, desc.label, "miss");
  for (std::size_t i = 0; i < desc.hit_groups.size(); ++i) {
    const std::string group = "hit group " + to_string(i);
    check_optional_stage(desc.hit_groups[i].closest_hit, ShaderStage::closest_hit, desc.label, group + " closest hit");
    check_optional_stage(desc.hit_groups[i].any_hit, ShaderStage::any_hit, desc.label, group + " any hit");
    check_optional_stage(desc.hit_groups[i].intersection, ShaderStage::intersection, desc.label,
                         group + " intersection");
  }
  for (const ShaderModuleHandle& shader : desc.callable)
    check_stage(shader, ShaderStage::callable, desc.label, "callable");
  require_limit(desc.max_recursion_depth, device.limits.max_ray_recursion_depth, desc.label, "rays in flight at once");
  const std::vector<ShaderModuleHandle> shaders = shaders_of(desc);
  check_specialization(desc.specialization, shaders, desc.label);
  check_interface(combined_interface(shaders, desc.label, desc.unsized_array_length), desc.label, device);
}

void check(const ShaderTableDesc& desc, const DeviceInfo& device) {
  require(desc.pipeline != nullptr, desc.label, "a shader table needs a pipeline");
  const RayTracingPipelineDesc& pipeline = desc.pipeline->desc();
  require(!desc.ray_generation.records.empty(), desc.label, "a shader table needs a ray generation record");
  for (const ShaderRecord& record : desc.ray_generation.records)
    require(record.shader != no_shader, desc.label, "a ray generation record names no shader");
  check_records(desc.ray_generation, pipeline.ray_generation, "ray generation", desc.label, device.limits);
  check_records(desc.miss, pipeline.miss, "miss", desc.label, device.limits);
  check_records(desc.hit, pipeline.hit_groups, "hit", desc.label, device.limits);
  check_records(desc.callable, pipeline.callable, "callable", desc.label, device.limits);
}

}  // namespace tandem::rhi::validation
