#pragma once

#include <map>
#include <memory>
#include <tuple>

#include "pathtracer/render/path_trace_program.hpp"
#include "rhi/device.hpp"

namespace tandem::pathtracer {

/// The path tracer's programs on one device: each is made when it is first asked for, and once. Renderers of several
/// scenes may share a store, since drivers take seconds to minutes for a program. For one thread at a time.
class ProgramStore {
 public:
  explicit ProgramStore(rhi::DeviceHandle device);

  /// @param features that are built in (built_features)
  const PathTraceProgram& program(TracingMode form, Features features, PathTraceTask task);

 private:
  rhi::DeviceHandle device_;
  std::map<std::tuple<TracingMode, Features, PathTraceTask>, PathTraceProgram> programs_;
};

using ProgramStoreHandle = std::shared_ptr<ProgramStore>;

}  // namespace tandem::pathtracer
