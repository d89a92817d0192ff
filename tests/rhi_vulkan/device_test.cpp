#include "rhi_vulkan/device.hpp"

#include <doctest/doctest.h>

#include <cstring>

#include "rhi/glsl/compile.hpp"
#include "rhi_vulkan/vulkan.hpp"
#include "tests/rhi/dispatch.hpp"
#include "tests/support/environment_variable.hpp"
#include "tests/support/messages.hpp"

using namespace tandem;

namespace {

rhi::DeviceDesc named(const std::string& name) {
  rhi::DeviceDesc desc;
  desc.name = name;
  return desc;
}

}  // namespace

TEST_CASE("enumerate lists devices that can be created by their names") {
  const std::vector<rhi::DeviceInfo> infos = vulkan::enumerate();
  REQUIRE_FALSE(infos.empty());
  for (std::size_t i = 0; i < infos.size(); ++i) {
    const rhi::DeviceInfo& info = infos[i];
    CHECK(info.name == "vulkan:" + std::to_string(i));
    CHECK(info.backend == "vulkan");
    CHECK_FALSE(info.description.empty());
    CHECK_FALSE(info.driver.empty());
    CHECK(info.api.starts_with("Vulkan 1."));
    CHECK(info.limits.max_push_constant_size >= 128);
    CHECK(info.limits.max_instance_count > 0);
    if (i > 0) CHECK(infos[i - 1].kind <= info.kind);
    CHECK(vulkan::create_device(named(info.name))->info().description == info.description);
  }
  CHECK(vulkan::create_device(named("vulkan"))->info().name == "vulkan:0");
}

TEST_CASE("names that name no device are errors that say which there are") {
  CHECK_ERROR(no_such_device, "vulkan:0 (", vulkan::create_device(named("vulkan:99")));
  for (const char* name :
       {"vulkan:", "vulkan:x", "vulkan:0x", "vulkan:-1", "vulkan0", "", "vulkan:99999999999999999999"})
    CHECK_ERROR(no_such_device, "is not a Vulkan device", vulkan::create_device(named(name)));
}

TEST_CASE("without a driver there is one clear sentence and no device") {
  const test::EnvironmentVariable drivers("VK_DRIVER_FILES", "/nonexistent/driver.json");
  const test::EnvironmentVariable older_drivers("VK_ICD_FILENAMES", "/nonexistent/driver.json");
  CHECK_ERROR(no_such_device, "no Vulkan", vulkan::create_device(named("vulkan")));
  test::Messages messages;
  CHECK(vulkan::enumerate(messages.callback()).empty());
  CHECK_FALSE(messages.take().empty());
}

TEST_CASE("driver validation speaks through on_message") {
  test::Messages messages;
  rhi::DeviceDesc desc = named("vulkan");
  desc.driver_validation = true;
  desc.on_message = messages.callback();
  const rhi::DeviceHandle device = vulkan::create_device(desc);
  device->submit(device->create_command_list("fine"))->wait();
  CHECK(messages.take().empty());
  // More shared memory than any device has, for which the interface has no rule.
  const std::vector<std::uint32_t> spirv = glsl::compile(
      "#version 460\nlayout(local_size_x = 1) in;\n"
      "layout(set = 0, binding = 0) buffer Values { uint values[]; };\nshared uint huge[1 << 24];\n"
      "void main() { huge[values[0]] = values[1]; values[2] = huge[values[3]]; }",
      rhi::ShaderStage::compute, "huge");
  const rhi::ShaderModuleHandle shader = device->create_shader_module({.spirv = spirv, .label = "huge"});
  try {
    device->create_compute_pipeline({.shader = shader, .specialization = {}, .label = "huge"});
  } catch (const rhi::Error&) {
    // The driver may refuse as well.
  }
  const std::vector<rhi::Message> said = messages.take();
  REQUIRE_FALSE(said.empty());
  CHECK(said.front().source == "vulkan validation");
  CHECK(said.front().severity == rhi::Severity::error);
}

TEST_CASE("objects of another device are refused") {
  const rhi::DeviceHandle device = vulkan::create_device(named("vulkan"));
  const rhi::DeviceHandle other = vulkan::create_device(named("vulkan"));
  const rhi::BufferHandle foreign = other->create_buffer({.size = 16, .label = "foreign"});
  const rhi::CommandListHandle list = device->create_command_list("list");
  CHECK_ERROR(invalid_argument, "belongs to another device", list->fill({foreign}, 0));
  CHECK_ERROR(invalid_argument, "belongs to another device", other->submit(list));
  std::vector<std::byte> bytes(16);
  CHECK_ERROR(invalid_argument, "belongs to another device", device->download(foreign, 0, bytes));
}

TEST_CASE("objects may outlive the device") {
  rhi::BufferHandle buffer;
  rhi::FenceHandle fence;
  rhi::CommandListHandle recorded;
  {
    const rhi::DeviceHandle device = vulkan::create_device(named("vulkan"));
    buffer = device->create_buffer(
        {.size = 1 << 20, .usage = rhi::BufferUsage::storage | rhi::BufferUsage::device_address, .label = "survivor"});
    const rhi::CommandListHandle list = device->create_command_list("last");
    list->fill({buffer}, 1);
    fence = device->submit(list);
    recorded = device->create_command_list("never submitted");
    recorded->fill({buffer}, 2);
  }
  CHECK(fence->wait_for(std::chrono::nanoseconds(0)));
  CHECK(buffer->device_address() != 0);
  recorded->fill({buffer}, 3);
}

TEST_CASE("a buffer larger than any memory is out of memory, and the device goes on") {
  const rhi::DeviceHandle device = vulkan::create_device(named("vulkan"));
  CHECK_ERROR(out_of_memory, "colossal: ", device->create_buffer({.size = 1ull << 55, .label = "colossal"}));
  const rhi::BufferHandle buffer = device->create_buffer({.size = 16, .label = "modest"});
  const rhi::CommandListHandle list = device->create_command_list("go on");
  list->fill({buffer}, 5);
  device->submit(list);
  CHECK(test::contents<std::uint32_t>(*device, buffer, 4) == std::vector<std::uint32_t>(4, 5));
}

TEST_CASE("InstanceDesc has the bits of VkAccelerationStructureInstanceKHR") {
  rhi::InstanceDesc ours = {};
  ours.object_to_world[1][2] = 3;
  ours.custom_index = 0x123456;
  ours.mask = 0x78;
  ours.sbt_offset = 0x9abcde;
  ours.flags = 0xf1;
  ours.blas_address = 0x1122334455667788;
  VkAccelerationStructureInstanceKHR theirs = {};
  theirs.transform.matrix[1][2] = 3;
  theirs.instanceCustomIndex = 0x123456;
  theirs.mask = 0x78;
  theirs.instanceShaderBindingTableRecordOffset = 0x9abcde;
  theirs.flags = 0xf1;
  theirs.accelerationStructureReference = 0x1122334455667788;
  CHECK(std::memcmp(&ours, &theirs, sizeof(ours)) == 0);
}
