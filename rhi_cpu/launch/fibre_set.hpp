#pragma once

#include <cstddef>
#include <cstdint>
#include <exception>
#include <memory>
#include <optional>
#include <vector>

#include <boost/context/fiber.hpp>

#include "rhi_cpu/kernel/abi.hpp"
#include "rhi_cpu/launch/stack_memory.hpp"

namespace tandem::cpu {

/// Fibres with their stacks, which are kept from one workgroup to the next: a fibre that has ended waits for the next
/// function. One thread at a time uses them.
class FibreSet final : private kernel::Fibres {
 public:
  FibreSet();
  FibreSet(const FibreSet&) = delete;
  FibreSet& operator=(const FibreSet&) = delete;

  /// As kernel::FibreHost::run. kernel::Fibres::fail throws NotAllArrived.
  void run(std::uint32_t count, std::size_t stack_size, kernel::FibreFunction function, void* context);

  /// Not all invocations of a workgroup reach the same barrier.
  struct NotAllArrived {};

 private:
  using Continuation = boost::context::fiber;

  struct Fibre {
    std::optional<StackMemory> stack = {};  ///< declared before what lies on it
    Continuation rest = {};                 ///< what it goes on with; nothing while it runs or before it first does
  };

  static void switch_to(kernel::Fibres& fibres, std::uint32_t index);
  [[noreturn]] static void fail(kernel::Fibres& fibres);
  /// Goes on with `to`; what calls is left in `from`.
  void go_on(Continuation& to, Continuation& from);
  /// What fibre `index` goes on with.
  Continuation& rest_of(std::uint32_t index);
  [[noreturn]] void live(std::uint32_t index);

  std::vector<std::unique_ptr<Fibre>> fibres_;
  Continuation caller_;           ///< run(), while fibres run
  Continuation* left_ = nullptr;  ///< where the one that was left is put
  std::uint32_t running_ = 0;
  std::uint32_t count_ = 0;
  std::size_t stack_size_ = 0;
  kernel::FibreFunction function_ = nullptr;
  void* context_ = nullptr;
  std::exception_ptr failure_;
};

}  // namespace tandem::cpu
