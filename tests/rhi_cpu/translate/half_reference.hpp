#pragma once

#include <cstdint>

/// IEEE 754 binary16 by its definition, in double, without the code that it tests.
namespace tandem::test {

double half_value(std::uint16_t bits);

/// The nearest binary16, halves to even. A NaN is 0x7e00.
std::uint16_t nearest_half(double value);

/// The value of the nearest binary16.
inline double rounded_to_half(double value) { return half_value(nearest_half(value)); }

bool is_half_nan(std::uint16_t bits);

/// How many binary16 lie between two of them; 0 for two NaNs, large for one.
int half_distance(std::uint16_t a, std::uint16_t b);

}  // namespace tandem::test
