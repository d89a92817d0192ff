#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "rhi/message.hpp"

struct RTCDeviceTy;

namespace tandem::cpu {

/// Owns the Embree device that acceleration structures are built with. What Embree reports goes to the message callback
/// under the source "embree".
class EmbreeDevice {
 public:
  /// @param thread_count threads that a build uses, 0 for all that the machine has
  /// Throws rhi::Error when Embree does not start or lacks filter functions.
  explicit EmbreeDevice(rhi::MessageCallback on_message = {}, std::uint32_t thread_count = 0);
  ~EmbreeDevice();
  EmbreeDevice(EmbreeDevice&&) noexcept;
  EmbreeDevice& operator=(EmbreeDevice&&) noexcept;

  RTCDeviceTy* get() const noexcept;

  /// Whether Embree itself skips instances by mask; else the trace functions do it.
  bool has_ray_masks() const noexcept;

  /// Memory that Embree holds for this device. What a build adds to it is only known when no other build, and no
  /// release of a structure, happens meanwhile.
  std::int64_t allocated_bytes() const noexcept;

  /// Throws rhi::Error, in the name of `label`, if an Embree call of this thread has failed since the last check.
  void check(std::string_view label) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// The Embree that is linked: "Embree 3.13.5".
std::string embree_version();

}  // namespace tandem::cpu
