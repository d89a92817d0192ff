#include "tests/fuzz/module_mutation.hpp"

#include <algorithm>
#include <cstddef>
#include <iterator>

namespace tandem::test {
namespace {

constexpr std::size_t header_words = 5;
constexpr std::size_t bound_word = 3;

using Instructions = std::vector<std::vector<std::uint32_t>>;

/// A number below `count`. The distributions of the standard library differ between its implementations.
std::size_t below(std::size_t count, std::mt19937& random) { return random() % count; }

Instructions instructions_of(std::span<const std::uint32_t> module) {
  Instructions result;
  for (std::size_t i = header_words; i < module.size(); i += module[i] >> 16) {
    const auto words = module.subspan(i, module[i] >> 16);
    result.emplace_back(words.begin(), words.end());
  }
  return result;
}

std::uint32_t other_word(std::uint32_t word, std::uint32_t id_bound, std::mt19937& random) {
  constexpr std::uint32_t extremes[] = {0, 1, 0x7fffffff, 0x80000000, 0xffffffff, 0x3fffff, 1u << 24, 0x7fc00000};
  switch (below(6, random)) {
    case 0:
      return word ^ 1u << below(32, random);
    case 1:
      return word + 1;
    case 2:
      return word - 1;
    case 3:
      return extremes[below(std::size(extremes), random)];
    default:
      return static_cast<std::uint32_t>(below(id_bound, random));
  }
}

void damage(Instructions& instructions, std::uint32_t id_bound, std::mt19937& random) {
  if (instructions.size() < 2) return;
  const std::size_t at = below(instructions.size() - 1, random);
  std::vector<std::uint32_t>& instruction = instructions[at];
  switch (below(10, random)) {
    case 0:
      instructions.erase(instructions.begin() + static_cast<std::ptrdiff_t>(at));
      return;
    case 1: {
      const std::vector<std::uint32_t> copy = instruction;
      instructions.insert(instructions.begin() + static_cast<std::ptrdiff_t>(at), copy);
      return;
    }
    case 2:
      std::swap(instructions[at], instructions[at + 1]);
      return;
    case 3:
      if (instruction.size() > 1) {
        instruction.pop_back();
        instruction[0] -= 1u << 16;
      }
      return;
    default: {
      std::uint32_t& word = instruction[below(instruction.size(), random)];
      word = other_word(word, id_bound, random);
      return;
    }
  }
}

}  // namespace

std::vector<std::uint32_t> mutated(std::span<const std::uint32_t> module, std::mt19937& random) {
  std::vector<std::uint32_t> header(module.begin(), module.begin() + header_words);
  Instructions instructions = instructions_of(module);
  const std::size_t damages = 1 + below(3, random);
  for (std::size_t i = 0; i < damages; ++i) {
    if (below(64, random) != 0) {
      damage(instructions, module[bound_word], random);
      continue;
    }
    std::uint32_t& word = header[below(header_words, random)];
    word = other_word(word, module[bound_word], random);
  }
  for (const std::vector<std::uint32_t>& instruction : instructions)
    header.insert(header.end(), instruction.begin(), instruction.end());
  return header;
}

}  // namespace tandem::test
