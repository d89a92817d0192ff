#include "rhi_cpu/bottom_level_registry.hpp"

namespace tandem::cpu {

std::uint64_t BottomLevelRegistry::add() {
  const std::lock_guard lock(mutex_);
  const std::uint64_t address = next_address_;
  next_address_ += spacing;
  bottom_levels_[address];
  return address;
}

void BottomLevelRegistry::set_built(std::uint64_t address, std::weak_ptr<const BuiltBottomLevel> built) {
  const std::lock_guard lock(mutex_);
  bottom_levels_.at(address) = std::move(built);
}

void BottomLevelRegistry::remove(std::uint64_t address) {
  const std::lock_guard lock(mutex_);
  bottom_levels_.erase(address);
}

BottomLevelRegistry::Found BottomLevelRegistry::find(std::uint64_t address) const {
  const std::lock_guard lock(mutex_);
  const auto found = bottom_levels_.find(address);
  if (found == bottom_levels_.end()) return {};
  return {.lives = true, .built = found->second.lock()};
}

}  // namespace tandem::cpu
