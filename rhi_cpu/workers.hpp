#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include <tbb/global_control.h>
#include <tbb/task_arena.h>

namespace tandem::cpu {

/// The threads of one device, the submitting one among them.
class Workers {
 public:
  /// @param thread_count 0 for as many as the machine (or the affinity of the process) has
  explicit Workers(std::uint32_t thread_count);

  std::uint32_t thread_count() const noexcept { return thread_count_; }

  /// Calls `work` for ranges [first, end) that together are [0, count), on all threads, and returns when all are done.
  /// Ranges are small and taken as threads become free; their order and borders are unspecified. In `work`, floating
  /// point rounds to nearest and keeps denormals, whatever the calling program has set.
  void for_each_range(std::uint64_t count, const std::function<void(std::uint64_t first, std::uint64_t end)>& work);

 private:
  /// More threads than processors need oneTBB's leave, which holds for the whole program while the device lives.
  std::optional<tbb::global_control> permission_;
  std::uint32_t thread_count_;
  tbb::task_arena arena_;
};

}  // namespace tandem::cpu
