#include "rhi_cpu/launch/launch_fibres.hpp"

#include <type_traits>
#include <utility>

#include "rhi/error.hpp"

namespace tandem::cpu {

std::unique_ptr<FibreSet> FibrePool::take() {
  const std::lock_guard lock(mutex_);
  if (free_.empty()) return std::make_unique<FibreSet>();
  std::unique_ptr<FibreSet> set = std::move(free_.back());
  free_.pop_back();
  return set;
}

void FibrePool::give_back(std::unique_ptr<FibreSet> set) {
  const std::lock_guard lock(mutex_);
  free_.push_back(std::move(set));
}

LaunchFibres::LaunchFibres(FibrePool& pool, const std::string& label)
    : pool_(pool), label_(label), host_{.host = {.run = run}, .owner = this} {}

LaunchFibres::~LaunchFibres() {
  if (set_ != nullptr) pool_.give_back(std::move(set_));
}

void LaunchFibres::run(const kernel::FibreHost& host, std::uint32_t count, std::size_t stack_size,
                       kernel::FibreFunction function, void* context) {
  static_assert(std::is_standard_layout_v<OwnHost>, "its first member has its address");
  LaunchFibres& owner = *reinterpret_cast<const OwnHost&>(host).owner;
  if (owner.set_ == nullptr) owner.set_ = owner.pool_.take();
  try {
    owner.set_->run(count, stack_size, function, context);
  } catch (const FibreSet::NotAllArrived&) {
    throw rhi::Error(rhi::ErrorCode::invalid_argument, owner.label_,
                     "some invocations of a workgroup reach a barrier() that others do not reach");
  }
}

}  // namespace tandem::cpu
