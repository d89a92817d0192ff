#pragma once

#include <string_view>
#include <vector>

#include "rhi/device.hpp"

/// The factory: the only code outside the backends that knows which backends exist.
namespace tandem {

/// Every device present that qualifies, "cpu" and "cpu-exact" first. A backend that cannot even be asked (no Vulkan
/// loader) adds none and says so through `on_message`.
std::vector<rhi::DeviceInfo> enumerate_devices(const rhi::MessageCallback& on_message = {});

/// Whether the word has the form of a device's name: "cpu", "cpu-exact", "vulkan", "vulkan:1".
bool is_device_name(std::string_view word);

/// Throws Error(no_such_device) with a sentence that names the devices there are.
rhi::DeviceHandle create_device(const rhi::DeviceDesc& desc);

}  // namespace tandem
