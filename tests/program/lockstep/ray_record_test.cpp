// Recording through the shaders of a ray tracing pipeline, which call each other.

#include <doctest/doctest.h>

#include <algorithm>
#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "program/lockstep/recorded_execution.hpp"
#include "program/lockstep/walk.hpp"
#include "rhi/glsl/compile.hpp"
#include "tests/support/device_test.hpp"

using namespace tandem;
using namespace tandem::program;

namespace {

constexpr std::uint64_t plenty = 1 << 24;

Shader shader(const std::string& name, rhi::ShaderStage stage, const std::string& text) {
  return {.name = name,
          .stage = stage,
          .spirv = glsl::compile("#version 460\n#extension GL_EXT_ray_tracing : require\n" + text, stage, name)};
}

/// The closest-hit shader traces once more from the hit, and calls a callable; the any-hit shader lets every second
/// primitive through; the boxes have an intersection shader.
Job ray_job() {
  const Triangles near{.positions = {{0, 0, 2}, {1, 0, 2}, {0, 1, 2}}, .flags = rhi::GeometryFlags::none};
  const Triangles far{.positions = {{0, 0, 3}, {1, 0, 3}, {0, 1, 3}, {2, 0, 3}, {3, 0, 3}, {2, 1, 3}},
                      .flags = rhi::GeometryFlags::none};
  TraceRays trace;
  trace.miss = {{.shader = 0}};
  trace.hit = {{.shader = 0}, {.shader = 1}};
  trace.callable = {{.shader = 0}};
  trace.size = {4, 1, 1};
  return {
      .shaders = {shader("generation", rhi::ShaderStage::ray_generation, R"(
                    layout(set = 0, binding = 0) uniform accelerationStructureEXT scene;
                    layout(set = 0, binding = 1) buffer Results { float results[]; };
                    layout(location = 0) rayPayloadEXT vec2 value;
                    void main() {
                      float sum = 0;
                      for (int i = 0; i < 2; ++i) {
                        value = vec2(0, i);
                        traceRayEXT(scene, 0, 0xff, 0, 0, 0, vec3(gl_LaunchIDEXT.x + 0.25, 0.25, 0), 0, vec3(0, 0, 1),
                                    100, 0);
                        sum += value.x;
                      }
                      results[gl_LaunchIDEXT.x] = sum;
                    })"),
                  shader("miss", rhi::ShaderStage::miss, R"(
                    layout(location = 0) rayPayloadInEXT vec2 value;
                    void main() { value.x -= 1; })"),
                  shader("hit", rhi::ShaderStage::closest_hit, R"(
                    layout(set = 0, binding = 0) uniform accelerationStructureEXT scene;
                    layout(location = 0) rayPayloadInEXT vec2 value;
                    layout(location = 1) rayPayloadEXT vec2 further;
                    layout(location = 2) callableDataEXT float squared;
                    void main() {
                      further = vec2(0, 1);
                      if (value.y < 1 && gl_HitTEXT < 2.5)
                        traceRayEXT(scene, 0, 0xff, 0, 0, 0, gl_WorldRayOriginEXT, gl_HitTEXT + 0.1,
                                    gl_WorldRayDirectionEXT, 100, 1);
                      squared = gl_HitTEXT + further.x;
                      executeCallableEXT(0, 2);
                      value.x = squared;
                    })"),
                  shader("any", rhi::ShaderStage::any_hit, R"(
                    layout(location = 0) rayPayloadInEXT vec2 value;
                    void main() { if (gl_PrimitiveID == 1) ignoreIntersectionEXT; })"),
                  shader("box", rhi::ShaderStage::intersection, "void main() { reportIntersectionEXT(5.0, 0); }"),
                  shader("square", rhi::ShaderStage::callable, R"(
                    layout(location = 2) callableDataInEXT float squared;
                    void main() { squared *= squared; })")},
      .buffers = {{.name = "results", .initial = std::vector<std::byte>(16)}},
      .bottom_levels = {{.name = "triangles", .geometries = {near, far}},
                        {.name = "boxes", .geometries = {Boxes{.boxes = {{3, 0, 4, 4, 1, 6}}}}}},
      .top_levels = {{.name = "scene", .instances = {{.bottom_level = 0}, {.bottom_level = 1, .sbt_offset = 1}}}},
      .pipelines = {{.name = "rays",
                     .stages =
                         RayTracingStages{
                             .ray_generation = {{.shader = 0}},
                             .miss = {{.shader = 1}},
                             .hit_groups = {{.closest_hit = Stage{.shader = 2}, .any_hit = Stage{.shader = 3}},
                                            {.closest_hit = Stage{.shader = 2}, .intersection = Stage{.shader = 4}}},
                             .callable = {{.shader = 5}},
                             .max_recursion_depth = 2},
                     .bindings = {{.binding = 0, .resource = TopLevelUse{0}},
                                  {.binding = 1, .resource = BufferUse{0}}}}},
      .commands = {trace}};
}

Snapshot inputs_of(const Job& job) { return {.buffers = {job.buffers[0].initial}, .images = {}}; }

/// The shaders that an invocation ran, with how deep inside of others.
std::multiset<std::pair<std::string, std::size_t>> shaders_of(const RecordedLaunch& launch, const Recording& recording,
                                                              std::size_t slot) {
  std::multiset<std::pair<std::string, std::size_t>> found;
  Walk walk(launch, slot_of(recording.request, recording.buffer, slot));
  while (walk.next()) {
    if (walk.begins_shader()) found.emplace(walk.shader().name, walk.shader_depth());
    for (std::size_t i = walk.segment().first_instruction; i < walk.segment().end_instruction; ++i) walk.pass(i);
  }
  return found;
}

}  // namespace

TANDEM_DEVICE_TEST("a record goes through all shaders that a ray runs, and changes no result") {
  const Job job = ray_job();
  Execution plain(device, job);
  plain.run();
  const std::vector<std::byte> expected = plain.buffer(0);
  const RecordedLaunch to_record = record_launch(job, job.commands[0], RecordForm::record);
  RecordedExecution recorder(device, to_record, inputs_of(job));
  const Recording recorded = recorder.record({0, 1, 2, 3}, plenty);
  CHECK(recorder.outputs().buffers[0] == expected);
  using Shaders = std::multiset<std::pair<std::string, std::size_t>>;
  // The first ray of invocation 0 meets the near triangle, whose shader traces on to the far one.
  Shaders seen = shaders_of(to_record, recorded, 0);
  std::erase_if(seen, [](const auto& each) { return each.first == "any"; });  // how often it runs is the device's
  CHECK(seen ==
        Shaders{{"generation", 1}, {"hit", 2}, {"hit", 2}, {"hit", 3}, {"square", 3}, {"square", 3}, {"square", 4}});
  CHECK(shaders_of(to_record, recorded, 1) == Shaders{{"generation", 1}, {"miss", 2}, {"miss", 2}});
  CHECK(shaders_of(to_record, recorded, 2) ==
        Shaders{{"generation", 1}, {"any", 2}, {"any", 2}, {"miss", 2}, {"miss", 2}});
  Shaders boxes = shaders_of(to_record, recorded, 3);
  std::erase_if(boxes, [](const auto& each) { return each.first == "box"; });
  CHECK(boxes == Shaders{{"generation", 1}, {"hit", 2}, {"hit", 2}, {"square", 3}, {"square", 3}});

  const RecordedLaunch to_hash = record_launch(job, job.commands[0], RecordForm::hash);
  RecordedExecution hasher(device, to_hash, inputs_of(job));
  const std::vector<std::uint32_t> hashes = hasher.hashes();
  CHECK(hasher.outputs().buffers[0] == expected);
  CHECK(hashes.size() == 4);
  CHECK(std::set(hashes.begin(), hashes.end()).size() == 4);

  const RecordedLaunch to_replay = record_launch(job, job.commands[0], RecordForm::lockstep);
  RecordedExecution replayer(device, to_replay, inputs_of(job));
  const Recording replayed = replayer.replay(recorded, true);
  CHECK(replayer.outputs().buffers[0] == expected);
  for (std::size_t slot = 0; slot < 4; ++slot)
    CHECK(std::ranges::equal(slot_of(recorded.request, recorded.buffer, slot).words,
                             slot_of(replayed.request, replayed.buffer, slot).words));
}

TANDEM_DEVICE_TEST("a ray that runs another shader leaves the rest of a replay in step") {
  Job job = ray_job();
  const RecordedLaunch to_record = record_launch(job, job.commands[0], RecordForm::record);
  RecordedExecution recorder(device, to_record, inputs_of(job));
  const Recording recorded = recorder.record({0, 1, 2, 3}, plenty);
  const std::vector<std::byte> expected = recorder.outputs().buffers[0];
  job.top_levels[0].instances[0].mask = 0;  // the triangles are gone
  const RecordedLaunch to_replay = record_launch(job, job.commands[0], RecordForm::lockstep);
  RecordedExecution replayer(device, to_replay, inputs_of(job));
  const Recording free = replayer.replay(recorded, false);
  CHECK(replayer.outputs().buffers[0] != expected);
  const Recording forced = replayer.replay(recorded, true);
  CHECK(replayer.outputs().buffers[0] == expected);  // the payloads are those of the record
  const SlotView missed = slot_of(recorded.request, recorded.buffer, 1);
  CHECK(std::ranges::equal(missed.words, slot_of(forced.request, forced.buffer, 1).words));
}
