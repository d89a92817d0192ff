#include "rhi_cpu/device.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cfenv>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <set>
#include <thread>

#include "rhi/error.hpp"
#include "rhi/glsl/compile.hpp"
#include "tests/support/device_test.hpp"
#include "tests/support/environment_variable.hpp"
#include "tests/support/scratch_folder.hpp"

// What only the CPU device can be asked, on kernels that are C++ functions of this file: neither the translator nor a
// compiler has a part in it. What every device must do is tested in tests/rhi.
namespace tandem::cpu {
namespace {

using rhi::BufferUsage;
using test::EnvironmentVariable;

// Each workgroup writes element gl_WorkGroupID.x.
const std::vector<std::uint32_t>& store_spirv() {
  static const std::vector<std::uint32_t> words = glsl::compile(R"(#version 460
layout(local_size_x = 1) in;
layout(constant_id = 3) const uint factor = 5;
layout(set = 0, binding = 0) buffer Values { uint values[]; };
void main() { values[gl_WorkGroupID.x] = factor; })",
                                                                rhi::ShaderStage::compute, "store.comp");
  return words;
}

constexpr kernel::BindingSlot store_slot = {
    .set = 0, .binding = 0, .count = 1, .first_resource = 0, .kind = kernel::ResourceKind::storage_buffer};

/// A kernel for store_spirv() that calls `element` for each workgroup and stores what it gives.
template <std::uint32_t (*element)(std::uint64_t workgroup)>
const kernel::KernelInfo* store_entry() {
  static constexpr kernel::KernelInfo info = {
      .abi_version = kernel::abi_version,
      .workgroup_size = {1, 1, 1},
      .push_constant_size = 0,
      .resource_count = 1,
      .binding_count = 1,
      .bindings = &store_slot,
      .run = [](const kernel::Dispatch& dispatch, std::uint64_t first, std::uint64_t end) {
        auto* values = reinterpret_cast<std::uint32_t*>(dispatch.resources[0].data);
        for (std::uint64_t i = first; i < end; ++i) values[i] = element(i);
      }};
  return &info;
}

template <std::uint32_t (*element)(std::uint64_t workgroup)>
rhi::DeviceHandle device_of(const rhi::DeviceDesc& desc = {}) {
  return create_device(desc, {{.spirv = store_spirv(), .entry = store_entry<element>}});
}

rhi::ComputePipelineHandle store_pipeline(rhi::Device& device,
                                          const std::vector<rhi::SpecializationValue>& specialization = {}) {
  return device.create_compute_pipeline(
      {.shader = device.create_shader_module({.spirv = store_spirv(), .label = "store.comp"}),
       .specialization = specialization,
       .label = "store"});
}

/// Dispatches `count` workgroups of the pipeline and gives what they have stored.
std::vector<std::uint32_t> run_store(rhi::Device& device, const rhi::ComputePipelineHandle& pipeline,
                                     std::uint32_t count) {
  const rhi::BufferHandle buffer = test::buffer_of(device, std::vector<std::uint32_t>(count, 0xDEADBEEF), "values");
  const rhi::BindGroupHandle group =
      device.create_bind_group({.pipeline = pipeline,
                                .set = 0,
                                .entries = {{.binding = 0, .resource = rhi::BufferRange{buffer}}},
                                .label = "g"});
  const rhi::CommandListHandle list = device.create_command_list("run");
  list->dispatch({.pipeline = pipeline, .bind_groups = {group}, .workgroup_count = {count, 1, 1}});
  device.submit(list);
  return test::contents<std::uint32_t>(device, buffer, count);
}

std::uint32_t square(std::uint64_t i) { return static_cast<std::uint32_t>(i * i); }

/// The code and the text of the Error that `call` throws.
template <typename Call>
rhi::Error error_of(const Call& call) {
  try {
    call();
  } catch (const rhi::Error& error) {
    return error;
  }
  FAIL("nothing was thrown");
  throw;
}

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

rhi::TopLevelDesc top_level_desc(rhi::Device& device, std::uint64_t blas_address) {
  rhi::InstanceDesc instance{};
  for (int i = 0; i < 3; ++i) instance.object_to_world[i][i] = 1;
  instance.mask = 0xFF;
  instance.blas_address = blas_address;
  return {.instances = {test::buffer_of(device, std::vector{instance}, "instances")},
          .instance_count = 1,
          .label = "scene"};
}

rhi::BottomLevelDesc triangle_desc(rhi::Device& device) {
  const std::vector<float> vertices = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  return {.geometries = {rhi::TriangleGeometry{.vertices = {test::buffer_of(device, vertices, "vertices")},
                                               .vertex_count = 3,
                                               .indices = {},
                                               .triangle_count = 1,
                                               .transform = {}}},
          .label = "triangle"};
}

}  // namespace

