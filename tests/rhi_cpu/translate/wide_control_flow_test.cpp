#include <doctest/doctest.h>

#include <stdexcept>
#include <vector>

#include "rhi_cpu/translate/wide/control_flow.hpp"
#include "rhi_cpu/translate/wide/uniformity.hpp"

namespace {

using tandem::cpu::analyze;
using tandem::cpu::ControlFlow;
using tandem::cpu::FlowGraph;
using tandem::cpu::mark_divergence;
using tandem::cpu::no_block;
using tandem::cpu::WideFunction;

/// Every edge but those back to a header that dominates their source leads forward in the order.
void check_order(const FlowGraph& graph, const ControlFlow& flow) {
  for (const int block : flow.order)
    for (const int next : graph.blocks[static_cast<std::size_t>(block)].successors) {
      const bool is_back =
          flow.position[static_cast<std::size_t>(next)] <= flow.position[static_cast<std::size_t>(block)];
      CHECK(is_back == (flow.is_header(next) && flow.dominates(next, block)));
    }
}

ControlFlow analyzed(const FlowGraph& graph) {
  ControlFlow flow = analyze(graph);
  check_order(graph, flow);
  return flow;
}

WideFunction function_of(const FlowGraph& graph) {
  WideFunction function;
  function.graph = graph;
  function.flow = analyze(graph);
  function.is_divergent.assign(graph.blocks.size(), 0);
  function.joins_differ.assign(graph.blocks.size(), 0);
  function.branch_varies.assign(graph.blocks.size(), 0);
  return function;
}

// if (...) 1 else 2; 3
const FlowGraph diamond = {{{{1, 2}, 3}, {{3}}, {{3}}, {{}}}};

// 0: before; 1: header; 2: body with a break; 3: rest of the body; 4: continue target; 5: merge
const FlowGraph loop_with_break = {{{{1}}, {{2, 5}, 5, 4}, {{5, 3}, 3}, {{4}}, {{1}}, {{}}}};

// for (...) { for (...) {} }: 1 and 2 are headers, 3 the inner body, 4 its continue target, 5 its merge, 6 the outer
// continue target, 7 the outer merge
const FlowGraph nested = {{{{1}}, {{2, 7}, 7, 6}, {{3, 5}, 5, 4}, {{4}}, {{2}}, {{6}}, {{1}}, {{}}}};

// switch with fall-through: 1 falls into 2, which breaks; 3 is the default
const FlowGraph fall_through = {{{{2, 1, 3}, 4}, {{2}}, {{4}}, {{4}}, {{}}}};

}  // namespace

TEST_CASE("a selection: both sides are dominated by its branch and come together behind it") {
  const ControlFlow flow = analyzed(diamond);
  CHECK(flow.order.front() == 0);
  CHECK(flow.order.back() == 3);
  CHECK(flow.dominator == std::vector<int>{no_block, 0, 0, 0});
  CHECK(flow.post_dominator == std::vector<int>{3, 3, 3, no_block});
  CHECK(flow.loop == std::vector<int>(4, no_block));
  CHECK(flow.is_equivalent(0, 3));
  CHECK_FALSE(flow.is_equivalent(0, 1));
  CHECK_FALSE(flow.is_equivalent(1, 3));
  CHECK_FALSE(flow.is_equivalent(3, 0));
  CHECK(flow.predecessors[3].size() == 2);
}

TEST_CASE("a loop: its blocks, and a post-dominator that takes it for left in the end") {
  const ControlFlow flow = analyzed(loop_with_break);
  CHECK(flow.loop == std::vector<int>{no_block, 1, 1, 1, 1, no_block});
  CHECK(flow.outer_loop[1] == no_block);
  CHECK(flow.is_header(1));
  CHECK_FALSE(flow.is_header(4));
  CHECK(flow.dominator == std::vector<int>{no_block, 0, 1, 2, 3, 1});
  CHECK(flow.post_dominator == std::vector<int>{1, 5, 5, 4, 5, no_block});
  CHECK(flow.forward_successors[4] == std::vector<int>{5});
  CHECK(flow.is_equivalent(0, 5));
  CHECK(flow.is_equivalent(0, 1));
  CHECK(flow.is_equivalent(3, 4));
  // The header runs once for every round.
  CHECK_FALSE(flow.is_equivalent(1, 5));
  CHECK_FALSE(flow.is_equivalent(2, 4));
}

