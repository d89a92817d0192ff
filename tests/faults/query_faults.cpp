#include <cstdint>
#include <vector>

#include "tests/faults/fault.hpp"
#include "tests/faults/shader_edits.hpp"

namespace tandem::test {
namespace {

// Operands of OpRayQueryInitializeKHR.
constexpr std::size_t flags_operand = 2;
constexpr std::size_t mask_operand = 3;
constexpr std::size_t t_min_operand = 5;
constexpr std::size_t t_max_operand = 7;

constexpr std::uint32_t cull_facing = 16 | 32;  // gl_RayFlagsCull{Back,Front}FacingTrianglesEXT
constexpr std::uint32_t cull_opacity = 64 | 128;

DeviceEdits results(spv::Op opcode, ValueEdit edit) { return shader_edits(edited_results(opcode, std::move(edit))); }

DeviceEdits operand(std::size_t index, ValueEdit edit) {
  return shader_edits(edited_operand(spv::OpRayQueryInitializeKHR, index, std::move(edit)));
}

std::uint32_t one_less(CodeWriter& code, std::uint32_t value) {
  SpirvModule& module = code.module();
  const std::uint32_t less = code.value(spv::OpISub, module.int_type(), {value, module.constant(1)});
  const std::uint32_t is_first = code.value(spv::OpIEqual, module.bool_type(), {value, module.constant(0)});
  return code.value(spv::OpSelect, module.int_type(), {is_first, value, less});
}

std::uint32_t without_bits(CodeWriter& code, std::uint32_t flags, std::uint32_t bits) {
  return code.value(spv::OpBitwiseAnd, code.module().uint_type(), {flags, code.module().constant(~bits)});
}

/// Back for front, where one of them is culled.
std::uint32_t inverted_cull(CodeWriter& code, std::uint32_t flags) {
  SpirvModule& module = code.module();
  const std::uint32_t uints = module.uint_type();
  const std::uint32_t culled = code.value(spv::OpBitwiseAnd, uints, {flags, module.constant(cull_facing)});
  const std::uint32_t none = code.value(spv::OpIEqual, module.bool_type(), {culled, module.constant(0u)});
  const std::uint32_t inverted = code.value(spv::OpBitwiseXor, uints, {flags, module.constant(cull_facing)});
  return code.value(spv::OpSelect, uints, {none, flags, inverted});
}

DeviceEdits without_flags(std::uint32_t bits) {
  return operand(flags_operand,
                 [bits](CodeWriter& code, std::uint32_t flags) { return without_bits(code, flags, bits); });
}

std::vector<std::uint32_t> components(CodeWriter& code, std::uint32_t vector, std::uint32_t count) {
  std::vector<std::uint32_t> values;
  for (std::uint32_t i = 0; i < count; ++i)
    values.push_back(code.value(spv::OpCompositeExtract, code.module().float_type(), {vector, i}));
  return values;
}

std::uint32_t swapped(CodeWriter& code, std::uint32_t barycentrics) {
  const std::vector<std::uint32_t> uv = components(code, barycentrics, 2);
  return code.value(spv::OpCompositeConstruct, code.module().type_of(barycentrics), {uv[1], uv[0]});
}

/// Those of the first and the second vertex in the place of the second and the third.
std::uint32_t of_other_vertices(CodeWriter& code, std::uint32_t barycentrics) {
  const std::uint32_t floats = code.module().float_type();
  const std::vector<std::uint32_t> uv = components(code, barycentrics, 2);
  const std::uint32_t rest = code.value(spv::OpFSub, floats, {code.module().constant(1.0f), uv[0]});
  const std::uint32_t first = code.value(spv::OpFSub, floats, {rest, uv[1]});
  return code.value(spv::OpCompositeConstruct, code.module().type_of(barycentrics), {first, uv[0]});
}

std::uint32_t noisy_barycentrics(CodeWriter& code, std::uint32_t barycentrics) {
  std::vector<std::uint32_t> uv = components(code, barycentrics, 2);
  uv[0] = moved_by_ulp(code, uv[0], 1);
  uv[1] = moved_by_ulp(code, uv[1], -1);
  return code.value(spv::OpCompositeConstruct, code.module().type_of(barycentrics), uv);
}

/// The rotation of a 4x3 matrix transposed; the translation stays.
std::uint32_t transposed(CodeWriter& code, std::uint32_t matrix) {
  SpirvModule& module = code.module();
  const std::uint32_t type = module.type_of(matrix);
  const std::uint32_t column_type = module.column_type(type);
  std::vector<std::uint32_t> columns;
  for (std::uint32_t column = 0; column < 3; ++column) {
    std::vector<std::uint32_t> values;
    for (std::uint32_t row = 0; row < 3; ++row)
      values.push_back(code.value(spv::OpCompositeExtract, module.float_type(), {matrix, row, column}));
    columns.push_back(code.value(spv::OpCompositeConstruct, column_type, values));
  }
  columns.push_back(code.value(spv::OpCompositeExtract, column_type, {matrix, 3}));
  return code.value(spv::OpCompositeConstruct, type, columns);
}

/// The index of a primitive is one less in every geometry but the first.
ShaderEdit off_by_one_in_later_geometries() {
  return [](SpirvModule& module, rhi::ShaderStage) {
    bool changed = false;
    module.edit_functions([&](Instruction instruction, CodeWriter& code) {
      if (instruction.opcode != spv::OpRayQueryGetIntersectionPrimitiveIndexKHR) return code.put(instruction);
      changed = true;
      code.put_changed(instruction, [&](std::uint32_t result) {
        const std::uint32_t ints = code.module().int_type();
        const std::uint32_t geometry = code.value(spv::OpRayQueryGetIntersectionGeometryIndexKHR, ints,
                                                  {instruction.operands[2], instruction.operands[3]});
        const std::uint32_t first =
            code.value(spv::OpIEqual, code.module().bool_type(), {geometry, code.module().constant(0)});
        return code.value(spv::OpSelect, ints, {first, result, one_less(code, result)});
      });
    });
    return changed;
  };
}

}  // namespace

std::vector<Fault> query_faults() {
  FaultList faults;

  // Which primitive a ray meets.
  faults.add("t-max-ignored", "a ray goes on behind its t_max", plain_scene,
             operand(t_max_operand, [](CodeWriter& code, std::uint32_t) { return code.module().constant(1e30f); }),
             "ray", {"answer"});
  faults.add("shadow-rays-short", "rays that may stop at any hit end half way", plain_scene,
             shader_edits(edited_operand("is_occluded", spv::OpRayQueryInitializeKHR, t_max_operand,
                                         [](CodeWriter& code, std::uint32_t t) { return scaled(code, t, 0.5f); })),
             "ray", {"answer"});
  faults.add("primitive-off-by-one", "the index of a primitive is one less", plain_scene,
             results(spv::OpRayQueryGetIntersectionPrimitiveIndexKHR, one_less), "ray", {"answer"});
  faults.add("primitive-off-by-one-in-later-geometries", "the same, but not in the first geometry of a bottom level",
             transparent_scene, shader_edits(off_by_one_in_later_geometries()), "ray", {"answer"});
  faults.add("confirm-ignored", "rayQueryConfirmIntersectionEXT does nothing", transparent_scene,
             shader_edits(without(spv::OpRayQueryConfirmIntersectionKHR)), "ray", {"answer"});

  // What is reported of a hit.
  faults.add_for_survey("barycentrics-swapped", "the two barycentric coordinates change places", plain_scene,
                        results(spv::OpRayQueryGetIntersectionBarycentricsKHR, swapped), "barycentrics");
  faults.add_for_survey("barycentrics-of-other-vertices", "they are those of the first and the second vertex",
                        plain_scene, results(spv::OpRayQueryGetIntersectionBarycentricsKHR, of_other_vertices),
                        "barycentrics");
  faults.add_for_survey("t-doubled", "the t of a hit is reported in half the ray's units", plain_scene,
                        results(spv::OpRayQueryGetIntersectionTKHR,
                                [](CodeWriter& code, std::uint32_t t) { return scaled(code, t, 2.0f); }),
                        "t");
  faults.add_harmless("t-noise", "the t of a hit is reported one float too large", plain_scene,
                      results(spv::OpRayQueryGetIntersectionTKHR,
                              [](CodeWriter& code, std::uint32_t t) { return moved_by_ulp(code, t, 1); }),
                      Finder::survey);
  faults.add_harmless("barycentrics-noise", "barycentric coordinates are reported one float off", plain_scene,
                      results(spv::OpRayQueryGetIntersectionBarycentricsKHR, noisy_barycentrics), Finder::survey);

  faults.add_for_survey("front-face-inverted", "the front face is reported as the back face", plain_scene,
                        results(spv::OpRayQueryGetIntersectionFrontFaceKHR,
                                [](CodeWriter& code, std::uint32_t front) {
                                  return code.value(spv::OpLogicalNot, code.module().bool_type(), {front});
                                }),
                        "hit kind");

  // What no path asks for.
  faults.add_for_probes(
      "t-min-ignored", "a ray begins at its origin", plain_scene,
      operand(t_min_operand, [](CodeWriter& code, std::uint32_t) { return code.module().constant(0.0f); }),
      "from behind the hit", {"type"});
  faults.add_for_probes(
      "mask-ignored", "a ray meets instances that its mask leaves out", plain_scene,
      operand(mask_operand, [](CodeWriter& code, std::uint32_t) { return code.module().constant(0xffu); }),
      "instance mask", {"type"});
  faults.add_for_probes("cull-flags-inverted", "front faces are culled for back faces and the other way round",
                        plain_scene, operand(flags_operand, inverted_cull), "back faces culled", {"type"});
  faults.add_for_probes("cull-flags-ignored", "no face is culled", plain_scene, without_flags(cull_facing),
                        "front faces culled", {"type"});
  faults.add_for_probes("opacity-cull-ignored", "neither opaque nor other triangles are culled", plain_scene,
                        without_flags(cull_opacity), "opaque culled", {"type"});
  faults.add_for_probes("opaque-flag-ignored", "a ray's flag that all is opaque does nothing", plain_scene,
                        without_flags(1), "all opaque", {"type"});
  faults.add_for_probes("skip-triangles-ignored", "a ray's flag that skips triangles does nothing", plain_scene,
                        without_flags(0x100), "triangles skipped", {"type"});
  faults.add_for_probes("object-to-world-transposed", "an instance's rotation is reported transposed", plain_scene,
                        results(spv::OpRayQueryGetIntersectionObjectToWorldKHR, transposed), "turned instance",
                        {"object to world (0, 1)"});
  faults.add_harmless("first-hit-flag-ignored", "rays that may stop at any hit look for the closest", plain_scene,
                      without_flags(4), Finder::nobody);
  return faults.take();
}

}  // namespace tandem::test
