#include <cstdint>
#include <utility>
#include <vector>

#include "tests/faults/fault.hpp"
#include "tests/faults/shader_edits.hpp"

namespace tandem::test {
namespace {

/// The edit, but in shaders of one stage alone.
DeviceEdits in_stage(rhi::ShaderStage stage, ShaderEdit edit) {
  return shader_edits([stage, edit = std::move(edit)](SpirvModule& module, rhi::ShaderStage of_module) {
    return of_module == stage && edit(module, of_module);
  });
}

std::uint32_t zero(CodeWriter& code, std::uint32_t) { return code.module().constant(0); }

}  // namespace

std::vector<Fault> pipeline_faults() {
  using rhi::ShaderStage;
  FaultList faults(pathtracer::TracingMode::pipeline);
  faults.add("ignore-intersection-ignored", "ignoreIntersectionEXT does nothing", transparent_scene,
             in_stage(ShaderStage::any_hit, without(spv::OpIgnoreIntersectionKHR, spv::OpReturn)), "ray", {"answer"});
  faults.add("any-hit-sees-first-geometry", "gl_GeometryIndexEXT is 0 in any-hit shaders", transparent_scene,
             in_stage(ShaderStage::any_hit, edited_builtin(spv::BuiltInRayGeometryIndexKHR, zero)), "ray", {"answer"});
  faults.add("closest-hit-sees-first-geometry", "gl_GeometryIndexEXT is 0 in closest-hit shaders", transparent_scene,
             in_stage(ShaderStage::closest_hit, edited_builtin(spv::BuiltInRayGeometryIndexKHR, zero)), "ray",
             {"answer"});
  faults.add("closest-hit-sees-first-primitive", "gl_PrimitiveID is 0 in closest-hit shaders", plain_scene,
             in_stage(ShaderStage::closest_hit, edited_builtin(spv::BuiltInPrimitiveId, zero)), "ray", {"answer"});
  faults.add("closest-hit-sees-first-instance", "gl_InstanceCustomIndexEXT is 0 in closest-hit shaders", sphere_scene,
             in_stage(ShaderStage::closest_hit, edited_builtin(spv::BuiltInInstanceCustomIndexKHR, zero)), "ray",
             {"answer"});
  faults.add("report-ignored", "what intersection shaders report is lost", sphere_scene,
             in_stage(ShaderStage::intersection,
                      edited_returns("sphere_hit",
                                     [](CodeWriter& code, std::uint32_t) { return code.module().constant(-1.0f); })),
             "ray", {"answer"});
  faults.add("reported-t-doubled", "a hit is twice as far away as reportIntersectionEXT said", sphere_scene,
             in_stage(ShaderStage::intersection,
                      edited_operand(spv::OpReportIntersectionKHR, 2,
                                     [](CodeWriter& code, std::uint32_t t) { return scaled(code, t, 2.0f); })),
             "ray", {"answer"});
  faults.add("miss-shader-not-run", "rays that meet nothing run no shader", plain_scene,
             in_stage(ShaderStage::miss, without(spv::OpStore)), "ray", {"answer"});
  return faults.take();
}

}  // namespace tandem::test
