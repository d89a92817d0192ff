#include "devices/devices.hpp"

#include <doctest/doctest.h>

#include <set>

#include "shaders/spirv.hpp"
#include "tests/support/environment_variable.hpp"

namespace tandem {

TEST_CASE("Every device that is listed has a name of its own and can be created by it; the CPU's come first") {
  const std::vector<rhi::DeviceInfo> devices = enumerate_devices();
  REQUIRE(devices.size() >= 2);
  CHECK(devices[0].name == "cpu");
  CHECK(devices[1].name == "cpu-exact");
  std::set<std::string> names;
  for (const rhi::DeviceInfo& device : devices) {
    CHECK(names.insert(device.name).second);
    CHECK(create_device({.name = device.name})->info().name == device.name);
  }
}

TEST_CASE("A name that no device has is an error that names those there are") {
  for (const char* name : {"", "gpu", "CPU", "cpu:0", "vulkan:", "vulkan:x", "vulkan:-1", "vulkan:1000"}) {
    CAPTURE(name);
    try {
      create_device({.name = name});
      FAIL_CHECK("a device was created");
    } catch (const rhi::Error& error) {
      CHECK(error.code() == rhi::ErrorCode::no_such_device);
      CHECK_FALSE(std::string(error.what()).empty());
    }
  }
  CHECK_THROWS_WITH_AS(create_device({.name = "gpu"}), doctest::Contains("cpu"), rhi::Error);
}

TEST_CASE("The shaders that ship run on the CPU without a compiler") {
  const test::EnvironmentVariable compiler("TANDEM_CXX", "/nonexistent");
  const rhi::DeviceHandle device = create_device({.name = "cpu"});
  CHECK_NOTHROW(device->create_compute_pipeline(
      {.shader = device->create_shader_module({.spirv = shaders::path_trace(), .label = "path_trace.comp"}),
       .specialization = {},
       .label = "path_trace"}));
}

}  // namespace tandem
