#pragma once

#include <vector>

#include <glm/vec2.hpp>

#include "pathtracer/scene_buffers.hpp"
#include "pathtracer/trace_form.hpp"
#include "rhi/device.hpp"

namespace tandem::pathtracer {

/// What an invocation of the path tracer's shaders does.
enum class PathTraceTask {
  picture,  ///< shaders/path_trace.glsl: adds samples to the sums of a pixel
  log,      ///< shaders/path_log.glsl: writes down the rays of a path
  answer    ///< shaders/ray_answer.glsl: traces one ray again
};

/// The path tracer's shaders in one of their forms, ready to run on a device.
class PathTraceProgram {
 public:
  /// @param transparency for scenes with transparent triangles, which cost time even where there are none
  PathTraceProgram(rhi::Device& device, TraceForm form, bool transparency, PathTraceTask task = PathTraceTask::picture);

  /// For which bind groups are made.
  const rhi::PipelineHandle& pipeline() const noexcept { return pipeline_; }
  /// One invocation for each element of constants.tile_size, which is not empty.
  void record(rhi::CommandList& list, const std::vector<rhi::BindGroupHandle>& bind_groups,
              const RenderConstants& constants) const;

 private:
  TraceForm form_;
  rhi::PipelineHandle pipeline_;
  rhi::ComputePipelineHandle compute_;  ///< of the form query
  rhi::ShaderTableHandle table_;        ///< of the form pipeline
};

}  // namespace tandem::pathtracer
