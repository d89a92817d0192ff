#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>

#include "rhi_vulkan/vulkan.hpp"

namespace tandem::vulkan {

/// The one queue of a device. Submissions are numbered from 1 on by a timeline semaphore and execute in that order;
/// what each needs is kept until it has executed. Thread-safe.
class Queue {
 public:
  Queue(const vk::raii::Device& device, std::uint32_t family);

  std::uint32_t family() const noexcept { return family_; }

  /// Submits the commands and keeps `payload` alive until they have executed. Returns the submission's number.
  std::uint64_t submit(vk::CommandBuffer commands, std::shared_ptr<const void> payload);
  /// The number of the last submission, 0 before the first.
  std::uint64_t last_submitted() const;
  /// Waits until submission `number` has executed, at most `timeout`; false when that passed.
  bool wait(std::uint64_t number, std::chrono::nanoseconds timeout);
  void wait(std::uint64_t number);
  /// Releases what finished submissions needed.
  void release_finished();
  /// Waits for all submissions and releases what they needed, whatever the driver returns: for the device's destructor.
  void drain() noexcept;

 private:
  struct InFlight {
    std::uint64_t number;
    std::shared_ptr<const void> payload;
  };

  const vk::raii::Device& device_;
  std::uint32_t family_;
  vk::raii::Queue queue_;
  vk::raii::Semaphore timeline_;
  mutable std::mutex mutex_;
  std::uint64_t last_submitted_ = 0;
  std::deque<InFlight> in_flight_;
};

}  // namespace tandem::vulkan
