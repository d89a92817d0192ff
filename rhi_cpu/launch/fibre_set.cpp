#include "rhi_cpu/launch/fibre_set.hpp"

#include <algorithm>
#include <utility>

namespace tandem::cpu {
namespace {

/// Boost.Context asks for one; a fibre's stack belongs to the set.
struct KeptStack {
  void deallocate(boost::context::stack_context&) {}
};

}  // namespace

FibreSet::FibreSet() : kernel::Fibres{.switch_to = switch_to, .fail = fail} {}

void FibreSet::run(std::uint32_t count, std::size_t stack_size, kernel::FibreFunction function, void* context) {
  if (stack_size > stack_size_) {
    fibres_.clear();
    stack_size_ = stack_size;
  }
  while (fibres_.size() < count) fibres_.push_back(std::make_unique<Fibre>());
  count_ = count;
  function_ = function;
  context_ = context;
  running_ = 0;
  go_on(rest_of(0), caller_);
  if (failure_ == nullptr) return;
  // Others may be in the middle of their functions; Boost.Context unwinds them.
  fibres_.clear();
  std::rethrow_exception(std::exchange(failure_, nullptr));
}

FibreSet::Continuation& FibreSet::rest_of(std::uint32_t index) {
  Fibre& fibre = *fibres_[index];
  if (!fibre.rest) {
    if (!fibre.stack) fibre.stack.emplace(stack_size_, index);
    boost::context::stack_context whole;
    whole.sp = fibre.stack->top();
    whole.size = fibre.stack->size();
    fibre.rest = Continuation(std::allocator_arg, boost::context::preallocated(whole.sp, whole.size, whole),
                              KeptStack{}, [this, index](Continuation&& caller) -> Continuation {
                                *left_ = std::move(caller);
                                live(index);
                              });
  }
  return fibre.rest;
}

void FibreSet::go_on(Continuation& to, Continuation& from) {
  left_ = &from;
  Continuation caller = std::move(to).resume();
  *left_ = std::move(caller);
}

void FibreSet::live(std::uint32_t index) {
  while (true) {
    Continuation* next = &caller_;
    try {
      const std::uint32_t other = function_(context_, *this, index);
      if (other < count_) {
        next = &rest_of(other);
        running_ = other;
      }
    } catch (const boost::context::detail::forced_unwind&) {
      throw;
    } catch (...) {
      failure_ = std::current_exception();
    }
    go_on(*next, fibres_[index]->rest);
  }
}

void FibreSet::switch_to(kernel::Fibres& fibres, std::uint32_t index) {
  auto& set = static_cast<FibreSet&>(fibres);
  Continuation& to = set.rest_of(index);
  Continuation& from = set.fibres_[std::exchange(set.running_, index)]->rest;
  set.go_on(to, from);
}

void FibreSet::fail(kernel::Fibres&) { throw NotAllArrived(); }

}  // namespace tandem::cpu
