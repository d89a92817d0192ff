#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "rhi_cpu/trace/exact/bounds.hpp"

namespace tandem::cpu::exact {

/// A binary tree of bounds over items, split at the median of their centres.
class Bvh {
 public:
  Bvh() = default;  ///< of no items
  /// @param items bounds of each, none empty
  explicit Bvh(std::span<const Bounds> items);

  /// Of everything; empty without items.
  Bounds bounds() const { return nodes_.empty() ? Bounds{} : nodes_[0].bounds; }
  std::size_t bytes() const { return nodes_.size() * sizeof(Node) + items_.size() * sizeof(std::uint32_t); }

  /// Calls visit(item) for the items of every leaf whose bounds the ray may meet in the interval, near ones first,
  /// until it returns false. `visit` may shorten the interval.
  /// @return false when visit did
  template <class Visit>
  bool traverse(const RayLine& ray, const Interval& interval, const Visit& visit) const {
    struct Entry {
      std::uint32_t node;
      double t;
    };
    constexpr double infinity = std::numeric_limits<double>::infinity();
    // The tree is balanced: 32 levels for 2^32 items, and at each one sibling waits.
    std::array<Entry, 40> stack;
    std::size_t size = 0;
    const auto entry_into = [&](std::uint32_t node) {
      return Entry{node, ray.entry_into(nodes_[node].bounds, interval)};
    };
    const auto is_met = [&](const Entry& entry) { return entry.t <= interval.last && entry.t < infinity; };
    if (!nodes_.empty()) stack[size++] = entry_into(0);
    while (size > 0) {
      const Entry entry = stack[--size];
      if (!is_met(entry)) continue;
      const Node& node = nodes_[entry.node];
      for (std::uint32_t i = 0; i < node.item_count; ++i) {
        if (!visit(items_[node.first + i])) return false;
      }
      if (node.item_count > 0) continue;
      Entry near = entry_into(node.first);
      Entry far = entry_into(node.first + 1);
      if (far.t < near.t) std::swap(near, far);
      if (is_met(far)) stack[size++] = far;
      if (is_met(near)) stack[size++] = near;
    }
    return true;
  }

 private:
  struct Node {
    Bounds bounds;
    std::uint32_t first;       ///< of a leaf: in items_; else the first of two children that lie together
    std::uint32_t item_count;  ///< 0: not a leaf
  };

  void split(std::span<const Bounds> items, std::uint32_t node, std::uint32_t first, std::uint32_t end);

  std::vector<Node> nodes_;
  std::vector<std::uint32_t> items_;
};

}  // namespace tandem::cpu::exact
