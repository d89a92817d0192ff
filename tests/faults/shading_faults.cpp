#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "tests/faults/fault.hpp"
#include "tests/faults/shader_edits.hpp"

namespace tandem::test {
namespace {

std::uint32_t one(CodeWriter& code, std::uint32_t) { return code.module().constant(1.0f); }
std::uint32_t zero(CodeWriter& code, std::uint32_t) { return code.module().constant(0.0f); }

std::uint32_t complement(CodeWriter& code, std::uint32_t value) {
  return code.value(spv::OpFSub, code.module().float_type(), {code.module().constant(1.0f), value});
}

std::uint32_t inverse(CodeWriter& code, std::uint32_t value) {
  return code.value(spv::OpFDiv, code.module().float_type(), {code.module().constant(1.0f), value});
}

std::uint32_t negated(CodeWriter& code, std::uint32_t value) {
  return code.value(spv::OpFNegate, code.module().type_of(value), {value});
}

std::uint32_t next_float(CodeWriter& code, std::uint32_t value) { return moved_by_ulp(code, value, 1); }

/// No bits at all.
std::uint32_t lost(CodeWriter& code, std::uint32_t value) {
  return code.value(spv::OpBitwiseXor, code.module().type_of(value), {value, value});
}

using Products = std::map<std::uint32_t, std::pair<std::uint32_t, std::uint32_t>>;

/// a * b + c, or minus c, rounded once: the product and the sum of floats are exact in double precision but for one
/// rounding that hardly ever matters.
std::uint32_t fused(CodeWriter& code, spv::Op opcode, std::pair<std::uint32_t, std::uint32_t> product,
                    std::uint32_t other, bool product_first) {
  const std::uint32_t doubles = code.module().float_type(64);
  const std::uint32_t a = code.value(spv::OpFConvert, doubles, {product.first});
  const std::uint32_t b = code.value(spv::OpFConvert, doubles, {product.second});
  const std::uint32_t c = code.value(spv::OpFConvert, doubles, {other});
  const std::uint32_t ab = code.value(spv::OpFMul, doubles, {a, b});
  const std::uint32_t sum = code.value(opcode, doubles, {product_first ? ab : c, product_first ? c : ab});
  return code.value(spv::OpFConvert, code.module().float_type(), {sum});
}

/// Products and sums of det_dot and det_cross are contracted.
bool contract(SpirvModule& module, rhi::ShaderStage) {
  Products products;
  const SpirvModule::Edit edit = [&](Instruction instruction, CodeWriter& code) {
    const spv::Op opcode = instruction.opcode;
    if (opcode == spv::OpFMul) products[instruction.operands[1]] = {instruction.operands[2], instruction.operands[3]};
    if (opcode != spv::OpFAdd && opcode != spv::OpFSub) return code.put(instruction);
    for (const bool product_first : {true, false}) {
      const auto found = products.find(instruction.operands[product_first ? 2 : 3]);
      if (found == products.end()) continue;
      const std::uint32_t other = instruction.operands[product_first ? 3 : 2];
      const std::uint32_t result = fused(code, opcode, found->second, other, product_first);
      return code.put({spv::OpCopyObject, {instruction.operands[0], instruction.operands[1], result}});
    }
    code.put(instruction);
  };
  const bool dot = module.edit_function("det_dot", edit);
  const bool cross = module.edit_function("det_cross", edit);
  return dot || cross;
}

/// det_dot adds the last two products first.
bool reassociate(SpirvModule& module, rhi::ShaderStage) {
  Products sums;
  return module.edit_function("det_dot", [&](Instruction instruction, CodeWriter& code) {
    if (instruction.opcode != spv::OpFAdd) return code.put(instruction);
    const auto found = sums.find(instruction.operands[2]);
    sums[instruction.operands[1]] = {instruction.operands[2], instruction.operands[3]};
    if (found != sums.end()) {
      instruction.operands[3] =
          code.value(spv::OpFAdd, instruction.operands[0], {found->second.second, instruction.operands[3]});
      instruction.operands[2] = found->second.first;
    }
    code.put(instruction);
  });
}

}  // namespace

std::vector<Fault> shading_faults() {
  FaultList faults;
  faults.add("random-numbers-halved", "random numbers are in [0, 1/2)", plain_scene,
             shader_edits(edited_returns("unit_interval",
                                         [](CodeWriter& code, std::uint32_t u) { return scaled(code, u, 0.5f); })),
             "camera", {"direction"});
  faults.add("hash-without-shift", "the hash of random numbers leaves out its shift", plain_scene,
             shader_edits(edited_results("pcg4d", spv::OpShiftRightLogical, lost)), "camera", {"direction"});
  faults.add("roulette-uncompensated", "paths that survive roulette count no more for it", plain_scene,
             shader_edits(edited_calls("path_radiance", "det_div(f1;f1;", one)), "segment", {"throughput"}, 3);
  faults.add("refraction-inverted", "the index of refraction is that of the way back", glass_scene,
             shader_edits(edited_returns("relative_index", inverse)), "scatter", {"lobe", "direction"});
  faults.add("fresnel-inverted", "glass reflects what it should transmit", glass_scene,
             shader_edits(edited_returns("fresnel_dielectric", complement)), "scatter", {"lobe", "direction"});
  faults.add("cosine-missing", "light that arrives at an angle counts in full", plain_scene,
             shader_edits(edited_results("vertex_value", spv::OpExtInst, one)), "light value", {"bsdf"});
  faults.add("normal-not-flipped", "normals stay on their own side of a triangle", glass_scene,
             shader_edits(edited_results("triangle_surface", spv::OpFNegate, negated)), "surface", {"geometric normal"},
             1);
  faults.add("offset-lost", "rays start on the surface that they leave", plain_scene,
             shader_edits(edited_returns("offset_distance", zero)), "surface", {"offset"});
  faults.add("mis-weights-swapped", "light samples have the weight of scattered rays", plain_scene,
             shader_edits(edited_returns("light_sample_weight", complement)), "light value", {"weight"});
  faults.add("texture-not-repeated", "texture coordinates are clamped where they should repeat", transparent_scene,
             shader_edits(edited_results("addressed", spv::OpExtInst, zero)), "ray", {"answer"});
  faults.add_for_picture(
      "last-sample-lost", "a loop over samples ends one too early", plain_scene,
      shader_edits(edited_operand("path_trace", spv::OpULessThan, 2, [](CodeWriter& code, std::uint32_t i) {
        return code.value(spv::OpIAdd, code.module().uint_type(), {i, code.module().constant(1u)});
      })));

  faults.add_harmless("square-root-off", "square roots are one float too large", plain_scene,
                      shader_edits(edited_returns("det_sqrt", next_float)), Finder::picture);
  faults.add_harmless("division-off", "quotients are one float too large", plain_scene,
                      shader_edits(edited_results("det_div", spv::OpFDiv, next_float)), Finder::picture);
  faults.add_harmless("contracted", "products and sums of dot and cross products are rounded once", plain_scene,
                      shader_edits(contract), Finder::picture);
  faults.add_harmless("reassociated", "dot products are added up from behind", plain_scene, shader_edits(reassociate),
                      Finder::picture);
  return faults.take();
}

}  // namespace tandem::test
