#include "rhi_cpu/translate/folding/constant_folding.hpp"
#include "rhi/spirv/words.hpp"

#include <algorithm>
#include <optional>
#include <unordered_map>

#include <spirv_cross/spirv.hpp>

#include "rhi_cpu/translate/folding/scalar_folding.hpp"

namespace tandem::cpu {
namespace {

using Words = std::vector<std::uint32_t>;
using Instruction = std::span<const std::uint32_t>;

constexpr std::size_t bound = 3;  ///< word of the header

struct NumberType {
  std::uint32_t width = 0;  ///< 1 for a boolean
  bool is_boolean = false;
  bool is_signed = false;
};

struct VectorType {
  std::uint32_t component = 0;
  std::uint32_t length = 0;
};

/// A number, or the constants that a composite consists of.
struct Constant {
  std::uint32_t type = 0;
  std::optional<ScalarConstant> scalar;
  Words constituents;
};

class Folder {
 public:
  explicit Folder(Instruction module)
      : module_(module), result_(module.begin(), module.begin() + rhi::spirv_header_words), next_id_(module[bound]) {}

  Words folded() {
    for (std::size_t k = rhi::spirv_header_words; k < module_.size(); k += module_[k] >> 16)
      fold(module_.subspan(k, module_[k] >> 16));
    result_[bound] = next_id_;
    return std::move(result_);
  }

 private:
  void fold(Instruction i) {
    const auto op = static_cast<spv::Op>(i[0] & 0xffff);
    switch (op) {
      case spv::OpTypeBool:
        numbers_[i[1]] = {.width = 1, .is_boolean = true};
        break;
      case spv::OpTypeInt:
        numbers_[i[1]] = {.width = i[2], .is_signed = i[3] != 0};
        break;
      case spv::OpTypeFloat:
        numbers_[i[1]] = {.width = i[2]};
        break;
      case spv::OpTypeVector:
        vectors_[i[1]] = {.component = i[2], .length = i[3]};
        break;
      case spv::OpConstantTrue:
      case spv::OpConstantFalse:
        constants_[i[2]] = {.type = i[1], .scalar = ScalarConstant{op == spv::OpConstantTrue, 1}, .constituents = {}};
        break;
      case spv::OpConstant:
        constants_[i[2]] = {.type = i[1], .scalar = number(i), .constituents = {}};
        break;
      case spv::OpConstantNull:
        if (numbers_.contains(i[1]) || vectors_.contains(i[1])) return put_null(i[1], i[2]);
        break;
      case spv::OpConstantComposite:
      case spv::OpSpecConstantComposite:
        return put_composite(i[1], i[2], {i.begin() + 3, i.end()});
      case spv::OpSpecConstantOp:
        if (fold_operation(i)) return;
        break;
      default:
        break;
    }
    result_.insert(result_.end(), i.begin(), i.end());
  }

  ScalarConstant number(Instruction i) const {
    const std::uint32_t width = numbers_.at(i[1]).width;
    if (width == 64) return {i[3] | std::uint64_t{i[4]} << 32, width};
    return {width == 32 ? i[3] : i[3] & ((1u << width) - 1), width};
  }

  // Every put writes the constant `id` and remembers it.

  void put(spv::Op op, const Words& operands) {
    result_.push_back(static_cast<std::uint32_t>(operands.size() + 1) << 16 | op);
    result_.insert(result_.end(), operands.begin(), operands.end());
  }

  void put_scalar(std::uint32_t type, std::uint32_t id, const ScalarConstant& scalar) {
    constants_[id] = {.type = type, .scalar = scalar, .constituents = {}};
    const NumberType& number = numbers_.at(type);
    if (number.is_boolean) return put(scalar.bits != 0 ? spv::OpConstantTrue : spv::OpConstantFalse, {type, id});
    auto low = static_cast<std::uint32_t>(scalar.bits);
    if (number.width == 64) return put(spv::OpConstant, {type, id, low, static_cast<std::uint32_t>(scalar.bits >> 32)});
    const std::uint32_t unused = 32 - number.width;
    if (number.is_signed) low = static_cast<std::uint32_t>(static_cast<std::int32_t>(low << unused) >> unused);
    put(spv::OpConstant, {type, id, low});
  }

  void put_composite(std::uint32_t type, std::uint32_t id, const Words& constituents) {
    constants_[id] = {.type = type, .scalar = std::nullopt, .constituents = constituents};
    Words operands = {type, id};
    operands.insert(operands.end(), constituents.begin(), constituents.end());
    put(spv::OpConstantComposite, operands);
  }

  void put_vector(std::uint32_t type, std::uint32_t id, std::span<const ScalarConstant> components) {
    Words constituents;
    for (const ScalarConstant& component : components) {
      put_scalar(vectors_.at(type).component, next_id_, component);
      constituents.push_back(next_id_++);
    }
    put_composite(type, id, constituents);
  }

