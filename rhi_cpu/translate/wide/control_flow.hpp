#pragma once

#include <cstdint>
#include <vector>

/// The control flow of a function, as the wide form needs it: an order of the blocks in which every lane's way leads
/// forward, but for the edges back to loop headers.
namespace tandem::cpu {

inline constexpr int no_block = -1;

/// A function's blocks by number; block 0 is its entry.
struct FlowGraph {
  struct Block {
    std::vector<int> successors;
    int merge = no_block;            ///< of a selection or a loop
    int continue_target = no_block;  ///< of a loop: what makes its header one
  };
  std::vector<Block> blocks;
};

/// All vectors are by block. Blocks that the entry does not lead to are in none of the orders.
struct ControlFlow {
  std::vector<int> order;      ///< blocks in structured order: a construct's before its merge block
  std::vector<int> position;   ///< of a block in `order`; no_block: never reached
  std::vector<int> dominator;  ///< immediate; no_block of the entry
  /// Innermost loop that a block belongs to, by its header; of a header itself: its own loop. no_block: none.
  std::vector<int> loop;
  std::vector<int> outer_loop;  ///< of a header: the loop around its loop
  /// The nearest block that every way forward from a block leads to, a loop being left in the end; no_block: none.
  std::vector<int> post_dominator;
  std::vector<std::vector<int>> predecessors;        ///< along all edges, each block once
  std::vector<std::vector<int>> forward_successors;  ///< edges back to a header lead to its merge block instead

  bool is_header(int block) const { return loop[static_cast<std::size_t>(block)] == block; }
  bool is_reached(int block) const { return position[static_cast<std::size_t>(block)] != no_block; }
  /// Whether `block` is in the loop of `header`, or `header` is no_block.
  bool is_in_loop(int block, int header) const;
  /// The loop around a block: of a header, the one around its own loop.
  int loop_around(int block) const;
  bool dominates(int a, int b) const;
  /// Whether exactly the lanes that execute `a` execute `b`, once for each time: a dominates b, all ways lead to b, and
  /// both are in the same loop.
  bool is_equivalent(int a, int b) const;
};

/// Throws std::runtime_error for control flow that is not structured by the rules of SPIR-V.
ControlFlow analyze(const FlowGraph& graph);

}  // namespace tandem::cpu
