#include "tools/output/progress_bar.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <optional>

#include "tools/output/interruption.hpp"

namespace tandem::tools {
namespace {

/// A bar that cannot be drawn is no error.
void draw(std::string_view text) {
  std::fwrite(text.data(), 1, text.size(), stderr);
  std::fflush(stderr);
}

}  // namespace

ProgressBar::ProgressBar(std::string label) : label_(std::move(label)), terminal_(isatty(STDERR_FILENO) != 0) {}

ProgressBar::~ProgressBar() {
  if (drawn_) draw("\r\033[K");
}

void ProgressBar::show(double fraction) {
  using namespace std::chrono_literals;
  constexpr int cells = 40;
  const Clock::time_point now = Clock::now();
  if (!terminal_ || now - started_ < 1s || (drawn_ && now - last_drawn_ < 100ms)) return;
  const double done = std::clamp(fraction, 0.0, 1.0);
  const int filled = static_cast<int>(done * cells);
  const double elapsed = std::chrono::duration<double>(now - started_).count();
  const std::string left = done > 0.0 ? fmt::format("{:.0f} s left", elapsed / done - elapsed) : std::string();
  draw(fmt::format("\r{} [{:#<{}}{:.<{}}] {:3.0f} % {}\033[K", label_, "", filled, "", cells - filled, 100.0 * done,
                   left));
  drawn_ = true;
  last_drawn_ = now;
}

StageProgress progress_bars() {
  struct Current {
    std::string stage;
    std::optional<ProgressBar> bar;
  };
  return [current = std::make_shared<Current>()](std::string_view stage, double fraction) {
    if (!current->bar || current->stage != stage) {
      current->bar.reset();  // clears its line before another is drawn
      current->stage = stage;
      current->bar.emplace(current->stage);
    }
    current->bar->show(fraction);
    if (fraction >= 1) current->bar.reset();
    return !interrupted();
  };
}

Progress progress_bar(const std::string& label) {
  return [bars = progress_bars(), label](double fraction) { return bars(label, fraction); };
}

}  // namespace tandem::tools
