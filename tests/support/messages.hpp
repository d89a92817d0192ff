#pragma once

#include <algorithm>
#include <cstddef>
#include <mutex>
#include <string_view>
#include <utility>
#include <vector>

#include "rhi/message.hpp"

namespace tandem::test {

/// Collects what a device or a cache says, on whichever thread.
class Messages {
 public:
  void add(const rhi::Message& message) {
    const std::lock_guard lock(mutex_);
    messages_.push_back(message);
  }

  /// Adds what it is called with; the collector has to outlive it.
  rhi::MessageCallback callback() {
    return [this](const rhi::Message& message) { add(message); };
  }

  /// All that were collected since the last call.
  std::vector<rhi::Message> take() {
    const std::lock_guard lock(mutex_);
    return std::exchange(messages_, {});
  }

  /// How many messages of that severity contain `text`.
  std::size_t count(rhi::Severity severity, std::string_view text) const {
    const std::lock_guard lock(mutex_);
    return static_cast<std::size_t>(std::ranges::count_if(messages_, [&](const rhi::Message& message) {
      return message.severity == severity && message.text.find(text) != std::string::npos;
    }));
  }

 private:
  mutable std::mutex mutex_;
  std::vector<rhi::Message> messages_;
};

}  // namespace tandem::test
