#include "rhi_cpu/cache/kernel_store.hpp"

#include <doctest/doctest.h>

#include <fstream>
#include <thread>

#include "rhi_cpu/cache/kernel_compiler.hpp"
#include "rhi_cpu/cache/process.hpp"
#include "rhi_cpu/device.hpp"
#include "tests/support/device_test.hpp"
#include "tests/support/environment_variable.hpp"
#include "tests/support/messages.hpp"
#include "tests/support/scratch_folder.hpp"

// Shaders that the program does not know: translated, compiled by the system's compiler and cached.
namespace tandem::cpu {
namespace {

namespace fs = std::filesystem;
using rhi::Severity;
using test::EnvironmentVariable;
using test::Messages;
using test::ScratchFolder;

constexpr const char* glow = R"(#version 460
layout(local_size_x = 4, local_size_y = 2) in;
layout(constant_id = 7) const uint scale = 3;
layout(set = 0, binding = 0) buffer Values { uint values[]; };
void main() {
  uint width = gl_NumWorkGroups.x * gl_WorkGroupSize.x;
  uint i = gl_GlobalInvocationID.y * width + gl_GlobalInvocationID.x;
  uint state = i;
  for (int step = 0; step < 100; ++step) state = state * 747796405u + 2891336453u;
  values[i] = state * scale;
})";

std::uint32_t glow_value(std::uint32_t i, std::uint32_t scale) {
  std::uint32_t state = i;
  for (int step = 0; step < 100; ++step) state = state * 747796405u + 2891336453u;
  return state * scale;
}

constexpr std::uint32_t glow_invocations = 5 * 4 * 3 * 2;

/// Dispatches 5x3 workgroups of the shader.
std::vector<std::uint32_t> run_glow(rhi::Device& device, const rhi::ComputePipelineHandle& pipeline) {
  const rhi::BufferHandle buffer = test::buffer_of(device, std::vector<std::uint32_t>(glow_invocations), "values");
  const rhi::BindGroupHandle group =
      device.create_bind_group({.pipeline = pipeline,
                                .set = 0,
                                .entries = {{.binding = 0, .resource = rhi::BufferRange{buffer}}},
                                .label = "g"});
  const rhi::CommandListHandle list = device.create_command_list("run");
  list->dispatch({.pipeline = pipeline, .bind_groups = {group}, .workgroup_count = {5, 3, 1}});
  device.submit(list);
  return test::contents<std::uint32_t>(device, buffer, glow_invocations);
}

std::vector<std::uint32_t> glow_values(std::uint32_t scale) {
  std::vector<std::uint32_t> values;
  for (std::uint32_t i = 0; i < glow_invocations; ++i) values.push_back(glow_value(i, scale));
  return values;
}

rhi::DeviceHandle device_with(const fs::path& cache, Messages& messages) {
  return create_device({.on_message = messages.callback(), .kernel_cache = cache}, {});
}

std::size_t file_count(const fs::path& folder) {
  return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

fs::path only_file(const fs::path& folder) {
  REQUIRE(file_count(folder) == 1);
  return fs::directory_iterator(folder)->path();
}

}  // namespace

TEST_CASE("A shader is compiled the first time, loaded by later devices, and shared while it is in use") {
  const ScratchFolder cache;
  Messages first;
  const rhi::DeviceHandle device = device_with(cache.path(), first);
  const rhi::ComputePipelineHandle pipeline = test::compute_pipeline(*device, glow, "glow");
  CHECK(first.count(Severity::info, "glow: compiled") == 1);
  CHECK(run_glow(*device, pipeline) == glow_values(3));
  test::compute_pipeline(*device, glow, "glow again");
  CHECK(first.count(Severity::info, "glow again") == 0);

  Messages second;
  const rhi::DeviceHandle later = device_with(cache.path(), second);
  CHECK(run_glow(*later, test::compute_pipeline(*later, glow, "glow")) == glow_values(3));
  CHECK(second.count(Severity::info, "glow: loaded") == 1);
  CHECK(second.count(Severity::info, "compiled") == 0);
}

TEST_CASE("Each specialisation is a kernel of its own; a default that is spelled out is not") {
  const ScratchFolder cache;
  Messages messages;
  const rhi::DeviceHandle device = device_with(cache.path(), messages);
  const auto run = [&](std::vector<rhi::SpecializationValue> values) {
    return run_glow(*device, test::compute_pipeline(*device, glow, "glow", std::move(values)));
  };
  CHECK(run({}) == glow_values(3));
  CHECK(run({{.id = 7, .value = 3}}) == glow_values(3));
  CHECK(messages.count(Severity::info, "compiled") == 1);
  CHECK(run({{.id = 7, .value = 4}}) == glow_values(4));
  CHECK(messages.count(Severity::info, "compiled") == 2);
  CHECK(run({{.id = 7, .value = 4}}) == glow_values(4));
  CHECK(messages.count(Severity::info, "compiled") == 2);
}

TEST_CASE("Headers are precompiled for the second kernel of a cache, and made anew when they are damaged") {
  const ScratchFolder cache;
  Messages messages;
  const rhi::DeviceHandle device = device_with(cache.path(), messages);
  if (!precompiles_headers(find_kernel_compiler("glow"))) return;
  const auto run = [&](std::uint32_t scale) {
    return run_glow(*device, test::compute_pipeline(*device, glow, "glow", {{.id = 7, .value = scale}}));
  };
  const auto headers = [&] {
    std::vector<fs::path> found;
    for (const fs::directory_entry& item : fs::directory_iterator(cache.path()))
      if (item.path().filename().string().starts_with("headers-")) found.push_back(item.path());
    return found;
  };
  CHECK(run(4) == glow_values(4));
  CHECK(headers().empty());
  CHECK(run(5) == glow_values(5));
  REQUIRE(headers().size() == 1);
  const fs::path header = headers()[0] / precompiled_kernel_header(native_lanes());
  const auto size = fs::file_size(header);
  fs::resize_file(header, size / 2);
  CHECK(run(6) == glow_values(6));
  CHECK(run(7) == glow_values(7));
  REQUIRE(headers().size() == 1);
  CHECK(fs::file_size(headers()[0] / precompiled_kernel_header(native_lanes())) > size / 2);
}

TEST_CASE("A damaged kernel in the cache is compiled anew") {
  const ScratchFolder cache;
  Messages messages;
  test::compute_pipeline(*device_with(cache.path(), messages), glow, "glow");
  const fs::path file = only_file(cache.path());
  fs::resize_file(file, fs::file_size(file) / 2);
  const rhi::DeviceHandle device = device_with(cache.path(), messages);
  CHECK(run_glow(*device, test::compute_pipeline(*device, glow, "glow")) == glow_values(3));
  CHECK(messages.count(Severity::info, "glow: compiled") == 2);
}

TEST_CASE("Large kernels may be left without optimisation, and compute the same") {
  const EnvironmentVariable compiler("TANDEM_CXX", "");
  std::string large = R"(#version 460
layout(set = 0, binding = 0) buffer Values { uint values[]; };
void main() {
  uint i = gl_GlobalInvocationID.x + 5 * gl_GlobalInvocationID.y;
  float x = float(i) * 0.37;
)";
  // Some 50 words of SPIR-V for each.
  for (int line = 0; line < 400; ++line) large += "  x = fract(sin(x) * 43.5453) * sqrt(x + 1.0) + 0.125;\n";
  large += "  values[i] = floatBitsToUint(x);\n}\n";
  const ScratchFolder cache;
  const auto values = [&](const char* text, bool quick) {
    Messages messages;
    const rhi::DeviceHandle device = create_device(
        {.name = "cpu-scalar", .on_message = messages.callback(), .quick_kernels = quick, .kernel_cache = cache.path()},
        {});
    return run_glow(*device, test::compute_pipeline(*device, text, "large"));
  };
  const std::vector<std::uint32_t> quick = values(large.c_str(), true);
  CHECK(quick == values(large.c_str(), false));
  const auto kernels = [&] {
    return std::ranges::count_if(fs::directory_iterator(cache.path()),
                                 [](const auto& file) { return file.path().extension() == ".so"; });
  };
  CHECK(kernels() == 2);
  // A small kernel is the same one on both devices.
  CHECK(values(glow, true) == values(glow, false));
  CHECK(kernels() == 3);
}

TEST_CASE("Another compiler, another kernel") {
  const ScratchFolder cache;
  const ScratchFolder tools;
  // The same compiler under another name stands for another one.
  const fs::path alias = tools.path() / "my-c++";
  fs::create_symlink(find_kernel_compiler("test").path, alias);
  Messages messages;
  test::compute_pipeline(*device_with(cache.path(), messages), glow, "glow");
  const EnvironmentVariable chosen("TANDEM_CXX", alias.string());
  test::compute_pipeline(*device_with(cache.path(), messages), glow, "glow");
  CHECK(messages.count(Severity::info, "glow: compiled") == 2);
  CHECK(file_count(cache.path()) == (precompiles_headers(find_kernel_compiler("test")) ? 3 : 2));
}

TEST_CASE("Without a compiler a shader that needs one is an error that names it") {
  const ScratchFolder cache;
  Messages messages;
  const EnvironmentVariable chosen("TANDEM_CXX", "/nonexistent");
  const rhi::DeviceHandle device = device_with(cache.path(), messages);
  try {
    test::compute_pipeline(*device, glow, "glow");
    FAIL("nothing was thrown");
  } catch (const rhi::Error& error) {
    CHECK(error.code() == rhi::ErrorCode::shader_compilation);
    CHECK(error.label() == "glow");
  }
}

TEST_CASE("A compiler that fails is an error that says where its log is") {
  const ScratchFolder cache;
  const ScratchFolder tools;
  const fs::path compiler = tools.path() / "c++";
  std::ofstream(compiler) << "#!/bin/sh\n[ \"$1\" = --version ] && echo broken 1.0 && exit 0\n"
                             "echo 'kernel.cpp:1: error: out of order' >&2\nexit 1\n";
  fs::permissions(compiler, fs::perms::owner_all);
  const EnvironmentVariable chosen("TANDEM_CXX", compiler.string());
  Messages messages;
  const rhi::DeviceHandle device = device_with(cache.path(), messages);
  try {
    test::compute_pipeline(*device, glow, "glow");
    FAIL("nothing was thrown");
  } catch (const rhi::Error& error) {
    const std::string text = error.what();
    CHECK(error.code() == rhi::ErrorCode::shader_compilation);
    CHECK(text.starts_with("glow: "));
    CHECK(text.find("out of order") != std::string::npos);
    const fs::path kept = only_file(cache.path());
    CHECK(text.find(kept.string()) != std::string::npos);
    CHECK(fs::exists(kept / "compiler.log"));
    CHECK(fs::exists(kept / "kernel.cpp"));
  }
}

TEST_CASE("A cache folder that cannot be written is a warning, and shaders run all the same") {
  Messages messages;
  const rhi::DeviceHandle device = device_with("/proc/tandem", messages);
  CHECK(run_glow(*device, test::compute_pipeline(*device, glow, "glow")) == glow_values(3));
  CHECK(messages.count(Severity::warning, "/proc/tandem") == 1);
}

TEST_CASE("A shader that several threads ask for at once is compiled once") {
  const ScratchFolder cache;
  Messages messages;
  const rhi::DeviceHandle device = device_with(cache.path(), messages);
  std::vector<rhi::ComputePipelineHandle> pipelines(6);
  std::vector<std::jthread> threads;
  for (rhi::ComputePipelineHandle& pipeline : pipelines)
    threads.emplace_back([&] { pipeline = test::compute_pipeline(*device, glow, "glow"); });
  threads.clear();
  CHECK(messages.count(Severity::info, "compiled") == 1);
  for (const rhi::ComputePipelineHandle& pipeline : pipelines) CHECK(run_glow(*device, pipeline) == glow_values(3));
}

// Run by the case below, as a process of its own.
TEST_CASE("one of many processes" * doctest::skip()) {
  const char* cache = std::getenv("TANDEM_TEST_SHARED_CACHE");
  REQUIRE(cache != nullptr);
  Messages messages;
  const rhi::DeviceHandle device = device_with(cache, messages);
  CHECK(run_glow(*device, test::compute_pipeline(*device, glow, "glow")) == glow_values(3));
  CHECK(messages.count(Severity::warning, "") == 0);
}

TEST_CASE("Many processes may fill an empty cache at once") {
  const ScratchFolder cache;
  const EnvironmentVariable shared("TANDEM_TEST_SHARED_CACHE", cache.path().string());
  const std::string self = fs::read_symlink("/proc/self/exe").string();
  std::vector<std::optional<ProcessResult>> results(6);
  {
    std::vector<std::jthread> threads;
    for (std::optional<ProcessResult>& result : results)
      threads.emplace_back([&] { result = run_process({self, "--no-skip", "--test-case=one of many processes"}); });
  }
  for (const std::optional<ProcessResult>& result : results) {
    REQUIRE(result);
    CHECK_MESSAGE(result->exit_code == 0, result->output);
    CHECK(result->output.find("1 passed") != std::string::npos);
  }
  // One kernel, and no work folder left behind.
  CHECK(only_file(cache.path()).extension() == ".so");
}

TEST_CASE("What a shader writes does not depend on the number of threads") {
  const ScratchFolder cache;
  for (const std::uint32_t thread_count : {1u, 2u, 3u, 8u}) {
    CAPTURE(thread_count);
    const rhi::DeviceHandle device = create_device({.thread_count = thread_count, .kernel_cache = cache.path()}, {});
    CHECK(run_glow(*device, test::compute_pipeline(*device, glow, "glow")) == glow_values(3));
  }
}

}  // namespace tandem::cpu
