#include "pathtracer/render/program_store.hpp"

#include <utility>

namespace tandem::pathtracer {

ProgramStore::ProgramStore(rhi::DeviceHandle device) : device_(std::move(device)) {}

const PathTraceProgram& ProgramStore::program(TracingMode form, Features features, PathTraceTask task) {
  // Programs of several features may be the same one of a task.
  const auto key = std::tuple(form, task_features(features, task), task);
  const auto known = programs_.find(key);
  if (known != programs_.end()) return known->second;
  return programs_.emplace(key, PathTraceProgram(*device_, form, features, task)).first->second;
}

}  // namespace tandem::pathtracer
