#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>

#include "rhi_cpu/tracer.hpp"

namespace tandem::cpu {

/// The bottom levels that live, by the address that instances name them by. Addresses are never used twice, so an
/// instance that names a bottom level which is gone is found out. It keeps none alive. Thread-safe.
class BottomLevelRegistry {
 public:
  /// A new address, never 0, of a bottom level that is not built yet.
  std::uint64_t add();
  void set_built(std::uint64_t address, std::weak_ptr<const BuiltBottomLevel> built);
  void remove(std::uint64_t address);

  struct Found {
    bool lives = false;
    std::shared_ptr<const BuiltBottomLevel> built;  ///< null as long as it is not built
  };
  Found find(std::uint64_t address) const;

 private:
  /// Vulkan aligns acceleration structures to 256 bytes.
  static constexpr std::uint64_t spacing = 256;

  mutable std::mutex mutex_;
  std::uint64_t next_address_ = spacing;
  std::map<std::uint64_t, std::weak_ptr<const BuiltBottomLevel>> bottom_levels_;
};

}  // namespace tandem::cpu
