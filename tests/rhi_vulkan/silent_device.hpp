#pragma once

#include "tests/support/device_test.hpp"

namespace tandem::test {

/// The Vulkan device under test; at the end of its scope the test fails for every word of the validation layer.
class SilentDevice {
 public:
  SilentDevice() = default;
  SilentDevice(const SilentDevice&) = delete;
  SilentDevice& operator=(const SilentDevice&) = delete;

  rhi::Device& operator*() const { return *device_; }
  rhi::Device* operator->() const { return device_.get(); }

 private:
  NoWarnings no_warnings_{{"vulkan"}};
  rhi::DeviceHandle device_ = device("vulkan");
};

}  // namespace tandem::test
