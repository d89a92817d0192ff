#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "program/record/components.hpp"

/// What is said of two results of an instruction.
namespace tandem::program {

enum class Cause : std::uint8_t {
  equal,
  within_precision,  ///< both results lie within what the Vulkan specification allows for the instruction
  tie,               ///< a ray with two right answers
  order,             ///< an atomic or a race: a device differs from itself under another schedule
  undefined,         ///< the specification leaves the result open: uninitialised, out of bounds, division by zero, ...
  device_defined,    ///< every device has its own: addresses, clocks, the size of subgroups
  mismatch           ///< one device is wrong
};

inline constexpr std::size_t cause_count = 7;

/// "within precision", "device defined" and so on.
std::string_view name_of(Cause cause);

enum class WrongDevice : std::uint8_t { none, a, b, both, unknown };

struct Judgement {
  Cause cause = Cause::mismatch;
  WrongDevice wrong = WrongDevice::unknown;  ///< none unless `cause` is mismatch
  /// The correctly rounded result, where there is one.
  std::optional<RecordedWords> expected = {};
  /// Of the component that decides: the distance of each device's result from the exact one, and what is allowed, in
  /// units in the last place of the exact result. Floats only.
  std::optional<double> error_a = {}, error_b = {}, allowed = {};
  std::string reason = {};  ///< a clause: "sqrt may err by 4.5 ulp", "the divisor is 0"
};

/// What an id of the module holds; nothing for what is not recorded.
using ValueLookup = std::function<std::optional<RecordedWords>(std::uint32_t id)>;

}  // namespace tandem::program
