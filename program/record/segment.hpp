#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "program/record/components.hpp"

/// What a shader that records writes, and in which order.
namespace tandem::program {

enum class RecordForm : std::uint8_t {
  record,    ///< writes every result
  lockstep,  ///< writes every result, and goes on with the one that another device wrote in its place
  hash       ///< writes one word for all results of an invocation
};

struct RecordOptions {
  RecordForm form = RecordForm::record;
  std::uint32_t set = 0;  ///< of the buffer, which no shader of the pipeline uses
  std::uint32_t binding = 0;
  std::uint32_t first_segment = 0;  ///< the number of this module's first segment
  bool mirrored = false;            ///< the first invocation does the work of the last (Mirror)
};

/// The result of an instruction.
struct RecordedValue {
  std::size_t instruction = 0;  ///< position in Module::instructions
  std::uint32_t offset = 0;     ///< of its first word, from the segment's first one on
  std::vector<Component> components = {};
  bool is_address = false;  ///< or what one is made of: another on each device, and never taken over
};

/// A stretch of a block that is executed as a whole: from its beginning, or from a call on, to the next call or its
/// end. It is recorded as its number, then the values.
struct Segment {
  std::size_t first_instruction = 0;  ///< position in Module::instructions: the OpLabel, or the call
  std::size_t end_instruction = 0;    ///< behind its last one: the call, or what ends the block
  std::vector<RecordedValue> values = {};
  std::uint32_t words = 1;  ///< with the number
  bool calls = false;       ///< a call that can run other shaders follows; the last word is where the record goes on
};

}  // namespace tandem::program
