#pragma once

#include <functional>
#include <stdexcept>
#include <string>
#include <string_view>

namespace tandem {

/// Called now and then with the finished fraction of a call's work, in [0, 1]; false cancels it.
using Progress = std::function<bool(double fraction)>;

/// The same for work in several stages, such as "cpu", "vulkan" and "classification".
using StageProgress = std::function<bool(std::string_view stage, double fraction)>;

/// One stage of it. `progress` must outlive the result.
inline Progress stage_of(const StageProgress& progress, std::string_view stage) {
  if (!progress) return {};
  return [&progress, stage](double fraction) { return progress(stage, fraction); };
}

/// Thrown by calls without a result of their own to say so, when progress cancelled them.
class Cancelled : public std::runtime_error {
 public:
  explicit Cancelled(const std::string& sentence = "interrupted; nothing was written") : std::runtime_error(sentence) {}
};

}  // namespace tandem
