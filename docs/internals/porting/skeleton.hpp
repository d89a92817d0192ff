#pragma once

#include "rhi/device.hpp"

/// The backend that docs/internals/porting.md begins with: buffers in host memory, copies, and nothing else.
namespace skeleton {

tandem::rhi::DeviceInfo device_info();

tandem::rhi::DeviceHandle create_device();

}  // namespace skeleton
