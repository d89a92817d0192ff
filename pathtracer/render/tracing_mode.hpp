#pragma once

#include <optional>
#include <string_view>

#include "rhi/device.hpp"

namespace tandem::pathtracer {

/// How the path tracer traces its rays. The picture is the same to the last bit.
enum class TracingMode {
  query,    ///< a compute shader with ray queries
  pipeline  ///< a ray tracing pipeline
};

/// "query", "pipeline"
std::string_view name(TracingMode form);

/// The form that is wanted; by default ray queries where the device has them, else a pipeline. Throws
/// rhi::Error(unsupported) when the device lacks what it takes.
TracingMode choose_tracing_mode(const rhi::DeviceInfo& device, std::optional<TracingMode> wanted = {});

}  // namespace tandem::pathtracer
