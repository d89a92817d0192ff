#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "rhi/device.hpp"

namespace tandem::conformance {

struct Settings {
  /// Rays of all watertightness cases together.
  std::uint64_t watertightness_rays = 500'000;
};

/// What a compute pipeline has beside its shader: members of rhi::ComputePipelineDesc.
struct ComputeOptions {
  std::vector<rhi::SpecializationValue> specialization = {};
  std::uint32_t required_subgroup_size = 0;
  bool full_subgroups = false;
};

/// What a case runs with: the device, and the shaders that cases before it have compiled for it. Used by one thread;
/// the device must outlive it.
class Context {
 public:
  explicit Context(rhi::Device& device, const Settings& settings = {}) : device_(device), settings_(settings) {}
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;

  rhi::Device& device() const noexcept { return device_; }
  const Settings& settings() const noexcept { return settings_; }

  /// The module of this source, compiled at the first call. `label` names it in errors.
  rhi::ShaderModuleHandle shader(rhi::ShaderStage stage, const std::string& glsl, const std::string& label);

  /// The compute pipeline of this source, made at the first call. Run-time compilation takes about half a second on a
  /// CPU device, so cases share shaders and differ in data where they can.
  rhi::ComputePipelineHandle compute_pipeline(const std::string& glsl, const std::string& label,
                                              const ComputeOptions& options = {});

  /// Adds a sentence that the report shows beside the result, such as a count: the same in every run on the same
  /// device.
  void note(const std::string& sentence);
  /// What was noted since the last call.
  std::string take_note() { return std::exchange(note_, {}); }

 private:
  rhi::Device& device_;
  Settings settings_;
  std::map<std::pair<rhi::ShaderStage, std::string>, rhi::ShaderModuleHandle> shaders_;
  std::map<std::string, rhi::ComputePipelineHandle> compute_pipelines_;
  std::string note_;
};

}  // namespace tandem::conformance
