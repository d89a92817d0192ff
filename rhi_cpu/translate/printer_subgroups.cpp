// Subgroup operations (kernel/subgroups.hpp), of which those that ask other invocations go through an invocation's
// k::Lane.

#include <algorithm>
#include <iterator>

#include <fmt/format.h>

#include "rhi/spirv/names.hpp"
#include "rhi_cpu/translate/groups/places.hpp"
#include "rhi_cpu/translate/printer.hpp"

namespace tandem::cpu {

using spirv_cross::SPIRConstant;
using spirv_cross::SPIRType;

namespace {

/// What a subgroup operation becomes. Its operands are counted behind the scope, which SPV_KHR_shader_ballot and
/// SPV_KHR_subgroup_vote do not have.
enum class SubgroupShape : std::uint8_t {
  elect,       ///< whether the lane is the lowest
  agree,       ///< lane.agree<k::text>(a)
  arithmetic,  ///< lane.apply<k::Reduction<k::text, size>>(a), or a scan
  exchange,    ///< lane.exchange(a, text), where text says of which lane: {0} is its own number, {1} the operand b, {2}
               ///< the size of a cluster
  ballot       ///< text, of the ballot {1}: {0} is the lane's own number, {2} the operand b, {3} a subgroup's size
};

struct SubgroupOperation {
  spv::Op op;
  SubgroupShape shape;
  const char* text;
  Sign sign = Sign::any;
};

constexpr SubgroupOperation subgroup_operations[] = {
    {spv::OpGroupNonUniformElect, SubgroupShape::elect, ""},
    {spv::OpGroupNonUniformAll, SubgroupShape::agree, "AllOf"},
    {spv::OpGroupNonUniformAny, SubgroupShape::agree, "AnyOf"},
    {spv::OpGroupNonUniformAllEqual, SubgroupShape::agree, "AllEqual"},
    {spv::OpGroupNonUniformBallot, SubgroupShape::agree, "Ballot"},
    {spv::OpGroupNonUniformBroadcastFirst, SubgroupShape::agree, "ValueOfFirst"},
    {spv::OpSubgroupAllKHR, SubgroupShape::agree, "AllOf"},
    {spv::OpSubgroupAnyKHR, SubgroupShape::agree, "AnyOf"},
    {spv::OpSubgroupAllEqualKHR, SubgroupShape::agree, "AllEqual"},
    {spv::OpSubgroupBallotKHR, SubgroupShape::agree, "Ballot"},
    {spv::OpSubgroupFirstInvocationKHR, SubgroupShape::agree, "ValueOfFirst"},

    {spv::OpGroupNonUniformIAdd, SubgroupShape::arithmetic, "Sum"},
    {spv::OpGroupNonUniformFAdd, SubgroupShape::arithmetic, "Sum"},
    {spv::OpGroupNonUniformIMul, SubgroupShape::arithmetic, "Product"},
    {spv::OpGroupNonUniformFMul, SubgroupShape::arithmetic, "Product"},
    {spv::OpGroupNonUniformSMin, SubgroupShape::arithmetic, "Least", Sign::as_signed},
    {spv::OpGroupNonUniformUMin, SubgroupShape::arithmetic, "Least", Sign::as_unsigned},
    {spv::OpGroupNonUniformFMin, SubgroupShape::arithmetic, "Least"},
    {spv::OpGroupNonUniformSMax, SubgroupShape::arithmetic, "Greatest", Sign::as_signed},
    {spv::OpGroupNonUniformUMax, SubgroupShape::arithmetic, "Greatest", Sign::as_unsigned},
    {spv::OpGroupNonUniformFMax, SubgroupShape::arithmetic, "Greatest"},
    {spv::OpGroupNonUniformBitwiseAnd, SubgroupShape::arithmetic, "And"},
    {spv::OpGroupNonUniformBitwiseOr, SubgroupShape::arithmetic, "Or"},
    {spv::OpGroupNonUniformBitwiseXor, SubgroupShape::arithmetic, "Xor"},
    {spv::OpGroupNonUniformLogicalAnd, SubgroupShape::arithmetic, "And"},
    {spv::OpGroupNonUniformLogicalOr, SubgroupShape::arithmetic, "Or"},
    {spv::OpGroupNonUniformLogicalXor, SubgroupShape::arithmetic, "Xor"},

    {spv::OpGroupNonUniformBroadcast, SubgroupShape::exchange, "{1}"},
    {spv::OpSubgroupReadInvocationKHR, SubgroupShape::exchange, "{1}"},
    {spv::OpGroupNonUniformShuffle, SubgroupShape::exchange, "{1}"},
    {spv::OpGroupNonUniformShuffleXor, SubgroupShape::exchange, "{0} ^ {1}"},
    {spv::OpGroupNonUniformShuffleUp, SubgroupShape::exchange, "{0} - {1}"},
    {spv::OpGroupNonUniformShuffleDown, SubgroupShape::exchange, "{0} + {1}"},
    {spv::OpGroupNonUniformQuadBroadcast, SubgroupShape::exchange, "k::quad_source({0}, {1})"},
    {spv::OpGroupNonUniformQuadSwap, SubgroupShape::exchange, "k::quad_neighbour({0}, {1})"},
    {spv::OpGroupNonUniformRotateKHR, SubgroupShape::exchange, "k::rotated_source({0}, {1}, {2})"},

    {spv::OpGroupNonUniformInverseBallot, SubgroupShape::ballot, "k::ballot_bit({1}, {0})"},
    {spv::OpGroupNonUniformBallotBitExtract, SubgroupShape::ballot, "k::ballot_bit({1}, {2})"},
    {spv::OpGroupNonUniformBallotFindLSB, SubgroupShape::ballot, "k::ballot_lowest<{3}>({1})"},
    {spv::OpGroupNonUniformBallotFindMSB, SubgroupShape::ballot, "k::ballot_highest<{3}>({1})"},
    {spv::OpGroupNonUniformBallotBitCount, SubgroupShape::ballot, ""},
};

const SubgroupOperation* find_subgroup_operation(spv::Op op) {
  const auto found = std::ranges::find(subgroup_operations, op, &SubgroupOperation::op);
  return found == std::end(subgroup_operations) ? nullptr : found;
}

}  // namespace

bool Printer::is_subgroup_operation(spv::Op op) { return find_subgroup_operation(op) != nullptr; }

bool Printer::is_ballot_query(spv::Op op) {
  const SubgroupOperation* operation = find_subgroup_operation(op);
  return operation != nullptr && operation->shape == SubgroupShape::ballot;
}

std::string Printer::place_words() const {
  const Place& place = marks_.places.at(place_);
  std::string text;
  for (const std::uint32_t loop : place.loops) text += fmt::format("{}u, rounds_{}, ", marks_.loops[loop].number, loop);
  return text + fmt::format("{}u", place.number);
}

std::string Printer::lane_number() const {
  if (is_wide()) return mode_ == Mode::lane ? "k::uint(lane)" : "k::lane_indices()";
  return fmt::format("(built_in_LocalInvocationIndex % {}u)", options_.subgroup_size);
}

std::string Printer::lane() const {
  if (is_wide()) return fmt::format("k::Together{{{}}}", mask_);
  return fmt::format("own_lane.at({})", place_words());
}

void Printer::print_mark(const Instruction& i) {
  const std::uint32_t index = i.operand(0) & ~mark_bit;
  if (i.op() == place_mark) {
    place_ = index;
    is_marked_ = true;
  }
  if (i.op() == loop_declaration) statement("k::uint rounds_", index, " = 0;");
  if (i.op() != round_mark) return;
  statement("++rounds_", index, ";");
  for (const std::uint32_t inner : marks_.loops.at(index).inner) statement("rounds_", inner, " = 0;");
}

void Printer::print_subgroup_operation(const Instruction& i) {
  const SubgroupOperation& operation = *find_subgroup_operation(i.op());
  const bool has_scope = rhi::instruction_name(i.op(), i.words()).starts_with("OpGroup");
  const std::size_t a = has_scope ? 1 : 0, b = a + 1;
  const std::string width = std::to_string(options_.subgroup_size);
  const std::string own = lane_number();
  uses_subgroups_ = true;
  const auto operand = [&](std::size_t k) {
    return i.operand_count() > k ? value_as(i.operand(k), SPIRType::UInt) : std::string();
  };
  switch (operation.shape) {
    case SubgroupShape::elect:
      return define(i, lane() + ".is_elected()");
    case SubgroupShape::agree: {
      const Type& type = type_of(i.operand(a));
      return define(
          i, fmt::format("{}.agree<k::{}, {}>({})", lane(), operation.text, narrow_name(type), value(i.operand(a))));
    }
    case SubgroupShape::arithmetic:
      return print_subgroup_arithmetic(i, operation.text, operation.sign);
    case SubgroupShape::exchange: {
      const std::string cluster = i.operand_count() > b + 1 ? operand(b + 1) : width + "u";
      const std::string source = fmt::format(fmt::runtime(operation.text), own, operand(b), cluster);
      return define(i, fmt::format("{}.exchange<{}>({}, {})", lane(), narrow_name(get<SPIRType>(i.result_type())),
                                   value(i.operand(a)), source));
    }
    case SubgroupShape::ballot: {
      if (i.op() == spv::OpGroupNonUniformBallotBitCount) return print_ballot_count(i);
      const std::string text =
          fmt::format(fmt::runtime(operation.text), own, value_as(i.operand(a), SPIRType::UInt), operand(b), width);
      return define(i, fmt::format("{}({})", type_name(i.result_type()), text));
    }
  }
}

void Printer::print_subgroup_arithmetic(const Instruction& i, const char* function, Sign sign) {
  const std::uint32_t kind = i.operand(1), operand = i.operand(2);
  const Type& type = get<Type>(i.result_type());
  const BaseType base = with_sign(type.basetype, sign);
  const bool is_reduction = kind == spv::GroupOperationReduce || kind == spv::GroupOperationClusteredReduce;
  const char* name = is_reduction                               ? "Reduction"
                     : kind == spv::GroupOperationInclusiveScan ? "InclusiveScan"
                     : kind == spv::GroupOperationExclusiveScan ? "ExclusiveScan"
                                                                : nullptr;
  if (name == nullptr) fail(rhi::instruction_name(i.op(), i.words()) + " of another kind than a reduction or a scan");
  const std::string cluster =
      kind == spv::GroupOperationClusteredReduce ? fmt::format(", {}u", get<SPIRConstant>(i.operand(3)).scalar()) : "";
  const std::string type_text = vector_name(base, type.vecsize);
  define_as(i,
            fmt::format("{}.apply<k::{}<k::{}, {}{}>, {}>({})", lane(), name, function, options_.subgroup_size, cluster,
                        type_text, value_as(operand, base)),
            base);
}

void Printer::print_ballot_count(const Instruction& i) {
  const std::uint32_t kind = i.operand(1);
  const std::string lanes = kind == spv::GroupOperationReduce          ? std::to_string(options_.subgroup_size)
                            : kind == spv::GroupOperationInclusiveScan ? lane_number() + " + 1"
                                                                       : lane_number();
  define(i, fmt::format("{}(k::ballot_count({}, k::lanes_below({})))", type_name(i.result_type()),
                        value_as(i.operand(2), SPIRType::UInt), lanes));
}

std::string Printer::subgroup_built_in(spv::BuiltIn built_in) {
  const std::uint32_t width = options_.subgroup_size;
  const auto mask = [&](const char* name) {
    uses_subgroups_ = true;
    if (is_wide()) return fmt::format("k::of_lanes([](k::uint lane) {{ return k::mask_{}<{}>(lane); }})", name, width);
    return fmt::format("k::mask_{}<{}>{}", name, width, lane_number());
  };
  switch (built_in) {
    case spv::BuiltInSubgroupSize:
      return fmt::format("{}u", width);
    case spv::BuiltInNumSubgroups:
      return fmt::format("{}u", (invocation_count() + width - 1) / width);
    case spv::BuiltInSubgroupId:
      return fmt::format(
          "{} / {}u", is_wide() ? "k::lane(built_in_LocalInvocationIndex, 0)" : "built_in_LocalInvocationIndex", width);
    case spv::BuiltInSubgroupLocalInvocationId:
      return lane_number();
    case spv::BuiltInSubgroupEqMask:
      return mask("equal");
    case spv::BuiltInSubgroupGeMask:
      return mask("greater_equal");
    case spv::BuiltInSubgroupGtMask:
      return mask("greater");
    case spv::BuiltInSubgroupLeMask:
      return mask("less_equal");
    case spv::BuiltInSubgroupLtMask:
      return mask("less");
    default:
      return {};
  }
}

}  // namespace tandem::cpu
