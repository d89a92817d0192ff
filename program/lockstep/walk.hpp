#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "program/cause/judgement.hpp"
#include "program/lockstep/recorded_launch.hpp"
#include "program/record/recording.hpp"

namespace tandem::program {

/// What the operands of an instruction held, by Instruction::used_ids.
struct OperandValues {
  std::size_t instruction = 0;  ///< position in the module's instructions
  std::vector<std::optional<RecordedWords>> values;
};

/// Goes through what one invocation recorded, segment by segment, and knows at each point what every id holds.
class Walk {
 public:
  /// @param launch, slot outlive the walk
  Walk(const RecordedLaunch& launch, const SlotView& slot);

  /// Goes to the next segment; false at the end of the record.
  bool next();

  const RecordedShader& shader() const noexcept { return *place_.shader; }
  const Segment& segment() const noexcept { return *place_.segment; }
  std::uint32_t number() const noexcept { return number_; }
  /// Of the segment's number in the slot's words.
  std::size_t position() const noexcept { return position_; }
  /// Whether a shader begins with this segment.
  bool begins_shader() const noexcept { return begins_shader_; }
  /// How many shaders and functions are running.
  std::size_t depth() const noexcept;
  /// Shaders that other shaders call are inside of the one that calls them.
  std::size_t shader_depth() const noexcept { return frames_.size(); }

  /// The words that a value of this segment recorded.
  RecordedWords words_of(const RecordedValue& value) const;

  /// Makes known what the instruction holds. Called for every instruction of the segment in turn, behind the judgement
  /// about it: in a loop its operands may have its own last value.
  void pass(std::size_t instruction);

  /// What an id of the shader holds: a constant, or its latest value. Nothing for one that is not recorded.
  std::optional<RecordedWords> value_of(std::uint32_t id) const;

  /// The last OpStore into the variable that a pointer points into, by position in the module's instructions; nothing
  /// where the shader has not stored into it, or another shader has.
  std::optional<std::size_t> last_store(std::uint32_t pointer) const;
  /// Whether a pointer into the variable has been given to a function, which may have stored into it.
  bool was_passed(std::uint32_t variable) const { return frames_.back().passed.contains(variable); }

  /// The operands (by Instruction::used_ids) of the last OpRayQueryInitialize of a query; nothing before it.
  const OperandValues* query_ray(std::uint32_t query) const;
  /// The operands of the OpTraceRay that runs this shader; nothing in a ray generation shader. `caller` becomes the
  /// shader that has it.
  const OperandValues* traced_ray(const RecordedShader*& caller) const;

  /// The variable that a pointer points into, also through parameters of functions.
  std::uint32_t variable_of(std::uint32_t pointer) const;

 private:
  struct Frame {
    const RecordedShader* shader = nullptr;
    std::size_t resumes_at = 0;  ///< the position where the shader that called this one goes on
    std::unordered_map<std::uint32_t, std::size_t> positions;    ///< by id: its latest words
    std::unordered_map<std::uint32_t, std::uint32_t> arguments;  ///< a parameter that is a constant: its id
    std::unordered_map<std::uint32_t, std::size_t> stores;       ///< by variable: the last OpStore
    std::vector<std::uint32_t> calls;                            ///< the OpFunctionCalls that are running
    std::unordered_set<std::uint32_t> passed;                    ///< variables into which functions have got a pointer
    std::unordered_map<std::uint32_t, OperandValues> queries;    ///< by variable: what it was initialised with
    OperandValues traced;                                        ///< of the last OpTraceRay
    std::uint32_t returned = 0;                                  ///< the id that the last function returned
  };

  OperandValues operands_of(std::size_t instruction) const;
  void enter_function(const Instruction& call);

  const RecordedLaunch& launch_;
  SlotView slot_;
  std::size_t position_ = 0, next_position_ = 0;
  std::uint32_t number_ = 0;
  bool begins_shader_ = false;
  SegmentPlace place_;
  std::vector<Frame> frames_;
  std::optional<std::size_t> resumes_at_;  ///< of the segment before, which called shaders
};

/// The built-in of spv::BuiltIn that a variable is decorated as, or -1.
int built_in_of(const Module& module, std::uint32_t variable);

/// The value of a constant; nothing for any other id. Null and undefined composites are zeros.
std::optional<RecordedWords> constant_value(const Module& module, std::uint32_t id);

}  // namespace tandem::program
