// What shaders print by debugPrintfEXT, on every device.

#include "program/print/printing_job.hpp"

#include <doctest/doctest.h>

#include <cstdint>
#include <string>
#include <vector>

#include "program/execute/execution.hpp"
#include "program/explain/explanation.hpp"
#include "rhi/glsl/compile.hpp"
#include "tests/support/device_test.hpp"

using namespace tandem;
using namespace tandem::program;

namespace {

/// Prints from divergent control flow, from a loop and from a function, and computes.
constexpr const char* printing = R"(#version 460
#extension GL_EXT_debug_printf : enable
layout(local_size_x = 4, local_size_y = 2) in;
layout(set = 0, binding = 0) buffer Values { float values[]; };
layout(set = 0, binding = 3) buffer Unused { uint more[]; };
float halved(float x) {
  debugPrintfEXT("half of %g", x);
  return x / 2;
}
void main() {
  const uint i = gl_GlobalInvocationID.x + 8 * gl_GlobalInvocationID.y;
  if (gl_GlobalInvocationID.x == 6) {
    for (int round = 0; round < 2; ++round)
      debugPrintfEXT("round %d, %v3f, %v2u, %d%%\n", round, vec3(round, 0.5, -1), gl_GlobalInvocationID.xy, i > 8);
  }
  if (i == 9) values[i] = halved(values[i]);
  values[i] += 1;
}
)";

Job printing_shader_job() {
  std::vector<std::byte> bytes(32 * sizeof(float));
  Job job = {.shaders = {{.name = "printing.comp",
                          .spirv = glsl::compile(printing, rhi::ShaderStage::compute, "printing.comp")}},
             .buffers = {{.name = "values", .type = make_array(make_type(ScalarType::float32), 0), .initial = bytes}},
             .pipelines = {{.name = "print",
                            .stages = ComputeStages{.shader = {.shader = 0}},
                            .bindings = {{.set = 0, .binding = 0, .resource = BufferUse{.buffer = 0}}}}},
             .commands = {Dispatch{.pipeline = 0, .workgroup_count = {2, 2, 1}}}};
  return job;
}

/// "x,y,z text" of each line.
std::vector<std::string> texts(const PrintedLines& lines) {
  std::vector<std::string> result;
  for (const PrintedLine& line : lines.lines)
    result.push_back(std::to_string(line.invocation[0]) + "," + std::to_string(line.invocation[1]) + "," +
                     std::to_string(line.invocation[2]) + " " + line.text);
  return result;
}

PrintedLines lines_of(rhi::Device& device, const Job& job, std::uint32_t most_lines) {
  const std::optional<PrintingJob> printing = printing_job(job, most_lines);
  REQUIRE(printing);
  Execution execution(device, printing->job);
  execution.run();
  return printed_lines(*printing, execution.buffer(printing->buffer));
}

}  // namespace

TANDEM_DEVICE_TEST("a shader's debugPrintfEXT gives the same lines on every device, sorted by invocation") {
  const PrintedLines lines = lines_of(device, printing_shader_job(), 100);
  CHECK(lines.left_out == 0);
  CHECK(texts(lines) == std::vector<std::string>{"6,0,0 round 0, 0.000000, 0.500000, -1.000000, 6, 0, 0%",
                                                 "6,0,0 round 1, 1.000000, 0.500000, -1.000000, 6, 0, 0%",
                                                 "1,1,0 half of 0",
                                                 "6,1,0 round 0, 0.000000, 0.500000, -1.000000, 6, 1, 1%",
                                                 "6,1,0 round 1, 1.000000, 0.500000, -1.000000, 6, 1, 1%",
                                                 "6,2,0 round 0, 0.000000, 0.500000, -1.000000, 6, 2, 1%",
                                                 "6,2,0 round 1, 1.000000, 0.500000, -1.000000, 6, 2, 1%",
                                                 "6,3,0 round 0, 0.000000, 0.500000, -1.000000, 6, 3, 1%",
                                                 "6,3,0 round 1, 1.000000, 0.500000, -1.000000, 6, 3, 1%"});
}

TANDEM_DEVICE_TEST("lines that find no place are counted, and a shader computes the same with and without printing") {
  const Job job = printing_shader_job();
  const PrintedLines few = lines_of(device, job, 4);
  CHECK(few.lines.size() == 4);
  CHECK(few.left_out == 5);

  const std::optional<PrintingJob> printing = printing_job(job, 4);
  Execution with(device, printing->job), without(device, job);
  with.run();
  without.run();
  CHECK(with.buffer(0) == without.buffer(0));
}

TANDEM_DEVICE_TEST("a shader that prints can be recorded and explained") {
  const Job job = printing_shader_job();
  CHECK(refusals(device, job).empty());
  const Explanation explanation = explain(device, device, job, {});
  CHECK(gravest(explanation) == Cause::equal);
  CHECK(explanation.lockstep.values > 0);
}

TEST_CASE("a format that does not fit its arguments is refused in the name of the shader, or of its line") {
  const std::string text = R"(#version 460
#extension GL_EXT_debug_printf : enable
void main() {
  debugPrintfEXT("%d of %f\n", gl_GlobalInvocationID.x, gl_GlobalInvocationID.y);
})";
  const auto message = [&](bool debug_info) -> std::string {
    const Job job = {.shaders = {{.name = "wrong.comp",
                                  .spirv = glsl::compile(text, rhi::ShaderStage::compute, "wrong.comp",
                                                         {.debug_info = debug_info})}}};
    try {
      print_calls(job);
    } catch (const rhi::Error& error) {
      return error.what();
    }
    return "nothing";
  };
  const std::string reason = "debugPrintfEXT(\"%d of %f\\n\"): '%f' is given a whole number";
  CHECK(message(false) == "wrong.comp: " + reason);
  CHECK(message(true) == "wrong.comp:4: " + reason);
}
