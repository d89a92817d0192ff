#include "program/record/instrument.hpp"

#include <algorithm>
#include <string>
#include <unordered_map>
#include <unordered_set>

#include "program/record/mirror.hpp"
#include "program/record/probe_code.hpp"
#include "rhi/error.hpp"

namespace tandem::program {
namespace {

bool is_recorded(spv::Op op) {
  switch (op) {
    case spv::OpUndef:
    case spv::OpVariable:
    case spv::OpFunction:
    case spv::OpFunctionParameter:
    case spv::OpFunctionCall:  // the callee's own instruction has the value
      return false;
    default:
      return true;
  }
}

bool is_in_block(spv::Op op) {
  return op != spv::OpFunction && op != spv::OpFunctionParameter && op != spv::OpFunctionEnd && op != spv::OpLine &&
         op != spv::OpNoLine;
}

bool calls_shaders(spv::Op op) {
  return op == spv::OpTraceRayKHR || op == spv::OpExecuteCallableKHR || op == spv::OpReportIntersectionKHR;
}

bool ends_segment(spv::Op op) { return op == spv::OpFunctionCall || calls_shaders(op); }

/// What may stand in a block before the code that begins its segment.
bool stands_first(spv::Op op) {
  return op == spv::OpPhi || op == spv::OpVariable || op == spv::OpLine || op == spv::OpNoLine || op == spv::OpUndef;
}

bool ends_block(spv::Op op) {
  switch (op) {
    case spv::OpSelectionMerge:
    case spv::OpLoopMerge:
    case spv::OpBranch:
    case spv::OpBranchConditional:
    case spv::OpSwitch:
    case spv::OpKill:
    case spv::OpReturn:
    case spv::OpReturnValue:
    case spv::OpUnreachable:
    case spv::OpTerminateInvocation:
    case spv::OpIgnoreIntersectionKHR:
    case spv::OpTerminateRayKHR:
      return true;
    default:
      return false;
  }
}

/// Ids whose value is an address, or becomes one: they are another on each device.
std::unordered_set<std::uint32_t> addresses_of(const Module& module) {
  std::unordered_set<std::uint32_t> found;
  const auto is_pointer = [&](std::uint32_t type) {
    return type != 0 && definition(module, type).op == spv::OpTypePointer;
  };
  for (std::size_t i = module.instructions.size(); i-- > module.first_function;) {
    const Instruction& instruction = module.instructions[i];
    const bool makes_address = instruction.op == spv::OpConvertUToPtr ||
                               instruction.op == spv::OpConvertUToAccelerationStructureKHR ||
                               (instruction.op == spv::OpBitcast && is_pointer(instruction.type));
    const bool is_address =
        instruction.op == spv::OpConvertPtrToU ||
        (instruction.op == spv::OpBitcast && is_pointer(definition(module, instruction.words[3]).type));
    if (is_address) found.insert(instruction.result);
    if (!makes_address && !(found.contains(instruction.result) && instruction.op != spv::OpLoad)) continue;
    for (const std::uint16_t used : instruction.used_ids) found.insert(instruction.words[used]);
  }
  return found;
}

struct Plan {
  std::vector<Segment> segments;
  std::unordered_map<std::size_t, std::size_t> segment_of;                        ///< by the instruction that begins it
  std::unordered_map<std::size_t, std::pair<std::size_t, std::size_t>> value_of;  ///< segment, position in its values
};

Plan plan_of(const Module& module) {
  Plan plan;
  const std::unordered_set<std::uint32_t> addresses = addresses_of(module);
  const auto begin = [&](std::size_t instruction) {
    plan.segment_of.emplace(instruction, plan.segments.size());
    plan.segments.push_back({.first_instruction = instruction});
  };
  for (std::size_t i = module.first_function; i < module.instructions.size(); ++i) {
    const Instruction& instruction = module.instructions[i];
    if (instruction.op == spv::OpLabel) begin(i);
    if (!plan.segments.empty() && is_in_block(instruction.op)) plan.segments.back().end_instruction = i + 1;
    if (instruction.type != 0 && is_recorded(instruction.op) && !plan.segments.empty() &&
        !calls_shaders(instruction.op)) {
      if (std::optional<std::vector<Component>> components = components_of(module, instruction.type)) {
        Segment& segment = plan.segments.back();
        plan.value_of.emplace(i, std::pair(plan.segments.size() - 1, segment.values.size()));
        const std::uint32_t words = word_count(*components);
        segment.values.push_back({i, segment.words, std::move(*components), addresses.contains(instruction.result)});
        segment.words += words;
      }
    }
    if (!ends_segment(instruction.op)) continue;
    if (calls_shaders(instruction.op)) {
      plan.segments.back().calls = true;
      ++plan.segments.back().words;
    }
    begin(i);
  }
  return plan;
}

/// Copies the module, with the probes between its instructions.
class Instrumentation {
 public:
  Instrumentation(const Module& module, const RecordOptions& options, std::string_view label)
      : module_(module),
        options_(options),
        plan_(plan_of(module)),
        entry_(entry_point(module, label)),
        globals_(module),
        code_(globals_),
        probes_(code_, options.form, model(), options.set, options.binding) {
    if (options.mirrored) mirror_.emplace(module, globals_, model());
    if (options.form != RecordForm::lockstep) return;
    for (const Segment& segment : plan_.segments)
      for (const RecordedValue& value : segment.values)
        if (!value.is_address) replaced_.emplace(module.instructions[value.instruction].result, globals_.new_id());
  }

