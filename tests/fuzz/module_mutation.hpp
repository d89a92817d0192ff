#pragma once

#include <cstdint>
#include <random>
#include <span>
#include <vector>

namespace tandem::test {

/// The module with one to three small damages: words and ids replaced by others or by extreme values, instructions left
/// out, doubled, exchanged or cut short. The same for the same state of `random` on every machine.
std::vector<std::uint32_t> mutated(std::span<const std::uint32_t> module, std::mt19937& random);

}  // namespace tandem::test
