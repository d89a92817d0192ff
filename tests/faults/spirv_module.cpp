#define SPV_ENABLE_UTILITY_CODE
#include "tests/faults/spirv_module.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <iterator>
#include <string>
#include <utility>

#include "rhi/error.hpp"

namespace tandem::test {
namespace {

constexpr std::size_t header_words = 5;

/// Whether the instruction belongs to the section of types, constants and global variables.
bool is_global(spv::Op opcode) {
  return (opcode >= spv::OpTypeVoid && opcode <= spv::OpTypeForwardPointer) || opcode == spv::OpTypeRayQueryKHR ||
         opcode == spv::OpTypeAccelerationStructureKHR ||
         (opcode >= spv::OpConstantTrue && opcode <= spv::OpSpecConstantOp) || opcode == spv::OpVariable ||
         opcode == spv::OpUndef;
}

bool is_rounding(spv::Op opcode) {
  return opcode == spv::OpFAdd || opcode == spv::OpFSub || opcode == spv::OpFMul || opcode == spv::OpFDiv ||
         opcode == spv::OpFNegate || opcode == spv::OpVectorTimesScalar;
}

std::string text_of(std::span<const std::uint32_t> words) {
  const auto bytes = std::as_bytes(words);
  const auto end = std::ranges::find(bytes, std::byte{0});
  std::string text(static_cast<std::size_t>(end - bytes.begin()), '\0');
  std::memcpy(text.data(), bytes.data(), text.size());
  return text;
}

[[noreturn]] void refuse(const char* why) {
  throw rhi::Error(rhi::ErrorCode::invalid_argument, "SPIR-V to be edited", why);
}

}  // namespace

std::uint32_t Instruction::type() const {
  bool has_result = false, has_type = false;
  spv::HasResultAndType(opcode, &has_result, &has_type);
  return has_type ? operands.at(0) : 0;
}

std::uint32_t Instruction::result() const {
  bool has_result = false, has_type = false;
  spv::HasResultAndType(opcode, &has_result, &has_type);
  return has_result ? operands.at(has_type ? 1 : 0) : 0;
}

void Instruction::set_result(std::uint32_t id) {
  bool has_result = false, has_type = false;
  spv::HasResultAndType(opcode, &has_result, &has_type);
  if (!has_result) refuse("an instruction without a result was to have one");
  operands.at(has_type ? 1 : 0) = id;
}

SpirvModule::SpirvModule(std::span<const std::uint32_t> words) {
  if (words.size() < header_words || words[0] != spv::MagicNumber) refuse("these words are no SPIR-V module");
  version_ = words[1];
  bound_ = words[3];
  std::vector<Instruction>* section = &head_;
  for (std::size_t begin = header_words; begin < words.size();) {
    const std::size_t count = words[begin] >> spv::WordCountShift;
    if (count == 0 || begin + count > words.size()) refuse("an instruction does not end within the module");
    const auto opcode = static_cast<spv::Op>(words[begin] & spv::OpCodeMask);
    const auto operands = words.subspan(begin + 1, count - 1);
    begin += count;
    if (opcode == spv::OpLine || opcode == spv::OpNoLine) continue;
    if (section == &head_ && is_global(opcode)) section = &globals_;
    if (opcode == spv::OpFunction) section = &functions_;
    section->push_back({opcode, {operands.begin(), operands.end()}});
    const Instruction& instruction = section->back();
    if (instruction.type() != 0) types_[instruction.result()] = instruction.type();
  }
  if (functions_.empty() || functions_.back().opcode != spv::OpFunctionEnd)
    refuse("the last function of the module does not end");
}

std::vector<std::uint32_t> SpirvModule::words() const {
  std::vector<std::uint32_t> words = {spv::MagicNumber, version_, 0, bound_, 0};
  for (const std::vector<Instruction>* section : {&head_, &globals_, &functions_}) {
    for (const Instruction& instruction : *section) {
      const auto count = static_cast<std::uint32_t>(instruction.operands.size() + 1);
      words.push_back(count << spv::WordCountShift | static_cast<std::uint32_t>(instruction.opcode));
      words.insert(words.end(), instruction.operands.begin(), instruction.operands.end());
    }
  }
  return words;
}

void SpirvModule::edit_range(std::vector<Instruction>& written, std::size_t begin, std::size_t end, const Edit& edit) {
  CodeWriter code(*this, written);
  for (std::size_t i = begin; i < end; ++i) edit(functions_[i], code);
}

bool SpirvModule::edit_function(std::string_view name, const Edit& edit) {
  // glslang names a function by its GLSL name and the types of its parameters: "det_div(f1;f1;".
  const std::string prefix = std::string(name) + "(";
  bool found = false;
  std::vector<Instruction> written;
  for (std::size_t begin = 0; begin < functions_.size();) {
    std::size_t end = begin;
    while (functions_[end].opcode != spv::OpFunctionEnd) ++end;
    ++end;
    const std::uint32_t function = functions_[begin].result();
    const bool is_meant = std::ranges::any_of(head_, [&](const Instruction& instruction) {
      return instruction.opcode == spv::OpName && instruction.operands[0] == function &&
             text_of(std::span(instruction.operands).subspan(1)).starts_with(prefix);
    });
    found = found || is_meant;
    if (is_meant)
      edit_range(written, begin, end, edit);
    else
      written.insert(written.end(), functions_.begin() + static_cast<std::ptrdiff_t>(begin),
                     functions_.begin() + static_cast<std::ptrdiff_t>(end));
    begin = end;
  }
  functions_ = std::move(written);
  return found;
}

void SpirvModule::edit_functions(const Edit& edit) {
  std::vector<Instruction> written;
  edit_range(written, 0, functions_.size(), edit);
  functions_ = std::move(written);
}

std::uint32_t SpirvModule::global(spv::Op opcode, const std::vector<std::uint32_t>& operands) {
  // Behind the result, and behind the type where there is one.
  const bool has_type = opcode == spv::OpConstant;
  for (const Instruction& instruction : globals_) {
    if (instruction.opcode != opcode) continue;
    std::vector<std::uint32_t> others = instruction.operands;
    others.erase(others.begin() + (has_type ? 1 : 0));
    if (others == operands) return instruction.result();
  }
  Instruction instruction{opcode, operands};
  const std::uint32_t id = new_id();
  instruction.operands.insert(instruction.operands.begin() + (has_type ? 1 : 0), id);
  if (has_type) types_[id] = operands[0];
  globals_.push_back(std::move(instruction));
  return id;
}

std::uint32_t SpirvModule::float_type(std::uint32_t width) {
  if (width == 64) require(spv::CapabilityFloat64);
  return global(spv::OpTypeFloat, {width});
}
std::uint32_t SpirvModule::bool_type() { return global(spv::OpTypeBool, {}); }
std::uint32_t SpirvModule::uint_type() { return global(spv::OpTypeInt, {32, 0}); }
std::uint32_t SpirvModule::int_type() { return global(spv::OpTypeInt, {32, 1}); }

std::uint32_t SpirvModule::constant(std::uint32_t type, std::uint32_t bits) {
  return global(spv::OpConstant, {type, bits});
}
std::uint32_t SpirvModule::constant(float value) { return constant(float_type(), std::bit_cast<std::uint32_t>(value)); }
std::uint32_t SpirvModule::constant(std::uint32_t value) { return constant(uint_type(), value); }
std::uint32_t SpirvModule::constant(std::int32_t value) {
  return constant(int_type(), static_cast<std::uint32_t>(value));
}

std::uint32_t SpirvModule::type_of(std::uint32_t value) const {
  const auto found = types_.find(value);
  return found == types_.end() ? 0 : found->second;
}

std::uint32_t SpirvModule::column_type(std::uint32_t matrix_type) const {
  for (const Instruction& instruction : globals_)
    if (instruction.opcode == spv::OpTypeMatrix && instruction.result() == matrix_type) return instruction.operands[1];
  refuse("a type that is no matrix has no columns");
}

bool SpirvModule::has_name(std::uint32_t id, std::string_view name) const {
  return std::ranges::any_of(head_, [&](const Instruction& instruction) {
    return instruction.opcode == spv::OpName && instruction.operands[0] == id &&
           text_of(std::span(instruction.operands).subspan(1)) == name;
  });
}

int SpirvModule::builtin_of(std::uint32_t variable) const {
  for (const Instruction& instruction : head_)
    if (instruction.opcode == spv::OpDecorate && instruction.operands[0] == variable &&
        instruction.operands[1] == spv::DecorationBuiltIn)
      return static_cast<int>(instruction.operands[2]);
  return -1;
}

void SpirvModule::require(spv::Capability capability) {
  const bool is_there = std::ranges::any_of(head_, [&](const Instruction& instruction) {
    return instruction.opcode == spv::OpCapability && instruction.operands[0] == std::uint32_t(capability);
  });
  if (!is_there) head_.insert(head_.begin(), {spv::OpCapability, {std::uint32_t(capability)}});
}

std::uint32_t SpirvModule::extended_instructions() const {
  for (const Instruction& instruction : head_)
    if (instruction.opcode == spv::OpExtInstImport &&
        text_of(std::span(instruction.operands).subspan(1)) == "GLSL.std.450")
      return instruction.operands[0];
  refuse("the module does not import GLSL.std.450");
}

void CodeWriter::put(Instruction instruction) {
  if (instruction.type() != 0) module_.types_[instruction.result()] = instruction.type();
  written_.push_back(std::move(instruction));
}

std::uint32_t CodeWriter::value(spv::Op opcode, std::uint32_t type, std::vector<std::uint32_t> operands) {
  const std::uint32_t id = module_.new_id();
  if (is_rounding(opcode)) module_.head_.push_back({spv::OpDecorate, {id, spv::DecorationNoContraction}});
  operands.insert(operands.begin(), {type, id});
  put({opcode, std::move(operands)});
  return id;
}

std::uint32_t CodeWriter::extended(GLSLstd450 function, std::uint32_t type, std::vector<std::uint32_t> operands) {
  operands.insert(operands.begin(), {module_.extended_instructions(), static_cast<std::uint32_t>(function)});
  return value(spv::OpExtInst, type, std::move(operands));
}

void CodeWriter::put_changed(Instruction instruction,
                             const std::function<std::uint32_t(std::uint32_t result)>& change) {
  const std::uint32_t type = instruction.type();
  const std::uint32_t seen_by_all = instruction.result();
  const std::uint32_t original = module_.new_id();
  instruction.set_result(original);
  // NoContraction is said of the operation, not of its copy.
  for (Instruction& decoration : module_.head_)
    if (decoration.opcode == spv::OpDecorate && decoration.operands[0] == seen_by_all)
      decoration.operands[0] = original;
  put(std::move(instruction));
  put({spv::OpCopyObject, {type, seen_by_all, change(original)}});
}

}  // namespace tandem::test
