#include "pathtracer/render/accumulation.hpp"

#include <algorithm>

#include "base/error.hpp"

namespace tandem::pathtracer {
namespace {

/// The settings that the picture depends on, completed by the camera in use, for comparison. Seeds of frames that are
/// not accumulated differ on purpose.
RenderSettings essential(RenderSettings settings, const Camera& camera) {
  const RenderSettings usual;
  settings.submission_seconds = usual.submission_seconds;
  settings.maximum_tile = usual.maximum_tile;
  if (!settings.camera) settings.camera = camera;
  return settings;
}

}  // namespace

bool Accumulation::next_frame(const RenderSettings& settings, const AccumulationSettings& accumulation) {
  if (accumulation.samples_per_frame == 0 || accumulation.maximum_samples == 0)
    throw Error("a frame, and a picture, have at least one sample");
  if (!accumulation.accumulate) {
    RenderSettings frame = settings;
    frame.seed = settings.seed + ++frames_;
    renderer_->restart(frame);
    return renderer_->render(accumulation.samples_per_frame);
  }
  const Camera& camera = renderer_->scene().camera();
  if (!(essential(settings, camera) == essential(renderer_->scene().settings(), camera))) renderer_->restart(settings);
  frames_ = 0;
  if (renderer_->samples() >= accumulation.maximum_samples) return false;
  const std::uint32_t missing = accumulation.maximum_samples - renderer_->samples();
  return renderer_->render(std::min(accumulation.samples_per_frame, missing));
}

}  // namespace tandem::pathtracer
