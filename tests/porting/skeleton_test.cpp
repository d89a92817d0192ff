#include "docs/internals/porting/skeleton.hpp"

#include <doctest/doctest.h>

#include <string>

#include "conformance/kit/report.hpp"
#include "conformance/kit/run.hpp"
#include "tests/rhi/dispatch.hpp"

namespace tandem {
namespace {

using conformance::Status;

TEST_CASE("the skeleton passes what it has, and the kit names what it lacks") {
  const rhi::DeviceHandle device = skeleton::create_device();
  const std::vector<conformance::Case> cases = conformance::all_cases();
  const conformance::DeviceReport report = conformance::run(*device, cases, {});
  MESSAGE(conformance::text(report));
  CHECK_FALSE(conformance::succeeded(report));
  CHECK(report.results.size() == cases.size());
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const conformance::Result& result = report.results[i];
    CAPTURE(result.name);
    CAPTURE(result.sentence);
    const std::string_view group = conformance::group_of(result.name);
    if (group == "device.buffers") {
      CHECK(result.status == Status::passed);
    } else if (group == "device.compute") {
      CHECK(result.status == Status::error);
      CHECK(result.sentence == "multiply and add: the skeleton has no compute pipelines");
    } else if (result.status == Status::passed) {
      CHECK(group == "compute.command_list");
    } else if (result.status == Status::error) {
      CHECK(result.sentence.find("the skeleton has no ") != std::string::npos);
    } else {
      CHECK(result.status == Status::unsupported);
      CHECK(result.sentence.starts_with("the device "));
    }
  }
}

TEST_CASE("the skeleton refuses by name what it does not have, and checks what it has") {
  const rhi::DeviceHandle device = skeleton::create_device();
  CHECK_ERROR(unsupported, "field: the skeleton has no bottom levels",
              device->create_bottom_level({.geometries = {}, .label = "field"}));
  CHECK_ERROR(unsupported, "picture: the skeleton has no textures", device->create_texture({.label = "picture"}));
  CHECK_ERROR(invalid_argument, "nothing: ", device->create_buffer({.size = 0, .label = "nothing"}));
  const rhi::BufferHandle buffer = device->create_buffer({.size = 4, .label = "word"});
  const rhi::CommandListHandle list = device->create_command_list("closed");
  device->submit(list);
  CHECK_ERROR(invalid_argument, "closed: ", list->fill({buffer}, 1));
}

}  // namespace
}  // namespace tandem
