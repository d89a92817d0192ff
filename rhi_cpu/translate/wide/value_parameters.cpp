#include "rhi_cpu/translate/wide/value_parameters.hpp"

#include <map>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include <spirv_cross/spirv.hpp>

#include "rhi/spirv/words.hpp"

namespace tandem::cpu {
namespace {

using rhi::for_each_instruction;
using rhi::operation_of;

struct Function {
  std::uint32_t type = 0;
  std::vector<std::uint32_t> parameters;  ///< ids
};

/// What is known of a module before anything changes.
struct Module {
  std::unordered_map<std::uint32_t, std::uint32_t> pointees;                   ///< of pointers to Function variables
  std::unordered_map<std::uint32_t, std::uint32_t> parameter_types;            ///< of parameters' ids
  std::unordered_map<std::uint32_t, Function> functions;                       ///< by id
  std::map<std::vector<std::uint32_t>, std::uint32_t> function_types;          ///< id by result and parameters
  std::unordered_map<std::uint32_t, std::vector<std::uint32_t>> type_members;  ///< the other way round
};

Module read(std::span<const std::uint32_t> spirv) {
  Module module;
  std::uint32_t current = 0;
  for_each_instruction(spirv, [&](std::span<const std::uint32_t> i) {
    switch (operation_of(i)) {
      case spv::OpTypePointer:
        if (i[2] == spv::StorageClassFunction) module.pointees[i[1]] = i[3];
        break;
      case spv::OpTypeFunction: {
        const std::vector<std::uint32_t> members(i.begin() + 2, i.end());
        module.function_types[members] = i[1];
        module.type_members[i[1]] = members;
        break;
      }
      case spv::OpFunction:
        current = i[2];
        module.functions[current].type = i[4];
        break;
      case spv::OpFunctionParameter:
        module.functions[current].parameters.push_back(i[2]);
        module.parameter_types[i[2]] = i[1];
        break;
      default:
        break;
    }
  });
  return module;
}

/// Parameters that are pointers to Function variables, which their function only reads.
std::unordered_set<std::uint32_t> find_read_only(std::span<const std::uint32_t> spirv, const Module& module) {
  std::unordered_set<std::uint32_t> found;
  for (const auto& [id, type] : module.parameter_types)
    if (module.pointees.contains(type)) found.insert(id);
  for (bool changed = true; changed;) {
    changed = false;
    std::unordered_map<std::uint32_t, std::uint32_t> parameter_of;  // pointers into a parameter
    for (const std::uint32_t id : found) parameter_of[id] = id;
    const auto written = [&](std::uint32_t id) {
      if (const auto known = parameter_of.find(id); known != parameter_of.end())
        changed |= found.erase(known->second) > 0;
    };
    for_each_instruction(spirv, [&](std::span<const std::uint32_t> i) {
      switch (operation_of(i)) {
        case spv::OpFunctionParameter:
        case spv::OpLoad:
        case spv::OpName:
        case spv::OpDecorate:
          return;
        case spv::OpAccessChain:
        case spv::OpInBoundsAccessChain:
          if (parameter_of.contains(i[3])) parameter_of[i[2]] = parameter_of[i[3]];
          return;
        case spv::OpFunctionCall: {
          const auto& parameters = module.functions.at(i[3]).parameters;
          // A part of a parameter could be loaded for the call too; front ends pass none.
          for (std::size_t k = 4; k < i.size(); ++k)
            if (!found.contains(i[k]) || !found.contains(parameters[k - 4])) written(i[k]);
          return;
        }
        default:
          // A number that is no id may be taken for one, which only keeps a pointer.
          for (std::size_t k = 1; k < i.size(); ++k) written(i[k]);
      }
    });
  }
  return found;
}

class Rewriter {
 public:
  Rewriter(std::span<const std::uint32_t> spirv, Module module, std::unordered_set<std::uint32_t> by_value)
      : module_(std::move(module)), by_value_(std::move(by_value)), bound_(spirv[3]) {}

  std::vector<std::uint32_t> run(std::span<const std::uint32_t> spirv) {
    words_.assign(spirv.begin(), spirv.begin() + rhi::spirv_header_words);
    for_each_instruction(spirv, [&](std::span<const std::uint32_t> i) { write(i); });
    words_[3] = bound_;
    return std::move(words_);
  }

