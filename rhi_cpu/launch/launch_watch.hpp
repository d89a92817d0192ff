#pragma once

#include <atomic>
#include <chrono>
#include <string>

#include "rhi_cpu/kernel/abi.hpp"

namespace tandem::cpu {

/// Ends a launch that takes longer than the device's time limit. Kernels call it, from all threads.
class LaunchWatch {
 public:
  /// @param label the pipeline's. It must outlive this.
  LaunchWatch(std::chrono::milliseconds limit, const std::string& label);

  /// For kernel::Dispatch::watch. Its look throws once the time is over.
  const kernel::Watch* watch() const noexcept { return &watch_.watch; }
  /// To be called now and then between invocations: short ones do not look. Throws rhi::Error(timeout) as kernels do.
  void look() const {
    if (limit_.count() > 0) look(watch_.watch);
  }
  /// To be called when the launch has ended: Embree keeps exceptions that pass through it to itself. Throws
  /// rhi::Error(timeout) where a look has thrown.
  void check() const;

 private:
  /// `watch` comes first: kernels know no more of it.
  struct OwnWatch {
    kernel::Watch watch;
    const LaunchWatch* owner;
  };

  static void look(const kernel::Watch& watch);
  [[noreturn]] void fail() const;

  std::chrono::milliseconds limit_;
  std::chrono::steady_clock::time_point end_;
  const std::string& label_;
  OwnWatch watch_;
  mutable std::atomic<bool> is_over_ = false;
};

}  // namespace tandem::cpu
