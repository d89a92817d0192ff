#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "rhi/pipeline.hpp"

namespace tandem::rhi {

/// What happens where a ray meets a geometry. Every member may be absent: without `closest_hit` nothing runs for the
/// closest hit, without `any_hit` every candidate is accepted. With `intersection` the group is for boxes, without for
/// triangles: a hit record names a group for the kind of its geometry (VUID-vkCmdTraceRaysKHR-*-04735, -04736).
struct HitGroup {
  ShaderModuleHandle closest_hit;
  ShaderModuleHandle any_hit;
  ShaderModuleHandle intersection;
};

/// Callable shaders in flight at once, called by each other: a GPU reserves a stack for them beforehand.
inline constexpr std::uint32_t max_callable_depth = 8;

/// The shaders of a pipeline. A shader record names one by its position in the list of its kind.
struct RayTracingPipelineDesc {
  std::vector<ShaderModuleHandle> ray_generation;  ///< at least one
  std::vector<ShaderModuleHandle> miss;
  std::vector<HitGroup> hit_groups;
  std::vector<ShaderModuleHandle> callable;
  /// Rays in flight at once: 1 when only the ray generation shader traces; at most Limits::max_ray_recursion_depth.
  /// 0 when nothing traces.
  std::uint32_t max_recursion_depth = 1;
  /// Given to every shader that declares the constant; each id must be declared by one.
  std::vector<SpecializationValue> specialization;
  /// The most elements that a bind group gives to an array of descriptors without a length, such as textures[].
  std::uint32_t unsized_array_length = usual_unsized_array_length;
  std::string label;
};

/// Every module that the desc names, each once, in the order ray generation, miss, hit groups, callable.
std::vector<ShaderModuleHandle> shaders_of(const RayTracingPipelineDesc& desc);

/// Ray tracing shaders ready to run through a ShaderTable. Vulkan: VK_KHR_ray_tracing_pipeline.
class RayTracingPipeline : public Pipeline {
 public:
  const RayTracingPipelineDesc& desc() const noexcept { return desc_; }

 protected:
  explicit RayTracingPipeline(RayTracingPipelineDesc desc)
      : Pipeline(Kind::ray_tracing, desc.label,
                 combined_interface(shaders_of(desc), desc.label, desc.unsized_array_length)),
        desc_(std::move(desc)) {}

 private:
  RayTracingPipelineDesc desc_;
};

using RayTracingPipelineHandle = std::shared_ptr<RayTracingPipeline>;

}  // namespace tandem::rhi
