#pragma once

#include <cstddef>
#include <cstdint>

#include "rhi_cpu/kernel/abi.hpp"

/// Workgroups whose invocations wait for each other, as fibres that run by turns. A fibre is an invocation, or a
/// subgroup where the kernel runs all invocations of one at once.
namespace tandem::kernel {

/// Whose turn it is where fibres wait at barriers alone: from one barrier to the next each runs once, the lowest first.
class Turns {
 public:
  explicit Turns(std::uint32_t count) : count_(count) {}

  /// To be called by each fibre when it begins.
  void begin(Fibres& fibres) { fibres_ = &fibres; }

  /// Returns when all fibres have called it. Where some have called it for another place or have ended, which no
  /// shader may do, it throws.
  /// @param place which barrier it is; not 0
  void barrier(std::uint32_t index, std::uint32_t place) {
    if (count_ == 1) return;
    arrive(index, place);
    fibres_->switch_to(*fibres_, index + 1 == count_ ? 0 : index + 1);
  }

  /// The same of a subgroup that is one fibre, at a barrier that not all of its invocations may have reached.
  void barrier_of_lanes(bool are_all, std::uint32_t index, std::uint32_t place) {
    if (!are_all) fibres_->fail(*fibres_);
    barrier(index, place);
  }

  /// @return what a FibreFunction returns that has ended
  std::uint32_t end(std::uint32_t index) {
    arrive(index, 0);
    return index + 1;
  }

 private:
  void arrive(std::uint32_t index, std::uint32_t place) {
    if (index == 0)
      place_ = place;
    else if (place_ != place)
      fibres_->fail(*fibres_);
  }

  Fibres* fibres_ = nullptr;
  std::uint32_t count_;
  std::uint32_t place_ = 0;  ///< where the fibres of this turn wait
};

/// Runs group.invoke(index) for each of Group::fibre_count fibres; group.turns says whose turn it is.
template <typename Group>
inline void run_fibres(const Dispatch& dispatch, Group& group, std::size_t stack_size) {
  const auto run_one = [](void* context, Fibres& fibres, std::uint32_t index) -> std::uint32_t {
    Group& own = *static_cast<Group*>(context);
    own.turns.begin(fibres);
    own.invoke(index);
    return own.turns.end(index);
  };
  dispatch.fibres->run(*dispatch.fibres, Group::fibre_count, stack_size, run_one, &group);
}

/// The same of invocations that never wait.
template <typename Group>
inline void run_loop(Group& group) {
  for (std::uint32_t index = 0; index < Group::fibre_count; ++index) group.invoke(index);
}

}  // namespace tandem::kernel
