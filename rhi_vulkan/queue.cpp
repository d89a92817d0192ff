#include "rhi_vulkan/queue.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "rhi_vulkan/error.hpp"

namespace tandem::vulkan {
namespace {

vk::raii::Semaphore make_timeline(const vk::raii::Device& device) {
  const vk::SemaphoreTypeCreateInfo type = {.semaphoreType = vk::SemaphoreType::eTimeline, .initialValue = 0};
  return device.createSemaphore(vk::SemaphoreCreateInfo{.pNext = &type});
}

}  // namespace

Queue::Queue(const vk::raii::Device& device, std::uint32_t family)
    : device_(device), family_(family), queue_(device.getQueue(family, 0)), timeline_(make_timeline(device)) {}

std::uint64_t Queue::submit(vk::CommandBuffer commands, std::shared_ptr<const void> payload) {
  release_finished();
  const std::scoped_lock lock(mutex_);
  const std::uint64_t number = last_submitted_ + 1;
  const vk::Semaphore signalled = *timeline_;
  const vk::TimelineSemaphoreSubmitInfo timeline = {.signalSemaphoreValueCount = 1, .pSignalSemaphoreValues = &number};
  const vk::SubmitInfo info = {.pNext = &timeline,
                               .commandBufferCount = 1,
                               .pCommandBuffers = &commands,
                               .signalSemaphoreCount = 1,
                               .pSignalSemaphores = &signalled};
  in_flight_.push_back({number, std::move(payload)});
  try {
    queue_.submit(info);
  } catch (...) {
    in_flight_.pop_back();
    throw;
  }
  last_submitted_ = number;
  return number;
}

std::uint64_t Queue::last_submitted() const {
  const std::scoped_lock lock(mutex_);
  return last_submitted_;
}

bool Queue::wait(std::uint64_t number, std::chrono::nanoseconds timeout) {
  const vk::Semaphore semaphore = *timeline_;
  const vk::SemaphoreWaitInfo info = {.semaphoreCount = 1, .pSemaphores = &semaphore, .pValues = &number};
  const auto nanoseconds = static_cast<std::uint64_t>(std::max<std::chrono::nanoseconds::rep>(timeout.count(), 0));
  const bool finished = translating_errors(
      "", "wait for the device", [&] { return device_.waitSemaphores(info, nanoseconds) == vk::Result::eSuccess; });
  if (finished) release_finished();
  return finished;
}

void Queue::wait(std::uint64_t number) {
  while (!wait(number, std::chrono::nanoseconds::max())) {
  }
}

void Queue::release_finished() {
  std::vector<InFlight> finished;  // destroyed after the lock is given back: a payload may be the last user of much
  const std::uint64_t executed = timeline_.getCounterValue();
  const std::scoped_lock lock(mutex_);
  while (!in_flight_.empty() && in_flight_.front().number <= executed) {
    finished.push_back(std::move(in_flight_.front()));
    in_flight_.pop_front();
  }
}

void Queue::drain() noexcept {
  try {
    wait(last_submitted());
  } catch (const rhi::Error&) {
    // A lost device executes nothing any more, so what it needed can go.
  }
  std::deque<InFlight> abandoned;
  const std::scoped_lock lock(mutex_);
  abandoned.swap(in_flight_);
}

}  // namespace tandem::vulkan
