#pragma once

#include <cstddef>

#if defined(__SANITIZE_ADDRESS__)
#define TANDEM_SANITIZED_SWITCH
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define TANDEM_SANITIZED_SWITCH
#endif
#endif
#ifdef TANDEM_SANITIZED_SWITCH
#include <sanitizer/asan_interface.h>
#include <sanitizer/common_interface_defs.h>
#endif

/// What AddressSanitizer has to know of a thread that goes on on another stack. Nothing in other builds.
namespace tandem::cpu {

struct StackBounds {
  const void* bottom = nullptr;
  std::size_t size = 0;
};

/// Before the switch. @return what end_switch() is given when the one that calls goes on
inline void* begin_switch([[maybe_unused]] const StackBounds& to) {
  void* own = nullptr;
#ifdef TANDEM_SANITIZED_SWITCH
  __sanitizer_start_switch_fiber(&own, to.bottom, to.size);
#endif
  return own;
}

/// Before the switch of a stack that is never gone on with.
inline void begin_last_switch([[maybe_unused]] const StackBounds& to) {
#ifdef TANDEM_SANITIZED_SWITCH
  __sanitizer_start_switch_fiber(nullptr, to.bottom, to.size);
#endif
}

/// After it, on the stack that goes on. @param from gets the bounds of the stack that was left
inline void end_switch([[maybe_unused]] void* own, [[maybe_unused]] StackBounds& from) {
#ifdef TANDEM_SANITIZED_SWITCH
  __sanitizer_finish_switch_fiber(own, &from.bottom, &from.size);
#endif
}

/// Of memory that has been a stack before, on which frames were left.
inline void forget_frames([[maybe_unused]] const void* bottom, [[maybe_unused]] std::size_t size) {
#ifdef TANDEM_SANITIZED_SWITCH
  __asan_unpoison_memory_region(bottom, size);
#endif
}

}  // namespace tandem::cpu
