#include "rhi_cpu/translate/groups/places.hpp"

#include <algorithm>
#include <functional>
#include <unordered_map>
#include <unordered_set>

#include "rhi/spirv/words.hpp"

namespace tandem::cpu {
namespace {

using rhi::operation_of;
using Words = std::span<const std::uint32_t>;

struct Block {
  std::vector<Words> instructions;  ///< with its label and its end
  std::vector<std::uint32_t> successors;
  std::uint32_t merge = 0;         ///< 0 for what is no header
  std::uint32_t continuation = 0;  ///< of the header of a loop
};

struct Function {
  std::uint32_t id = 0;
  std::vector<Words> head = {};           ///< OpFunction and its parameters
  std::vector<std::uint32_t> order = {};  ///< labels in the order of the module
  std::unordered_map<std::uint32_t, Block> blocks = {};
};

struct Module {
  std::vector<Words> globals;
  std::vector<Function> functions;
  std::unordered_map<std::uint32_t, std::uint32_t> types;   ///< of what has one
  std::unordered_map<std::uint32_t, std::uint32_t> widths;  ///< of types of integers, in bits
};

void add_to(Block& block, Words i, const Module& module) {
  block.instructions.push_back(i);
  switch (operation_of(i)) {
    case spv::OpSelectionMerge:
      block.merge = i[1];
      break;
    case spv::OpLoopMerge:
      block.merge = i[1];
      block.continuation = i[2];
      break;
    case spv::OpBranch:
      block.successors = {i[1]};
      break;
    case spv::OpBranchConditional:
      block.successors = {i[2], i[3]};
      break;
    case spv::OpSwitch: {
      const std::size_t literal_words = module.widths.at(module.types.at(i[1])) > 32 ? 2 : 1;
      block.successors = {i[2]};
      for (std::size_t k = 3 + literal_words; k < i.size(); k += literal_words + 1) block.successors.push_back(i[k]);
      break;
    }
    default:
      break;
  }
}

Module parsed(Words spirv) {
  Module module;
  Block* block = nullptr;
  rhi::for_each_instruction(spirv, [&](Words i) {
    const spv::Op op = operation_of(i);
    bool has_result = false, has_type = false;
    spv::HasResultAndType(op, &has_result, &has_type);
    if (has_result && has_type) module.types[i[2]] = i[1];
    if (op == spv::OpTypeInt) module.widths[i[1]] = i[2];
    if (op == spv::OpFunction) {
      module.functions.push_back({.id = i[2]});
      block = nullptr;
    }
    if (module.functions.empty()) return module.globals.push_back(i);
    Function& function = module.functions.back();
    if (op == spv::OpFunctionEnd) {
      block = nullptr;
      return;
    }
    if (op == spv::OpLabel) {
      function.order.push_back(i[1]);
      block = &function.blocks[i[1]];
    }
    if (block == nullptr) return function.head.push_back(i);
    add_to(*block, i, module);
  });
  return module;
}

/// Labels of blocks that can be reached, a header before its merge block and all between them in between.
std::vector<std::uint32_t> structured_order(const Function& function) {
  std::vector<std::uint32_t> order;
  if (function.order.empty()) return order;
  struct Step {
    std::uint32_t label;
    std::vector<std::uint32_t> next;  ///< not visited yet, the last first
  };
  std::unordered_set<std::uint32_t> known;
  std::vector<Step> steps;
  const auto enter = [&](std::uint32_t label) {
    const auto found = function.blocks.find(label);
    if (found == function.blocks.end() || !known.insert(label).second) return;
    const Block& block = found->second;
    std::vector<std::uint32_t> next(block.successors.rbegin(), block.successors.rend());
    // What is visited first comes last.
    if (block.continuation != 0) next.push_back(block.continuation);
    if (block.merge != 0) next.push_back(block.merge);
    steps.push_back({label, std::move(next)});
  };
  enter(function.order.front());
  while (!steps.empty()) {
    Step& step = steps.back();
    if (step.next.empty()) {
      order.push_back(step.label);
      steps.pop_back();
    } else {
      const std::uint32_t label = step.next.back();
      step.next.pop_back();
      enter(label);
    }
  }
  std::reverse(order.begin(), order.end());
  return order;
}

class Marker {
 public:
  explicit Marker(Words spirv) : spirv_(spirv), module_(parsed(spirv)) {}

  MarkedModule marked() {
    find_meeting_functions();
    result_.words.assign(spirv_.begin(), spirv_.begin() + rhi::spirv_header_words);
    for (const Words i : module_.globals) append(i);
    for (const Function& function : module_.functions) number(function);
    for (const Function& function : module_.functions) print(function);
    for (const Function& function : module_.functions) result_.depth = std::max(result_.depth, depth_of(function.id));
    return std::move(result_);
  }

 private:
  bool is_place(Words i) const {
    return is_meeting(operation_of(i)) || (operation_of(i) == spv::OpFunctionCall && meeting_.contains(i[3]));
  }

  /// Functions that have places. Functions may be called before they are declared.
  void find_meeting_functions() {
    for (bool found = true; found;) {
      found = false;
      for (const Function& function : module_.functions)
        for (const auto& [label, block] : function.blocks)
          for (const Words i : block.instructions)
            if (is_place(i)) found |= meeting_.insert(function.id).second;
    }
  }

