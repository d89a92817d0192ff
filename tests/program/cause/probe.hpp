#pragma once

#include <bit>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string>
#include <vector>

#include "program/cause/judge.hpp"
#include "program/record/module.hpp"

/// Judgements about one instruction of a small shader.
namespace tandem::program::testing {

using Words = std::vector<std::uint32_t>;

template <typename... Floats>
Words floats(Floats... values) {
  return {std::bit_cast<std::uint32_t>(static_cast<float>(values))...};
}

template <typename... Integers>
Words integers(Integers... values) {
  return {static_cast<std::uint32_t>(values)...};
}

/// 64-bit floats or integers.
template <typename... Values>
Words wide(Values... values) {
  Words words;
  for (const std::uint64_t bits : {std::bit_cast<std::uint64_t>(values)...}) {
    words.push_back(static_cast<std::uint32_t>(bits));
    words.push_back(static_cast<std::uint32_t>(bits >> 32));
  }
  return words;
}

/// What a shader's text lacks.
struct Extras {
  std::vector<std::pair<spv::ExecutionMode, std::uint32_t>> modes = {};  ///< with the width
  std::vector<spv::Decoration> decorations = {};                         ///< of the result
};

class Probe {
 public:
  /// @param operands the members of a buffer: "float x; vec3 v;"
  /// @param result   the type of the expression, which the shader stores
  /// @param op       of the instruction; @param glsl of an OpExtInst
  Probe(const std::string& operands, const std::string& result, const std::string& expression, spv::Op op,
        std::uint32_t glsl = 0, const Extras& extras = {});

  /// The same operands for another instruction, which GLSL does not have.
  Probe with(spv::Op op) const;

  /// @param operands of the ids that are values, in order
  Judgement operator()(const std::vector<Words>& operands, const Words& a, const Words& b,
                       const ValueLookup& lookup = {}) const;

  const Module& module() const { return module_; }
  const Instruction& instruction() const { return instruction_; }

 private:
  Module module_;
  Instruction instruction_;
};

/// Whether the judgement is a mismatch of this device.
bool blames(const Judgement& judgement, WrongDevice device);

bool is_within(const Judgement& judgement);
bool is_undefined(const Judgement& judgement);

/// The float that is `steps` floats further away from minus infinity.
float moved(float value, int steps);
double moved(double value, int steps);

/// Random numbers, the same in every run.
class Random {
 public:
  std::uint32_t word();
  std::uint64_t long_word() { return std::uint64_t{word()} << 32 | word(); }
  /// Of both signs, with exponents in [-range, range].
  float real(int range);
  double long_real(int range);
  float between(float low, float high);

 private:
  std::uint64_t state_ = 0x9e3779b97f4a7c15u;
};

}  // namespace tandem::program::testing
