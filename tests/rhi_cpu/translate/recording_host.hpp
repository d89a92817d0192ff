#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "rhi_cpu/kernel/shader_call.hpp"
#include "tests/rhi_cpu/translate/kernel_harness.hpp"

/// Runs single ray tracing shaders, with a host that writes down what they call.
namespace tandem::test {

/// A shader of one stage, from the module as glslang writes it and from an optimised one.
std::array<std::unique_ptr<Kernel>, 2> kernels(const std::string& glsl, rhi::ShaderStage stage);

/// What shaders called, as the host sees it.
struct RecordingHost {
  struct Trace {
    const kernel::TopLevel* scene;
    kernel::Ray ray;
    std::uint32_t sbt_record_offset, sbt_record_stride, miss_index, payload_size;
  };
  struct Report {
    float t;
    std::uint32_t hit_kind;
    std::array<float, 8> attributes;
  };
  std::vector<Trace> traces;
  std::vector<std::uint32_t> callable_indices;
  std::vector<std::uint32_t> data_sizes;
  std::vector<Report> reports;
  const Kernel* hit_shader = nullptr;       ///< what trace_ray runs
  const Kernel* callable_shader = nullptr;  ///< what execute_callable runs
  const kernel::Hit* hit = nullptr;
  float terminating_t = -1;  ///< a report of it ends the intersection shader
};

/// A call whose functions write into `host`, which must outlive it.
kernel::ShaderCall call_of(RecordingHost& host);

}  // namespace tandem::test
