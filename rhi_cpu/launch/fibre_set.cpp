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

FibreSet::~FibreSet() { drop_all(); }

void FibreSet::drop_all() {
  drops_ = true;
  for (const std::unique_ptr<Fibre>& fibre : fibres_)
    if (fibre->rest) go_on(*fibre, caller_);
  drops_ = false;
  fibres_.clear();
}

void FibreSet::run(std::uint32_t count, std::size_t stack_size, kernel::FibreFunction function, void* context) {
  if (stack_size > stack_size_) {
    drop_all();
    stack_size_ = stack_size;
  }
  while (fibres_.size() < count) fibres_.push_back(std::make_unique<Fibre>());
  count_ = count;
  function_ = function;
  context_ = context;
  running_ = 0;
  go_on(prepared(0), caller_);
  if (failure_ == nullptr) return;
  // Others may be in the middle of their functions.
  drop_all();
  std::rethrow_exception(std::exchange(failure_, nullptr));
}

FibreSet::Fibre& FibreSet::prepared(std::uint32_t index) {
  Fibre& fibre = *fibres_[index];
  if (fibre.rest) return fibre;
  if (!fibre.stack) fibre.stack.emplace(stack_size_, index);
  boost::context::stack_context whole;
  whole.sp = fibre.stack->top();
  whole.size = fibre.stack->size();
  fibre.bounds = {.bottom = static_cast<std::byte*>(whole.sp) - whole.size, .size = whole.size};
  fibre.rest = Continuation(std::allocator_arg, boost::context::preallocated(whole.sp, whole.size, whole), KeptStack{},
                            [this, index](Continuation&& caller) -> Continuation {
                              end_switch(nullptr, left_->bounds);
                              left_->rest = std::move(caller);
                              live(index);
                              left_ = fibres_[index].get();
                              begin_last_switch(caller_.bounds);
                              return std::move(caller_.rest);
                            });
  return fibre;
}

void FibreSet::go_on(Fibre& to, Fibre& from) {
  left_ = &from;
  void* own = begin_switch(to.bounds);
  Continuation caller = std::move(to.rest).resume();
  end_switch(own, left_->bounds);
  left_->rest = std::move(caller);
  if (drops_ && &from != &caller_) throw Dropped();
}

void FibreSet::live(std::uint32_t index) {
  while (true) {
    Fibre* next = &caller_;
    try {
      const std::uint32_t other = function_(context_, *this, index);
      if (other < count_) {
        next = &prepared(other);
        running_ = other;
      }
    } catch (const Dropped&) {
      return;
    } catch (...) {
      failure_ = std::current_exception();
    }
    try {
      go_on(*next, *fibres_[index]);
    } catch (const Dropped&) {
      return;
    }
  }
}

void FibreSet::switch_to(kernel::Fibres& fibres, std::uint32_t index) {
  auto& set = static_cast<FibreSet&>(fibres);
  if (index == set.running_) return;
  Fibre& to = set.prepared(index);
  Fibre& from = *set.fibres_[std::exchange(set.running_, index)];
  set.go_on(to, from);
}

void FibreSet::fail(kernel::Fibres&) { throw NotAllArrived(); }

}  // namespace tandem::cpu
