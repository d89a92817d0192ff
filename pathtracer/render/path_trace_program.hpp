#pragma once

#include <vector>

#include <glm/vec2.hpp>

#include "pathtracer/render/features.hpp"
#include "pathtracer/render/tracing_mode.hpp"
#include "pathtracer/scene/buffers.hpp"
#include "rhi/device.hpp"

namespace tandem::pathtracer {

/// What an invocation of the path tracer's shaders does.
enum class PathTraceTask {
  picture,    ///< shaders/path_trace.glsl: adds samples to the sums of a pixel
  log,        ///< shaders/path_log.glsl: records the events of a path
  first_hit,  ///< shaders/first_hit.glsl: adds samples to sums of what a pixel shows first
  answer,     ///< shaders/ray_answer.glsl: traces one ray again
  metropolis  ///< shaders/metropolis/metropolis.glsl: steps of a chain
};

/// What a program for `features` has built in: tasks other than the picture are rare, so fewer sets are built for them.
Features task_features(Features features, PathTraceTask task);

/// The path tracer's shaders in one of their forms, ready to run on a device.
class PathTraceProgram {
 public:
  /// @param features what the scene and the settings need; what is built in may have more (built_features)
  PathTraceProgram(rhi::Device& device, TracingMode form, Features features,
                   PathTraceTask task = PathTraceTask::picture);

  /// For which bind groups are made.
  const rhi::PipelineHandle& pipeline() const noexcept { return pipeline_; }
  Features features() const noexcept { return features_; }
  /// One invocation for each element of constants.tile_size, which is not empty.
  void record(rhi::CommandList& list, const std::vector<rhi::BindGroupHandle>& bind_groups,
              const DispatchConstants& constants) const;

 private:
  TracingMode form_;
  Features features_;
  rhi::PipelineHandle pipeline_;
  rhi::ComputePipelineHandle compute_;  ///< of the form query
  rhi::ShaderTableHandle table_;        ///< of the form pipeline
};

}  // namespace tandem::pathtracer
