#include <doctest/doctest.h>

#include <chrono>
#include <thread>

#include "tests/rhi/dispatch.hpp"

using namespace tandem;
using test::contents;

namespace {

/// Adds 1 to each element `rounds` times, slowly enough to be timed.
const std::string add_source = R"(#version 460
layout(local_size_x = 64) in;
layout(set = 0, binding = 0) buffer Values { uint values[]; };
layout(push_constant) uniform Constants { uint rounds; };
void main() {
  uint value = values[gl_GlobalInvocationID.x];
  for (uint i = 0; i < rounds; ++i) value = value * 1664525u + 1013904223u;
  values[gl_GlobalInvocationID.x] = value;
}
)";

std::uint32_t after(std::uint32_t value, std::uint32_t rounds) {
  for (std::uint32_t i = 0; i < rounds; ++i) value = value * 1664525u + 1013904223u;
  return value;
}

}  // namespace

TANDEM_DEVICE_TEST("a list may be submitted again, but not added to") {
  const rhi::BufferHandle buffer = test::buffer_of(device, std::vector<std::uint32_t>(4), "buffer");
  const rhi::CommandListHandle list = device.create_command_list("again");
  list->fill({buffer}, 1);
  device.submit(list)->wait();
  CHECK_ERROR(invalid_argument, "again: a command is recorded after", list->fill({buffer}, 2));
  const rhi::CommandListHandle other = device.create_command_list("other");
  other->fill({buffer}, 3);
  device.submit(other);
  CHECK(contents<std::uint32_t>(device, buffer, 4) == std::vector<std::uint32_t>(4, 3));
  device.submit(list);
  device.submit(list);
  CHECK(contents<std::uint32_t>(device, buffer, 4) == std::vector<std::uint32_t>(4, 1));
  CHECK_ERROR(invalid_argument, "", device.submit(nullptr));
}

TANDEM_DEVICE_TEST("an empty list and one never submitted do no harm") {
  const rhi::BufferHandle buffer = test::buffer_of(device, std::vector<std::uint32_t>(4, 7), "buffer");
  device.create_command_list("never submitted")->fill({buffer}, 1);
  device.submit(device.create_command_list("empty"))->wait();
  CHECK(contents<std::uint32_t>(device, buffer, 4) == std::vector<std::uint32_t>(4, 7));
}

TANDEM_DEVICE_TEST("fences are signalled and stay so") {
  const rhi::FenceHandle fence = device.submit(device.create_command_list("empty"));
  fence->wait();
  CHECK(fence->wait_for(std::chrono::nanoseconds(0)));
  CHECK(fence->wait_for(std::chrono::seconds(-1)));
  device.wait_idle();
  fence->wait();
}

TANDEM_DEVICE_TEST("dispatches see what commands before them wrote, within a list and across lists") {
  constexpr std::uint32_t count = 1 << 14;
  const rhi::ComputePipelineHandle pipeline = test::compute_pipeline(device, add_source, "add");
  const rhi::BufferHandle values = test::buffer_of(device, std::vector<std::uint32_t>(count), "values");
  const rhi::BindGroupHandle group = device.create_bind_group(
      {.pipeline = pipeline, .entries = {{.binding = 0, .resource = rhi::BufferRange{values}}}, .label = "values"});
  const std::uint32_t rounds = 3;
  for (int list_index = 0; list_index < 2; ++list_index) {
    const rhi::CommandListHandle list = device.create_command_list("chain");
    if (list_index == 0) list->fill({values}, 5);
    for (int i = 0; i < 10; ++i)
      list->dispatch({.pipeline = pipeline,
                      .bind_groups = {group},
                      .push_constants = std::as_bytes(std::span(&rounds, 1)),
                      .workgroup_count = {count / 64, 1, 1}});
    device.submit(list);
  }
  CHECK(contents<std::uint32_t>(device, values, count) == std::vector<std::uint32_t>(count, after(5, 60)));
}

