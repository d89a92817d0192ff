#include "pathtracer/render/tracing_mode.hpp"

namespace tandem::pathtracer {

std::string_view name(TracingMode form) { return form == TracingMode::query ? "query" : "pipeline"; }

TracingMode choose_tracing_mode(const rhi::DeviceInfo& device, std::optional<TracingMode> wanted) {
  const auto unsupported = [&](const char* sentence) {
    return rhi::Error(rhi::ErrorCode::unsupported, device.name, sentence);
  };
  const bool query = device.capabilities.ray_query;
  const bool pipeline = device.capabilities.ray_tracing_pipeline;
  if (!query && !pipeline)
    throw unsupported("the path tracer needs ray queries or ray tracing pipelines, and this device has neither");
  if (!wanted) return query ? TracingMode::query : TracingMode::pipeline;
  if (*wanted == TracingMode::query && !query) throw unsupported("this device has no ray queries, only pipelines");
  if (*wanted == TracingMode::pipeline && !pipeline)
    throw unsupported("this device has no ray tracing pipelines, only ray queries");
  return *wanted;
}

}  // namespace tandem::pathtracer
