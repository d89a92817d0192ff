#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "rhi_cpu/kernel/abi.hpp"
#include "rhi_cpu/launch/fibre_set.hpp"

namespace tandem::cpu {

/// The fibres of a device, which are kept until it ends: as many sets as threads have run workgroups of fibres at once.
/// Thread-safe.
class FibrePool {
 public:
  std::unique_ptr<FibreSet> take();
  void give_back(std::unique_ptr<FibreSet> set);

 private:
  std::mutex mutex_;
  std::vector<std::unique_ptr<FibreSet>> free_;
};

/// Where the kernel gets its fibres from while it runs a range of workgroups on one thread.
class LaunchFibres {
 public:
  /// @param label the pipeline's. Both must outlive this.
  LaunchFibres(FibrePool& pool, const std::string& label);
  ~LaunchFibres();
  LaunchFibres(const LaunchFibres&) = delete;
  LaunchFibres& operator=(const LaunchFibres&) = delete;

  /// For kernel::Dispatch::fibres. Its run throws rhi::Error(invalid_argument) where not all invocations of a workgroup
  /// reach the same barrier.
  const kernel::FibreHost* host() const noexcept { return &host_.host; }

 private:
  /// `host` comes first: kernels know no more of it.
  struct OwnHost {
    kernel::FibreHost host;
    LaunchFibres* owner;
  };

  static void run(const kernel::FibreHost& host, std::uint32_t count, std::size_t stack_size,
                  kernel::FibreFunction function, void* context);

  FibrePool& pool_;
  const std::string& label_;
  OwnHost host_;
  std::unique_ptr<FibreSet> set_;  ///< from the first workgroup on
};

}  // namespace tandem::cpu
