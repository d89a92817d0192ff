#include "tests/rhi_cpu/translate/recording_host.hpp"

#include <cstring>

namespace tandem::test {
namespace {

using kernel::HitDecision;
using kernel::ShaderCall;

RecordingHost& host_of(ShaderCall& call) { return *static_cast<RecordingHost*>(call.host); }

void trace_ray(ShaderCall& caller, const kernel::TopLevel* scene, const kernel::Ray& ray, std::uint32_t offset,
               std::uint32_t stride, std::uint32_t miss_index, void* payload, std::uint32_t payload_size) {
  RecordingHost& host = host_of(caller);
  host.traces.push_back({scene, ray, offset, stride, miss_index, payload_size});
  if (host.hit_shader == nullptr) return;
  ShaderCall call = caller;
  call.payload = payload;
  call.payload_size = payload_size;
  call.ray = &ray;
  call.hit = host.hit;
  host.hit_shader->call(call);
}

void execute_callable(ShaderCall& caller, std::uint32_t index, void* data, std::uint32_t data_size) {
  RecordingHost& host = host_of(caller);
  host.callable_indices.push_back(index);
  host.data_sizes.push_back(data_size);
  ShaderCall call = caller;
  call.payload = data;
  call.payload_size = data_size;
  if (host.callable_shader != nullptr) host.callable_shader->call(call);
}

bool report_intersection(ShaderCall& caller, float t, std::uint32_t hit_kind) {
  RecordingHost& host = host_of(caller);
  RecordingHost::Report report = {t, hit_kind, {}};
  std::memcpy(report.attributes.data(), caller.hit_attributes, sizeof(report.attributes));
  host.reports.push_back(report);
  caller.decision = t == host.terminating_t ? HitDecision::terminate : HitDecision::accept;
  return t < 5;
}

constexpr kernel::PipelineFunctions functions = {trace_ray, execute_callable, report_intersection};

}  // namespace

std::array<std::unique_ptr<Kernel>, 2> kernels(const std::string& glsl, rhi::ShaderStage stage) {
  const std::vector<std::uint32_t> spirv = traced_spirv(glsl, stage);
  std::array<std::unique_ptr<Kernel>, 2> result;
  for (const bool optimize : {false, true}) {
    KernelOptions options;
    options.optimize = optimize;
    result[optimize] = std::make_unique<Kernel>(spirv, options);
  }
  return result;
}

ShaderCall call_of(RecordingHost& host) {
  ShaderCall call;
  call.functions = &functions;
  call.host = &host;
  return call;
}

}  // namespace tandem::test
