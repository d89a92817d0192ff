#include "program/execute/execution.hpp"

#include <doctest/doctest.h>

#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <vector>

#include "rhi/glsl/compile.hpp"
#include "tests/support/device_test.hpp"

using namespace tandem;
using namespace tandem::program;

namespace {

template <typename T>
std::vector<std::byte> bytes_of(const std::vector<T>& values) {
  const auto bytes = std::as_bytes(std::span(values));
  return {bytes.begin(), bytes.end()};
}

template <typename T>
std::vector<T> values_of(const std::vector<std::byte>& bytes) {
  std::vector<T> values(bytes.size() / sizeof(T));
  std::memcpy(values.data(), bytes.data(), bytes.size());
  return values;
}

using Words = std::vector<std::uint32_t>;

Shader compute(const std::string& name, const std::string& text) {
  return {.name = name, .spirv = glsl::compile("#version 460\n" + text, rhi::ShaderStage::compute, name)};
}

/// Adds two push constants and a specialisation constant to every word of the buffer.
constexpr const char* adding = R"(
  layout(local_size_x = 4) in;
  layout(constant_id = 3) const uint more = 0;
  layout(set = 1, binding = 2) buffer Words { uint words[]; };
  layout(push_constant) uniform Push { uint first, second; };
  void main() { words[gl_GlobalInvocationID.x] += first + second + more; }
)";

Job adding_job() {
  return {.shaders = {compute("adding", adding)},
          .buffers = {{.name = "words", .initial = bytes_of(Words{1, 2, 3, 4, 5, 6, 7, 8})},
                      {.name = "other", .initial = bytes_of(Words{0})}},
          .pipelines = {{.name = "add",
                         .stages = ComputeStages{.shader = {.shader = 0, .specialization = {{3, 100}}}},
                         .bindings = {{.set = 1, .binding = 2, .resource = BufferUse{.buffer = 0}},
                                      {.set = 0, .binding = 0, .resource = BufferUse{.buffer = 1}}},
                         .push_constants = bytes_of(Words{10, 20, 30})}},
          .commands = {Dispatch{.pipeline = 0, .workgroup_count = {2, 1, 1}}}};
}

std::string refusal(rhi::Device& device, const Job& job) {
  try {
    Execution(device, job).run();
  } catch (const rhi::Error& error) {
    return error.what();
  }
  return "";
}

TANDEM_DEVICE_TEST("a dispatch of a job binds what the shader uses, and cuts push constants to what it declares") {
  const Job job = adding_job();
  Execution execution(device, job);
  execution.run();
  CHECK(values_of<std::uint32_t>(execution.buffer(0)) == Words{131, 132, 133, 134, 135, 136, 137, 138});
  execution.run(job.commands[0]);
  CHECK(values_of<std::uint32_t>(execution.buffer(0))[7] == 268);
  CHECK(execution.timed_run() >= 0);
  CHECK(values_of<std::uint32_t>(execution.buffer(0))[7] == 398);
  execution.set_buffer(0, bytes_of(Words(8, 0)));
  execution.run();
  CHECK(values_of<std::uint32_t>(execution.buffer(0)) == Words(8, 130));
}

TANDEM_DEVICE_TEST("push constants that a job lacks are zero") {
  Job job = adding_job();
  job.pipelines[0].push_constants.resize(4);
  Execution execution(device, job);
  execution.run();
  CHECK(values_of<std::uint32_t>(execution.buffer(0))[0] == 111);
}

TANDEM_DEVICE_TEST("a base workgroup begins behind the first") {
  Job job = adding_job();
  job.commands = {Dispatch{.pipeline = 0, .workgroup_count = {1, 1, 1}, .base_workgroup = {1, 0, 0}}};
  Execution execution(device, job);
  execution.run();
  CHECK(values_of<std::uint32_t>(execution.buffer(0)) == Words{1, 2, 3, 4, 135, 136, 137, 138});
}

