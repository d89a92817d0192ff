#include "pathtracer/render/trace_form.hpp"

namespace tandem::pathtracer {

std::string_view name(TraceForm form) { return form == TraceForm::query ? "query" : "pipeline"; }

TraceForm choose_trace_form(const rhi::DeviceInfo& device, std::optional<TraceForm> wanted) {
  const auto unsupported = [&](const char* sentence) {
    return rhi::Error(rhi::ErrorCode::unsupported, device.name, sentence);
  };
  const bool query = device.capabilities.ray_query;
  const bool pipeline = device.capabilities.ray_tracing_pipeline;
  if (!query && !pipeline)
    throw unsupported("the path tracer needs ray queries or ray tracing pipelines, and this device has neither");
  if (!wanted) return query ? TraceForm::query : TraceForm::pipeline;
  if (*wanted == TraceForm::query && !query) throw unsupported("this device has no ray queries, only pipelines");
  if (*wanted == TraceForm::pipeline && !pipeline)
    throw unsupported("this device has no ray tracing pipelines, only ray queries");
  return *wanted;
}

}  // namespace tandem::pathtracer
