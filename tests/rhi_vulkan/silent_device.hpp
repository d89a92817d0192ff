#pragma once

#include <doctest/doctest.h>

#include "tests/support/device_test.hpp"

namespace tandem::test {

/// The Vulkan device under test; at the end of its scope the test fails for every word of the validation layer.
class SilentDevice {
 public:
  SilentDevice() = default;
  SilentDevice(const SilentDevice&) = delete;
  SilentDevice& operator=(const SilentDevice&) = delete;
  ~SilentDevice() {
    for (const std::string& warning : take_warnings("vulkan")) FAIL_CHECK(warning);
  }

  rhi::Device& operator*() const { return *device_; }
  rhi::Device* operator->() const { return device_.get(); }

 private:
  rhi::DeviceHandle device_ = device("vulkan");
};

}  // namespace tandem::test
