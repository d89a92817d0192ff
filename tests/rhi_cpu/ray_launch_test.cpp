#include <doctest/doctest.h>

#include <array>
#include <atomic>
#include <bit>
#include <cstring>
#include <string>

#include "rhi/error.hpp"
#include "tests/rhi_cpu/scripted_pipeline.hpp"
#include "tests/support/device_test.hpp"

// Which shaders a trace_rays of the CPU device runs, how often, and with which data.
namespace tandem::cpu {
namespace {

using kernel::ShaderCall;
using rhi::ShaderStage;
using test::ray_with;
using test::ScriptedPipeline;
using test::ScriptedScene;
using test::triangle_at;

std::string message_of(const std::function<void()>& call) {
  try {
    call();
  } catch (const rhi::Error& error) {
    CHECK(error.code() == rhi::ErrorCode::invalid_argument);
    return error.what();
  }
  return "nothing was thrown";
}

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

const ScriptedScene& empty_scene() {
  static const ScriptedScene scene({});
  return scene;
}

}  // namespace

TEST_CASE("Every invocation of a trace runs once and knows its place, whatever the size and the threads") {
  constexpr std::array<std::array<std::uint32_t, 3>, 7> sizes = {
      {{1, 1, 1}, {7, 1, 1}, {1000, 1, 1}, {1, 9, 1}, {13, 17, 1}, {64, 64, 1}, {3, 5, 7}}};
  for (const std::uint32_t thread_count : {1u, 4u}) {
    std::vector<std::atomic<std::uint32_t>> counts(64 * 64);
    std::array<std::uint32_t, 3> size{};
    std::atomic<std::uint32_t> wrong_sizes = 0;
    const ScriptedPipeline pipeline({{.stage = ShaderStage::ray_generation,
                                      .run =
                                          [&](ShaderCall& call) {
                                            const auto& id = call.launch_id;
                                            ++counts[(std::size_t{id[2]} * size[1] + id[1]) * size[0] + id[0]];
                                            wrong_sizes += !std::equal(size.begin(), size.end(), call.launch_size);
                                          }}},
                                    {}, 0, thread_count);
    for (const auto& each : sizes) {
      size = each;
      for (auto& count : counts) count = 0;
      pipeline.trace({}, size);
      std::uint32_t wrong = 0;
      for (std::size_t i = 0; i < counts.size(); ++i) wrong += counts[i] != (i < size[0] * size[1] * size[2] ? 1 : 0);
      CHECK(wrong == 0);
    }
    CHECK(wrong_sizes == 0);
  }
}

TEST_CASE("A trace with a size of zero runs nothing") {
  std::atomic<int> calls = 0;
  const ScriptedPipeline pipeline({{.stage = ShaderStage::ray_generation, .run = [&](ShaderCall&) { ++calls; }}}, {});
  pipeline.trace({}, {0, 5, 5});
  pipeline.trace({}, {5, 0, 5});
  pipeline.trace({}, {5, 5, 0});
  CHECK(calls == 0);
}

TEST_CASE("An indirect trace reads its size when it executes, and refuses one beyond the device's limit") {
  std::atomic<int> calls = 0;
  const ScriptedPipeline pipeline({{.stage = ShaderStage::ray_generation, .run = [&](ShaderCall&) { ++calls; }}}, {});
  rhi::Device& device = pipeline.device();
  const rhi::BufferHandle buffer =
      device.create_buffer({.size = 16, .usage = rhi::BufferUsage::indirect, .label = "size"});
  const auto trace_with = [&](std::array<std::uint32_t, 4> values) {
    const rhi::CommandListHandle list = device.create_command_list("list");
    rhi::TraceRaysDesc desc;
    desc.table = device.create_shader_table(pipeline.table_desc({}));
    desc.indirect_size = {buffer, 4};
    list->trace_rays(desc);
    const rhi::CommandListHandle upload = device.create_command_list("upload");
    upload->upload(buffer, 0, std::as_bytes(std::span(values)));
    device.submit(upload);
    device.submit(list);
  };
  trace_with({9, 2, 3, 4});
  CHECK(calls == 24);
  trace_with({9, 0, 3, 4});
  CHECK(calls == 24);
  CHECK(contains(message_of([&] { trace_with({1, 1u << 20, 1u << 20, 1u << 31}); }), "scripted: an indirect trace"));
  CHECK(contains(message_of([&] { trace_with({1, (1u << 30) + 1, 1, 1}); }), "1073741825 x 1 x 1"));
  CHECK(calls == 24);
}

TEST_CASE(
    "The hit record is offset + instance offset + geometry index * stride + the trace's first, all with their bits") {
  // Record i has the number i as data.
  std::uint32_t seen = 0;
  std::uint32_t offset = 0;
  std::uint32_t stride = 0;
  ScriptedScene scene({triangle_at(1, true)}, {0, 5});
  const ScriptedPipeline pipeline(
      {{.stage = ShaderStage::ray_generation,
        .run =
            [&](ShaderCall& call) {
              call.functions->trace_ray(call, &scene, ray_with(0), offset, stride, 0, nullptr, 0);
            }},
       {.stage = ShaderStage::closest_hit,
        .run = [&](ShaderCall& call) { std::memcpy(&seen, call.shader_record, sizeof(seen)); },
        .shader_record_size = 4}},
      {{.closest_hit = 1}});
  rhi::ShaderTableDesc desc = pipeline.table_desc(std::vector<std::uint32_t>(64, 0));
  for (std::uint32_t i = 0; i < 64; ++i) {
    const auto bytes = std::bit_cast<std::array<std::byte, 4>>(i);
    desc.hit.records[i].data.assign(bytes.begin(), bytes.end());
  }
  const rhi::ShaderTableHandle table = pipeline.device().create_shader_table(desc);
  struct Case {
    std::uint32_t instance, geometry, offset, stride, first, record;
  };
  for (const Case& each :
       {Case{0, 0, 0, 0, 0, 0}, Case{1, 0, 0, 0, 0, 5}, Case{0, 3, 0, 2, 0, 6}, Case{0, 3, 0, 0, 0, 0},
        Case{0, 0, 15, 1, 0, 15}, Case{0, 0, 16 + 3, 0, 0, 3}, Case{0, 2, 0, 16 + 4, 0, 8}, Case{1, 3, 7, 2, 40, 58}}) {
    CAPTURE(each.record);
    scene.hits[0].instance_index = each.instance;
    scene.hits[0].geometry_index = each.geometry;
    offset = each.offset;
    stride = each.stride;
    rhi::TraceRaysDesc trace_desc;
    trace_desc.table = table;
    trace_desc.first_hit_record = each.first;
    pipeline.submit(trace_desc);
    CHECK(seen == each.record);
  }
}

TEST_CASE("The miss index has 16 bits and counts from the trace's first miss record") {
  std::array<int, 2> calls{};
  std::uint32_t index = 0;
  const ScriptedPipeline pipeline({{.stage = ShaderStage::ray_generation,
                                    .run =
                                        [&](ShaderCall& call) {
                                          call.functions->trace_ray(call, &empty_scene(), ray_with(0), 0, 0, index,
                                                                    nullptr, 0);
                                        }},
                                   {.stage = ShaderStage::miss,
                                    .run =
                                        [&](ShaderCall& call) {
                                          ++calls[0];
                                          CHECK(call.t == 100);
                                          CHECK(call.hit == nullptr);
                                        }},
                                   {.stage = ShaderStage::miss, .run = [&](ShaderCall&) { ++calls[1]; }}},
                                  {});
  index = 0x10000;
  pipeline.trace({});
  CHECK(calls == std::array{1, 0});
  index = 0x70001;
  pipeline.trace({});
  CHECK(calls == std::array{1, 1});
  index = 0;
  rhi::TraceRaysDesc desc;
  desc.table = pipeline.device().create_shader_table(pipeline.table_desc({}));
  desc.first_miss_record = 1;
  pipeline.submit(desc);
  CHECK(calls == std::array{1, 2});
}

TEST_CASE("A null structure, an empty mask, and ends of t without a number between them are misses") {
  std::atomic<int> misses = 0;
  const ScriptedScene scene({triangle_at(1, true)});
  const auto misses_of = [&](const kernel::TopLevel* traced, const kernel::Ray& ray) {
    misses = 0;
    const ScriptedPipeline pipeline(
        {{.stage = ShaderStage::ray_generation,
          .run = [&](ShaderCall& call) { call.functions->trace_ray(call, traced, ray, 0, 0, 0, nullptr, 0); }},
         {.stage = ShaderStage::miss, .run = [&](ShaderCall&) { ++misses; }}},
        {{}});
    pipeline.trace({0});
    return misses.load();
  };
  kernel::Ray ray = ray_with(0);
  CHECK(misses_of(&scene, ray) == 0);
  CHECK(misses_of(nullptr, ray) == 1);
  ray.mask = 0x100;  // the mask has 8 bits
  CHECK(misses_of(&scene, ray) == 1);
  ray = ray_with(0);
  ray.t_min = 100;
  CHECK(misses_of(&scene, ray) == 1);
  ray.t_min = std::bit_cast<float>(0x7FC00000u);
  CHECK(misses_of(&scene, ray) == 1);
}

TEST_CASE("Records without a shader run nothing, and a shader reads zeros where its record ends") {
  std::array<std::byte, 16> seen;
  const ScriptedScene scene({triangle_at(1, true)});
  const ScriptedPipeline pipeline({{.stage = ShaderStage::ray_generation,
                                    .run =
                                        [&](ShaderCall& call) {
                                          CHECK(reinterpret_cast<std::uintptr_t>(call.shader_record) % 16 == 0);
                                          std::memcpy(seen.data(), call.shader_record, seen.size());
                                          call.functions->trace_ray(call, &scene, ray_with(0), 0, 0, 0, nullptr, 0);
                                          call.functions->trace_ray(call, nullptr, ray_with(0), 0, 0, 0, nullptr, 0);
                                          call.functions->execute_callable(call, 0, nullptr, 0);
                                        },
                                    .shader_record_size = 16},
                                   {.stage = ShaderStage::closest_hit, .run = [](ShaderCall&) { FAIL_CHECK("runs"); }},
                                   {.stage = ShaderStage::miss, .run = [](ShaderCall&) { FAIL_CHECK("runs"); }},
                                   {.stage = ShaderStage::callable, .run = [](ShaderCall&) { FAIL_CHECK("runs"); }}},
                                  {{.closest_hit = 1}});
  rhi::ShaderTableDesc desc = pipeline.table_desc({rhi::no_shader});
  desc.ray_generation.records[0].data = {std::byte{1}, std::byte{2}, std::byte{3}};
  desc.miss.records[0].shader = rhi::no_shader;
  desc.callable.records[0].shader = rhi::no_shader;
  pipeline.trace_table(pipeline.device().create_shader_table(desc));
  CHECK(seen[0] == std::byte{1});
  CHECK(seen[2] == std::byte{3});
  CHECK(std::all_of(seen.begin() + 3, seen.end(), [](std::byte byte) { return byte == std::byte{0}; }));
}

TEST_CASE("A record that the table does not have ends the submission in an error that names it") {
  const ScriptedScene scene({triangle_at(1, true)}, {0, (1u << 24) - 1});
  std::function<void(ShaderCall&)> script;
  const ScriptedPipeline pipeline(
      {{.stage = ShaderStage::ray_generation, .run = [&](ShaderCall& call) { script(call); }},
       {.stage = ShaderStage::miss, .run = [](ShaderCall&) { FAIL_CHECK("runs"); }},
       {.stage = ShaderStage::closest_hit, .run = [](ShaderCall&) { FAIL_CHECK("runs"); }},
       {.stage = ShaderStage::callable, .run = [](ShaderCall&) { FAIL_CHECK("runs"); }}},
      {{.closest_hit = 2}});
  script = [&](ShaderCall& call) { call.functions->trace_ray(call, &scene, ray_with(0), 3, 0, 0, nullptr, 0); };
  CHECK(message_of([&] {
          pipeline.trace({0, 0, 0}, {8, 8, 1});
        }) == "scripted: a ray asks for hit record 3 of the trace, beyond the 3 of the shader table 'table'");
  script = [&](ShaderCall& call) { call.functions->trace_ray(call, nullptr, ray_with(0), 0, 0, 1, nullptr, 0); };
  CHECK(contains(message_of([&] { pipeline.trace({0}); }), "miss record 1"));
  // The lowest index is named, whichever invocation comes first.
  script = [&](ShaderCall& call) { call.functions->execute_callable(call, 40 - call.launch_id[0], nullptr, 0); };
  CHECK(contains(message_of([&] { pipeline.trace({0}, {40, 1, 1}); }), "callable record 1 "));
}

TEST_CASE("A kind without records, and a first record behind the last, name no shader") {
  const ScriptedScene scene({triangle_at(1, true)});
  const ScriptedPipeline pipeline({{.stage = ShaderStage::ray_generation,
                                    .run =
                                        [&](ShaderCall& call) {
                                          call.functions->trace_ray(call, &scene, ray_with(0), 3, 0, 7, nullptr, 0);
                                          call.functions->trace_ray(call, nullptr, ray_with(0), 0, 0, 7, nullptr, 0);
                                          call.functions->execute_callable(call, 5, nullptr, 0);
                                        }},
                                   {.stage = ShaderStage::miss, .run = [](ShaderCall&) { FAIL_CHECK("runs"); }},
                                   {.stage = ShaderStage::closest_hit, .run = [](ShaderCall&) { FAIL_CHECK("runs"); }},
                                   {.stage = ShaderStage::callable, .run = [](ShaderCall&) { FAIL_CHECK("runs"); }}},
                                  {{.closest_hit = 2}});
  rhi::ShaderTableDesc table = pipeline.table_desc({0, 0});
  rhi::TraceRaysDesc behind;
  behind.table = pipeline.device().create_shader_table(table);
  behind.first_miss_record = 1;
  behind.first_hit_record = 2;
  behind.first_callable_record = 1;
  CHECK_NOTHROW(pipeline.submit(behind));
  table.miss = table.hit = table.callable = {};
  CHECK_NOTHROW(pipeline.trace_table(pipeline.device().create_shader_table(table)));
}

TEST_CASE("A shader whose payload is larger than the one it is given does not run, and is named") {
  std::uint32_t payload = 0;
  const ScriptedScene scene({triangle_at(1, true)});
  std::function<void(ShaderCall&)> script;
  const ScriptedPipeline pipeline(
      {{.stage = ShaderStage::ray_generation, .run = [&](ShaderCall& call) { script(call); }},
       {.stage = ShaderStage::miss, .run = [](ShaderCall&) { FAIL_CHECK("runs"); }, .payload_size = 8},
       {.stage = ShaderStage::callable, .run = [](ShaderCall&) { FAIL_CHECK("runs"); }, .payload_size = 5}},
      {{}});
  script = [&](ShaderCall& call) { trace(call, empty_scene(), ray_with(0), payload); };
  CHECK(contains(message_of([&] { pipeline.trace({0}); }), "'shader 1'"));
  script = [&](ShaderCall& call) { call.functions->execute_callable(call, 0, &payload, sizeof(payload)); };
  CHECK(contains(message_of([&] { pipeline.trace({0}); }), "'shader 2'"));
}

TEST_CASE("Rays recurse as deep as the pipeline says, each with its own payload; one deeper is an error") {
  constexpr std::uint32_t most = 31;
  std::uint32_t wanted = most;
  const ScriptedScene scene({triangle_at(1, true)});
  std::atomic<std::uint32_t> deepest = 0;
  const ScriptedPipeline pipeline({{.stage = ShaderStage::ray_generation,
                                    .run =
                                        [&](ShaderCall& call) {
                                          CHECK(call.depth == 0);
                                          std::uint32_t result = 0;
                                          trace(call, scene, ray_with(0), result);
                                          deepest = result;
                                        }},
                                   {.stage = ShaderStage::closest_hit,
                                    .run =
                                        [&](ShaderCall& call) {
                                          // Large shaders keep kilobytes on the stack.
                                          volatile std::uint32_t locals[16384];
                                          locals[call.depth] = call.depth;
                                          std::uint32_t result = locals[call.depth];
                                          if (call.depth < wanted) trace(call, scene, ray_with(0), result);
                                          *static_cast<std::uint32_t*>(call.payload) = result;
                                        },
                                    .payload_size = 4}},
                                  {{.closest_hit = 1}}, most, 4);
  CHECK(pipeline.device().info().limits.max_ray_recursion_depth == most);
  pipeline.trace({0}, {64, 64, 1});
  CHECK(deepest == most);
  wanted = most + 1;
  CHECK(contains(message_of([&] { pipeline.trace({0}); }), "max_recursion_depth of 31"));
}

TEST_CASE("Callable shaders read and write their caller's data, call each other, and not without end") {
  std::uint32_t wanted = 5;
  std::uint32_t calls = 0;
  const ScriptedPipeline pipeline({{.stage = ShaderStage::ray_generation,
                                    .run =
                                        [&](ShaderCall& call) {
                                          std::uint32_t data = 0;
                                          call.functions->execute_callable(call, 0, &data, sizeof(data));
                                          calls = data;
                                        }},
                                   {.stage = ShaderStage::callable,
                                    .run =
                                        [&](ShaderCall& call) {
                                          CHECK(call.ray == nullptr);
                                          auto& data = *static_cast<std::uint32_t*>(call.payload);
                                          if (++data < wanted)
                                            call.functions->execute_callable(call, 0, &data, sizeof(data));
                                        },
                                    .payload_size = 4}},
                                  {});
  pipeline.trace({});
  CHECK(calls == 5);
  wanted = ~0u;
  CHECK(contains(message_of([&] { pipeline.trace({}); }), "8 deep"));
}

}  // namespace tandem::cpu
