#include "rhi_vulkan/error.hpp"

#include <string>

namespace tandem::vulkan {
namespace {

rhi::ErrorCode code_of(vk::Result result) {
  switch (result) {
    case vk::Result::eErrorOutOfHostMemory:
    case vk::Result::eErrorOutOfDeviceMemory:
    case vk::Result::eErrorTooManyObjects:
    case vk::Result::eErrorOutOfPoolMemory:
    case vk::Result::eErrorFragmentedPool:
      return rhi::ErrorCode::out_of_memory;
    case vk::Result::eErrorDeviceLost:
      return rhi::ErrorCode::device_lost;
    default:
      return rhi::ErrorCode::unsupported;
  }
}

}  // namespace

void throw_error(vk::Result result, std::string_view label, std::string_view action) {
  const rhi::ErrorCode code = code_of(result);
  std::string why = "cannot " + std::string(action) + ": ";
  if (code == rhi::ErrorCode::out_of_memory) why += "out of memory, ";
  if (code == rhi::ErrorCode::device_lost) why += "the device is lost, ";
  throw rhi::Error(code, label, why + "the driver says " + vk::to_string(result));
}

}  // namespace tandem::vulkan