TEST_CASE("The devices say what they are") {
  for (const std::string_view name : device_names()) {
    const rhi::DeviceInfo info = device_info(name);
    CHECK(info.name == name);
    CHECK(info.backend == "cpu");
    CHECK(info.kind == rhi::DeviceKind::cpu);
    CHECK(info.driver.starts_with("Embree ") == (name == "cpu"));
    CHECK_FALSE(info.description.empty());
    CHECK(info.capabilities.ray_query);
    CHECK(info.capabilities.ray_tracing_pipeline);
    CHECK(create_device({.name = std::string(name)}, {})->info().name == name);
  }
  CHECK(error_of([] { create_device({.name = "cpu-slow"}, {}); }).code() == rhi::ErrorCode::no_such_device);
}

TEST_CASE("Every workgroup runs exactly once, whatever the number of threads and workgroups") {
  for (const std::uint32_t thread_count : {1u, 2u, 3u, 8u}) {
    const rhi::DeviceHandle device = device_of<square>({.thread_count = thread_count});
    const rhi::ComputePipelineHandle pipeline = store_pipeline(*device);
    for (const std::uint32_t count : {1u, 2u, 63u, 64u, 1000u, 65537u}) {
      CAPTURE(thread_count);
      CAPTURE(count);
      const std::vector<std::uint32_t> values = run_store(*device, pipeline, count);
      std::uint32_t wrong = 0;
      for (std::uint32_t i = 0; i < count; ++i) wrong += values[i] != square(i);
      CHECK(wrong == 0);
    }
  }
}

std::mutex seen_mutex;
std::condition_variable seen_changed;
std::set<std::thread::id> seen_threads;
std::size_t wanted_threads = 0;
/// Waits until as many threads as are wanted have come, however late a loaded machine lets them.
std::uint32_t note_thread(std::uint64_t) {
  std::unique_lock lock(seen_mutex);
  seen_threads.insert(std::this_thread::get_id());
  seen_changed.notify_all();
  if (!seen_changed.wait_for(lock, std::chrono::seconds(60), [] { return seen_threads.size() >= wanted_threads; }))
    wanted_threads = 0;  // the others need not wait, too
  return 0;
}

TEST_CASE("The device uses the threads it was given, and no more") {
  for (const std::uint32_t thread_count : {1u, 4u}) {
    const rhi::DeviceHandle device = device_of<note_thread>({.thread_count = thread_count});
    seen_threads.clear();
    wanted_threads = thread_count;
    run_store(*device, store_pipeline(*device), 400);
    CHECK(seen_threads.size() == thread_count);
  }
}

TEST_CASE("An absurd thread count is an error, not thousands of threads") {
  CHECK_THROWS_AS(device_of<square>({.thread_count = 1u << 30}), rhi::Error);
}

std::uint32_t minus_a_third(std::uint64_t) {
  volatile float minus_one = -1.0f;
  volatile float three = 3.0f;
  return std::bit_cast<std::uint32_t>(minus_one / three);
}

TEST_CASE("The host's rounding mode does not reach kernels, and is the host's again afterwards") {
  const rhi::DeviceHandle device = device_of<minus_a_third>();
  const rhi::ComputePipelineHandle pipeline = store_pipeline(*device);
  REQUIRE(std::fesetround(FE_UPWARD) == 0);
  const std::vector<std::uint32_t> values = run_store(*device, pipeline, 1000);
  const int mode = std::fegetround();
  std::fesetround(FE_TONEAREST);
  CHECK(mode == FE_UPWARD);
  // -1/3 to nearest; rounded upwards it would be 0xbeaaaaaa.
  CHECK(std::all_of(values.begin(), values.end(), [](std::uint32_t value) { return value == 0xbeaaaaab; }));
}

