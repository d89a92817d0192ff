#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "tests/faults/fault.hpp"
#include "tests/faults/shader_edits.hpp"

namespace tandem::test {
namespace {

// Operands of OpRayQueryInitializeKHR.
constexpr std::size_t direction_operand = 6;
constexpr std::size_t t_max_operand = 7;

DeviceEdits losing(std::function<bool(const TriangleCorners&)> lost) {
  DeviceEdits edits;
  edits.loses_triangle = std::move(lost);
  return edits;
}

DeviceEdits seeing_no_farther_than(float t) {
  return shader_edits(
      edited_operand(spv::OpRayQueryInitializeKHR, t_max_operand, [t](CodeWriter& code, std::uint32_t t_max) {
        return code.extended(GLSLstd450FMin, code.module().float_type(), {t_max, code.module().constant(t)});
      }));
}

/// One ray in `count`, by a hash of its direction, ends where it begins.
/// @param function whose rays; "": of all
DeviceEdits missing_one_in(std::uint32_t count, const std::string& function) {
  return shader_edits([count, function](SpirvModule& module, rhi::ShaderStage) {
    bool changed = false;
    const SpirvModule::Edit edit = [&](Instruction instruction, CodeWriter& code) {
      if (instruction.opcode != spv::OpRayQueryInitializeKHR) return code.put(instruction);
      changed = true;
      SpirvModule& in = code.module();
      const std::uint32_t uints = in.uint_type();
      const std::uint32_t x =
          code.value(spv::OpCompositeExtract, in.float_type(), {instruction.operands[direction_operand], 0});
      const std::uint32_t bits = code.value(spv::OpBitcast, uints, {x});
      const std::uint32_t hash = code.value(spv::OpIMul, uints, {bits, in.constant(2654435769u)});
      const std::uint32_t misses =
          code.value(spv::OpULessThan, in.bool_type(), {hash, in.constant(0xffffffffu / count)});
      instruction.operands[t_max_operand] =
          code.value(spv::OpSelect, in.float_type(), {misses, in.constant(0.0f), instruction.operands[t_max_operand]});
      code.put(instruction);
    };
    if (function.empty())
      module.edit_functions(edit);
    else
      module.edit_function(function, edit);
    return changed;
  });
}

}  // namespace

std::vector<Fault> surface_faults() {
  FaultList faults;
  faults.add("large-triangles-missed", "triangles of more than 100,000 units are missed", wide_scene,
             losing([](const TriangleCorners& corners) { return longest_edge(corners) > 1e5f; }), "ray", {"answer"});
  faults.add("small-triangles-missed", "triangles of less than half a unit are missed", wide_scene,
             losing([](const TriangleCorners& corners) { return longest_edge(corners) < 0.5f; }), "ray", {"answer"});
  faults.add("region-missed", "triangles on one side of the scene are missed", wide_scene,
             losing([](const TriangleCorners& corners) {
               return std::ranges::all_of(corners, [](const auto& corner) { return corner[0] > 0 && corner[0] < 10; });
             }),
             "ray", {"answer"});
  faults.add("far-surfaces-missed", "rays end after 9 units", wide_scene, seeing_no_farther_than(9), "ray", {"answer"});
  faults.add("far-surfaces-missed-in-a-room", "rays end after 1200 units", plain_scene, seeing_no_farther_than(1200),
             "ray", {"answer"});
  faults.add("one-ray-in-100-missed", "one ray in a hundred meets nothing", wide_scene, missing_one_in(100, ""), "ray",
             {"answer"});
  faults.add("one-ray-in-100-missed-in-a-room", "likewise", plain_scene, missing_one_in(100, ""), "ray", {"answer"});
  faults.add("one-shadow-ray-in-10-missed", "one shadow ray in ten is not blocked", wide_scene,
             missing_one_in(10, "is_occluded"), "ray", {"answer"});
  faults.add("all-in-shadow", "every shadow ray is blocked", wide_scene,
             shader_edits(edited_returns("is_occluded",
                                         [](CodeWriter& code, std::uint32_t value) {
                                           return code.value(spv::OpLogicalOr, code.module().bool_type(),
                                                             {value, code.value(spv::OpLogicalNot,
                                                                                code.module().bool_type(), {value})});
                                         })),
             "ray", {"answer"});
  return faults.take();
}

}  // namespace tandem::test
