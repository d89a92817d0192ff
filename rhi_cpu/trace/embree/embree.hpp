#pragma once

#if TANDEM_EMBREE_MAJOR >= 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <memory>

/// The little in which Embree 3 and Embree 4 differ for us: how a ray is traced with a filter function.
namespace tandem::cpu {

#if TANDEM_EMBREE_MAJOR >= 4
using EmbreeContext = RTCRayQueryContext;
inline constexpr RTCSceneFlags filter_per_ray = RTC_SCENE_FLAG_FILTER_FUNCTION_IN_ARGUMENTS;
#else
using EmbreeContext = RTCIntersectContext;
inline constexpr RTCSceneFlags filter_per_ray = RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION;
#endif

struct SceneRelease {
  void operator()(RTCSceneTy* scene) const noexcept { rtcReleaseScene(scene); }
};
using ScenePointer = std::unique_ptr<RTCSceneTy, SceneRelease>;

struct GeometryRelease {
  void operator()(RTCGeometryTy* geometry) const noexcept { rtcReleaseGeometry(geometry); }
};
using GeometryPointer = std::unique_ptr<RTCGeometryTy, GeometryRelease>;

/// Closest hit without any filter.
inline void intersect(RTCScene scene, RTCRayHit& ray) {
#if TANDEM_EMBREE_MAJOR >= 4
  rtcIntersect1(scene, &ray);
#else
  EmbreeContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(scene, &context, &ray);
#endif
}

/// Any hit without any filter; sets tfar to minus infinity when there is one.
inline void occlude(RTCScene scene, RTCRay& ray) {
#if TANDEM_EMBREE_MAJOR >= 4
  rtcOccluded1(scene, &ray);
#else
  EmbreeContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded1(scene, &context, &ray);
#endif
}

inline void initialize_context(EmbreeContext& context) {
#if TANDEM_EMBREE_MAJOR >= 4
  rtcInitRayQueryContext(&context);
#else
  rtcInitIntersectContext(&context);
#endif
}

#if TANDEM_EMBREE_MAJOR >= 4
template <typename Arguments>
void use_filter(Arguments& arguments, EmbreeContext& context, RTCFilterFunctionN filter) {
  arguments.context = &context;
  arguments.filter = filter;
  arguments.flags = static_cast<RTCRayQueryFlags>(arguments.flags | RTC_RAY_QUERY_FLAG_INVOKE_ARGUMENT_FILTER);
}
#endif

/// Closest of the hits that the filter accepts. The filter finds `context`, initialised, in its arguments.
inline void intersect(RTCScene scene, RTCRayHit& ray, EmbreeContext& context, RTCFilterFunctionN filter) {
#if TANDEM_EMBREE_MAJOR >= 4
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  use_filter(arguments, context, filter);
  rtcIntersect1(scene, &ray, &arguments);
#else
  context.filter = filter;
  rtcIntersect1(scene, &context, &ray);
#endif
}

/// Closest hit of user geometries, whose callbacks find `context`, initialised, in their arguments.
inline void intersect(RTCScene scene, RTCRayHit& ray, EmbreeContext& context) {
#if TANDEM_EMBREE_MAJOR >= 4
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  arguments.context = &context;
  rtcIntersect1(scene, &ray, &arguments);
#else
  rtcIntersect1(scene, &context, &ray);
#endif
}

/// Any of the hits that the filter accepts.
inline void occlude(RTCScene scene, RTCRay& ray, EmbreeContext& context, RTCFilterFunctionN filter) {
#if TANDEM_EMBREE_MAJOR >= 4
  RTCOccludedArguments arguments;
  rtcInitOccludedArguments(&arguments);
  use_filter(arguments, context, filter);
  rtcOccluded1(scene, &ray, &arguments);
#else
  context.filter = filter;
  rtcOccluded1(scene, &context, &ray);
#endif
}

}  // namespace tandem::cpu
