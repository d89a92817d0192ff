#include "rhi_cpu/workers.hpp"

#include <algorithm>
#include <cfenv>

#include <tbb/blocked_range.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/partitioner.h>

namespace tandem::cpu {
namespace {

/// IEEE 754's own defaults, until the end of its life; then what was set before.
class DefaultFloatingPoint {
 public:
  DefaultFloatingPoint() {
    std::fegetenv(&before_);
    std::fesetenv(FE_DFL_ENV);
  }
  ~DefaultFloatingPoint() { std::fesetenv(&before_); }
  DefaultFloatingPoint(const DefaultFloatingPoint&) = delete;
  DefaultFloatingPoint& operator=(const DefaultFloatingPoint&) = delete;

 private:
  std::fenv_t before_;
};

/// So that the last range to end keeps the other threads waiting for about 1 % of the time.
constexpr std::uint64_t ranges_per_thread = 64;
/// Enough for a workgroup of a few nanoseconds to outweigh the task that runs it.
constexpr std::uint64_t largest_range = 1024;

}  // namespace

Workers::Workers(std::uint32_t thread_count)
    : thread_count_(thread_count != 0 ? thread_count : static_cast<std::uint32_t>(tbb::info::default_concurrency())),
      arena_(static_cast<int>(thread_count_)) {
  if (thread_count_ > static_cast<std::uint32_t>(tbb::info::default_concurrency()))
    permission_.emplace(tbb::global_control::max_allowed_parallelism, thread_count_);
}

void Workers::for_each_range(std::uint64_t count,
                             const std::function<void(std::uint64_t first, std::uint64_t end)>& work) {
  const std::uint64_t size = std::clamp<std::uint64_t>(count / (ranges_per_thread * thread_count_), 1, largest_range);
  arena_.execute([&] {
    tbb::parallel_for(
        tbb::blocked_range<std::uint64_t>(0, count, size),
        [&](const tbb::blocked_range<std::uint64_t>& range) {
          const DefaultFloatingPoint environment;
          work(range.begin(), range.end());
        },
        tbb::simple_partitioner());
  });
}

}  // namespace tandem::cpu
