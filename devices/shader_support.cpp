#include "devices/shader_support.hpp"

#include <algorithm>
#include <set>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "rhi/spirv/names.hpp"
#include "rhi_cpu/translate/supported.hpp"

namespace tandem {
namespace {

/// | first | one | two | ...
std::string row(const std::string& first, std::span<const std::string> cells) {
  return fmt::format("| {} | {} |\n", first, fmt::join(cells, " | "));
}

std::string head(const std::string& first, std::span<const rhi::DeviceInfo> devices) {
  std::vector<std::string> names;
  for (const rhi::DeviceInfo& device : devices) names.push_back(fmt::format("`{}`", device.name));
  return fmt::format("{}{}", row(first, names), row("---", std::vector<std::string>(devices.size(), "---")));
}

std::string capabilities(std::span<const rhi::DeviceInfo> devices) {
  std::set<std::pair<std::string, std::uint32_t>> all;  // by name
  for (const rhi::DeviceInfo& device : devices)
    for (const std::uint32_t number : device.spirv_capabilities) all.emplace(rhi::capability_name(number), number);
  std::string text = head("capability", devices);
  for (const auto& [name, number] : all) {
    std::vector<std::string> cells;
    for (const rhi::DeviceInfo& device : devices)
      cells.emplace_back(std::ranges::binary_search(device.spirv_capabilities, number) ? "yes" : "no");
    text += row(name, cells);
  }
  return text;
}

std::string letters(const rhi::FormatSupport& support) {
  std::string text;
  const auto add = [&](bool has, char letter) {
    if (has) text += letter;
  };
  add(support.storage, 'S');
  add(support.storage_atomic, 'A');
  add(support.sampled, 'L');
  add(support.filtered, 'F');
  add(support.uniform_texel_buffer, 'u');
  add(support.storage_texel_buffer, 's');
  return text.empty() ? "none" : text;
}

std::string formats(std::span<const rhi::DeviceInfo> devices) {
  std::string text = head("format", devices);
  for (std::size_t i = 0; i < rhi::texture_format_count; ++i) {
    std::vector<std::string> cells;
    for (const rhi::DeviceInfo& device : devices) cells.push_back(letters(device.formats[i]));
    text += row(std::string(rhi::info_of(static_cast<rhi::TextureFormat>(i)).name), cells);
  }
  return text;
}

/// A bullet with the names, in lines of at most 120 columns.
std::string bullet(const std::string& what, const std::vector<std::string>& names) {
  constexpr std::size_t columns = 120;
  std::string text;
  std::string line = fmt::format("- {}:", what);
  for (std::size_t i = 0; i < names.size(); ++i) {
    // SPIRV-Tools still has the first names of what KHR took over.
    const std::string_view name = names[i];
    const std::string word = fmt::format("{}{}{}", name.substr(0, name.size() - (name.ends_with("NV") ? 2 : 0)),
                                         name.ends_with("NV") ? "KHR" : "", i + 1 < names.size() ? "," : ".");
    if (line.size() + 1 + word.size() > columns) {
      text += fmt::format("{}\n", line);
      line.assign(1, ' ');
    }
    line += fmt::format(" {}", word);
  }
  return fmt::format("{}{}\n", text, line);
}

}  // namespace

std::string shader_support_markdown(std::span<const rhi::DeviceInfo> devices) {
  std::string text =
      "# What shaders may use, by device\n\nWritten by `tandem devices --markdown`. "
      "[shader-support.md](../guide/shader-support.md) says the same in words.\n\n";
  for (const rhi::DeviceInfo& device : devices)
    text += fmt::format("- `{}`: {}, {}\n", device.name, device.description, device.driver);
  text += "\n## Capabilities of SPIR-V\n\nThose that at least one of the devices offers.\n\n" + capabilities(devices);
  text +=
      "\n## Image formats\n\nS: storage images, A: atomic operations on them, L: sampled images, F: linear filters,\n"
      "u: uniform texel buffers, s: storage texel buffers.\n\n" +
      formats(devices);
  const cpu::ShaderSupport support = cpu::shader_support();
  text +=
      "\n## What else the CPU devices know by name\n\nAnything else is refused by name when a pipeline is made. "
      "Vulkan devices take\nwhat the capabilities that they offer allow.\n\n";
  text += bullet("Execution models", support.execution_models);
  text += bullet("Execution modes", support.execution_modes);
  text += bullet("Storage classes", support.storage_classes);
  text += bullet("Built-ins", support.built_ins);
  text += bullet("Decorations", support.decorations);
  return text;
}

}  // namespace tandem
