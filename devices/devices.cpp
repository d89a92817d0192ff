#include "devices/devices.hpp"

#include <algorithm>
#include <span>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "denoise_shaders/kernels.hpp"
#include "metropolis_shaders/kernels.hpp"
#include "probe_shaders/kernels.hpp"
#include "rhi_cpu/device.hpp"
#include "rhi_vulkan/device.hpp"
#include "shaders/kernels.hpp"
#include "study_shaders/kernels.hpp"

namespace tandem {

std::vector<rhi::DeviceInfo> enumerate_devices(const rhi::MessageCallback& on_message) {
  std::vector<rhi::DeviceInfo> devices;
  for (const std::string_view name : cpu::device_names()) devices.push_back(cpu::device_info(name));
  for (rhi::DeviceInfo& device : vulkan::enumerate(on_message)) devices.push_back(std::move(device));
  return devices;
}

bool is_device_name(std::string_view word) {
  return cpu::is_device_name(word) || word == "vulkan" || word.starts_with("vulkan:");
}

rhi::DeviceHandle create_device(const rhi::DeviceDesc& desc) {
  const std::string_view name = desc.name;
  if (cpu::is_device_name(name)) {
    std::vector<cpu::PrecompiledKernel> kernels;
    for (const std::span<const cpu::PrecompiledKernel> some :
         {shaders::kernels(), probe_shaders::kernels(), denoise_shaders::kernels(), study_shaders::kernels(),
          metropolis_shaders::kernels()})
      kernels.insert(kernels.end(), some.begin(), some.end());
    return cpu::create_device(desc, kernels);
  }
  if (is_device_name(name)) return vulkan::create_device(desc);
  std::vector<std::string> names;
  for (const rhi::DeviceInfo& device : enumerate_devices()) names.push_back(device.name);
  throw rhi::Error(rhi::ErrorCode::no_such_device, name,
                   fmt::format("there is no such device; there are: {}", fmt::join(names, ", ")));
}

}  // namespace tandem
