#pragma once

#include <optional>
#include <string_view>

#include "rhi/device.hpp"

namespace tandem::pathtracer {

/// How the path tracer traces its rays. The picture is the same to the last bit.
enum class TraceForm {
  query,    ///< a compute shader with ray queries
  pipeline  ///< a ray tracing pipeline
};

/// "query", "pipeline"
std::string_view name(TraceForm form);

/// The form that is wanted; by default ray queries where the device has them, else a pipeline. Throws
/// rhi::Error(unsupported) when the device lacks what it takes.
TraceForm choose_trace_form(const rhi::DeviceInfo& device, std::optional<TraceForm> wanted = {});

}  // namespace tandem::pathtracer
