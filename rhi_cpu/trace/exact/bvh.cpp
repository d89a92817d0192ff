#include "rhi_cpu/trace/exact/bvh.hpp"

#include <algorithm>
#include <numeric>

// compare/geometry/bounding_volumes.cpp splits the tree of the probes' reference tracer in the same way. The two share
// no code on purpose: the reference judges this device too, and a fault that they had in common would stay unseen.

namespace tandem::cpu::exact {
namespace {

constexpr std::uint32_t largest_leaf = 1;

/// Twice the centre.
double centre(const Bounds& bounds, std::size_t axis) { return bounds.lower[axis] + bounds.upper[axis]; }

}  // namespace

Bvh::Bvh(std::span<const Bounds> items) : items_(items.size()) {
  if (items.empty()) return;
  std::iota(items_.begin(), items_.end(), 0u);
  nodes_.emplace_back();
  split(items, 0, 0, static_cast<std::uint32_t>(items.size()));
}

void Bvh::split(std::span<const Bounds> items, std::uint32_t node, std::uint32_t first, std::uint32_t end) {
  Bounds bounds;
  Bounds centres;
  for (std::uint32_t i = first; i < end; ++i) {
    const Bounds& item = items[items_[i]];
    bounds.include(item);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      centres.lower[axis] = std::min(centres.lower[axis], centre(item, axis));
      centres.upper[axis] = std::max(centres.upper[axis], centre(item, axis));
    }
  }
  nodes_[node] = {.bounds = bounds, .first = first, .item_count = end - first};
  if (end - first <= largest_leaf) return;

  std::size_t axis = 0;
  for (std::size_t i = 1; i < 3; ++i) {
    if (centres.upper[i] - centres.lower[i] > centres.upper[axis] - centres.lower[axis]) axis = i;
  }
  const std::uint32_t middle = first + (end - first) / 2;
  std::nth_element(items_.begin() + first, items_.begin() + middle, items_.begin() + end,
                   [&](std::uint32_t a, std::uint32_t b) { return centre(items[a], axis) < centre(items[b], axis); });
  const auto children = static_cast<std::uint32_t>(nodes_.size());
  nodes_[node].first = children;
  nodes_[node].item_count = 0;
  nodes_.resize(nodes_.size() + 2);
  split(items, children, first, middle);
  split(items, children + 1, middle, end);
}

}  // namespace tandem::cpu::exact
