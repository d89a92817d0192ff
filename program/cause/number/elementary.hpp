#pragma once

#include "program/cause/number/range.hpp"
#include "rhi/precision.hpp"

/// The functions of GLSL.std.450 that have a bound of their own in Vulkan's tables, and those that inherit theirs.
/// Of 16 and 32 bits: there are none of 64.
namespace tandem::program {

Range exp_of(const Rules& rules, const Range& x);
Range exp2_of(const Rules& rules, const Range& x);
Range log_of(const Rules& rules, const Range& x);
Range log2_of(const Rules& rules, const Range& x);
Range sin_of(const Rules& rules, const Range& x);
Range cos_of(const Rules& rules, const Range& x);
Range atan_of(const Rules& rules, const Range& x);
Range atan2_of(const Rules& rules, const Range& y, const Range& x);

}  // namespace tandem::program
