#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <string>

#include "devices/devices.hpp"
#include "devices/shader_support.hpp"
#include "tools/command.hpp"
#include "tools/output/messages.hpp"
#include "tools/output/output_file.hpp"
#include "tools/output/print.hpp"
#include "tools/report/device_json.hpp"

namespace tandem::tools {
namespace {

std::string capability_names(const rhi::Capabilities& capabilities) {
  std::string names;
  const auto add = [&](bool present, const char* name) {
    if (present) names += (names.empty() ? "" : ", ") + std::string(name);
  };
  add(capabilities.ray_query, "ray query");
  add(capabilities.ray_tracing_pipeline, "ray tracing pipeline");
  add(capabilities.position_fetch, "position fetch");
  add(capabilities.trace_rays_indirect, "indirect trace");
  add(capabilities.primitive_culling, "primitive culling");
  add(capabilities.null_acceleration_structure, "null structures");
  add(capabilities.buffer_references, "buffer references");
  add(capabilities.non_uniform_indexing, "non-uniform indexing");
  add(capabilities.unsized_arrays, "unsized arrays");
  add(capabilities.partially_bound, "partially bound arrays");
  add(capabilities.cube_arrays, "cube arrays");
  add(capabilities.scalar_block_layout, "scalar layout");
  add(capabilities.shader_int8, "int8");
  add(capabilities.shader_int16, "int16");
  add(capabilities.shader_int64, "int64");
  add(capabilities.shader_float16, "float16");
  add(capabilities.shader_float64, "float64");
  add(capabilities.timestamps, "timestamps");
  return names.empty() ? "none" : names;
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
