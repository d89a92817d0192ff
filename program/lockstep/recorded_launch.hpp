#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "program/job/job.hpp"
#include "program/record/instrument.hpp"
#include "program/record/module.hpp"

/// One command of a job, with shaders that record.
namespace tandem::program {

/// A shader of the launch, as it was before it was instrumented: with its specialisation constants replaced.
struct RecordedShader {
  std::string name;
  rhi::ShaderStage stage = rhi::ShaderStage::compute;
  Module module;
  std::uint32_t first_segment = 0;
  std::vector<Segment> segments;  ///< number first_segment is the first
};

struct RecordedLaunch {
  Job job;                                 ///< one pipeline and one command, with all resources of the job
  std::size_t record_buffer = 0;           ///< position in job.buffers
  std::vector<RecordedShader> shaders;     ///< ascending by first_segment
  std::array<std::uint32_t, 3> size = {};  ///< invocations
  std::array<std::uint32_t, 3> workgroup_size = {1, 1, 1};  ///< of a compute shader
  std::uint32_t largest_segment = 1;
};

/// @param command a Dispatch or TraceRays of the job
/// @param mirrored the first invocation does the work of the last (Mirror)
/// Throws rhi::Error, which names the shader, for one that cannot be recorded, and for any other command.
RecordedLaunch record_launch(const Job& job, const Command& command, RecordForm form, bool mirrored = false);

/// A segment with the shader that it belongs to; null where no segment has the number.
struct SegmentPlace {
  const RecordedShader* shader = nullptr;
  const Segment* segment = nullptr;
};
SegmentPlace segment_at(const RecordedLaunch& launch, std::uint32_t number);

}  // namespace tandem::program
