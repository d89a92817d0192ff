#pragma once

#include <cstdint>
#include <initializer_list>
#include <vector>

#include "program/record/code.hpp"
#include "program/record/segment.hpp"

namespace tandem::program {

/// Writes the instructions that record, between those of the module. The pieces of a block are called in the order of
/// their declaration.
class ProbeCode {
 public:
  /// @param code outlives the probes
  ProbeCode(Code& code, RecordForm form, spv::ExecutionModel model, std::uint32_t set, std::uint32_t binding);

  /// The input that tells invocations apart: GlobalInvocationId, or LaunchId.
  std::uint32_t id_input() const noexcept { return id_input_; }

  /// At the beginning of the entry point: whether and where this invocation records.
  /// @param id the input, or a variable in its place; `storage` is its class
  void begin_entry(std::uint32_t id, spv::StorageClass storage);
  /// Takes `words` words for the segment, and writes its number.
  void begin_segment(std::uint32_t number, std::uint32_t words);
  /// Writes the result of an instruction that stands in front. Lockstep: `replacement` becomes the other device's
  /// result, unless it is 0.
  void record(const Module& module, const Instruction& instruction, const RecordedValue& value,
              std::uint32_t replacement);
  /// In front of a call or of the block's end. @param leaves the invocation ends here
  void end_segment(bool leaves);
  /// Behind a call that has run other shaders: where their record has ended goes into the word `link` of the segment.
  /// Lockstep: the record goes on where the other device's did, whatever was called in between.
  void resume(std::uint32_t link);

 private:
  std::uint32_t value(spv::Op op, std::uint32_t type, std::initializer_list<std::uint32_t> operands) {
    return code_.value(op, type, operands);
  }
  std::uint32_t load(std::uint32_t pointer, std::uint32_t type) { return code_.load(pointer, type); }
  void store(std::uint32_t pointer, std::uint32_t object) { code_.store(pointer, object); }
  std::uint32_t word_pointer(std::uint32_t index);
  std::uint32_t load_word(std::uint32_t index) { return load(word_pointer(index), globals_.uint_type()); }
  void store_word(std::uint32_t index, std::uint32_t word) { store(word_pointer(index), word); }
  std::uint32_t plus(std::uint32_t id, std::uint32_t constant);
  void mix(std::uint32_t word);
  std::uint32_t scalar_of(const Component& component, const std::uint32_t* words);
  std::uint32_t composite(const Module& module, std::uint32_t type, const std::uint32_t*& scalars);

  Code& code_;
  Globals& globals_;
  RecordForm form_;
  bool is_compute_;
  std::uint32_t buffer_, id_input_, word_pointer_type_;
  // Private variables.
  std::uint32_t header_ = 0;  ///< of this invocation's cursor
  std::uint32_t limit_ = 0;   ///< the word behind the slot, + 1; 0: this invocation does not record
  std::uint32_t cursor_ = 0;  ///< compute only; other stages share the cursor in memory
  std::uint32_t delta_ = 0, force_ = 0, hash_state_ = 0;
  // Of the segment.
  std::uint32_t base_ = 0, other_base_ = 0, takes_ = 0, hash_ = 0;
};

}  // namespace tandem::program
