#include "program/amber/script_run.hpp"

#include <fmt/format.h>

#include <map>
#include <optional>
#include <span>
#include <utility>

#include "program/execute/execution.hpp"

namespace tandem::program::amber {
namespace {

constexpr std::size_t most_reasons = 10;
constexpr std::uint32_t most_printed_lines = 1000;

/// A result of a device's error: what it does not support is skipped, a broken rule is the script's fault.
Result result_of(const rhi::Error& error) {
  const Outcome outcome = error.code() == rhi::ErrorCode::unsupported        ? Outcome::skipped
                          : error.code() == rhi::ErrorCode::invalid_argument ? Outcome::error
                                                                             : Outcome::failed;
  return {outcome, {error.what()}};
}

/// The job's shaders as the device has them. Throws rhi::Error for SPIR-V that is not valid.
std::vector<rhi::ShaderModuleHandle> modules_of(const Job& job, rhi::Device& device) {
  std::vector<rhi::ShaderModuleHandle> modules;
  for (const Shader& shader : job.shaders)
    modules.push_back(device.create_shader_module(
        {.spirv = without_prints(shader.spirv, shader.name), .label = shader.name, .entry_point = shader.entry_point}));
  return modules;
}

/// Why a device cannot run one of the shaders; "" when it can.
std::string refusal(std::span<const rhi::ShaderModuleHandle> modules, const rhi::Device& device) {
  for (const rhi::ShaderModuleHandle& module : modules)
    for (const std::string& reason : device.refusals(module)) return module->label() + ": " + reason;
  return "";
}

/// The first dimension of the workgroup.
std::uint32_t width_of(const rhi::ShaderReflection& shader, const Stage& stage) {
  const std::optional<std::uint32_t>& constant = shader.workgroup_size_constant[0];
  if (constant)
    for (const rhi::SpecializationValue& each : stage.specialization)
      if (each.id == *constant) return static_cast<std::uint32_t>(each.value);
  return shader.workgroup_size[0];
}

/// FULLY_POPULATED for a workgroup that cannot be divided into whole subgroups asks for what Vulkan forbids
/// (VUID-VkPipelineShaderStageCreateInfo-flags-02758), and drivers let it pass. Such a pipeline does without.
void drop_impossible_requests(Job& job, std::span<const rhi::ShaderModuleHandle> modules,
                              const rhi::DeviceInfo& device) {
  for (Pipeline& pipeline : job.pipelines) {
    auto* const stages = std::get_if<ComputeStages>(&pipeline.stages);
    if (stages == nullptr || !stages->full_subgroups) continue;
    const std::uint32_t size =
        stages->required_subgroup_size != 0 ? stages->required_subgroup_size : device.limits.subgroup_size;
    if (width_of(modules[stages->shader.shader]->reflection(), stages->shader) % size != 0)
      stages->full_subgroups = false;
  }
}

/// What buffers and images hold, read once between two commands.
class Contents {
 public:
  Contents(Execution& execution, const Job& job) : execution_(execution), job_(job) {}

  void forget() { known_.clear(); }

  /// Of an image the first level.
  std::span<const std::byte> of(const Storage& storage) {
    const auto [entry, is_new] = known_.try_emplace({storage.kind, storage.index});
    if (is_new && storage.kind == Storage::Kind::buffer) {
      entry->second = execution_.buffer(storage.index);
    } else if (is_new) {
      entry->second = execution_.image(storage.index);
      entry->second.resize(rhi::level_size_in_bytes(job_.images[storage.index].desc, 0));
    }
    return entry->second;
  }

 private:
  Execution& execution_;
  const Job& job_;
  std::map<std::pair<Storage::Kind, std::size_t>, std::vector<std::byte>> known_;
};

Result take_steps(const Script& script, rhi::Device& device) {
  const std::optional<PrintingJob> printing = printing_job(script.job, most_printed_lines);
  const std::vector<std::byte>* const empty = printing ? &printing->job.buffers[printing->buffer].initial : nullptr;
  Execution execution(device, printing ? printing->job : script.job);
  Contents contents(execution, script.job);
  Result result;
  std::size_t failures = 0;
  for (const Step& step : script.steps) {
    if (step.kind == Step::Kind::command) {
      contents.forget();
      execution.run(script.job.commands[step.index]);
      if (!printing) continue;
      result.printed.push_back(printed_lines(*printing, execution.buffer(printing->buffer)));
      if (result.printed.back().lines.empty())
        result.printed.pop_back();
      else
        execution.set_buffer(printing->buffer, *empty);
      continue;
    }
    const Expectation& expectation = script.expectations[step.index];
    const auto* buffers = std::get_if<BuffersExpectation>(&expectation.what);
    const std::span<const std::byte> other =
        buffers != nullptr ? contents.of(buffers->other) : std::span<const std::byte>();
    const std::string why = failure(expectation, contents.of(expectation.storage), other);
    if (why.empty()) continue;
    result.outcome = Outcome::failed;
    if (++failures <= most_reasons)
      result.reasons.push_back(fmt::format("line {}: {}", expectation.position.line, why));
  }
  if (failures > most_reasons)
    result.reasons.push_back(fmt::format("{} further expectations are not met", failures - most_reasons));
  return result;
}

}  // namespace

void adapt(Script& script, const rhi::DeviceInfo& device) {
  for (const ExtremeSubgroupSize& each : script.extreme_subgroup_sizes)
    std::get<ComputeStages>(script.job.pipelines[each.pipeline].stages).required_subgroup_size =
        each.largest ? device.limits.max_subgroup_size : device.limits.min_subgroup_size;
}

Result run(const Script& script, rhi::Device& device) {
  if (!script.unsupported.empty()) return {Outcome::skipped, {script.unsupported}};
  if (const std::string lack = missing(script.requirements, device.info()); !lack.empty())
    return {Outcome::skipped, {lack}};
  try {
    Script compiled = script;
    compile(compiled);
    adapt(compiled, device.info());
    const std::vector<rhi::ShaderModuleHandle> modules = modules_of(compiled.job, device);
    if (const std::string why = refusal(modules, device); !why.empty()) return {Outcome::skipped, {why}};
    drop_impossible_requests(compiled.job, modules, device.info());
    return take_steps(compiled, device);
  } catch (const ScriptError& error) {
    return {Outcome::error, {error.what()}};
  } catch (const rhi::Error& error) {
    return result_of(error);
  }
}

}  // namespace tandem::program::amber
