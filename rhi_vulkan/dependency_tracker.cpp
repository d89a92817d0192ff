#include "rhi_vulkan/dependency_tracker.hpp"

#include <algorithm>

namespace tandem::vulkan {
namespace {

/// Beyond this many accesses a barrier is cheaper than the search for a conflict.
constexpr std::size_t most_accesses = 256;

bool overlap(const Access& a, const Access& b) {
  return a.object == b.object && a.begin < b.end && b.begin < a.end && (a.writes || b.writes);
}

}  // namespace

bool DependencyTracker::needs_barrier(CommandKind kind, std::span<const Access> accesses) {
  const bool needed = barrier_required_ || kind == CommandKind::exclusive || kind != kind_ ||
                      since_barrier_.size() + accesses.size() > most_accesses || conflicts(accesses);
  if (needed) since_barrier_.clear();
  since_barrier_.insert(since_barrier_.end(), accesses.begin(), accesses.end());
  kind_ = kind;
  barrier_required_ = false;
  return needed;
}

bool DependencyTracker::conflicts(std::span<const Access> accesses) const {
  return std::any_of(accesses.begin(), accesses.end(), [this](const Access& next) {
    return std::any_of(since_barrier_.begin(), since_barrier_.end(),
                       [&next](const Access& before) { return overlap(before, next); });
  });
}

}  // namespace tandem::vulkan
