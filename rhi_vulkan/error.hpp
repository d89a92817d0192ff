#pragma once

#include <string_view>
#include <utility>

#include "rhi/error.hpp"
#include "rhi_vulkan/vulkan.hpp"

namespace tandem::vulkan {

/// Throws the rhi::Error for a result: out_of_memory, device_lost, else unsupported (the driver refused).
/// @param action what failed, after "cannot": "create the buffer"
[[noreturn]] void throw_error(vk::Result result, std::string_view label, std::string_view action);

/// Calls `function`; what Vulkan-Hpp throws in it becomes an rhi::Error as by throw_error.
template <typename Function>
decltype(auto) translating_errors(std::string_view label, std::string_view action, Function&& function) {
  try {
    return std::forward<Function>(function)();
  } catch (const vk::SystemError& error) {
    throw_error(static_cast<vk::Result>(error.code().value()), label, action);
  }
}

}  // namespace tandem::vulkan
