#include "rhi_cpu/translate/wide/uniformity.hpp"

#include <cstddef>

namespace tandem::cpu {
namespace {

std::size_t at(int block) { return static_cast<std::size_t>(block); }

bool mark(char& flag) {
  const bool is_new = flag == 0;
  flag = 1;
  return is_new;
}

}  // namespace

bool mark_divergence(WideFunction& function, int branch) {
  const ControlFlow& flow = function.flow;
  if (!mark(function.branch_varies[at(branch)])) return false;
  const int end = flow.post_dominator[at(branch)];
  std::vector<char> is_known(function.graph.blocks.size(), 0);
  std::vector<int> work = flow.forward_successors[at(branch)];
  while (!work.empty()) {
    const int block = work.back();
    work.pop_back();
    if (is_known[at(block)]) continue;
    is_known[at(block)] = 1;
    function.joins_differ[at(block)] = 1;
    if (block == end) continue;
    function.is_divergent[at(block)] = 1;
    for (const int next : flow.forward_successors[at(block)]) work.push_back(next);
  }
  // Lanes leave the loops around the branch in different rounds where the branch decides whether they stay.
  for (int loop = flow.loop[at(branch)]; loop != no_block; loop = flow.outer_loop[at(loop)]) {
    bool leaves = false;
    for (const int block : flow.order) {
      const bool is_between = block == branch || (is_known[at(block)] && block != end);
      if (!is_between || !flow.is_in_loop(block, loop)) continue;
      const std::vector<int>& successors = function.graph.blocks[at(block)].successors;
      leaves |= successors.empty();
      for (const int next : successors) leaves |= !flow.is_in_loop(next, loop);
    }
    if (!leaves) continue;
    for (const int block : flow.order)
      if (flow.is_in_loop(block, loop)) function.is_divergent[at(block)] = 1;
  }
  return true;
}

}  // namespace tandem::cpu
