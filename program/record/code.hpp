#pragma once

#include <cstdint>
#include <initializer_list>
#include <utility>
#include <vector>

#include "program/record/globals.hpp"

namespace tandem::program {

/// The instructions of a module's functions, as they are written one after the other.
class Code {
 public:
  explicit Code(Globals& globals) : globals_(globals) {}

  void append(Words words) { instructions_.push_back(std::move(words)); }
  const std::vector<Words>& instructions() const noexcept { return instructions_; }
  Globals& globals() noexcept { return globals_; }

  /// A new value. Returns its id.
  std::uint32_t value(spv::Op op, std::uint32_t type, std::initializer_list<std::uint32_t> operands) {
    Words all = {type, globals_.new_id()};
    all.insert(all.end(), operands);
    append(encode(op, all));
    return all[1];
  }
  std::uint32_t load(std::uint32_t pointer, std::uint32_t type) { return value(spv::OpLoad, type, {pointer}); }
  void store(std::uint32_t pointer, std::uint32_t object) { append(encode(spv::OpStore, {pointer, object})); }

 private:
  Globals& globals_;
  std::vector<Words> instructions_;
};

}  // namespace tandem::program
