#include "tests/program/cause/probe.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "program/cause/environment.hpp"
#include "rhi/glsl/compile.hpp"

namespace tandem::program::testing {
namespace {

std::string shader_of(const std::string& operands, const std::string& result, const std::string& expression) {
  return R"(#version 460
#extension GL_EXT_shader_explicit_arithmetic_types : require
layout(local_size_x = 1) in;
layout(set = 0, binding = 0) buffer Operands { )" +
         operands + R"( };
layout(set = 0, binding = 1) buffer Result { )" +
         result + R"( result; };
void main() { result = )" +
         expression + "; }\n";
}

const Instruction& find(const Module& module, spv::Op op, std::uint32_t glsl) {
  for (std::size_t i = module.first_function; i < module.instructions.size(); ++i) {
    const Instruction& each = module.instructions[i];
    if (each.op == op && (glsl == 0 || glsl_instruction(module, each) == glsl)) return each;
  }
  throw std::runtime_error("the shader lacks the instruction");
}

/// Puts instructions in front of the first one with this opcode.
void insert_before(std::vector<std::uint32_t>& spirv, spv::Op op, const std::vector<std::uint32_t>& words) {
  std::size_t at = 5;
  while ((spirv[at] & 0xffff) != static_cast<std::uint32_t>(op)) at += spirv[at] >> 16;
  spirv.insert(spirv.begin() + static_cast<std::ptrdiff_t>(at), words.begin(), words.end());
}

}  // namespace

Probe::Probe(const std::string& operands, const std::string& result, const std::string& expression, spv::Op op,
             std::uint32_t glsl, const Extras& extras) {
  std::vector<std::uint32_t> spirv =
      glsl::compile(shader_of(operands, result, expression), rhi::ShaderStage::compute, expression);
  module_ = parse_module(spirv, expression);
  instruction_ = find(module_, op, glsl);
  if (extras.modes.empty() && extras.decorations.empty()) return;
  const std::uint32_t entry =
      std::find_if(module_.instructions.begin(), module_.instructions.end(), [](const Instruction& i) {
        return i.op == spv::OpEntryPoint;
      })->words[2];
  for (const auto& [mode, width] : extras.modes)
    insert_before(spirv, spv::OpExecutionMode, {4 << 16 | spv::OpExecutionMode, entry, mode, width});
  for (const spv::Decoration decoration : extras.decorations)
    insert_before(spirv, spv::OpDecorate, {3 << 16 | spv::OpDecorate, instruction_.result, decoration});
  module_ = parse_module(spirv, expression);
  instruction_ = find(module_, op, glsl);
}

Probe Probe::with(spv::Op op) const {
  Probe other = *this;
  other.instruction_.op = op;
  other.instruction_.words[0] = (other.instruction_.words[0] & 0xffff0000u) | static_cast<std::uint32_t>(op);
  return other;
}

Judgement Probe::operator()(const std::vector<Words>& operands, const Words& a, const Words& b,
                            const ValueLookup& lookup) const {
  std::vector<std::optional<RecordedWords>> given;
  std::size_t next = 0;
  for (const std::uint16_t used : instruction_.used_ids) {
    const std::uint32_t type = definition(module_, instruction_.words[used]).type;
    const auto components = components_of(module_, type);
    if (!components) {
      given.emplace_back();
      continue;
    }
    given.push_back(RecordedWords{*components, operands.at(next)});
    if (operands[next++].size() != word_count(*components)) throw std::runtime_error("an operand has another size");
  }
  const auto result = components_of(module_, instruction_.type).value();
  return judge(module_, instruction_, given, {result, a}, {result, b}, lookup);
}

bool blames(const Judgement& judgement, WrongDevice device) {
  return judgement.cause == Cause::mismatch && judgement.wrong == device;
}

bool is_within(const Judgement& judgement) {
  return judgement.cause == Cause::within_precision && judgement.wrong == WrongDevice::none &&
         !judgement.reason.empty();
}

bool is_undefined(const Judgement& judgement) {
  return judgement.cause == Cause::undefined && judgement.wrong == WrongDevice::none && !judgement.reason.empty();
}

float moved(float value, int steps) {
  for (; steps > 0; --steps) value = std::nextafter(value, INFINITY);
  for (; steps < 0; ++steps) value = std::nextafter(value, -INFINITY);
  return value;
}

double moved(double value, int steps) {
  for (; steps > 0; --steps) value = std::nextafter(value, static_cast<double>(INFINITY));
  for (; steps < 0; ++steps) value = std::nextafter(value, -static_cast<double>(INFINITY));
  return value;
}

std::uint32_t Random::word() {
  state_ = state_ * 6364136223846793005u + 1442695040888963407u;
  return static_cast<std::uint32_t>(state_ >> 32);
}

float Random::real(int range) {
  const int exponent = static_cast<int>(word() % static_cast<std::uint32_t>(2 * range + 1)) - range;
  const float mantissa = std::bit_cast<float>((word() & 0x807fffffu) | 0x3f800000u);
  return std::ldexp(mantissa, exponent);
}

double Random::long_real(int range) {
  const int exponent = static_cast<int>(word() % static_cast<std::uint32_t>(2 * range + 1)) - range;
  const double mantissa = std::bit_cast<double>((long_word() & 0x800fffffffffffffu) | 0x3ff0000000000000u);
  return std::ldexp(mantissa, exponent);
}

float Random::between(float low, float high) {
  return low + (high - low) * (static_cast<float>(word() >> 8) * 0x1p-24f);
}

}  // namespace tandem::program::testing
