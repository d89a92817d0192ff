#include "pathtracer/render/tracing_mode.hpp"

#include <string>

#include <doctest/doctest.h>

using namespace tandem;
using namespace tandem::pathtracer;

namespace {

rhi::DeviceInfo device_with(bool ray_query, bool ray_tracing_pipeline) {
  rhi::DeviceInfo info;
  info.name = "device";
  info.capabilities.ray_query = ray_query;
  info.capabilities.ray_tracing_pipeline = ray_tracing_pipeline;
  return info;
}

}  // namespace

TEST_CASE("The form of tracing is what the device has, ray queries first") {
  CHECK(choose_tracing_mode(device_with(true, true)) == TracingMode::query);
  CHECK(choose_tracing_mode(device_with(true, false)) == TracingMode::query);
  CHECK(choose_tracing_mode(device_with(false, true)) == TracingMode::pipeline);
  CHECK_THROWS_AS(choose_tracing_mode(device_with(false, false)), rhi::Error);
}

TEST_CASE("A form that is asked for is given or refused") {
  CHECK(choose_tracing_mode(device_with(true, true), TracingMode::query) == TracingMode::query);
  CHECK(choose_tracing_mode(device_with(true, true), TracingMode::pipeline) == TracingMode::pipeline);
  CHECK_THROWS_AS(choose_tracing_mode(device_with(false, true), TracingMode::query), rhi::Error);
  CHECK_THROWS_AS(choose_tracing_mode(device_with(true, false), TracingMode::pipeline), rhi::Error);
  CHECK_THROWS_AS(choose_tracing_mode(device_with(false, false), TracingMode::query), rhi::Error);
}
