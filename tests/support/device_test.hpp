#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include "rhi/device.hpp"

/// Test cases that are registered once per device. The devices are those of $TANDEM_TEST_DEVICES (comma-separated), by
/// default "cpu,vulkan"; one that cannot be created fails its tests rather than skipping them.
namespace tandem::test {

/// Names of the devices under test.
const std::vector<std::string>& device_names();

/// The device of that name, created at the first call with driver validation on, and kept for the rest of the run.
rhi::DeviceHandle device(const std::string& name);

/// What the validation layers have said of the device since the last call; a test that runs on a device must leave it
/// empty.
std::vector<std::string> take_warnings(const std::string& name);

/// At the end of its scope, also when an exception ends it, the test fails for every message of the validation layers:
/// so none is blamed on the next test. TANDEM_DEVICE_TEST has one of its own.
class NoWarnings {
 public:
  /// @param names of the devices that the test uses
  explicit NoWarnings(std::vector<std::string> names = device_names()) : names_(std::move(names)) {}
  ~NoWarnings();
  NoWarnings(const NoWarnings&) = delete;
  NoWarnings& operator=(const NoWarnings&) = delete;

 private:
  std::vector<std::string> names_;
};

/// Destroys the devices and returns what was said of them meanwhile. Before main returns: drivers and layers take
/// themselves apart when the process exits, and cannot be called any more.
std::vector<std::string> release_devices();

/// Compiles GLSL and makes a compute pipeline of it.
rhi::ComputePipelineHandle compute_pipeline(rhi::Device& device, const std::string& glsl, const std::string& label,
                                            std::vector<rhi::SpecializationValue> specialization = {});

/// A buffer with all usages that holds `values`.
template <typename T>
rhi::BufferHandle buffer_of(rhi::Device& device, const std::vector<T>& values, const std::string& label);

/// The first `count` T of the buffer.
template <typename T>
std::vector<T> contents(rhi::Device& device, const rhi::BufferHandle& buffer, std::size_t count);

}  // namespace tandem::test

/// TANDEM_DEVICE_TEST("what must be true") { ... }
/// One doctest case per device under test, named "what must be true [cpu]". Its body has `device`, an rhi::Device&,
/// `device_handle`, its rhi::DeviceHandle, and `device_name`, which created it. It fails on any message of the
/// validation layers.
#define TANDEM_DEVICE_TEST(name) TANDEM_DEVICE_TEST_IMPLEMENTATION(name, DOCTEST_ANONYMOUS(tandem_device_test_))

#include "tests/support/device_test_inline.hpp"
