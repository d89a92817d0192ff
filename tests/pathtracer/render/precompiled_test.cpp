// What the path tracer asks the CPU for is linked into the program: no compiler is needed, and no time for it.

#include <doctest/doctest.h>

#include <set>

#include "devices/devices.hpp"
#include "pathtracer/render/features.hpp"
#include "pathtracer/render/path_trace_program.hpp"
#include "shaders/spirv.hpp"
#include "tests/support/environment_variable.hpp"
#include "tests/support/scratch_folder.hpp"

using namespace tandem;
using namespace tandem::pathtracer;

namespace {

std::set<Features> all_built_features() {
  std::set<Features> sets;
  for (Features needed = 0; needed <= feature::all; ++needed) sets.insert(built_features(needed));
  return sets;
}

}  // namespace

TEST_CASE("The shaders are precompiled for all tasks and sets of features that are built") {
  // Neither a compiler nor what one may have left in the cache.
  const test::EnvironmentVariable compiler("TANDEM_CXX", "/nonexistent");
  const test::ScratchFolder cache;
  const rhi::DeviceHandle device = create_device({.name = "cpu", .kernel_cache = cache.path()});
  const std::set<Features> sets = all_built_features();
  CHECK(sets.size() == 5);
  for (const Features features : sets) {
    for (const TracingMode mode : {TracingMode::query, TracingMode::pipeline}) {
      for (const PathTraceTask task :
           {PathTraceTask::picture, PathTraceTask::log, PathTraceTask::first_hit, PathTraceTask::answer}) {
        CAPTURE(features);
        CAPTURE(name(mode));
        CAPTURE(static_cast<int>(task));
        CHECK_NOTHROW(PathTraceProgram(*device, mode, features, task));
      }
    }
  }
}

TEST_CASE("The shader of Metropolis light transport is precompiled for scenes without features and ray queries") {
  const test::EnvironmentVariable compiler("TANDEM_CXX", "/nonexistent");
  const test::ScratchFolder cache;
  const rhi::DeviceHandle device = create_device({.name = "cpu", .kernel_cache = cache.path()});
  CHECK_NOTHROW(PathTraceProgram(*device, TracingMode::query, 0, PathTraceTask::metropolis));
}

TEST_CASE("A set of features that is not built would need a compiler") {
  const test::EnvironmentVariable compiler("TANDEM_CXX", "/nonexistent");
  const test::ScratchFolder cache;
  const rhi::DeviceHandle device = create_device({.name = "cpu", .kernel_cache = cache.path()});
  const rhi::ShaderModuleHandle shader =
      device->create_shader_module({.spirv = shaders::path_trace(), .label = "path_trace.comp"});
  const auto create = [&](Features features) {
    device->create_compute_pipeline(
        {.shader = shader, .specialization = specialization(features), .label = "path tracer"});
  };
  CHECK_NOTHROW(create(built_features(feature::media)));
  CHECK_THROWS_AS(create(feature::media), rhi::Error);
}
