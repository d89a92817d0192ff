#include "rhi_cpu/translate/wide/control_flow.hpp"

#include <algorithm>
#include <cstddef>
#include <stdexcept>

namespace tandem::cpu {
namespace {

std::size_t at(int block) { return static_cast<std::size_t>(block); }

/// Blocks in the reverse of the order in which a depth-first search leaves them. Of the successors, those that
/// structure says to come last are visited first.
std::vector<int> structured_order(const FlowGraph& graph) {
  struct Visit {
    int block;
    std::vector<int> rest;  ///< next one last
  };
  std::vector<char> is_reached(graph.blocks.size(), 0), is_known(graph.blocks.size(), 0);
  std::vector<int> work{0};
  is_reached[0] = 1;
  while (!work.empty()) {
    const int block = work.back();
    work.pop_back();
    for (const int next : graph.blocks[at(block)].successors)
      if (!is_reached[at(next)]) {
        is_reached[at(next)] = 1;
        work.push_back(next);
      }
  }
  const auto visit = [&](int block) {
    is_known[at(block)] = 1;
    const FlowGraph::Block& each = graph.blocks[at(block)];
    std::vector<int> rest = each.successors;
    for (const int last : {each.continue_target, each.merge})
      if (last != no_block && is_reached[at(last)]) rest.push_back(last);
    return Visit{block, std::move(rest)};
  };
  std::vector<int> order;
  std::vector<Visit> stack{visit(0)};
  while (!stack.empty()) {
    if (stack.back().rest.empty()) {
      order.push_back(stack.back().block);
      stack.pop_back();
      continue;
    }
    const int next = stack.back().rest.back();
    stack.back().rest.pop_back();
    if (!is_known[at(next)]) stack.push_back(visit(next));
  }
  std::reverse(order.begin(), order.end());
  return order;
}

/// Immediate dominators of a graph whose nodes are numbered so that node 0 is the root and every node but the root has
/// a predecessor, in reverse postorder (Cooper, Harvey and Kennedy, "A Simple, Fast Dominance Algorithm", 2001).
std::vector<int> dominators(const std::vector<std::vector<int>>& predecessors) {
  std::vector<int> result(predecessors.size(), no_block);
  if (result.empty()) return result;
  result[0] = 0;
  for (bool changed = true; changed;) {
    changed = false;
    for (std::size_t node = 1; node < predecessors.size(); ++node) {
      int found = no_block;
      for (const int each : predecessors[node]) {
        if (result[at(each)] == no_block) continue;
        if (found == no_block) {
          found = each;
          continue;
        }
        int a = each, b = found;
        while (a != b) {
          while (a > b) a = result[at(a)];
          while (b > a) b = result[at(b)];
        }
        found = a;
      }
      if (found != result[node]) {
        result[node] = found;
        changed = true;
      }
    }
  }
  result[0] = no_block;
  return result;
}

/// A loop is what SPIR-V calls the loop construct with its continue construct: what the header dominates and the merge
/// block does not. A block that ends in a break belongs to it, so that the lanes of one round execute it together.
void find_loops(const FlowGraph& graph, ControlFlow& flow) {
  flow.loop.assign(graph.blocks.size(), no_block);
  flow.outer_loop.assign(graph.blocks.size(), no_block);
  // In structured order, so that inner loops overwrite outer ones.
  for (const int header : flow.order) {
    const FlowGraph::Block& block = graph.blocks[at(header)];
    if (block.continue_target == no_block) continue;
    flow.outer_loop[at(header)] = flow.loop[at(header)];
    const bool has_merge = block.merge != no_block && flow.is_reached(block.merge);
    for (const int each : flow.order)
      if (flow.dominates(header, each) && !(has_merge && flow.dominates(block.merge, each)))
        flow.loop[at(each)] = header;
  }
  for (const int block : flow.order)
    for (const int from : flow.predecessors[at(block)])
      if (flow.position[at(from)] >= flow.position[at(block)] &&
          !(flow.is_header(block) && flow.dominates(block, from)))
        throw std::runtime_error("the control flow is not structured");
}

void find_post_dominators(const FlowGraph& graph, ControlFlow& flow) {
  flow.forward_successors.resize(graph.blocks.size());
  for (const int block : flow.order) {
    auto& forward = flow.forward_successors[at(block)];
    for (int next : graph.blocks[at(block)].successors) {
      if (flow.position[at(next)] <= flow.position[at(block)]) next = graph.blocks[at(next)].merge;
      if (next == no_block || !flow.is_reached(next)) continue;
      if (std::find(forward.begin(), forward.end(), next) == forward.end()) forward.push_back(next);
    }
  }
  // The graph turned around, with an end that all ways lead to as its root. The reverse of the structured order is a
  // reverse postorder of it, because forward edges lead forward in the order.
  const std::size_t count = flow.order.size();
  const auto node = [&](int block) { return static_cast<int>(count) - flow.position[at(block)]; };
  std::vector<std::vector<int>> predecessors(count + 1);
  for (const int block : flow.order) {
    for (const int next : flow.forward_successors[at(block)]) predecessors[at(node(block))].push_back(node(next));
    if (flow.forward_successors[at(block)].empty()) predecessors[at(node(block))].push_back(0);
  }
  const std::vector<int> found = dominators(predecessors);
  flow.post_dominator.assign(graph.blocks.size(), no_block);
  for (const int block : flow.order) {
    const int each = found[at(node(block))];
    if (each > 0) flow.post_dominator[at(block)] = flow.order[count - at(each)];
  }
}

}  // namespace

bool ControlFlow::is_in_loop(int block, int header) const {
  if (header == no_block) return true;
  for (int each = loop[at(block)]; each != no_block; each = outer_loop[at(each)])
    if (each == header) return true;
  return false;
}

int ControlFlow::loop_around(int block) const { return is_header(block) ? outer_loop[at(block)] : loop[at(block)]; }

bool ControlFlow::dominates(int a, int b) const {
  while (b != no_block && position[at(b)] > position[at(a)]) b = dominator[at(b)];
  return a == b;
}

bool ControlFlow::is_equivalent(int a, int b) const {
  if (loop[at(a)] != loop_around(b) || !dominates(a, b)) return false;
  for (int each = a; each != no_block; each = post_dominator[at(each)])
    if (each == b) return true;
  return false;
}

ControlFlow analyze(const FlowGraph& graph) {
  ControlFlow flow;
  flow.order = structured_order(graph);
  flow.position.assign(graph.blocks.size(), no_block);
  for (std::size_t i = 0; i < flow.order.size(); ++i) flow.position[at(flow.order[i])] = static_cast<int>(i);

  flow.predecessors.resize(graph.blocks.size());
  std::vector<std::vector<int>> by_position(flow.order.size());
  for (const int block : flow.order) {
    for (const int next : graph.blocks[at(block)].successors) {
      auto& known = flow.predecessors[at(next)];
      if (std::find(known.begin(), known.end(), block) != known.end()) continue;
      known.push_back(block);
      by_position[at(flow.position[at(next)])].push_back(flow.position[at(block)]);
    }
  }
  const std::vector<int> found = dominators(by_position);
  flow.dominator.assign(graph.blocks.size(), no_block);
  for (std::size_t i = 0; i < found.size(); ++i)
    if (found[i] != no_block) flow.dominator[at(flow.order[i])] = flow.order[at(found[i])];

  find_loops(graph, flow);
  find_post_dominators(graph, flow);
  return flow;
}

}  // namespace tandem::cpu
