#include "program/lockstep/walk.hpp"

#include <algorithm>
#include <utility>

namespace tandem::program {
namespace {

/// Whether the segment is the first one of the entry point's function.
bool begins(const RecordedShader& shader, const Segment& segment) {
  const std::vector<Instruction>& all = shader.module.instructions;
  const auto entry = std::ranges::find(all, spv::OpEntryPoint, &Instruction::op);
  std::size_t i = shader.module.definitions.at(entry->words[2]);
  while (all[i].op != spv::OpLabel) ++i;
  return segment.first_instruction == i;
}

}  // namespace

Walk::Walk(const RecordedLaunch& launch, const SlotView& slot) : launch_(launch), slot_(slot) {}

bool Walk::next() {
  position_ = next_position_;
  if (position_ >= slot_.words.size()) return false;
  number_ = slot_.words[position_];
  place_ = segment_at(launch_, number_);
  if (place_.segment == nullptr || position_ + segment().words > slot_.words.size()) return false;
  next_position_ = position_ + segment().words;
  while (frames_.size() > 1 && position_ >= frames_.back().resumes_at) frames_.pop_back();
  begins_shader_ = begins(shader(), segment());
  if (begins_shader_) {
    // Shaders that the same call runs one after the other share a depth.
    const std::size_t resumes_at =
        resumes_at_.value_or(frames_.empty() ? slot_.words.size() : frames_.back().resumes_at);
    if (!resumes_at_ && !frames_.empty()) frames_.pop_back();
    Frame frame;
    frame.shader = place_.shader;
    frame.resumes_at = resumes_at;
    frames_.push_back(std::move(frame));
  }
  resumes_at_.reset();
  if (segment().calls) resumes_at_ = std::size_t{slot_.words[next_position_ - 1]} - slot_.first_word;
  return !frames_.empty() && frames_.back().shader == place_.shader;
}

std::size_t Walk::depth() const noexcept {
  std::size_t depth = 0;
  for (const Frame& frame : frames_) depth += 1 + frame.calls.size();
  return depth;
}

RecordedWords Walk::words_of(const RecordedValue& value) const {
  const auto words = slot_.words.subspan(position_ + value.offset, word_count(value.components));
  return {value.components, {words.begin(), words.end()}};
}

void Walk::pass(std::size_t i) {
  Frame& frame = frames_.back();
  const Instruction& instruction = shader().module.instructions[i];
  const auto value = std::ranges::find(segment().values, i, &RecordedValue::instruction);
  if (value != segment().values.end()) frame.positions[instruction.result] = position_ + value->offset;
  if (instruction.op == spv::OpStore) frame.stores[variable_of(instruction.words[1])] = i;
  if (instruction.op == spv::OpRayQueryInitializeKHR) frame.queries[variable_of(instruction.words[1])] = operands_of(i);
  if (instruction.op == spv::OpTraceRayKHR) frame.traced = operands_of(i);
  if (instruction.op == spv::OpReturnValue) frame.returned = instruction.words[1];
  if (instruction.op != spv::OpFunctionCall) return;
  if (i == segment().first_instruction) {  // it has returned
    if (!frame.calls.empty()) frame.calls.pop_back();
    if (const auto found = frame.positions.find(frame.returned); found != frame.positions.end())
      frame.positions[instruction.result] = found->second;
    else
      frame.arguments[instruction.result] = frame.returned;
    return;
  }
  enter_function(instruction);
}

void Walk::enter_function(const Instruction& call) {
  Frame& frame = frames_.back();
  frame.calls.push_back(call.result);
  const Module& module = shader().module;
  std::size_t parameter = module.definitions.at(call.words[3]) + 1;
  for (std::size_t argument = 4; argument < call.words.size(); ++parameter) {
    const Instruction& declared = module.instructions[parameter];
    if (declared.op != spv::OpFunctionParameter) continue;
    const std::uint32_t given = call.words[argument++];
    const auto found = frame.positions.find(given);
    if (found != frame.positions.end())
      frame.positions[declared.result] = found->second;
    else
      frame.arguments[declared.result] = given;
    if (definition(module, declared.type).op == spv::OpTypePointer) frame.passed.insert(variable_of(given));
  }
}

std::optional<RecordedWords> Walk::value_of(std::uint32_t id) const {
  if (id == 0 || frames_.empty()) return std::nullopt;
  const Frame& frame = frames_.back();
  const Module& module = shader().module;
  const auto found = frame.positions.find(id);
  if (found != frame.positions.end()) {
    std::optional<std::vector<Component>> components = components_of(module, definition(module, id).type);
    if (!components) return std::nullopt;
    const auto words = slot_.words.subspan(found->second, word_count(*components));
    return RecordedWords{std::move(*components), {words.begin(), words.end()}};
  }
  if (const auto argument = frame.arguments.find(id); argument != frame.arguments.end() && argument->second != id)
    return value_of(argument->second);
  return constant_value(module, id);
}

OperandValues Walk::operands_of(std::size_t i) const {
  OperandValues operands{i, {}};
  const Instruction& instruction = shader().module.instructions[i];
  for (const std::uint16_t used : instruction.used_ids) operands.values.push_back(value_of(instruction.words[used]));
  return operands;
}

const OperandValues* Walk::query_ray(std::uint32_t query) const {
  const auto found = frames_.back().queries.find(variable_of(query));
  return found == frames_.back().queries.end() ? nullptr : &found->second;
}

const OperandValues* Walk::traced_ray(const RecordedShader*& caller) const {
  if (frames_.size() < 2) return nullptr;
  const Frame& frame = frames_[frames_.size() - 2];
  caller = frame.shader;
  return frame.traced.values.empty() ? nullptr : &frame.traced;
}

std::uint32_t Walk::variable_of(std::uint32_t pointer) const {
  const Frame& frame = frames_.back();
  const Module& module = shader().module;
  for (;;) {
    if (const auto argument = frame.arguments.find(pointer); argument != frame.arguments.end()) {
      pointer = argument->second;
      continue;
    }
    const auto found = module.definitions.find(pointer);
    if (found == module.definitions.end()) return pointer;
    const Instruction& instruction = module.instructions[found->second];
    switch (instruction.op) {
      case spv::OpAccessChain:
      case spv::OpInBoundsAccessChain:
      case spv::OpPtrAccessChain:
      case spv::OpInBoundsPtrAccessChain:
      case spv::OpCopyObject:
      case spv::OpImageTexelPointer:
        pointer = instruction.words[3];
        continue;
      default:
        return pointer;
    }
  }
}

std::optional<std::size_t> Walk::last_store(std::uint32_t pointer) const {
  const auto found = frames_.back().stores.find(variable_of(pointer));
  return found == frames_.back().stores.end() ? std::nullopt : std::optional(found->second);
}

int built_in_of(const Module& module, std::uint32_t variable) {
  for (std::size_t i = 0; i < module.first_global; ++i) {
    const Instruction& instruction = module.instructions[i];
    if (instruction.op == spv::OpDecorate && instruction.words[1] == variable &&
        instruction.words[2] == spv::DecorationBuiltIn)
      return static_cast<int>(instruction.words[3]);
  }
  return -1;
}

std::optional<RecordedWords> constant_value(const Module& module, std::uint32_t id) {
  const auto found = module.definitions.find(id);
  if (found == module.definitions.end()) return std::nullopt;
  const Instruction& instruction = module.instructions[found->second];
  std::optional<std::vector<Component>> components = components_of(module, instruction.type);
  if (!components) return std::nullopt;
  RecordedWords value{std::move(*components), {}};
  const std::vector<std::uint32_t>& words = instruction.words;
  switch (instruction.op) {
    case spv::OpConstantTrue:
      value.words = {1};
      return value;
    case spv::OpConstantFalse:
      value.words = {0};
      return value;
    case spv::OpConstant:
      value.words.assign(words.begin() + 3, words.end());
      break;
    case spv::OpConstantNull:
      value.words.resize(word_count(value.components));
      return value;
    case spv::OpConstantComposite:
      for (std::size_t i = 3; i < words.size(); ++i) {
        const std::optional<RecordedWords> part = constant_value(module, words[i]);
        if (!part) return std::nullopt;
        value.words.insert(value.words.end(), part->words.begin(), part->words.end());
      }
      return value;
    default:
      return std::nullopt;
  }
  if (value.components[0].width < 32) value.words[0] = recorded_word(value.components[0], value.words[0]);
  return value;
}

}  // namespace tandem::program
