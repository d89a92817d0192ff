#pragma once

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>
#include <string>
#include <string_view>

/// How a case says what it saw. The first check that does not hold ends the case.
namespace tandem::conformance {

/// The device's answer is not what it must be: one sentence of what was expected and what came.
class Failure : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The device cannot run the case, for a reason that no bit of rhi::Capabilities tells (a limit): one sentence.
class Unsupported : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Throws Failure with `sentence` unless `holds`.
inline void check(bool holds, const std::string& sentence) {
  if (!holds) throw Failure(sentence);
}

/// Throws Failure unless both are equal: ids, flags, counts.
template <typename Seen, typename Expected>
void check_equal(std::string_view what, const Seen& seen, const Expected& expected) {
  if (!(seen == static_cast<Seen>(expected)))
    throw Failure(fmt::format("{} is {}, expected {}", what, seen, static_cast<Seen>(expected)));
}

/// Of t, barycentrics and all that is computed with 32-bit floats (docs/internals/rhi-contract.md). The expected value
/// is computed with doubles.
inline constexpr double tolerance = 1e-5;

/// Throws Failure unless |seen - expected| <= tolerance * scale. `scale` is the magnitude that rounding errors are
/// relative to: |expected| for a t, 1 for a barycentric coordinate, the length of a vector for its components.
inline void check_close(std::string_view what, double seen, double expected, double scale) {
  if (!(std::abs(seen - expected) <= tolerance * scale))
    throw Failure(fmt::format("{} is {:.9g}, expected {:.9g}", what, seen, expected));
}
inline void check_close(std::string_view what, double seen, double expected) {
  check_close(what, seen, expected, std::abs(expected));
}

}  // namespace tandem::conformance
