#include "rhi_cpu/launch/launch_watch.hpp"

#include <type_traits>

#include <fmt/format.h>

#include "rhi/error.hpp"

namespace tandem::cpu {

LaunchWatch::LaunchWatch(std::chrono::milliseconds limit, const std::string& label)
    : limit_(limit),
      end_(std::chrono::steady_clock::now() + limit),
      label_(label),
      watch_{.watch = {.look = look}, .owner = this} {}

void LaunchWatch::look(const kernel::Watch& watch) {
  static_assert(std::is_standard_layout_v<OwnWatch>, "its first member has its address");
  const LaunchWatch& owner = *reinterpret_cast<const OwnWatch&>(watch).owner;
  if (std::chrono::steady_clock::now() < owner.end_) return;
  owner.is_over_ = true;
  owner.fail();
}

void LaunchWatch::check() const {
  if (is_over_) fail();
}

void LaunchWatch::fail() const {
  throw rhi::Error(rhi::ErrorCode::timeout, label_,
                   fmt::format("it ran for more than the {} ms of the device's time limit and was stopped; a loop may "
                               "have no end",
                               limit_.count()));
}

}  // namespace tandem::cpu
