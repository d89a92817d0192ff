#include "program/lockstep/circumstances.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <string>

#include "program/lockstep/atomics.hpp"
#include "program/lockstep/divergence.hpp"
#include "program/lockstep/ray_arbiter.hpp"

namespace tandem::program {
namespace {

Judgement judgement(Cause cause, std::string reason) {
  return {.cause = cause,
          .wrong = cause == Cause::mismatch ? WrongDevice::unknown : WrongDevice::none,
          .reason = std::move(reason)};
}

bool is_subgroup_input(int built_in) {
  switch (built_in) {
    case spv::BuiltInSubgroupSize:
    case spv::BuiltInNumSubgroups:
    case spv::BuiltInSubgroupId:
    case spv::BuiltInSubgroupLocalInvocationId:
    case spv::BuiltInSubgroupEqMask:
    case spv::BuiltInSubgroupGeMask:
    case spv::BuiltInSubgroupGtMask:
    case spv::BuiltInSubgroupLeMask:
    case spv::BuiltInSubgroupLtMask:
      return true;
    default:
      return false;
  }
}

bool is_subgroup_operation(spv::Op op) {
  return (op >= spv::OpGroupNonUniformElect && op <= spv::OpGroupNonUniformQuadSwap) ||
         op == spv::OpGroupNonUniformRotateKHR ||
         (op >= spv::OpSubgroupBallotKHR && op <= spv::OpSubgroupReadInvocationKHR);
}

/// Whether an operation asks for the value of an invocation that no subgroup has.
bool is_beyond_subgroup(const Walk& walk, const Instruction& instruction, std::uint32_t subgroup_size) {
  if (instruction.op != spv::OpGroupNonUniformShuffle && instruction.op != spv::OpGroupNonUniformBroadcast)
    return false;
  const std::optional<RecordedWords> id = walk.value_of(instruction.words[5]);
  return subgroup_size != 0 && id && id->words[0] >= subgroup_size;
}

bool is_filtered(spv::Op op) {
  return (op >= spv::OpImageSampleImplicitLod && op <= spv::OpImageSampleProjDrefExplicitLod) ||
         op == spv::OpImageGather || op == spv::OpImageDrefGather;
}

/// The result against what it should be.
Judgement against(const RecordedWords& expected, const Divergence& difference, std::string reason) {
  Judgement result = judgement(Cause::mismatch, std::move(reason));
  const bool a = difference.a.words == expected.words, b = difference.b.words == expected.words;
  result.wrong = a ? WrongDevice::b : b ? WrongDevice::a : WrongDevice::both;
  result.expected = expected;
  return result;
}

/// Whether an index on the way to a value lies outside of its array, matrix or vector.
bool is_out_of_bounds(const Walk& walk, std::uint32_t pointer) {
  const Module& module = walk.shader().module;
  const auto found = module.definitions.find(pointer);
  if (found == module.definitions.end()) return false;
  const Instruction& chain = module.instructions[found->second];
  if (chain.op != spv::OpAccessChain && chain.op != spv::OpInBoundsAccessChain) return false;
  std::uint32_t type = definition(module, definition(module, chain.words[3]).type).words[3];
  for (std::size_t i = 4; i < chain.words.size(); ++i) {
    const Instruction& composite = definition(module, type);
    const std::optional<RecordedWords> index = walk.value_of(chain.words[i]);
    if (!index) return false;
    const std::uint32_t at = index->words[0];
    if (composite.op == spv::OpTypeStruct) {
      type = composite.words[2 + at];
      continue;
    }
    if ((composite.op == spv::OpTypeVector || composite.op == spv::OpTypeMatrix) && at >= composite.words[3])
      return true;
    if (composite.op == spv::OpTypeArray) {
      const Instruction& length = definition(module, composite.words[3]);
      if (length.op == spv::OpConstant && at >= length.words[3]) return true;
    }
    type = composite.words[2];
  }
  return is_out_of_bounds(walk, chain.words[3]);
}

Judgement judge_load(const Walk& walk, const Divergence& difference) {
  const Module& module = walk.shader().module;
  const Instruction& load = module.instructions[difference.instruction];
  const std::uint32_t pointer = load.words[3], variable = walk.variable_of(pointer);
  if (is_out_of_bounds(walk, pointer)) return judgement(Cause::undefined, "an index is out of bounds");
  const auto found = module.definitions.find(variable);
  if (found == module.definitions.end() || module.instructions[found->second].op != spv::OpVariable)
    return judgement(Cause::mismatch, "the devices load other values");
  const Instruction& declared = module.instructions[found->second];
  const auto storage = static_cast<spv::StorageClass>(declared.words[3]);
  const int built_in = built_in_of(module, variable);
  if (is_subgroup_input(built_in)) return judgement(Cause::device_defined, "each device forms its own subgroups");
  const bool is_passed_on = storage == spv::StorageClassRayPayloadKHR || storage == spv::StorageClassCallableDataKHR;
  if (is_passed_on && difference.parted) return judgement(Cause::order, "the ray has run other shaders");
  if (storage == spv::StorageClassInput) return judgement(Cause::mismatch, "an input has another value");
  if (storage != spv::StorageClassFunction && storage != spv::StorageClassPrivate)
    return judgement(Cause::mismatch, "memory holds another value");
  const bool has_initializer = declared.words.size() > 4;
  const std::optional<std::size_t> store = walk.last_store(pointer);
  if (!store && !has_initializer && !walk.was_passed(variable))
    return judgement(Cause::undefined, "nothing has been stored into the variable");
  if (store && module.instructions[*store].words[1] == variable && pointer == variable)
    if (const std::optional<RecordedWords> stored = walk.value_of(module.instructions[*store].words[2]))
      return against(*stored, difference, "the variable holds another value than was stored");
  return judgement(Cause::mismatch, "the variable holds another value");
}

/// Whether the pointer leads into shared memory that no store of the shader ever writes.
bool is_never_stored(const Walk& walk, std::uint32_t pointer) {
  const Module& module = walk.shader().module;
  const std::uint32_t variable = walk.variable_of(pointer);
  const auto found = module.definitions.find(variable);
  if (found == module.definitions.end()) return false;
  const Instruction& declared = module.instructions[found->second];
  if (declared.op != spv::OpVariable || declared.words[3] != spv::StorageClassWorkgroup || declared.words.size() > 4)
    return false;
  return std::ranges::none_of(module.instructions, [&](const Instruction& instruction) {
    return instruction.op == spv::OpStore && walk.variable_of(instruction.words[1]) == variable;
  });
}

/// Whether floats lie within `bound` of each other, relative to the larger and to 1.
bool is_near(const Divergence& difference, float bound) {
  for (std::size_t i = 0; i < difference.a.words.size(); ++i) {
    if (difference.a.components[i].kind != ComponentKind::floating) return false;
    const float a = std::bit_cast<float>(difference.a.words[i]), b = std::bit_cast<float>(difference.b.words[i]);
    if (!(std::fabs(a - b) <= bound * std::max({1.0f, std::fabs(a), std::fabs(b)}))) return false;
  }
  return true;
}

/// Filters may weigh texels with as few as 4 bits of the coordinates' fractions (VkPhysicalDeviceLimits::
/// subTexelPrecisionBits), and 8 on every device that we know of; a sum of weighted texels errs by as much.
constexpr float filter_bound = 0x1p-6f;
/// A normalised texel is a quotient of whole numbers: it may be off by a few units in the last place.
constexpr float texel_bound = 0x1p-21f;

}  // namespace

Judgement judge_by_circumstances(const Walk& walk, const Divergence& difference, const Circumstances& circumstances) {
  const Judgement& own = difference.judgement;
  const Module& module = walk.shader().module;
  const spv::Op op = module.instructions[difference.instruction].op;
  if (difference.is_address) return judgement(Cause::device_defined, "an address");
  if (op == spv::OpReadClockKHR) return judgement(Cause::device_defined, "a clock");
  if (own.cause != Cause::mismatch || own.wrong != WrongDevice::unknown) return own;
  if ((op == spv::OpImageRead || op == spv::OpImageFetch) && is_near(difference, texel_bound))
    return judgement(Cause::within_precision, "a normalised texel may round");
  if (const auto wrong = circumstances.wrong_atomics.find({difference.shader, difference.instruction});
      wrong != circumstances.wrong_atomics.end()) {
    Judgement result = judgement(Cause::mismatch, "in no order of the invocations do the old values follow each other");
    result.wrong = wrong->second;
    return result;
  }
  if (op == spv::OpLoad && !circumstances.wrong_atomics.empty() &&
      variables_of(circumstances.wrong_atomics)
          .contains({difference.shader, walk.variable_of(module.instructions[difference.instruction].words[3])}))
    return judgement(Cause::order, "a wrong atomic wrote it");
  const bool is_atomic = op >= spv::OpAtomicLoad && op <= spv::OpAtomicXor && op != spv::OpAtomicStore;
  if ((op == spv::OpLoad || is_atomic) && is_never_stored(walk, module.instructions[difference.instruction].words[3]))
    return judgement(Cause::undefined, "shared memory begins with any value, and nothing stores another");
  if (circumstances.order_dependent.contains({difference.shader, difference.instruction}))
    return judgement(Cause::order, "the result depends on the order of the invocations");
  if (is_subgroup_operation(op) && !circumstances.same_subgroups)
    return judgement(Cause::device_defined, "the devices' subgroups have other sizes");
  if (is_beyond_subgroup(walk, module.instructions[difference.instruction], circumstances.subgroup_size))
    return judgement(Cause::undefined, "the subgroup has no such invocation");
  if (is_filtered(op))
    return is_near(difference, filter_bound) ? judgement(Cause::within_precision, "filters may round their weights")
                                             : judgement(Cause::mismatch, "more than filters may differ");
  if (circumstances.rays != nullptr)
    if (std::optional<Judgement> of_ray = circumstances.rays->judge(walk, difference)) return *of_ray;
  if (op == spv::OpLoad) return judge_load(walk, difference);
  return own;
}

}  // namespace tandem::program