TANDEM_DEVICE_TEST("images, samplers and texel buffers of a job are bound, in several pipelines") {
  const std::string reading = R"(
    layout(set = 0, binding = 0) uniform sampler2D picture;
    layout(set = 0, binding = 1) uniform texture2D separate;
    layout(set = 0, binding = 2) uniform sampler linear;
    layout(set = 0, binding = 3) uniform textureBuffer texels;
    layout(set = 0, binding = 4) writeonly buffer Results { float results[]; };
    void main() {
      results[0] = textureLod(picture, vec2(0.5), 0).r;
      results[1] = textureLod(sampler2D(separate, linear), vec2(0.5), 0).r;
      results[2] = texelFetch(texels, 1).r;
    }
  )";
  const std::string writing = R"(
    layout(local_size_x = 2, local_size_y = 2) in;
    layout(set = 0, binding = 1, r32f) uniform writeonly image2D picture;
    void main() {
      const ivec2 p = ivec2(gl_GlobalInvocationID.xy);
      imageStore(picture, p, vec4(p.x + 2 * p.y));
    }
  )";
  const Job job{
      .shaders = {compute("reading", reading), compute("writing", writing)},
      .buffers = {{.name = "results", .initial = std::vector<std::byte>(12)},
                  {.name = "texels", .initial = bytes_of(std::vector<float>{7, 8})},
                  {.name = "copied", .initial = std::vector<std::byte>(16)},
                  {.name = "copied again", .initial = std::vector<std::byte>(16)}},
      .images = {{.desc = {.format = rhi::TextureFormat::r32_float, .size = {2, 2, 1}, .label = "picture"}},
                 {.desc = {.format = rhi::TextureFormat::r32_float, .size = {2, 2, 1}, .label = "copy"}}},
      .samplers = {{.label = "nearest"},
                   {.magnification = rhi::Filter::linear, .minification = rhi::Filter::linear, .label = "linear"}},
      .pipelines = {{.name = "read",
                     .stages = ComputeStages{.shader = {.shader = 0}},
                     .bindings = {{.binding = 0, .resource = ImageUse{.image = 0, .sampler = 1}},
                                  {.binding = 1, .resource = ImageUse{.image = 1, .sampler = 0}},
                                  {.binding = 2, .resource = SamplerUse{1}},
                                  {.binding = 3, .resource = TexelBufferUse{.buffer = 1}},
                                  {.binding = 4, .resource = BufferUse{.buffer = 0}}}},
                    {.name = "write",
                     .stages = ComputeStages{.shader = {.shader = 1}},
                     .bindings = {{.binding = 1, .resource = ImageUse{.image = 0}}}}},
      .commands = {Dispatch{.pipeline = 1}, CopyImage{.source = 0, .destination = 1}, Dispatch{.pipeline = 0},
                   CopyImageToBuffer{.source = 1, .destination = 2}, CopyBuffer{.source = 2, .destination = 3}}};
  Execution execution(device, job);
  CHECK(values_of<float>(execution.image(0)) == std::vector<float>(4, 0.0f));
  execution.run();
  CHECK(values_of<float>(execution.image(1)) == std::vector<float>{0, 1, 2, 3});
  CHECK(values_of<float>(execution.buffer(0)) == std::vector<float>{1.5f, 1.5f, 8});
  CHECK(values_of<float>(execution.buffer(3)) == std::vector<float>{0, 1, 2, 3});
  execution.set_image(0, bytes_of(std::vector<float>{4, 5, 6, 7}));
  execution.run(CopyImageToBuffer{.source = 0, .destination = 2});
  execution.run(CopyBufferToImage{.source = 3, .destination = 0});
  CHECK(values_of<float>(execution.buffer(2)) == std::vector<float>{4, 5, 6, 7});
  CHECK(values_of<float>(execution.image(0)) == std::vector<float>{0, 1, 2, 3});
}

TANDEM_DEVICE_TEST("what a job lacks or names wrongly is refused by name") {
  Job job = adding_job();
  job.pipelines[0].bindings.erase(job.pipelines[0].bindings.begin());
  CHECK(refusal(device, job) == "add: set 1 binding 2 ('Words') of pipeline 'add' needs 1 entry, but 0 are given");
  job = adding_job();
  job.pipelines[0].bindings[0].resource = BufferUse{.buffer = 9};
  CHECK(refusal(device, job) == "add: the job has no buffer 9");
  job = adding_job();
  job.buffers[0].initial.clear();
  CHECK(refusal(device, job) == "words: a buffer must have at least one byte");
  job = adding_job();
  job.commands = {Dispatch{.pipeline = 1}};
  CHECK(refusal(device, job) == "dispatch: the job has no pipeline 1");
  job = adding_job();
  Execution execution(device, job);
  CHECK_THROWS_WITH_AS(execution.set_buffer(0, bytes_of(Words{1})), "words: 4 bytes for the 32 that it has",
                       rhi::Error);
}

TANDEM_DEVICE_TEST("refusals name each shader that the device cannot run") {
  Job job = adding_job();
  CHECK(refusals(device, job).empty());
  job.shaders.push_back({.name = "nonsense", .spirv = {1, 2, 3}});
  const std::vector<std::string> reasons = refusals(device, job);
  REQUIRE(reasons.size() == 1);
  CHECK(reasons[0].starts_with("nonsense: "));
}

}  // namespace
