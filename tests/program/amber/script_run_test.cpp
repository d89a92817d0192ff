#include "program/amber/script_run.hpp"

#include <doctest/doctest.h>

#include <filesystem>
#include <string>

#include "tests/support/device_test.hpp"

using namespace tandem;
using namespace tandem::program::amber;

namespace {

const std::filesystem::path folder = std::filesystem::path(TANDEM_SOURCE_DIRECTORY) / "tests/program/amber";

Result run_file(const std::string& name, rhi::Device& device) { return run(read(folder / name), device); }

Result run_text(const std::string& text, rhi::Device& device) {
  return run(parse("#!amber\n" + text, "x.amber"), device);
}

/// A shader that adds one to the first value.
const std::string adding = R"(SHADER compute add GLSL
#version 450
layout(binding = 0) buffer Values { uint values[]; };
void main() { values[0] += 1u; }
END
BUFFER values DATA_TYPE uint32 SIZE 4 FILL 1
PIPELINE compute adding
  ATTACH add
  BIND BUFFER values AS storage DESCRIPTOR_SET 0 BINDING 0
END
)";

TANDEM_DEVICE_TEST("scripts with every kind of resource pass") {
  for (const char* name : {"types", "struct", "image", "repeat", "ray_query", "ray_pipeline"}) {
    const Result result = run_file(std::string(name) + ".amber", device);
    CAPTURE(name);
    for (const std::string& reason : result.reasons) MESSAGE(reason);
    CHECK(result.outcome == Outcome::passed);
  }
}

TANDEM_DEVICE_TEST("what a shader leaves fails an expectation that it does not meet") {
  const Result result = run_text(adding +
                                     "RUN adding 1 1 1\nEXPECT values IDX 0 EQ 3\nEXPECT values IDX 0 EQ 2\n"
                                     "EXPECT values IDX 4 NE 1\n",
                                 device);
  CHECK(result.outcome == Outcome::failed);
  REQUIRE(result.reasons.size() == 2);
  CHECK(result.reasons[0] == "line 13: values is 2 at byte 0, expected 3");
  CHECK(result.reasons[1] == "line 15: values is 1 at byte 4, expected not 1");
}

TANDEM_DEVICE_TEST("a VkScript runs, and fails where a probe finds something else") {
  const std::string text = R"([compute shader]
#version 450
layout(set = 1, binding = 2) buffer Values { vec3 values[2]; };
layout(binding = 0) uniform Factors { int factor; };
layout(push_constant) uniform Constants { float more; };
void main() { values[0] = values[1] * float(factor) + more; }
[test]
ssbo 1:2 subdata vec3 0 0 0 0 1 2 3
uniform ubo 0 int 0 10
uniform float 0 0.25
compute 1 1 1
probe ssbo vec3 1:2 0 == 10.25 20.25 )";
  const auto outcome = [&](const std::string& last) { return run(parse(text + last, "x.amber"), device); };
  CHECK(outcome("30.25 1 2 3").outcome == Outcome::passed);
  const Result result = outcome("30.5");
  CHECK(result.outcome == Outcome::failed);
  CHECK(result.reasons.at(0) == "line 12: ssbo 1:2 is 30.25 at byte 8, expected 30.5");
}

TANDEM_DEVICE_TEST("one name may be an image for a pipeline and a buffer for another") {
  const Result result = run_text(R"(SHADER compute paint GLSL
#version 450
layout(binding = 0, r32ui) uniform uimage2D picture;
void main() {
  const ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  imageStore(picture, at, imageLoad(picture, at) * 2u);
}
END
SHADER compute add GLSL
#version 450
layout(binding = 0) buffer Values { uint values[]; };
void main() { values[gl_GlobalInvocationID.x] += 1u; }
END
IMAGE picture FORMAT R32_UINT DIM_2D WIDTH 2 HEIGHT 2 SERIES_FROM 1 INC_BY 1
PIPELINE compute painting
  ATTACH paint
  BIND BUFFER picture AS storage_image DESCRIPTOR_SET 0 BINDING 0
END
PIPELINE compute adding
  ATTACH add
  BIND BUFFER picture AS storage DESCRIPTOR_SET 0 BINDING 0
END
RUN painting 2 2 1
RUN adding 4 1 1
RUN painting 2 2 1
EXPECT picture IDX 0 EQ 6 10 14 18
)",
                                 device);
  for (const std::string& reason : result.reasons) MESSAGE(reason);
  CHECK(result.outcome == Outcome::passed);
}

TANDEM_DEVICE_TEST("the smallest and the largest subgroup size are the device's") {
  const std::string text = R"(DEVICE_FEATURE SubgroupSizeControl.subgroupSizeControl
SHADER compute size GLSL TARGET_ENV spv1.3
#version 450
#extension GL_KHR_shader_subgroup_basic : require
layout(local_size_x = 64) in;
layout(binding = 0) buffer Values { uint values[]; };
void main() { values[0] = gl_SubgroupSize; }
END
BUFFER values DATA_TYPE uint32 SIZE 1 FILL 0
PIPELINE compute sizing
  ATTACH size
  SUBGROUP size
    REQUIRED_SIZE )";
  const auto ending = [](std::uint32_t size) {
    return "\n  END\n  BIND BUFFER values AS storage DESCRIPTOR_SET 0 BINDING 0\nEND\nRUN sizing 1 1 1\n"
           "EXPECT values IDX 0 EQ " +
           std::to_string(size);
  };
  const rhi::Limits& limits = device.info().limits;
  CHECK(run_text(text + "MIN" + ending(limits.min_subgroup_size), device).outcome == Outcome::passed);
  CHECK(run_text(text + "MAX" + ending(limits.max_subgroup_size), device).outcome == Outcome::passed);
  CHECK(run_text(text + "MAX" + ending(limits.max_subgroup_size + 1), device).outcome == Outcome::failed);
}

TANDEM_DEVICE_TEST("a script that the device cannot run is skipped with the reason, one that is wrong an error") {
  const Result lacking = run_text("DEVICE_FEATURE geometryShader\n" + adding + "RUN adding 1 1 1", device);
  CHECK(lacking.outcome == Outcome::skipped);
  CHECK(lacking.reasons.at(0) == "it needs the device feature geometryShader");
  const Result extension = run_text("DEVICE_EXTENSION VK_EXT_nonsense\n" + adding + "RUN adding 1 1 1", device);
  CHECK(extension.reasons.at(0) == "it needs the device extension VK_EXT_nonsense");
  CHECK(run_text("PIPELINE graphics g\nEND", device).outcome == Outcome::skipped);

  const Result unbound = run_text(R"(SHADER compute add GLSL
#version 450
layout(binding = 0) buffer Values { uint values[]; };
void main() { values[0] += 1u; }
END
PIPELINE compute adding
  ATTACH add
END
RUN adding 1 1 1
)",
                                  device);
  CHECK(unbound.outcome == Outcome::error);
  CHECK(unbound.reasons.at(0).starts_with("adding: "));
}

}  // namespace