  Recorder run() {
    for (std::size_t i = module_.first_function; i < module_.instructions.size(); ++i) visit(i);
    return {.spirv = assembled(), .segments = std::move(plan_.segments)};
  }

 private:
  static const Instruction& entry_point(const Module& module, std::string_view label) {
    for (const Instruction& instruction : module.instructions)
      if (instruction.op == spv::OpEntryPoint) {
        const auto model = static_cast<spv::ExecutionModel>(instruction.words[1]);
        if (model == spv::ExecutionModelGLCompute ||
            (model >= spv::ExecutionModelRayGenerationKHR && model <= spv::ExecutionModelCallableKHR))
          return instruction;
      }
    throw rhi::Error(rhi::ErrorCode::unsupported, label, "only compute and ray tracing shaders can be recorded");
  }

  spv::ExecutionModel model() const { return static_cast<spv::ExecutionModel>(entry_.words[1]); }

  void visit(std::size_t i) {
    const Instruction& instruction = module_.instructions[i];
    if (instruction.op == spv::OpFunction) {
      in_entry_ = instruction.result == entry_.words[2];
      is_first_block_ = true;
    }
    if (pending_ && !stands_first(instruction.op)) begin_block();
    if (ends_block(instruction.op) && is_open_) {
      const bool leaves = in_entry_ && instruction.op == spv::OpReturn;
      probes_.end_segment(leaves || instruction.op == spv::OpKill || instruction.op == spv::OpTerminateInvocation);
      is_open_ = false;
    }
    if (calls_shaders(instruction.op) || instruction.op == spv::OpFunctionCall) probes_.end_segment(false);
    code_.append(with_replaced_ids(instruction));
    if (instruction.op == spv::OpLabel) pending_ = i;
    if (const auto value = plan_.value_of.find(i); value != plan_.value_of.end()) {
      if (pending_)
        first_values_.push_back(i);  // OpPhi: recorded behind the last one
      else
        record(i);
    }
    if (!ends_segment(instruction.op)) return;
    if (calls_shaders(instruction.op)) probes_.resume(plan_.segments[plan_.segment_of.at(i) - 1].words - 1);
    begin_segment(i);
  }

  void begin_entry() {
    if (!mirror_) return probes_.begin_entry(probes_.id_input(), spv::StorageClassInput);
    mirror_->begin_entry(code_);
    probes_.begin_entry(mirror_->in_place_of(probes_.id_input()), spv::StorageClassPrivate);
  }

