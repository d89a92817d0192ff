#pragma once

#include <cstdint>
#include <utility>

#include "rhi/fence.hpp"
#include "rhi_vulkan/context.hpp"

namespace tandem::vulkan {

class Fence final : public rhi::Fence {
 public:
  /// @param submission its number in the queue
  Fence(ContextHandle context, std::uint64_t submission) : context_(std::move(context)), submission_(submission) {}

  bool wait_for(std::chrono::nanoseconds timeout) override { return context_->queue.wait(submission_, timeout); }
  void wait() override { context_->queue.wait(submission_); }

 private:
  ContextHandle context_;
  std::uint64_t submission_;
};

}  // namespace tandem::vulkan
