// Ray tracing pipelines and acceleration structures of a job.

#include <doctest/doctest.h>

#include <cstring>
#include <span>
#include <string>
#include <vector>

#include "program/execute/execution.hpp"
#include "program/execute/specialization.hpp"
#include "rhi/glsl/compile.hpp"
#include "tests/support/device_test.hpp"

using namespace tandem;
using namespace tandem::program;

namespace {

Shader shader(const std::string& name, rhi::ShaderStage stage, const std::string& text) {
  return {.name = name,
          .stage = stage,
          .spirv = glsl::compile("#version 460\n#extension GL_EXT_ray_tracing : require\n" + text, stage, name)};
}

/// Rays along +z at x = 0.25, 1.25, ... Their payloads become the results.
constexpr const char* ray_generation = R"(
  layout(set = 0, binding = 0) uniform accelerationStructureEXT scene;
  layout(set = 0, binding = 1) writeonly buffer Results { float results[]; };
  layout(constant_id = 0) const float scale = 1;
  layout(location = 0) rayPayloadEXT float value;
  void main() {
    value = 0;
    traceRayEXT(scene, 0, 0xff, 0, 0, 0, vec3(gl_LaunchIDEXT.x + 0.25, 0.25, 0), 0, vec3(0, 0, 1), 100, 0);
    results[gl_LaunchIDEXT.x] = value * scale;
  }
)";
constexpr const char* miss = R"(
  layout(location = 0) rayPayloadInEXT float value;
  void main() { value = -1; }
)";
constexpr const char* closest_hit = R"(
  layout(location = 0) rayPayloadInEXT float value;
  layout(shaderRecordEXT) buffer Record { float added; };
  layout(constant_id = 0) const float scale = 1;
  void main() { value = (gl_HitTEXT + added + gl_InstanceCustomIndexEXT) * scale; }
)";
constexpr const char* intersection = R"(
  void main() { reportIntersectionEXT(5.0, 0); }
)";

std::vector<std::byte> bytes_of(const std::vector<float>& values) {
  const auto bytes = std::as_bytes(std::span(values));
  return {bytes.begin(), bytes.end()};
}

std::vector<float> floats_of(const std::vector<std::byte>& bytes) {
  std::vector<float> values(bytes.size() / sizeof(float));
  std::memcpy(values.data(), bytes.data(), bytes.size());
  return values;
}

/// A triangle at x = 0 and z = 2, twice the same at x = 1, and a box at x = 3.
Job ray_job() {
  const Triangles triangle{.positions = {{0, 0, 2}, {1, 0, 2}, {0, 1, 2}}, .indices = {0, 1, 2}};
  Instance moved{.bottom_level = 0, .custom_index = 100};
  moved.object_to_world[3] = 1;
  TraceRays trace;
  trace.miss = {{.shader = 0}};
  trace.hit = {{.shader = 0, .data = bytes_of({0.5f})}, {.shader = 1, .data = bytes_of({0.25f})}};
  trace.size = {4, 1, 1};
  return {
      .shaders = {shader("generation", rhi::ShaderStage::ray_generation, ray_generation),
                  shader("miss", rhi::ShaderStage::miss, miss),
                  shader("hit", rhi::ShaderStage::closest_hit, closest_hit),
                  shader("box", rhi::ShaderStage::intersection, intersection)},
      .buffers = {{.name = "results", .initial = std::vector<std::byte>(16)}},
      .bottom_levels = {{.name = "triangles", .geometries = {triangle}},
                        {.name = "boxes", .geometries = {Boxes{.boxes = {{3, 0, 4, 4, 1, 6}}}}}},
      .top_levels = {{.name = "scene",
                      .instances = {{.bottom_level = 0}, moved, {.bottom_level = 1, .sbt_offset = 1}}}},
      .pipelines = {{.name = "rays",
                     .stages = RayTracingStages{.ray_generation = {{.shader = 0, .specialization = {{0, 0x40000000}}}},
                                                .miss = {{.shader = 1}},
                                                .hit_groups = {{.closest_hit = Stage{.shader = 2}},
                                                               {.closest_hit = Stage{.shader = 2},
                                                                .intersection = Stage{.shader = 3}}}},
                     .bindings = {{.binding = 0, .resource = TopLevelUse{0}},
                                  {.binding = 1, .resource = BufferUse{0}}}}},
      .commands = {trace}};
}

TANDEM_DEVICE_TEST("a trace of a job runs its shaders with their records; a constant's value is its stage's alone") {
  const Job job = ray_job();
  Execution execution(device, job);
  execution.run();
  // Only the ray generation shader's scale is 2.
  CHECK(floats_of(execution.buffer(0)) == std::vector<float>{5, 205, -2, 10.5f});
}

TANDEM_DEVICE_TEST("an index outside of the positions of a job's triangles is refused") {
  Job job = ray_job();
  std::get<Triangles>(job.bottom_levels[0].geometries[0]).indices[1] = 3;
  CHECK_THROWS_WITH_AS(Execution(device, job), "triangles, geometry 0: index 3 of 3 positions", rhi::Error);
}

TANDEM_DEVICE_TEST("values become defaults of specialisation constants, of every width") {
  const std::string text = R"(#version 460
    #extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
    layout(constant_id = 1) const uint a = 1;
    layout(constant_id = 2) const uint64_t b = 2;
    layout(constant_id = 3) const bool c = false;
    layout(binding = 0) buffer Results { uint64_t results[]; };
    void main() { results[0] = a + b + (c ? 1 : 0); }
  )";
  const auto words = glsl::compile(text, rhi::ShaderStage::compute, "constants");
  const rhi::ShaderModuleHandle module = device.create_shader_module({.spirv = words, .label = "constants"});
  const std::vector<rhi::SpecializationValue> values = {{2, 0x500000001}, {3, 1}};
  const rhi::ShaderReflection reflection = rhi::reflect(specialized(*module, values), "constants");
  REQUIRE(reflection.specialization_constants.size() == 3);
  CHECK(reflection.specialization_constants[0].default_value == 1);
  CHECK(reflection.specialization_constants[1].default_value == 0x500000001);
  CHECK(reflection.specialization_constants[2].default_value == 1);
  const std::vector<rhi::SpecializationValue> unknown = {{4, 1}};
  CHECK_THROWS_WITH_AS(specialized(*module, unknown), "constants: the shader has no specialisation constant 4",
                       rhi::Error);
}

}  // namespace
