#pragma once

#include <string>
#include <vector>

#include "rhi/device.hpp"

/// Test bodies that run once per device. The devices are those of $TANDEM_TEST_DEVICES (comma-separated), by default
/// "cpu,vulkan"; one that cannot be created fails the test rather than skipping it.
namespace tandem::test {

/// Names of the devices under test.
const std::vector<std::string>& device_names();

/// The device of that name, created at the first call with driver validation on, and kept for the rest of the run.
rhi::DeviceHandle device(const std::string& name);

/// What the validation layers have said of the device since the last call; a test that runs on a device must leave it
/// empty.
std::vector<std::string> take_warnings(const std::string& name);

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

/// TANDEM_DEVICE_TEST("what must be true") { ... `device` is an rhi::Device& ... }
/// One doctest case with a subcase per device; fails on any validation message.
#define TANDEM_DEVICE_TEST_IMPLEMENTATION(name, function)                                                  \
  static void function(::tandem::rhi::Device& device);                                                     \
  TEST_CASE(name) {                                                                                        \
    for (const std::string& device_name : ::tandem::test::device_names()) {                                \
      SUBCASE(device_name.c_str()) {                                                                       \
        function(*::tandem::test::device(device_name));                                                    \
        for (const std::string& warning : ::tandem::test::take_warnings(device_name)) FAIL_CHECK(warning); \
      }                                                                                                    \
    }                                                                                                      \
  }                                                                                                        \
  static void function([[maybe_unused]] ::tandem::rhi::Device& device)
#define TANDEM_DEVICE_TEST(name) TANDEM_DEVICE_TEST_IMPLEMENTATION(name, DOCTEST_ANONYMOUS(tandem_device_test_))

#include "tests/support/device_test_inline.hpp"
