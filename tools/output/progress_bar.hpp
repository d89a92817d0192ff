#pragma once

#include <chrono>
#include <string>

#include "base/progress.hpp"

namespace tandem::tools {

/// A bar with the percentage on the last line of a terminal, for work that takes longer than a second. Shows nothing
/// when standard error is no terminal. The line is cleared when the bar goes.
class ProgressBar {
 public:
  /// @param label what is going on: "cpu", "vulkan:0"
  explicit ProgressBar(std::string label);
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// @param fraction of the work that is done, 0 to 1
  void show(double fraction);

 private:
  using Clock = std::chrono::steady_clock;

  std::string label_;
  bool terminal_;
  bool drawn_ = false;
  Clock::time_point started_ = Clock::now();
  Clock::time_point last_drawn_ = started_;
};

/// Progress as a bar for each stage. Cancels when the user has interrupted the program.
StageProgress progress_bars();
/// The same for work of one stage.
Progress progress_bar(const std::string& label);

}  // namespace tandem::tools
