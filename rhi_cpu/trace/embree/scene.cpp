#include "rhi_cpu/trace/embree/scene.hpp"

namespace tandem::cpu {

RTCBuildQuality quality_of(rhi::BuildFlags flags) {
  if (rhi::has(flags, rhi::BuildFlags::allow_update)) return RTC_BUILD_QUALITY_REFIT;
  return rhi::has(flags, rhi::BuildFlags::prefer_fast_build) ? RTC_BUILD_QUALITY_LOW : RTC_BUILD_QUALITY_MEDIUM;
}

ScenePointer new_scene(const EmbreeDevice& device, RTCBuildQuality quality, std::string_view label) {
  ScenePointer scene(rtcNewScene(device.get()));
  device.check(label);
  int flags = static_cast<int>(RTC_SCENE_FLAG_ROBUST) | static_cast<int>(filter_per_ray);
  if (quality == RTC_BUILD_QUALITY_REFIT) flags |= static_cast<int>(RTC_SCENE_FLAG_DYNAMIC);
  rtcSetSceneFlags(scene.get(), static_cast<RTCSceneFlags>(flags));
  // Geometries are only built with their own quality, and refitted, in scenes of low quality.
  rtcSetSceneBuildQuality(scene.get(),
                          quality == RTC_BUILD_QUALITY_MEDIUM ? RTC_BUILD_QUALITY_MEDIUM : RTC_BUILD_QUALITY_LOW);
  return scene;
}

}  // namespace tandem::cpu
