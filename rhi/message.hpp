#pragma once

#include <functional>
#include <string>

namespace tandem::rhi {

enum class Severity { info, warning, error };

/// Something a backend, a driver or a validation layer has to say that is no exception.
struct Message {
  Severity severity = Severity::info;
  std::string source;  ///< who speaks: "vulkan validation", "cpu kernel cache", ...
  std::string text;
};

/// May be called from any thread, so it must be thread-safe; an empty callback drops the messages.
using MessageCallback = std::function<void(const Message&)>;

}  // namespace tandem::rhi
