#include "rhi_cpu/query_pool.hpp"

#include <chrono>

#include <fmt/format.h>

#include "rhi/error.hpp"

namespace tandem::cpu {

QueryPool::QueryPool(DeviceStateHandle device, const rhi::QueryPoolDesc& desc)
    : rhi::QueryPool(desc), device_(std::move(device)), times_ns_(desc.count) {}

std::vector<double> QueryPool::timestamps_ns() const {
  const std::lock_guard lock(mutex_);
  std::vector<double> times;
  for (const std::optional<double>& time : times_ns_) {
    if (!time)
      throw rhi::Error(rhi::ErrorCode::invalid_argument, desc().label,
                       fmt::format("query {} was never written", times.size()));
    times.push_back(*time);
  }
  return times;
}

void QueryPool::write(std::uint32_t index) {
  const std::chrono::duration<double, std::nano> now = std::chrono::steady_clock::now().time_since_epoch();
  const std::lock_guard lock(mutex_);
  times_ns_.at(index) = now.count();
}

}  // namespace tandem::cpu
