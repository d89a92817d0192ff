#include "rhi_cpu/trace/scene.hpp"

namespace tandem::cpu {

ScenePointer new_scene(const EmbreeDevice& device, rhi::BuildFlags flags, bool refits, std::string_view label) {
  ScenePointer scene(rtcNewScene(device.get()));
  device.check(label);
  int scene_flags = static_cast<int>(RTC_SCENE_FLAG_ROBUST) | static_cast<int>(filter_per_ray);
  // Only dynamic scenes keep what a refit needs.
  if (refits) scene_flags |= static_cast<int>(RTC_SCENE_FLAG_DYNAMIC);
  rtcSetSceneFlags(scene.get(), static_cast<RTCSceneFlags>(scene_flags));
  rtcSetSceneBuildQuality(scene.get(), rhi::has(flags, rhi::BuildFlags::prefer_fast_build) ? RTC_BUILD_QUALITY_LOW
                                                                                           : RTC_BUILD_QUALITY_MEDIUM);
  return scene;
}

}  // namespace tandem::cpu
