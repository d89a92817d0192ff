#pragma once

#include <cstdint>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "rhi_cpu/translate/wide/control_flow.hpp"

namespace tandem::cpu {

/// A function of a module, with its blocks in the numbers of its flow graph.
struct WideFunction {
  FlowGraph graph;
  ControlFlow flow;
  std::vector<std::uint32_t> block_ids;
  std::unordered_map<std::uint32_t, int> numbers;  ///< of block ids
  std::vector<char> is_divergent;                  ///< by block: may run without lanes that the function began with
  std::vector<char> joins_differ;                  ///< by block: lanes may come in by different edges
  std::vector<char> branch_varies;                 ///< by block: whether lanes may leave by different edges
};

/// Where a value is defined.
struct Definition {
  std::uint32_t function;
  int block;  ///< in the numbers of its flow graph
};

/// Which values may differ between the lanes that execute together. Everything else is kept once for all lanes.
struct Uniformity {
  std::unordered_set<std::uint32_t> varying;            ///< values, and pointers to different places
  std::unordered_set<std::uint32_t> varying_contents;   ///< variables and pointer parameters
  std::unordered_set<std::uint32_t> varying_functions;  ///< what they return
};

/// Marks the blocks that differ by lanes after a branch that does: those between it and its post-dominator, where the
/// lanes join, and the whole loop where some lanes leave it before others. True when something was not marked yet.
bool mark_divergence(WideFunction& function, int branch);

}  // namespace tandem::cpu
