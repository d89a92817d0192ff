#include "rhi_cpu/translate/wide/plain_copies.hpp"

#include <unordered_map>

#include <spirv_cross/spirv.hpp>

#include "rhi/spirv/words.hpp"
#include "rhi_cpu/translate/instructions/instruction.hpp"

namespace tandem::cpu {

std::vector<std::uint32_t> with_plain_copies(std::span<const std::uint32_t> spirv) {
  std::vector<std::uint32_t> words(spirv.begin(), spirv.begin() + rhi::spirv_header_words);
  std::unordered_map<std::uint32_t, std::uint32_t> pointees;  // of pointer types
  std::unordered_map<std::uint32_t, std::uint32_t> types;     // of results
  std::uint32_t bound = spirv[3];
  rhi::for_each_instruction(spirv, [&](std::span<const std::uint32_t> i) {
    const spv::Op op = rhi::operation_of(i);
    if (op == spv::OpTypePointer) pointees[i[1]] = i[3];
    if (Instruction(op, i.subspan(1)).has_result()) types[i[2]] = i[1];
    if (op != spv::OpCopyMemory) {
      words.insert(words.end(), i.begin(), i.end());
      return;
    }
    // What it says of alignment and of who else sees the memory means nothing here.
    const std::uint32_t to = i[1], from = i[2], value = bound++;
    words.insert(words.end(), {4u << 16 | spv::OpLoad, pointees.at(types.at(from)), value, from});
    words.insert(words.end(), {3u << 16 | spv::OpStore, to, value});
  });
  words[3] = bound;
  return words;
}

}  // namespace tandem::cpu