  void begin_block() {
    if (in_entry_ && is_first_block_) begin_entry();
    is_first_block_ = false;
    const std::size_t label = *pending_;
    pending_.reset();
    begin_segment(label);
    for (const std::size_t value : first_values_) record(value);
    first_values_.clear();
  }

  void begin_segment(std::size_t instruction) {
    const std::size_t segment = plan_.segment_of.at(instruction);
    probes_.begin_segment(options_.first_segment + static_cast<std::uint32_t>(segment), plan_.segments[segment].words);
    is_open_ = true;
  }

  void record(std::size_t i) {
    const auto [segment, position] = plan_.value_of.at(i);
    const RecordedValue& value = plan_.segments[segment].values[position];
    const Instruction& instruction = module_.instructions[i];
    const auto replacement = replaced_.find(instruction.result);
    probes_.record(module_, instruction, value, replacement != replaced_.end() ? replacement->second : 0);
  }

  Words with_replaced_ids(const Instruction& instruction) {
    Words words = instruction.words;
    for (const std::uint16_t used : instruction.used_ids)
      if (const auto found = replaced_.find(words[used]); found != replaced_.end()) words[used] = found->second;
    if (!mirror_) return words;
    const bool is_chain = instruction.op == spv::OpAccessChain || instruction.op == spv::OpInBoundsAccessChain;
    for (const std::uint16_t used : instruction.used_ids) {
      if (!mirror_->replaces(words[used])) continue;
      words[used] = mirror_->in_place_of(words[used]);
      if (is_chain)
        words[1] = globals_.pointer_type(spv::StorageClassPrivate, definition(module_, instruction.type).words[3]);
    }
    return words;
  }

  std::vector<std::uint32_t> assembled() {
    std::vector<std::uint32_t> spirv(module_.header.begin(), module_.header.end());
    const auto append = [&](const Words& words) { spirv.insert(spirv.end(), words.begin(), words.end()); };
    bool extensions_written = globals_.extensions().empty();
    for (std::size_t i = 0; i < module_.first_function; ++i) {
      const Instruction& instruction = module_.instructions[i];
      if (!extensions_written && instruction.op != spv::OpCapability) {
        for (const Words& words : globals_.extensions()) append(words);
        extensions_written = true;
      }
      if (i == module_.first_global) annotate(append);
      if (instruction.op == spv::OpEntryPoint) {
        Words words = instruction.words;
        words.insert(words.end(), globals_.interface().begin(), globals_.interface().end());
        words[0] = static_cast<std::uint32_t>(words.size() << 16 | spv::OpEntryPoint);
        append(words);
      } else {
        append(instruction.words);
      }
    }
    for (const Words& words : globals_.declarations()) append(words);
    for (const Words& words : code_.instructions()) append(words);
    spirv[3] = globals_.bound();
    return spirv;
  }

  template <typename Append>
  void annotate(const Append& append) {
    for (const Words& words : globals_.annotations()) append(words);
    // An index that differs between invocations stays one.
    for (std::size_t i = 0; i < module_.first_global; ++i) {
      const Instruction& instruction = module_.instructions[i];
      if (instruction.op != spv::OpDecorate || instruction.words[2] != spv::DecorationNonUniform) continue;
      if (const auto found = replaced_.find(instruction.words[1]); found != replaced_.end())
        append(encode(spv::OpDecorate, {found->second, spv::DecorationNonUniform}));
    }
  }

  const Module& module_;
  const RecordOptions& options_;
  Plan plan_;
  const Instruction& entry_;
  Globals globals_;
  Code code_;
  ProbeCode probes_;
  std::optional<Mirror> mirror_;
  std::unordered_map<std::uint32_t, std::uint32_t> replaced_;
  std::optional<std::size_t> pending_;     ///< the OpLabel of a block whose segment has not begun
  std::vector<std::size_t> first_values_;  ///< of that block
  bool in_entry_ = false, is_first_block_ = false, is_open_ = false;
};

}  // namespace

Recorder instrument(const Module& module, const RecordOptions& options, std::string_view label) {
  return Instrumentation(module, options, label).run();
}

}  // namespace tandem::program