  void number(const Function& function) {
    if (!meeting_.contains(function.id)) return;
    const std::vector<std::uint32_t> order = structured_order(function);
    std::unordered_map<std::uint32_t, std::size_t> position;
    for (std::size_t k = 0; k < order.size(); ++k) position[order[k]] = k;

    struct Open {
      std::uint32_t header;
      std::size_t end;
      bool is_listed = false;  ///< in result_.loops, because of a place in it
      std::uint32_t number;
      std::uint32_t index = 0;
    };
    std::vector<Open> open;
    std::uint32_t number = 0;
    for (std::size_t k = 0; k < order.size(); ++k) {
      while (!open.empty() && open.back().end <= k) open.pop_back();
      const Block& block = function.blocks.at(order[k]);
      if (block.continuation != 0)
        open.push_back({.header = order[k], .end = position.at(block.merge), .number = ++number});
      for (const Words i : block.instructions) {
        if (!is_place(i)) continue;
        Place place;
        for (std::size_t d = 0; d < open.size(); ++d) {
          Open& loop = open[d];
          if (!loop.is_listed) {
            loop.is_listed = true;
            loop.index = static_cast<std::uint32_t>(result_.loops.size());
            result_.loops.push_back({.number = loop.number, .inner = {}});
            loop_of_header_[loop.header] = loop.index;
            if (d > 0) result_.loops[open[d - 1].index].inner.push_back(loop.index);
            loops_of_[function.id].push_back(loop.index);
          }
          place.loops.push_back(loop.index);
        }
        place.number = ++number;
        places_[i.data()] = static_cast<std::uint32_t>(result_.places.size());
        result_.places.push_back(place);
      }
    }
  }

  void append(Words i) { result_.words.insert(result_.words.end(), i.begin(), i.end()); }
  void append_mark(spv::Op op, std::uint32_t index) {
    result_.words.push_back(2u << 16 | op);
    result_.words.push_back(mark_bit | index);
  }

  void print(const Function& function) {
    for (const Words i : function.head) append(i);
    for (const std::uint32_t label : function.order) {
      const Block& block = function.blocks.at(label);
      bool is_open = label != function.order.front();  // declarations go behind the variables
      for (const Words i : block.instructions) {
        const spv::Op op = operation_of(i);
        if (!is_open && op != spv::OpLabel && op != spv::OpVariable && op != spv::OpLine && op != spv::OpNoLine) {
          is_open = true;
          for (const std::uint32_t loop : loops_of_[function.id]) append_mark(loop_declaration, loop);
        }
        const auto loop = loop_of_header_.find(label);
        if (op == spv::OpLoopMerge && loop != loop_of_header_.end()) append_mark(round_mark, loop->second);
        if (const auto place = places_.find(i.data()); place != places_.end()) append_mark(place_mark, place->second);
        append(i);
      }
    }
    result_.words.push_back(1u << 16 | spv::OpFunctionEnd);
  }

  std::uint32_t depth_of(std::uint32_t function) {
    if (const auto known = depths_.find(function); known != depths_.end()) return known->second;
    std::uint32_t depth = 0;
    for (const Function& each : module_.functions) {
      if (each.id != function) continue;
      for (const auto& [label, block] : each.blocks)
        for (const Words i : block.instructions) {
          const auto place = places_.find(i.data());
          if (place == places_.end()) continue;
          const auto own = static_cast<std::uint32_t>(2 * result_.places[place->second].loops.size() + 1);
          depth = std::max(depth, own + (operation_of(i) == spv::OpFunctionCall ? depth_of(i[3]) : 0));
        }
    }
    return depths_[function] = depth;
  }

  Words spirv_;
  Module module_;
  MarkedModule result_;
  std::unordered_set<std::uint32_t> meeting_;
  std::unordered_map<const std::uint32_t*, std::uint32_t> places_;  ///< by the first word of an instruction
  std::unordered_map<std::uint32_t, std::uint32_t> loop_of_header_;
  std::unordered_map<std::uint32_t, std::vector<std::uint32_t>> loops_of_;  ///< of a function
  std::unordered_map<std::uint32_t, std::uint32_t> depths_;
};

}  // namespace

bool is_meeting(spv::Op op) {
  switch (op) {
    case spv::OpGroupNonUniformInverseBallot:
    case spv::OpGroupNonUniformBallotBitExtract:
    case spv::OpGroupNonUniformBallotBitCount:
    case spv::OpGroupNonUniformBallotFindLSB:
    case spv::OpGroupNonUniformBallotFindMSB:
      return false;  // of a ballot that the invocation has
    case spv::OpGroupNonUniformRotateKHR:
    case spv::OpSubgroupBallotKHR:
    case spv::OpSubgroupFirstInvocationKHR:
    case spv::OpSubgroupReadInvocationKHR:
    case spv::OpSubgroupAllKHR:
    case spv::OpSubgroupAnyKHR:
    case spv::OpSubgroupAllEqualKHR:
    case spv::OpControlBarrier:
      return true;
    default:
      return op >= spv::OpGroupNonUniformElect && op <= spv::OpGroupNonUniformQuadSwap;
  }
}

bool has_meetings(std::span<const std::uint32_t> spirv) {
  std::unordered_map<std::uint32_t, std::uint32_t> constants;
  bool found = false;
  rhi::for_each_instruction(spirv, [&](Words i) {
    if (operation_of(i) == spv::OpConstant) constants[i[2]] = i[3];
    const bool is_barrier = operation_of(i) == spv::OpControlBarrier;
    found |= is_meeting(operation_of(i)) && !(is_barrier && constants[i[1]] == spv::ScopeWorkgroup);
  });
  return found;
}

MarkedModule with_marked_places(std::span<const std::uint32_t> spirv) { return Marker(spirv).marked(); }

}  // namespace tandem::cpu
