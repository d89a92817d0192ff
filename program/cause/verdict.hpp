#pragma once

#include <optional>
#include <span>
#include <string>

#include "program/cause/permitted.hpp"

/// Two devices' scalars, held against what is permitted.
namespace tandem::program {

struct Verdict {
  Cause cause = Cause::equal;
  bool a_wrong = false, b_wrong = false;
  std::optional<double> error_a = {}, error_b = {}, allowed = {};  ///< as in Judgement
  std::string reason = {};
};

/// @param operation a noun for the reason: "sqrt", "a division"
Verdict verdict_of(const Permitted& permitted, const std::string& operation, const Scalar& a, const Scalar& b);

/// Whether they differ by no more than the sign of zero or the bits of a NaN.
bool are_alike(const Scalar& a, const Scalar& b);

/// "sqrt", "a division"; "the result" of what has no shorter name.
std::string operation_name(const Instruction& instruction, std::uint32_t glsl);

}  // namespace tandem::program
