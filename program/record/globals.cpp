#include "program/record/globals.hpp"

#include <algorithm>
#include <string_view>

namespace tandem::program {
namespace {

constexpr std::uint32_t version_1_3 = 0x10300, version_1_4 = 0x10400;

Words text_words(std::string_view text) {
  Words words(text.size() / 4 + 1);
  for (std::size_t i = 0; i < text.size(); ++i)
    words[i / 4] |= static_cast<std::uint32_t>(static_cast<unsigned char>(text[i])) << (8 * (i % 4));
  return words;
}

}  // namespace

Words encode(spv::Op op, std::span<const std::uint32_t> operands) {
  Words words = {static_cast<std::uint32_t>((operands.size() + 1) << 16 | op)};
  words.insert(words.end(), operands.begin(), operands.end());
  return words;
}

Words encode(spv::Op op, std::initializer_list<std::uint32_t> operands) {
  return encode(op, std::span(operands.begin(), operands.size()));
}

Globals::Globals(const Module& module) : module_(module), bound_(module.header[3]), version_(module.header[1]) {}

std::uint32_t Globals::type(spv::Op op, std::initializer_list<std::uint32_t> operands) {
  const auto is_it = [&](const Words& words) {
    return words.size() == operands.size() + 2 && std::equal(operands.begin(), operands.end(), words.begin() + 2) &&
           (words[0] & 0xffff) == static_cast<std::uint32_t>(op);
  };
  for (std::size_t i = module_.first_global; i < module_.first_function; ++i)
    if (is_it(module_.instructions[i].words)) return module_.instructions[i].result;
  for (const Words& words : declarations_)
    if (is_it(words)) return words[1];
  Words all = {new_id()};
  all.insert(all.end(), operands);
  declarations_.push_back(encode(op, all));
  return all[0];
}

std::uint32_t Globals::constant(std::uint32_t value) {
  const std::uint32_t type = uint_type();
  const auto [entry, is_new] = constants_.try_emplace(value, bound_);
  if (is_new) declarations_.push_back(encode(spv::OpConstant, {type, new_id(), value}));
  return entry->second;
}

std::uint32_t Globals::constant_vector(const std::array<std::uint32_t, 3>& values) {
  const std::uint32_t type = uint_vector(3);
  const std::array<std::uint32_t, 3> parts = {constant(values[0]), constant(values[1]), constant(values[2])};
  declarations_.push_back(encode(spv::OpConstantComposite, {type, new_id(), parts[0], parts[1], parts[2]}));
  return declarations_.back()[2];
}

std::uint32_t Globals::variable(spv::StorageClass storage, std::uint32_t pointee) {
  const std::uint32_t pointer = pointer_type(storage, pointee), id = new_id();
  declarations_.push_back(encode(spv::OpVariable, {pointer, id, static_cast<std::uint32_t>(storage)}));
  if (version_ >= version_1_4 || storage == spv::StorageClassInput) interface_.push_back(id);
  return id;
}

std::uint32_t Globals::input(spv::BuiltIn built_in, std::uint32_t type) {
  const auto is_it = [&](const Words& words) {
    return words.size() == 4 && (words[0] & 0xffff) == spv::OpDecorate && words[2] == spv::DecorationBuiltIn &&
           words[3] == static_cast<std::uint32_t>(built_in);
  };
  for (const Words& words : annotations_)
    if (is_it(words)) return words[1];
  for (std::size_t i = 0; i < module_.first_global; ++i)
    if (const Words& words = module_.instructions[i].words; is_it(words)) return words[1];
  const std::uint32_t id = variable(spv::StorageClassInput, type);
  decorate({id, spv::DecorationBuiltIn, static_cast<std::uint32_t>(built_in)});
  return id;
}

std::uint32_t Globals::input_component(std::uint32_t input) {
  const auto found = module_.definitions.find(input);
  if (found == module_.definitions.end()) return uint_type();
  const std::uint32_t vector = definition(module_, module_.instructions[found->second].type).words[3];
  return definition(module_, vector).words[2];
}

std::uint32_t Globals::scalar_type(spv::Op op, std::uint32_t width, bool is_signed) {
  return op == spv::OpTypeInt ? type(op, {width, is_signed ? 1u : 0u}) : type(op, {width});
}

std::uint32_t Globals::word_buffer(std::uint32_t set, std::uint32_t binding) {
  // The array and the structure are types of their own: those of the module may have other decorations.
  const std::uint32_t array = new_id(), block = new_id();
  declarations_.push_back(encode(spv::OpTypeRuntimeArray, {array, uint_type()}));
  declarations_.push_back(encode(spv::OpTypeStruct, {block, array}));
  decorate({array, spv::DecorationArrayStride, 4});
  decorate({block, spv::DecorationBlock});
  annotations_.push_back(encode(spv::OpMemberDecorate, {block, 0, spv::DecorationOffset, 0}));
  if (version_ < version_1_3) {
    constexpr std::string_view name = "SPV_KHR_storage_buffer_storage_class";
    const Words extension = encode(spv::OpExtension, text_words(name));
    if (std::ranges::none_of(module_.instructions, [&](const Instruction& i) { return i.words == extension; }))
      extensions_.push_back(extension);
  }
  const std::uint32_t id = variable(buffer_storage_, block);
  decorate({id, spv::DecorationDescriptorSet, set});
  decorate({id, spv::DecorationBinding, binding});
  return id;
}

void Globals::decorate(std::initializer_list<std::uint32_t> operands) {
  annotations_.push_back(encode(spv::OpDecorate, operands));
}

}  // namespace tandem::program
