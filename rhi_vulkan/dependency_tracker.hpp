#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace tandem::vulkan {

enum class CommandKind {
  transfer,            ///< upload, copy, fill: touches what it names
  bottom_level_build,  ///< likewise; its inputs are only read
  exclusive  ///< may touch anything: shaders follow device addresses, top levels refer to bottom levels by address
};

/// Bytes [begin, end) of an object, whatever pointer identifies it.
struct Access {
  const void* object = nullptr;
  std::uint64_t begin = 0;
  std::uint64_t end = 0;
  bool writes = false;
};

/// Decides where a command list needs a barrier: before every command, but for runs of transfers or of bottom-level
/// builds that do not touch each other's data.
class DependencyTracker {
 public:
  /// Whether a barrier must stand before the next command, which is taken to follow.
  bool needs_barrier(CommandKind kind, std::span<const Access> accesses);
  /// The next command needs a barrier, whatever it is.
  void require_barrier() noexcept { barrier_required_ = true; }

 private:
  bool conflicts(std::span<const Access> accesses) const;

  bool barrier_required_ = true;  // the list before this one may have written anything
  CommandKind kind_ = CommandKind::exclusive;
  std::vector<Access> since_barrier_;
};

}  // namespace tandem::vulkan
