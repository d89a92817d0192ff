#include "program/record/probe_code.hpp"

#include <array>

#include "program/record/buffer_layout.hpp"
#include "program/record/word_code.hpp"

namespace tandem::program {

ProbeCode::ProbeCode(Code& code, RecordForm form, spv::ExecutionModel model, std::uint32_t set, std::uint32_t binding)
    : code_(code),
      globals_(code.globals()),
      form_(form),
      is_compute_(model == spv::ExecutionModelGLCompute),
      buffer_(globals_.word_buffer(set, binding)),
      id_input_(globals_.input(is_compute_ ? spv::BuiltInGlobalInvocationId : spv::BuiltInLaunchIdKHR,
                               globals_.uint_vector(3))),
      word_pointer_type_(globals_.pointer_type(globals_.buffer_storage(), globals_.uint_type())) {
  const auto private_word = [&] { return globals_.variable(spv::StorageClassPrivate, globals_.uint_type()); };
  header_ = private_word();
  if (form == RecordForm::hash) {
    if (is_compute_) hash_state_ = private_word();
    return;
  }
  limit_ = private_word();
  if (is_compute_) cursor_ = private_word();
  if (form != RecordForm::lockstep) return;
  delta_ = private_word();
  force_ = globals_.variable(spv::StorageClassPrivate, globals_.bool_type());
}

std::uint32_t ProbeCode::word_pointer(std::uint32_t index) {
  return value(spv::OpAccessChain, word_pointer_type_, {buffer_, globals_.constant(0), index});
}

std::uint32_t ProbeCode::plus(std::uint32_t id, std::uint32_t constant) {
  return constant == 0 ? id : value(spv::OpIAdd, globals_.uint_type(), {id, globals_.constant(constant)});
}

void ProbeCode::begin_entry(std::uint32_t id, spv::StorageClass storage) {
  const std::uint32_t uint = globals_.uint_type();
  const auto header = [&](std::uint32_t position) { return load_word(globals_.constant(position)); };
  const std::uint32_t component = globals_.input_component(id_input_);  // may be int: the words are the same
  const std::uint32_t pointer_type = globals_.pointer_type(storage, component);
  const auto coordinate = [&](std::uint32_t axis) {
    const std::uint32_t loaded =
        load(value(spv::OpAccessChain, pointer_type, {id, globals_.constant(axis)}), component);
    return component == uint ? loaded : value(spv::OpBitcast, uint, {loaded});
  };
  const std::uint32_t row = value(spv::OpIMul, uint, {coordinate(1), header(header_width)});
  const std::uint32_t plane = value(spv::OpIMul, uint, {coordinate(2), header(header_area)});
  const std::uint32_t in_plane = value(spv::OpIAdd, uint, {coordinate(0), row});
  const std::uint32_t linear = value(spv::OpIAdd, uint, {in_plane, plane});
  const std::uint32_t slot = load_word(value(spv::OpIAdd, uint, {header(header_table), linear}));
  const std::uint32_t is_recorded = value(spv::OpINotEqual, globals_.bool_type(), {slot, globals_.constant(0)});
  const std::uint32_t before = value(spv::OpISub, uint, {slot, globals_.constant(1)});
  const std::uint32_t own = value(spv::OpIAdd, uint, {header(header_cursors), before});
  store(header_, value(spv::OpSelect, uint, {is_recorded, own, globals_.constant(header_trash_cursor)}));
  if (form_ == RecordForm::hash) {
    if (is_compute_) store(hash_state_, globals_.constant(0));
    return;
  }
  const std::uint32_t capacity = header(header_capacity);
  const std::uint32_t start =
      value(spv::OpIAdd, uint, {header(header_slots), value(spv::OpIMul, uint, {before, capacity})});
  const std::uint32_t end = plus(value(spv::OpIAdd, uint, {start, capacity}), 1);
  store(limit_, value(spv::OpSelect, uint, {is_recorded, end, globals_.constant(0)}));
  if (is_compute_) store(cursor_, start);
  if (form_ != RecordForm::lockstep) return;
  store(delta_, header(header_delta));
  store(force_, value(spv::OpINotEqual, globals_.bool_type(), {header(header_force), globals_.constant(0)}));
}

void ProbeCode::begin_segment(std::uint32_t number, std::uint32_t words) {
  const std::uint32_t uint = globals_.uint_type(), boolean = globals_.bool_type();
  const std::uint32_t id = globals_.constant(number);
  if (form_ == RecordForm::hash) {
    hash_ = is_compute_ ? load(hash_state_, uint) : load_word(load(header_, uint));
    mix(id);
    return;
  }
  const std::uint32_t header = load(header_, uint);
  const std::uint32_t cursor = is_compute_ ? load(cursor_, uint) : load_word(header);
  const std::uint32_t next = plus(cursor, words);
  const std::uint32_t fits = value(spv::OpULessThan, boolean, {next, load(limit_, uint)});
  base_ = value(spv::OpSelect, uint, {fits, cursor, globals_.constant(trash_start)});
  if (is_compute_) store(cursor_, next);
  store_word(header, next);
  store_word(base_, id);
  if (form_ != RecordForm::lockstep) return;
  other_base_ = value(spv::OpIAdd, uint, {base_, load(delta_, uint)});
  const std::uint32_t same = value(spv::OpIEqual, boolean, {load_word(other_base_), id});
  const std::uint32_t forces = value(spv::OpLogicalAnd, boolean, {fits, load(force_, boolean)});
  takes_ = value(spv::OpLogicalAnd, boolean, {forces, same});
}

/// Every bit of a word changes the hash, and the order of the words does: a multiplication, and a shift because a
/// multiplication carries upwards only.
void ProbeCode::mix(std::uint32_t word) {
  const std::uint32_t uint = globals_.uint_type();
  const std::uint32_t product =
      value(spv::OpIMul, uint, {value(spv::OpBitwiseXor, uint, {hash_, word}), globals_.constant(0x9e3779b1)});
  const std::uint32_t shifted = value(spv::OpShiftRightLogical, uint, {product, globals_.constant(15)});
  hash_ = value(spv::OpBitwiseXor, uint, {product, shifted});
}

void ProbeCode::record(const Module& module, const Instruction& instruction, const RecordedValue& value_recorded,
                       std::uint32_t replacement) {
  std::vector<std::uint32_t> scalars;
  for (const Component& component : value_recorded.components) {
    std::uint32_t scalar = instruction.result;
    if (!component.path.empty()) {
      Words operands = {scalar_type(globals_, component), globals_.new_id(), instruction.result};
      operands.insert(operands.end(), component.path.begin(), component.path.end());
      code_.append(encode(spv::OpCompositeExtract, operands));
      scalar = operands[1];
    }
    std::array<std::uint32_t, 2> words = {};
    append_words(code_, component, scalar, words.data());
    for (std::uint32_t i = 0; i < component.word_count(); ++i) {
      if (form_ == RecordForm::hash) {
        mix(words[i]);
        continue;
      }
      const std::uint32_t offset = value_recorded.offset + component.word + i;
      store_word(plus(base_, offset), words[i]);
      if (replacement == 0) continue;
      const std::uint32_t other = load_word(plus(other_base_, offset));
      words[i] = value(spv::OpSelect, globals_.uint_type(), {takes_, other, words[i]});
    }
    if (replacement != 0) scalars.push_back(scalar_of(component, words.data()));
  }
  if (replacement == 0) return;
  const std::uint32_t* next = scalars.data();
  code_.append(encode(spv::OpCopyObject, {instruction.type, replacement, composite(module, instruction.type, next)}));
}

void ProbeCode::end_segment(bool leaves) {
  if (form_ != RecordForm::hash) return;
  if (is_compute_) store(hash_state_, hash_);
  if (leaves || !is_compute_) store_word(load(header_, globals_.uint_type()), hash_);
}

void ProbeCode::resume(std::uint32_t link) {
  if (form_ == RecordForm::hash) return;
  const std::uint32_t uint = globals_.uint_type();
  const std::uint32_t header = load(header_, uint), cursor = load_word(header);
  store_word(plus(base_, link), cursor);
  if (form_ != RecordForm::lockstep) return;
  const std::uint32_t other = load_word(plus(other_base_, link));
  store_word(header, value(spv::OpSelect, uint, {takes_, other, cursor}));
}

std::uint32_t ProbeCode::scalar_of(const Component& component, const std::uint32_t* words) {
  const std::uint32_t type = scalar_type(globals_, component);
  if (component.kind == ComponentKind::boolean) return value(spv::OpINotEqual, type, {words[0], globals_.constant(0)});
  if (component.width == 64)
    return value(spv::OpBitcast, type,
                 {value(spv::OpCompositeConstruct, globals_.uint_vector(2), {words[0], words[1]})});
  if (component.width < 32 && component.kind == ComponentKind::floating)
    return value(spv::OpFConvert, type, {value(spv::OpBitcast, globals_.float_type(), {words[0]})});
  if (component.width < 32)
    return value(component.kind == ComponentKind::signed_integer ? spv::OpSConvert : spv::OpUConvert, type, {words[0]});
  return component.kind == ComponentKind::unsigned_integer ? words[0] : value(spv::OpBitcast, type, {words[0]});
}

std::uint32_t ProbeCode::composite(const Module& module, std::uint32_t type, const std::uint32_t*& scalars) {
  const auto defined = module.definitions.find(type);
  const Instruction& definition = module.instructions[defined->second];
  Words member_types;
  switch (definition.op) {
    case spv::OpTypeVector:
    case spv::OpTypeMatrix:
      member_types.assign(definition.words[3], definition.words[2]);
      break;
    case spv::OpTypeArray:
      member_types.assign(program::definition(module, definition.words[3]).words[3], definition.words[2]);
      break;
    case spv::OpTypeStruct:
      member_types.assign(definition.words.begin() + 2, definition.words.end());
      break;
    default:
      return *scalars++;
  }
  Words operands = {type, 0};
  for (const std::uint32_t member : member_types) operands.push_back(composite(module, member, scalars));
  operands[1] = globals_.new_id();
  code_.append(encode(spv::OpCompositeConstruct, operands));
  return operands[1];
}

}  // namespace tandem::program