  void put_null(std::uint32_t type, std::uint32_t id) {
    if (const auto number = numbers_.find(type); number != numbers_.end())
      return put_scalar(type, id, {0, number->second.width});
    const VectorType vector = vectors_.at(type);
    put_vector(type, id, std::vector<ScalarConstant>(vector.length, {0, numbers_.at(vector.component).width}));
  }

  void put_copy(std::uint32_t id, const Constant& constant) {
    if (constant.scalar)
      put_scalar(constant.type, id, *constant.scalar);
    else
      put_composite(constant.type, id, constant.constituents);
  }

  /// Null for what is no known constant.
  const Constant* find(std::uint32_t id) const {
    const auto found = constants_.find(id);
    return found == constants_.end() ? nullptr : &found->second;
  }

  bool fold_operation(Instruction i) {
    const std::uint32_t type = i[1], id = i[2];
    const auto op = static_cast<spv::Op>(i[3]);
    const Instruction operands = i.subspan(4);
    switch (op) {
      case spv::OpCompositeExtract:
        return extract(id, operands[0], operands.subspan(1));
      case spv::OpCompositeInsert:
        return insert(id, operands[0], operands[1], operands.subspan(2));
      case spv::OpVectorShuffle:
        return shuffle(type, id, operands);
      case spv::OpSelect:
        // A scalar condition picks a value of any type.
        if (const Constant* condition = find(operands[0]); condition != nullptr && condition->scalar) {
          const Constant* picked = find(operands[condition->scalar->bits != 0 ? 1 : 2]);
          if (picked == nullptr) return false;
          put_copy(id, Constant(*picked));
          return true;
        }
        return compute(op, type, id, operands);
      default:
        return compute(op, type, id, operands);
    }
  }

  bool extract(std::uint32_t id, std::uint32_t composite, Instruction indices) {
    const Constant* part = find(composite);
    for (const std::uint32_t index : indices) {
      if (part == nullptr || index >= part->constituents.size()) return false;
      part = find(part->constituents[index]);
    }
    if (part == nullptr) return false;
    put_copy(id, Constant(*part));
    return true;
  }

  bool insert(std::uint32_t id, std::uint32_t object, std::uint32_t composite, Instruction indices) {
    const Constant* whole = find(composite);
    if (whole == nullptr || indices[0] >= whole->constituents.size()) return false;
    const std::uint32_t type = whole->type;
    Words constituents = whole->constituents;
    std::uint32_t part = object;
    if (indices.size() > 1) {
      part = next_id_++;
      if (!insert(part, object, constituents[indices[0]], indices.subspan(1))) return false;
    }
    constituents[indices[0]] = part;
    put_composite(type, id, constituents);
    return true;
  }

  bool shuffle(std::uint32_t type, std::uint32_t id, Instruction operands) {
    constexpr std::uint32_t undefined = 0xffffffffu;
    const Constant *a = find(operands[0]), *b = find(operands[1]);
    if (a == nullptr || b == nullptr) return false;
    Words all = a->constituents;
    all.insert(all.end(), b->constituents.begin(), b->constituents.end());
    Words picked;
    for (const std::uint32_t index : operands.subspan(2)) {
      if (index != undefined && index >= all.size()) return false;
      picked.push_back(all[index == undefined ? 0 : index]);
    }
    put_composite(type, id, picked);
    return true;
  }

  bool compute(spv::Op op, std::uint32_t type, std::uint32_t id, Instruction operands) {
    const auto vector = vectors_.find(type);
    const std::uint32_t length = vector == vectors_.end() ? 1 : vector->second.length;
    const auto number = numbers_.find(vector == vectors_.end() ? type : vector->second.component);
    if (number == numbers_.end()) return false;
    std::vector<ScalarConstant> components;
    for (std::uint32_t k = 0; k < length; ++k) {
      std::vector<ScalarConstant> of_operands;
      for (const std::uint32_t operand : operands) {
        const Constant* constant = find(operand);
        if (constant != nullptr && k < constant->constituents.size()) constant = find(constant->constituents[k]);
        if (constant == nullptr || !constant->scalar) return false;
        of_operands.push_back(*constant->scalar);
      }
      const std::optional<ScalarConstant> component = fold_scalar(op, of_operands, number->second.width);
      if (!component) return false;
      components.push_back(*component);
    }
    if (vector == vectors_.end())
      put_scalar(type, id, components[0]);
    else
      put_vector(type, id, components);
    return true;
  }

  Instruction module_;
  Words result_;
  std::uint32_t next_id_;
  std::unordered_map<std::uint32_t, NumberType> numbers_;
  std::unordered_map<std::uint32_t, VectorType> vectors_;
  std::unordered_map<std::uint32_t, Constant> constants_;
};

}  // namespace

std::vector<std::uint32_t> fold_constants(std::span<const std::uint32_t> spirv) { return Folder(spirv).folded(); }

}  // namespace tandem::cpu