TEST_CASE("a return in a loop: what follows the loop has no longer the lanes that came to it") {
  FlowGraph graph = loop_with_break;
  graph.blocks[3].successors = {4, 6};
  graph.blocks[3].merge = 4;
  graph.blocks.push_back({});
  const ControlFlow flow = analyzed(graph);
  CHECK(flow.post_dominator[1] == no_block);
  CHECK_FALSE(flow.is_equivalent(0, 5));
  // What ends in a return belongs to the loop that it is in, so that the lanes of a round execute it together.
  CHECK(flow.loop[6] == 1);
}

TEST_CASE("nested loops: each block is in the innermost") {
  const ControlFlow flow = analyzed(nested);
  CHECK(flow.loop == std::vector<int>{no_block, 1, 2, 2, 2, 1, 1, no_block});
  CHECK(flow.outer_loop[2] == 1);
  CHECK(flow.outer_loop[1] == no_block);
  CHECK(flow.loop_around(2) == 1);
  CHECK(flow.loop_around(3) == 2);
  CHECK(flow.is_in_loop(3, 1));
  CHECK(flow.is_in_loop(3, 2));
  CHECK(flow.is_in_loop(5, 1));
  CHECK_FALSE(flow.is_in_loop(5, 2));
  CHECK(flow.is_in_loop(7, no_block));
  CHECK(flow.is_equivalent(2, 3) == false);
  CHECK(flow.is_equivalent(5, 6));
  CHECK(flow.post_dominator[2] == 5);
  CHECK(flow.post_dominator[4] == 5);
}

TEST_CASE("a switch with fall-through: a case comes before the one that it falls into") {
  const ControlFlow flow = analyzed(fall_through);
  CHECK(flow.position[1] < flow.position[2]);
  CHECK(flow.position[4] == 4);
  CHECK(flow.dominator == std::vector<int>{no_block, 0, 0, 0, 0});
  CHECK(flow.post_dominator == std::vector<int>{4, 2, 4, 4, no_block});
  CHECK(flow.is_equivalent(0, 4));
  CHECK_FALSE(flow.is_equivalent(1, 2));
}

TEST_CASE("a loop of one block, and one whose continue target nothing leads to") {
  const ControlFlow single = analyzed({{{{1}}, {{1, 2}, 2, 1}, {{}}}});
  CHECK(single.loop == std::vector<int>{no_block, 1, no_block});
  CHECK(single.is_equivalent(0, 2));
  const ControlFlow once = analyzed({{{{1}}, {{2}, 2, 3}, {{}}, {{1}}}});
  CHECK_FALSE(once.is_reached(3));
  CHECK(once.loop[1] == 1);
  CHECK(once.loop[2] == no_block);
  CHECK(once.order == std::vector<int>{0, 1, 2});
}

TEST_CASE("an edge back to a block that is no loop's header is refused") {
  CHECK_THROWS_AS(analyze({{{{1}}, {{2, 3}}, {{1}}, {{}}}}), std::runtime_error);
}

TEST_CASE("a branch that differs by lanes: what is between it and where they come together") {
  WideFunction function = function_of(diamond);
  CHECK(mark_divergence(function, 0));
  CHECK_FALSE(mark_divergence(function, 0));
  CHECK(function.is_divergent == std::vector<char>{0, 1, 1, 0});
  CHECK(function.joins_differ == std::vector<char>{0, 1, 1, 1});
}

TEST_CASE("a break that differs by lanes: the whole loop, and what leaves it from two places") {
  WideFunction function = function_of(loop_with_break);
  mark_divergence(function, 2);
  CHECK(function.is_divergent == std::vector<char>{0, 1, 1, 1, 1, 0});
  CHECK(function.joins_differ[5] == 1);
  // A branch of which both sides stay in the loop leaves the loop uniform.
  FlowGraph staying = loop_with_break;
  staying.blocks[2] = {{3, 4}, 4};
  function = function_of(staying);
  mark_divergence(function, 2);
  CHECK(function.is_divergent == std::vector<char>{0, 0, 0, 1, 0, 0});
}

TEST_CASE("a break that differs by lanes out of an inner loop leaves the outer one uniform") {
  FlowGraph graph = nested;
  graph.blocks[3] = {{5, 4}, 4};
  WideFunction function = function_of(graph);
  mark_divergence(function, 3);
  CHECK(function.is_divergent == std::vector<char>{0, 0, 1, 1, 1, 0, 0, 0});
}
