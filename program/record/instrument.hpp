#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "program/record/module.hpp"
#include "program/record/segment.hpp"

/// A SPIR-V module that writes down what it does: the result of every instruction that has one, for chosen invocations
/// (decision 24). Its results do not change.
namespace tandem::program {

struct Recorder {
  std::vector<std::uint32_t> spirv;
  std::vector<Segment> segments;  ///< number first_segment is the first
};

/// Throws rhi::Error(unsupported), which names `label`, for a stage that is neither compute nor ray tracing.
Recorder instrument(const Module& module, const RecordOptions& options, std::string_view label);

}  // namespace tandem::program
