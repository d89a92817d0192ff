#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>

#include <spirv_cross/spirv.hpp>

/// A SPIR-V module as words, whose lengths check_spirv_words() has passed.
namespace tandem::rhi {

inline constexpr std::size_t spirv_header_words = 5;

/// Calls visit(instruction) for each instruction, a span of its words.
template <typename Word, typename Visit>
void for_each_instruction(std::span<Word> spirv, const Visit& visit) {
  for (std::size_t i = spirv_header_words; i < spirv.size(); i += spirv[i] >> 16)
    visit(spirv.subspan(i, spirv[i] >> 16));
}

inline spv::Op operation_of(std::span<const std::uint32_t> instruction) {
  return static_cast<spv::Op>(instruction[0] & 0xffff);
}

}  // namespace tandem::rhi