TANDEM_DEVICE_TEST("timestamps enclose the work between them") {
  REQUIRE(device.info().capabilities.timestamps);
  constexpr std::uint32_t count = 1 << 16;
  const rhi::ComputePipelineHandle pipeline = test::compute_pipeline(device, add_source, "timed");
  const rhi::BufferHandle values = test::buffer_of(device, std::vector<std::uint32_t>(count), "values");
  const rhi::BindGroupHandle group = device.create_bind_group(
      {.pipeline = pipeline, .entries = {{.binding = 0, .resource = rhi::BufferRange{values}}}, .label = "values"});
  const rhi::QueryPoolHandle pool = device.create_query_pool({.count = 3, .label = "times"});
  CHECK_ERROR(invalid_argument, "times: ", pool->timestamps_ns());

  const auto before = std::chrono::steady_clock::now();
  const rhi::CommandListHandle list = device.create_command_list("timed");
  const auto work = [&](std::uint32_t rounds) {
    list->dispatch({.pipeline = pipeline,
                    .bind_groups = {group},
                    .push_constants = std::as_bytes(std::span(&rounds, 1)),
                    .workgroup_count = {count / 64, 1, 1}});
  };
  work(1);  // compiles and warms up
  list->write_timestamp(pool, 0);
  work(20);
  list->write_timestamp(pool, 1);
  work(20000);
  list->write_timestamp(pool, 2);
  device.submit(list)->wait();
  const std::chrono::duration<double, std::nano> wall = std::chrono::steady_clock::now() - before;

  const std::vector<double> times = pool->timestamps_ns();
  REQUIRE(times.size() == 3);
  CHECK(times[1] >= times[0]);
  CHECK(times[2] - times[0] <= wall.count());
  // The unit: 1.3e9 dependent multiply-adds do not fit into a microsecond on anything.
  CHECK(times[2] - times[1] > 1000);
}

TANDEM_DEVICE_TEST("queries may be written again, and out of range they are errors") {
  REQUIRE(device.info().capabilities.timestamps);
  const rhi::QueryPoolHandle pool = device.create_query_pool({.count = 1, .label = "again"});
  double last = 0;
  for (int i = 0; i < 2; ++i) {
    const rhi::CommandListHandle list = device.create_command_list("stamp");
    list->write_timestamp(pool, 0);
    device.submit(list)->wait();
    const double now = pool->timestamps_ns().at(0);
    if (i > 0) CHECK(now > last);
    last = now;
  }
  const rhi::CommandListHandle list = device.create_command_list("stamp");
  CHECK_ERROR(invalid_argument, "again: ", list->write_timestamp(pool, 1));
  CHECK_ERROR(invalid_argument, "stamp: ", list->write_timestamp(nullptr, 0));
  CHECK_ERROR(invalid_argument, "none: ", device.create_query_pool({.count = 0, .label = "none"}));
}

TANDEM_DEVICE_TEST("threads may create, record and submit at once") {
  const rhi::ComputePipelineHandle pipeline = test::compute_pipeline(device, add_source, "shared");
  constexpr std::uint32_t count = 1024;
  std::vector<std::vector<std::uint32_t>> results(4);
  {
    std::vector<std::jthread> threads;
    for (std::uint32_t thread = 0; thread < results.size(); ++thread)
      threads.emplace_back([&, thread] {
        for (std::uint32_t round = 0; round < 10; ++round) {
          const std::vector<std::uint32_t> start(count, thread * 100 + round);
          const rhi::BufferHandle values = test::buffer_of(device, start, "values");
          const std::uint32_t rounds = 7;
          test::run(device, pipeline, {values}, count / 64, std::as_bytes(std::span(&rounds, 1)));
          results[thread] = contents<std::uint32_t>(device, values, count);
        }
      });
  }
  for (std::uint32_t thread = 0; thread < results.size(); ++thread)
    CHECK(results[thread] == std::vector<std::uint32_t>(count, after(thread * 100 + 9, 7)));
}
