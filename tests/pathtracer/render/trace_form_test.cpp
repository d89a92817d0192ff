#include "pathtracer/render/trace_form.hpp"

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
  CHECK(choose_trace_form(device_with(true, true)) == TraceForm::query);
  CHECK(choose_trace_form(device_with(true, false)) == TraceForm::query);
  CHECK(choose_trace_form(device_with(false, true)) == TraceForm::pipeline);
  CHECK_THROWS_AS(choose_trace_form(device_with(false, false)), rhi::Error);
}

TEST_CASE("A form that is asked for is given or refused") {
  CHECK(choose_trace_form(device_with(true, true), TraceForm::query) == TraceForm::query);
  CHECK(choose_trace_form(device_with(true, true), TraceForm::pipeline) == TraceForm::pipeline);
  CHECK_THROWS_AS(choose_trace_form(device_with(false, true), TraceForm::query), rhi::Error);
  CHECK_THROWS_AS(choose_trace_form(device_with(true, false), TraceForm::pipeline), rhi::Error);
  CHECK_THROWS_AS(choose_trace_form(device_with(false, false), TraceForm::query), rhi::Error);
}
