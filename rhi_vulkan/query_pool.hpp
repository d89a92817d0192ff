#pragma once

#include <atomic>
#include <vector>

#include "rhi/query_pool.hpp"
#include "rhi_vulkan/context.hpp"

namespace tandem::vulkan {

class QueryPool final : public rhi::QueryPool {
 public:
  /// Throws rhi::Error(unsupported) when the device's queue keeps no time.
  QueryPool(ContextHandle context, const rhi::QueryPoolDesc& desc);

  std::vector<double> timestamps_ns() const override;
  const ContextHandle& context() const noexcept { return context_; }
  vk::QueryPool handle() const { return *pool_; }
  /// A list that writes query `index` was submitted.
  void mark_submitted(std::uint32_t index) noexcept { submitted_[index] = true; }

 private:
  ContextHandle context_;
  vk::raii::QueryPool pool_ = nullptr;
  std::vector<std::atomic<bool>> submitted_;
};

}  // namespace tandem::vulkan
