#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "compare/probe/answer.hpp"
#include "compare/probe/structures.hpp"
#include "compare/probe/trial.hpp"
#include "pathtracer/render/tracing_mode.hpp"
#include "pathtracer/scene/scene.hpp"
#include "rhi/device.hpp"

namespace tandem::compare {

/// Asks a device for trials of a scene, with shaders/probe.
class Prober {
 public:
  /// The device and the scene must outlive it. Throws rhi::Error for what the device refuses.
  /// @param form as pathtracer::choose_tracing_mode takes it
  Prober(rhi::Device& device, const pathtracer::Scene& scene, std::optional<pathtracer::TracingMode> form = {});

  pathtracer::TracingMode form() const noexcept { return form_; }
  /// Whether the device can do what the trial asks for; if not, the trial is not to be made.
  bool supports(const Trial& trial) const;
  /// One answer for each ray. @param rays as the trial's placements move them; not empty
  std::vector<ProbeAnswer> answer(const Trial& trial, std::span<const ProbeRay> rays);

 private:
  rhi::Device& device_;
  pathtracer::TracingMode form_;
  ProbeStructures structures_;
  rhi::PipelineHandle pipeline_;
  rhi::ComputePipelineHandle compute_;  ///< of the form query
  rhi::ShaderTableHandle table_;        ///< of the form pipeline
};

}  // namespace tandem::compare
