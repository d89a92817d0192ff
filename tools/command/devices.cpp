#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "devices/devices.hpp"
#include "devices/shader_support.hpp"
#include "tools/command.hpp"
#include "tools/output/messages.hpp"
#include "tools/output/output_file.hpp"
#include "tools/output/print.hpp"
#include "tools/report/device_json.hpp"

namespace tandem::tools {
namespace {

/// Names of what is present, in a list.
class Names {
 public:
  void add(bool present, std::string_view name) {
    if (present) text_ += (text_.empty() ? "" : ", ") + std::string(name);
  }
  const std::string& text() const noexcept { return text_; }

 private:
  std::string text_;
};

std::string capability_names(const rhi::Capabilities& capabilities) {
  Names names;
  names.add(capabilities.ray_query, "ray query");
  names.add(capabilities.ray_tracing_pipeline, "ray tracing pipeline");
  names.add(capabilities.position_fetch, "position fetch");
  names.add(capabilities.trace_rays_indirect, "indirect trace");
  names.add(capabilities.primitive_culling, "primitive culling");
  names.add(capabilities.null_acceleration_structure, "null structures");
  names.add(capabilities.buffer_references, "buffer references");
  names.add(capabilities.non_uniform_indexing, "non-uniform indexing");
  names.add(capabilities.unsized_arrays, "unsized arrays");
  names.add(capabilities.partially_bound, "partially bound arrays");
  names.add(capabilities.cube_arrays, "cube arrays");
  names.add(capabilities.scalar_block_layout, "scalar layout");
  names.add(capabilities.shader_int8, "int8");
  names.add(capabilities.shader_int16, "int16");
  names.add(capabilities.shader_int64, "int64");
  names.add(capabilities.shader_float16, "float16");
  names.add(capabilities.shader_float64, "float64");
  names.add(capabilities.timestamps, "timestamps");
  return names.text().empty() ? "none" : names.text();
}

std::string workgroup_text(const rhi::DeviceInfo& device) {
  const rhi::Capabilities& capabilities = device.capabilities;
  const rhi::Limits& limits = device.limits;
  Names names;
  names.add(true, fmt::format("{} invocations", limits.max_workgroup_invocations));
  names.add(true, fmt::format("{} bytes of shared memory", limits.workgroup_memory_size));
  names.add(capabilities.zeroed_workgroup_memory, "initialized memory");
  names.add(capabilities.workgroup_memory_layout, "explicit layout");
  names.add(capabilities.workgroup_memory_layout_8bit, "of int8");
  names.add(capabilities.workgroup_memory_layout_16bit, "of int16");
  names.add(capabilities.shared_int64_atomics, "int64 atomics");
  names.add(capabilities.shared_float32_atomics, "float32 atomics");
  names.add(capabilities.shared_float32_atomic_add, "float32 atomic add");
  names.add(capabilities.shared_float32_atomic_min_max, "float32 atomic min and max");
  names.add(capabilities.shared_float64_atomic_add, "float64 atomic add");
  return names.text();
}

std::string subgroup_text(const rhi::DeviceInfo& device) {
  const rhi::Capabilities& capabilities = device.capabilities;
  const rhi::Limits& limits = device.limits;
  Names names;
  names.add(true, fmt::format("{} invocations", limits.subgroup_size));
  names.add(capabilities.required_subgroup_size && limits.min_subgroup_size != limits.max_subgroup_size,
            fmt::format("{} to {} on demand", limits.min_subgroup_size, limits.max_subgroup_size));
  names.add(capabilities.full_subgroups, "full on demand");
  names.add(capabilities.subgroup_basic, "basic");
  names.add(capabilities.subgroup_vote, "vote");
  names.add(capabilities.subgroup_arithmetic, "arithmetic");
  names.add(capabilities.subgroup_ballot, "ballot");
  names.add(capabilities.subgroup_shuffle, "shuffle");
  names.add(capabilities.subgroup_shuffle_relative, "relative shuffle");
  names.add(capabilities.subgroup_clustered, "clustered");
  names.add(capabilities.subgroup_quad, "quad");
  names.add(capabilities.subgroup_rotate, "rotate");
  names.add(capabilities.subgroup_clustered_rotate, "clustered rotate");
  names.add(capabilities.subgroup_extended_types, "extended types");
  names.add(capabilities.subgroup_uniform_control_flow, "uniform control flow");
  names.add(capabilities.maximal_reconvergence, "maximal reconvergence");
  return names.text();
}

int list_devices(bool as_json, const std::filesystem::path& markdown) {
  const std::vector<rhi::DeviceInfo> devices = enumerate_devices(print_message);
  if (!markdown.empty()) {
    const std::vector<OutputFile> files = {
        {markdown, [&](const std::filesystem::path& path) { write_text(path, shader_support_markdown(devices)); }}};
    check_output_files(files);
    write_or_rescue(files);
    print_written(files);
    return exit_code::success;
  }
  if (as_json) {
    nlohmann::ordered_json json = nlohmann::ordered_json::array();
    for (const rhi::DeviceInfo& device : devices) json.push_back(to_json_in_full(device));
    print("{}", json_text(json));
    return exit_code::success;
  }
  for (const rhi::DeviceInfo& device : devices) {
    print("{}\n", device.name);
    print("  hardware      {} ({})\n", device.description, kind_name(device.kind));
    print("  driver        {}{}{}\n", device.driver, device.api.empty() ? "" : ", ", device.api);
    print("  capabilities  {}\n", capability_names(device.capabilities));
    print("  workgroups    {}\n", workgroup_text(device));
    print("  subgroups     {}\n", subgroup_text(device));
  }
  return exit_code::success;
}

}  // namespace

void add_devices_command(CLI::App& app, Action& action) {
  CLI::App* const command = app.add_subcommand("devices", "List the devices that can render");
  const auto as_json = std::make_shared<bool>(false);
  const auto markdown = std::make_shared<std::filesystem::path>();
  command->add_flag("--json", *as_json, "Print JSON, with all capabilities and limits");
  command->add_option("--markdown", *markdown,
                      "Write what shaders may use on each device as Markdown (docs/results/shader-support.md)");
  command->footer("--device, --a and --b take these names; 'vulkan' without a number is the first Vulkan device.");
  command->callback(
      [&action, as_json, markdown] { action = [as_json, markdown] { return list_devices(*as_json, *markdown); }; });
}

}  // namespace tandem::tools
