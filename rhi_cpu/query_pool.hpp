#pragma once

#include <mutex>
#include <optional>
#include <vector>

#include "rhi/query_pool.hpp"
#include "rhi_cpu/device_state.hpp"

namespace tandem::cpu {

/// Times of std::chrono::steady_clock.
class QueryPool final : public rhi::QueryPool {
 public:
  QueryPool(DeviceStateHandle device, const rhi::QueryPoolDesc& desc);

  std::vector<double> timestamps_ns() const override;

  const DeviceState& device() const noexcept { return *device_; }
  /// Sets query `index` to the time now.
  void write(std::uint32_t index);

 private:
  DeviceStateHandle device_;
  mutable std::mutex mutex_;
  std::vector<std::optional<double>> times_ns_;
};

}  // namespace tandem::cpu