 private:
  std::uint32_t pointee(std::uint32_t parameter) const {
    return module_.pointees.at(module_.parameter_types.at(parameter));
  }

  void add(std::initializer_list<std::uint32_t> words, spv::Op op) {
    words_.push_back(static_cast<std::uint32_t>(words.size() + 1) << 16 | static_cast<std::uint32_t>(op));
    words_.insert(words_.end(), words);
  }

  std::uint32_t type_of(const Function& function) {
    std::vector<std::uint32_t> members = module_.type_members.at(function.type);
    for (std::size_t k = 0; k < function.parameters.size(); ++k)
      if (by_value_.contains(function.parameters[k])) members[k + 1] = pointee(function.parameters[k]);
    return module_.function_types.at(members);
  }

  /// Function types that the module does not have yet, in front of the first function.
  void add_types() {
    if (std::exchange(has_types_, true)) return;
    for (const auto& [id, function] : module_.functions) {
      std::vector<std::uint32_t> members = module_.type_members.at(function.type);
      for (std::size_t k = 0; k < function.parameters.size(); ++k)
        if (by_value_.contains(function.parameters[k])) members[k + 1] = pointee(function.parameters[k]);
      const auto [place, is_new] = module_.function_types.try_emplace(members, bound_);
      if (!is_new) continue;
      ++bound_;
      words_.push_back(static_cast<std::uint32_t>(members.size() + 2) << 16 | spv::OpTypeFunction);
      words_.push_back(place->second);
      words_.insert(words_.end(), members.begin(), members.end());
    }
  }

  /// The parameters of this function as variables, behind the variables it has.
  void store_parameters() {
    for (const auto& [variable, value] : stored_) add({variable, value}, spv::OpStore);
    stored_.clear();
  }

  void write(std::span<const std::uint32_t> i) {
    const spv::Op op = operation_of(i);
    if (op == spv::OpFunction) add_types();
    if (is_first_block_ && op != spv::OpVariable && op != spv::OpLine && op != spv::OpNoLine) {
      store_parameters();
      is_first_block_ = false;
    }
    if (op == spv::OpFunctionCall) load_arguments(i);
    const std::size_t begin = words_.size();
    if (op == spv::OpFunctionParameter && by_value_.contains(i[2])) {
      add({pointee(i[2]), bound_}, op);
      waiting_.emplace_back(i[2], bound_++);
      return;
    }
    words_.insert(words_.end(), i.begin(), i.end());
    if (op == spv::OpFunction) words_[begin + 4] = type_of(module_.functions.at(i[2]));
    if (op == spv::OpFunctionCall)
      for (std::size_t k = 4; k < i.size(); ++k)
        if (loaded_[k - 4] != 0) words_[begin + k] = loaded_[k - 4];
    if (op == spv::OpLabel && !waiting_.empty()) {
      for (const auto& [variable, value] : waiting_)
        add({module_.parameter_types.at(variable), variable, spv::StorageClassFunction}, spv::OpVariable);
      stored_ = std::exchange(waiting_, {});
      is_first_block_ = true;
    }
  }

  void load_arguments(std::span<const std::uint32_t> call) {
    const std::vector<std::uint32_t>& parameters = module_.functions.at(call[3]).parameters;
    loaded_.assign(parameters.size(), 0);
    for (std::size_t k = 0; k < parameters.size(); ++k) {
      if (!by_value_.contains(parameters[k])) continue;
      loaded_[k] = bound_++;
      add({pointee(parameters[k]), loaded_[k], call[k + 4]}, spv::OpLoad);
    }
  }

  Module module_;
  std::unordered_set<std::uint32_t> by_value_;
  std::uint32_t bound_;
  std::vector<std::uint32_t> words_;
  bool has_types_ = false;
  bool is_first_block_ = false;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> waiting_, stored_;  ///< variables and the values they begin with
  std::vector<std::uint32_t> loaded_;                                      ///< arguments of a call
};

}  // namespace

std::vector<std::uint32_t> with_value_parameters(std::span<const std::uint32_t> spirv) {
  Module module = read(spirv);
  std::unordered_set<std::uint32_t> by_value = find_read_only(spirv, module);
  return Rewriter(spirv, std::move(module), std::move(by_value)).run(spirv);
}

}  // namespace tandem::cpu
