#pragma once

#include <cstddef>
#include <cstdint>
#include <exception>
#include <memory>
#include <optional>
#include <vector>

#include <boost/context/fiber.hpp>

#include "rhi_cpu/kernel/abi.hpp"
#include "rhi_cpu/launch/sanitized_switch.hpp"
#include "rhi_cpu/launch/stack_memory.hpp"

namespace tandem::cpu {

/// Fibres with their stacks, which are kept from one workgroup to the next: a fibre that has ended waits for the next
/// function. One thread at a time uses them.
class FibreSet final : private kernel::Fibres {
 public:
  FibreSet();
  ~FibreSet();
  FibreSet(const FibreSet&) = delete;
  FibreSet& operator=(const FibreSet&) = delete;

  /// As kernel::FibreHost::run. kernel::Fibres::fail throws NotAllArrived.
  void run(std::uint32_t count, std::size_t stack_size, kernel::FibreFunction function, void* context);

  /// Not all invocations of a workgroup reach the same barrier.
  struct NotAllArrived {};

 private:
  using Continuation = boost::context::fiber;

  struct Dropped {};

  struct Fibre {
    std::optional<StackMemory> stack = {};  ///< declared before what lies on it
    Continuation rest = {};                 ///< what it goes on with; nothing while it runs or before it first does
    StackBounds bounds = {};
  };

  static void switch_to(kernel::Fibres& fibres, std::uint32_t index);
  [[noreturn]] static void fail(kernel::Fibres& fibres);
  /// Goes on with `to`; what calls is left in `from`.
  void go_on(Fibre& to, Fibre& from);
  /// Fibre `index`, which can be gone on with.
  Fibre& prepared(std::uint32_t index);
  /// What a fibre does: one function after the other, until drop_all().
  void live(std::uint32_t index);
  /// Ends all fibres, wherever they are.
  void drop_all();

  std::vector<std::unique_ptr<Fibre>> fibres_;
  Fibre caller_;           ///< run(), while fibres run
  Fibre* left_ = nullptr;  ///< the one that was gone on from
  std::uint32_t running_ = 0;
  std::uint32_t count_ = 0;
  std::size_t stack_size_ = 0;
  kernel::FibreFunction function_ = nullptr;
  void* context_ = nullptr;
  std::exception_ptr failure_;
  bool drops_ = false;
};

}  // namespace tandem::cpu
