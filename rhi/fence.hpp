#pragma once

#include <chrono>
#include <memory>

namespace tandem::rhi {

/// Signalled when one submission has executed.
class Fence {
 public:
  virtual ~Fence() = default;
  Fence() = default;
  Fence(const Fence&) = delete;
  Fence& operator=(const Fence&) = delete;

  /// Waits at most `timeout`; false when it passed. Throws Error(device_lost) when the device is gone.
  virtual bool wait_for(std::chrono::nanoseconds timeout) = 0;
  /// Waits as long as it takes.
  virtual void wait() = 0;
};

using FenceHandle = std::shared_ptr<Fence>;

}  // namespace tandem::rhi