TEST_CASE("A precompiled kernel needs no compiler and no cache folder") {
  const EnvironmentVariable no_compiler("TANDEM_CXX", "/nonexistent");
  const test::ScratchFolder folder;
  const rhi::DeviceHandle device = device_of<square>({.kernel_cache = folder.path() / "cache"});
  CHECK(run_store(*device, store_pipeline(*device), 3) == std::vector<std::uint32_t>{0, 1, 4});
  CHECK(run_store(*device, store_pipeline(*device, {{.id = 3, .value = 5}}), 3)[2] == 4);  // 5 is the default
  CHECK_FALSE(std::filesystem::exists(folder.path() / "cache"));

  const rhi::Error error = error_of([&] { store_pipeline(*device, {{.id = 3, .value = 6}}); });
  CHECK(error.code() == rhi::ErrorCode::shader_compilation);
  CHECK(error.label() == "store");
  CHECK(contains(error.what(), "/nonexistent"));
}

TEST_CASE("A list executes whenever it is submitted, and takes no commands afterwards") {
  const rhi::DeviceHandle device = device_of<square>();
  const rhi::BufferHandle buffer = test::buffer_of(*device, std::vector<std::uint32_t>{1, 2, 3}, "values");
  const rhi::CommandListHandle list = device->create_command_list("late");
  list->fill({buffer}, 7);
  CHECK(test::contents<std::uint32_t>(*device, buffer, 3) == std::vector<std::uint32_t>{1, 2, 3});
  CHECK(device->submit(list)->wait_for(std::chrono::nanoseconds(0)));
  CHECK(test::contents<std::uint32_t>(*device, buffer, 3) == std::vector<std::uint32_t>{7, 7, 7});
  CHECK(contains(error_of([&] { list->fill({buffer}, 8); }).what(), "late"));
}

TEST_CASE("A list keeps what it names as long as it lives") {
  const rhi::DeviceHandle device = device_of<square>();
  rhi::BufferHandle buffer = test::buffer_of(*device, std::vector<std::uint32_t>{1}, "values");
  const std::weak_ptr<rhi::Buffer> watched = buffer;
  rhi::CommandListHandle list = device->create_command_list("list");
  list->fill({buffer}, 7);
  buffer = nullptr;
  device->submit(list);
  CHECK_FALSE(watched.expired());
  device->submit(list);
  list = nullptr;
  CHECK(watched.expired());
}

TEST_CASE("Objects outlive their device") {
  rhi::DeviceHandle device = device_of<square>();
  const rhi::BufferHandle buffer = test::buffer_of(*device, std::vector<std::uint32_t>{1}, "values");
  const rhi::ComputePipelineHandle pipeline = store_pipeline(*device);
  const rhi::AccelerationStructureHandle structure = device->create_bottom_level(triangle_desc(*device));
  const rhi::CommandListHandle list = device->create_command_list("list");
  device = nullptr;
  list->fill({buffer}, 7);
  CHECK(structure->device_address() != 0);
  CHECK(pipeline->label() == "store");
}

TEST_CASE("Objects of another device are refused wherever they are given") {
  const rhi::DeviceHandle device = device_of<square>();
  const rhi::DeviceHandle other = device_of<square>();
  const rhi::BufferHandle foreign = test::buffer_of(*other, std::vector<std::uint32_t>{1, 2}, "foreign");
  const rhi::BufferHandle buffer = test::buffer_of(*device, std::vector<std::uint32_t>{1, 2}, "values");
  const rhi::ComputePipelineHandle pipeline = store_pipeline(*device);
  const rhi::CommandListHandle list = device->create_command_list("list");
  const auto is_refused = [](const auto& call) {
    const rhi::Error error = error_of(call);
    CHECK(error.code() == rhi::ErrorCode::invalid_argument);
    CHECK(contains(error.what(), "another device"));
  };
  is_refused([&] { list->upload(foreign, 0, {}); });
  is_refused([&] { list->fill({foreign}, 0); });
  is_refused([&] { list->copy({foreign}, {buffer}); });
  is_refused([&] { list->copy({buffer}, {foreign}); });
  is_refused([&] { device->submit(other->create_command_list("foreign")); });
  is_refused([&] {
    std::array<std::byte, 4> bytes;
    device->download(foreign, 0, bytes);
  });
  is_refused([&] { device->create_bottom_level(triangle_desc(*other)); });
  is_refused([&] { device->create_top_level(top_level_desc(*other, 0)); });
  is_refused([&] {
    device->create_bind_group({.pipeline = pipeline,
                               .set = 0,
                               .entries = {{.binding = 0, .resource = rhi::BufferRange{foreign}}},
                               .label = ""});
  });
  is_refused([&] { list->write_timestamp(other->create_query_pool({.count = 1, .label = "times"}), 0); });
  is_refused([&] {
    list->dispatch(
        {.pipeline = store_pipeline(*other),
         .bind_groups = {other->create_bind_group({.pipeline = store_pipeline(*other),
                                                   .set = 0,
                                                   .entries = {{.binding = 0, .resource = rhi::BufferRange{foreign}}},
                                                   .label = ""})}});
  });
}

