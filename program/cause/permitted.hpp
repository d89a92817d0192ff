#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "program/cause/judgement.hpp"
#include "program/cause/number/range.hpp"
#include "program/cause/number/scalar.hpp"

/// What the specifications permit an instruction's result to be, scalar by scalar.
namespace tandem::program {

struct Permitted {
  Scalar expected = {};                    ///< the exact result, correctly rounded
  bool has_expected = true;                ///< false: only its kind and width
  std::vector<std::uint64_t> others = {};  ///< not of floats: bits that are as good
  std::vector<Range> ranges = {};          ///< of floats: what lies in one of them
  Rules rules = {};                        ///< of floats
  bool open = false;                       ///< anything is within precision
  bool undefined = false;
  std::string reason = {};  ///< of others, open, undefined: a clause
};

using Permissions = std::vector<Permitted>;

/// An instruction and what it got.
struct Call {
  const Module& module;
  const Instruction& instruction;
  std::uint32_t glsl = 0;                        ///< of GLSL.std.450
  std::vector<std::uint32_t> ids;                ///< of the operands, without the set of an OpExtInst
  std::vector<std::optional<Scalars>> operands;  ///< nothing for what is not recorded
  std::vector<Component> result;
  const ValueLookup& lookup;

  /// @pre it is recorded
  const Scalars& operand(std::size_t i) const { return *operands[i]; }
  /// A scalar of an operand; a scalar stands for all components of a vector.
  const Scalar& operand(std::size_t i, std::size_t component) const {
    return operand(i)[operand(i).size() == 1 ? 0 : component];
  }
  Scalar result_scalar(std::size_t i) const { return {result[i].kind, result[i].width}; }
};

inline constexpr const char* undefined_operand = "an operand is undefined (OpUndef)";

Permitted exactly_this(const Scalar& expected);
Permitted undefined(const Scalar& like, std::string reason);

/// A float that an instruction moves: NaN, infinities and the sign of zero count where the rules keep them.
Permitted moved_float(const Rules& rules, const Scalar& value);

/// Operands by position.
using Formula = std::function<Range(const Rules& rules, std::span<const Range> operands)>;

/// A float that a formula makes of floats, with denormal operands flushed or not.
Permitted computed(const Rules& rules, std::uint32_t width, std::span<const Scalar> operands, const Formula& formula);

/// A value that is not a float, but depends on floats: of every choice of flushed denormals.
/// @param decide gives the bits
Permitted decided(const Rules& rules, const Scalar& like, std::span<const Scalar> operands,
                  const std::function<std::uint64_t(std::span<const Real>)>& decide);

// Each knows some instructions, and has nothing for others. All operands that are values are there, but for OpPhi's.
std::optional<Permissions> permitted_integers(const Call& call);
std::optional<Permissions> permitted_extended_integers(const Call& call);
std::optional<Permissions> permitted_moves(const Call& call);
std::optional<Permissions> permitted_conversions(const Call& call);
std::optional<Permissions> permitted_float_arithmetic(const Call& call);
std::optional<Permissions> permitted_comparisons(const Call& call);
std::optional<Permissions> permitted_products(const Call& call);
std::optional<Permissions> permitted_glsl_common(const Call& call);
std::optional<Permissions> permitted_glsl_functions(const Call& call);
std::optional<Permissions> permitted_glsl_geometry(const Call& call);
std::optional<Permissions> permitted_glsl_matrices(const Call& call);
std::optional<Permissions> permitted_glsl_packing(const Call& call);

}  // namespace tandem::program
