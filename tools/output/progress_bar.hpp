#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "base/progress.hpp"

namespace tandem::tools {

/// Shows how far work is, and what it waits for when it does not say, as a driver's compiler does not. On a terminal, a
/// bar on the last line for work that takes longer than a second, which goes when the stage ends. Elsewhere, a line on
/// standard error every half minute.
class ProgressBar {
 public:
  ProgressBar();
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// @param stage what is going on: "cpu", "shaders for vulkan:0"
  /// @param fraction of the stage that is done, 0 to 1; it ends at 1
  void show(std::string_view stage, double fraction);

 private:
  class Display;
  std::unique_ptr<Display> display_;
};

/// Shows, while it lives, a stage that does not say how far it is.
class ShownStage {
 public:
  explicit ShownStage(std::string stage);
  ~ShownStage();
  ShownStage(const ShownStage&) = delete;
  ShownStage& operator=(const ShownStage&) = delete;

 private:
  std::string stage_;
  ProgressBar bar_;
};

inline constexpr const char* building_stage = "building acceleration structures";

/// Progress as a bar for each stage. Cancels when the user has interrupted the program.
StageProgress progress_bars();
/// The same for work of one stage.
Progress progress_bar(const std::string& label);

}  // namespace tandem::tools