TEST_CASE("An instance that names no built bottom level is an error that says which") {
  const rhi::DeviceHandle device = device_of<square>();
  rhi::AccelerationStructureHandle bottom = device->create_bottom_level(triangle_desc(*device));
  const std::uint64_t address = bottom->device_address();
  const auto build = [&](std::uint64_t named) {
    const rhi::TopLevelDesc desc = top_level_desc(*device, named);
    const rhi::AccelerationStructureHandle top = device->create_top_level(desc);
    const rhi::CommandListHandle list = device->create_command_list("build");
    list->build_top_level(top, desc);
    device->submit(list);
  };
  CHECK_NOTHROW(build(0));
  CHECK(contains(error_of([&] { build(address + 1); }).what(), "instance 0"));
  CHECK(contains(error_of([&] { build(address); }).what(), "not built"));

  rhi::CommandListHandle list = device->create_command_list("build");
  list->build_bottom_level(bottom, triangle_desc(*device));
  device->submit(list);
  list = nullptr;
  CHECK_NOTHROW(build(address));
  bottom = nullptr;
  CHECK(error_of([&] { build(address); }).label() == "scene");
}

TEST_CASE("Addresses of bottom levels are never used again") {
  const rhi::DeviceHandle device = device_of<square>();
  std::set<std::uint64_t> addresses;
  for (int i = 0; i < 100; ++i) addresses.insert(device->create_bottom_level(triangle_desc(*device))->device_address());
  CHECK(addresses.size() == 100);
  CHECK_FALSE(addresses.contains(0));
}

TEST_CASE("A created bottom level keeps no buffer of vertices alive") {
  const rhi::DeviceHandle device = device_of<square>();
  rhi::BottomLevelDesc desc = triangle_desc(*device);
  const std::weak_ptr<rhi::Buffer> vertices = std::get<rhi::TriangleGeometry>(desc.geometries[0]).vertices.buffer;
  const rhi::AccelerationStructureHandle structure = device->create_bottom_level(desc);
  desc = {};
  CHECK(vertices.expired());
}

TEST_CASE("Buffers begin at a cache line; one that no machine can hold is an error") {
  const rhi::DeviceHandle device = device_of<square>();
  for (const std::uint64_t size : {1, 3, 64, 1000}) {
    const rhi::BufferHandle buffer =
        device->create_buffer({.size = size, .usage = BufferUsage::device_address, .label = "b"});
    CHECK(buffer->device_address() % 64 == 0);
  }
  const rhi::Error error = error_of(
      [&] { device->create_buffer({.size = std::uint64_t{1} << 62, .usage = BufferUsage::storage, .label = "huge"}); });
  CHECK(error.code() == rhi::ErrorCode::out_of_memory);
  CHECK(error.label() == "huge");
}

TEST_CASE("Several threads may submit at once") {
  const rhi::DeviceHandle device = device_of<square>();
  const rhi::ComputePipelineHandle pipeline = store_pipeline(*device);
  std::atomic<int> right = 0;
  std::vector<std::jthread> threads;
  for (int i = 0; i < 4; ++i)
    threads.emplace_back([&] {
      for (int j = 0; j < 20; ++j) right += run_store(*device, pipeline, 100)[99] == 99 * 99;
    });
  threads.clear();
  CHECK(right == 80);
}

}  // namespace tandem::cpu
