#include "tools/output/progress_bar.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <mutex>
#include <string_view>
#include <system_error>
#include <thread>
#include <utility>

#include "base/printable.hpp"
#include "tools/output/interruption.hpp"
#include "tools/output/print.hpp"

namespace tandem::tools {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

/// Until a bar appears, and between two lines where there is no terminal.
constexpr auto first_after = 1s;
constexpr auto line_after = 30s;

/// A bar that cannot be drawn is no error.
void draw(std::string_view text) {
  std::fwrite(text.data(), 1, text.size(), stderr);
  std::fflush(stderr);
}

}  // namespace

/// What is shown. A thread of its own shows it, because the one that works may not come by for minutes.
class ProgressBar::Display {
 public:
  Display() : terminal_(isatty(STDERR_FILENO) != 0) {
    try {
      thread_ = std::thread([this] { run(); });
    } catch (const std::system_error&) {
      // No thread is to be had: the work goes on without being shown.
    }
  }
  ~Display() {
    {
      const std::lock_guard lock(mutex_);
      ended_ = true;
    }
    changed_.notify_all();
    if (thread_.joinable()) thread_.join();
    clear();
  }
  Display(const Display&) = delete;
  Display& operator=(const Display&) = delete;

  void show(std::string_view stage, double fraction) {
    const std::lock_guard lock(mutex_);
    if (stage != stage_) {
      clear();
      stage_ = stage;
      started_ = last_line_ = Clock::now();
    }
    fraction_ = std::clamp(fraction, 0.0, 1.0);
    if (fraction < 1) return;
    clear();
    stage_.clear();
  }

 private:
  void run() {
    std::unique_lock lock(mutex_);
    while (!changed_.wait_for(lock, terminal_ ? 100ms : 1000ms, [this] { return ended_; })) {
      if (stage_.empty()) continue;
      const Clock::time_point now = Clock::now();
      if (terminal_ && now - started_ > first_after) draw_bar(std::chrono::duration<double>(now - started_).count());
      if (!terminal_ && now - last_line_ > line_after) {
        last_line_ = now;
        const double elapsed = std::chrono::duration<double>(now - started_).count();
        print_error_line(fraction_ > 0 ? fmt::format("{}: {:.0f} % after {:.0f} s", stage_, 100 * fraction_, elapsed)
                                       : fmt::format("{}: {:.0f} s so far", stage_, elapsed));
      }
    }
  }

  void draw_bar(double elapsed) {
    constexpr int cells = 40;
    drawn_ = true;
    const std::string label = shortened(stage_);
    if (!(fraction_ > 0)) return draw(fmt::format("\r{} ... {:.0f} s\033[K", label, elapsed));
    const int filled = static_cast<int>(fraction_ * cells);
    draw(fmt::format("\r{} [{:#<{}}{:.<{}}] {:3.0f} % {:.0f} s left\033[K", label, "", filled, "", cells - filled,
                     100.0 * fraction_, elapsed / fraction_ - elapsed));
  }

  void clear() {
    if (drawn_) draw("\r\033[K");
    drawn_ = false;
  }

  bool terminal_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::string stage_;  ///< empty: none
  double fraction_ = 0;
  Clock::time_point started_ = Clock::now(), last_line_ = started_;
  bool drawn_ = false;
  bool ended_ = false;
  std::thread thread_;
};

ProgressBar::ProgressBar() : display_(std::make_unique<Display>()) {}
ProgressBar::~ProgressBar() = default;

void ProgressBar::show(std::string_view stage, double fraction) { display_->show(stage, fraction); }

ShownStage::ShownStage(std::string stage) : stage_(std::move(stage)) { bar_.show(stage_, 0); }
ShownStage::~ShownStage() { bar_.show(stage_, 1); }

StageProgress progress_bars() {
  return [bar = std::make_shared<ProgressBar>()](std::string_view stage, double fraction) {
    bar->show(stage, fraction);
    return !interrupted();
  };
}

Progress progress_bar(const std::string& label) {
  return [bars = progress_bars(), label](double fraction) { return bars(label, fraction); };
}

}  // namespace tandem::tools
