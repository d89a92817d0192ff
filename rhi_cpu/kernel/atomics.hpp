#pragma once

#include <cstddef>
#include <cstdint>
#include <ctime>
#include <type_traits>

#include "rhi_cpu/kernel/components.hpp"

/// Atomic operations on buffers, sequentially consistent, which is at least as strong as any SPIR-V memory semantics.
/// T is a 32- or 64-bit integer or a float. Each returns the value before the operation.
namespace tandem::kernel {

/// A T in a buffer: may alias whatever type the bytes were written as.
template <typename T>
using buffer_word [[gnu::may_alias]] = T;

/// What the machine moves for a T: T itself, where that is a type of the machine's.
template <typename T>
struct MachineWord {
  using type = T;
};
template <typename T>
using machine_word_t = typename MachineWord<T>::type;

template <typename T>
inline T atomic_load(const std::byte* address) {
  machine_word_t<T> value;
  __atomic_load(reinterpret_cast<const buffer_word<machine_word_t<T>>*>(address), &value, __ATOMIC_SEQ_CST);
  return kernel::bit_cast<T>(value);
}

template <typename T>
inline void atomic_store(std::byte* address, T value) {
  auto word = kernel::bit_cast<machine_word_t<T>>(value);
  __atomic_store(reinterpret_cast<buffer_word<machine_word_t<T>>*>(address), &word, __ATOMIC_SEQ_CST);
}

template <typename T>
inline T atomic_exchange(std::byte* address, T value) {
  auto word = kernel::bit_cast<machine_word_t<T>>(value);
  machine_word_t<T> before;
  __atomic_exchange(reinterpret_cast<buffer_word<machine_word_t<T>>*>(address), &word, &before, __ATOMIC_SEQ_CST);
  return kernel::bit_cast<T>(before);
}

/// Stores `value` where the memory holds `expected`.
template <typename T>
inline T atomic_compare_exchange(std::byte* address, T expected, T value) {
  __atomic_compare_exchange(reinterpret_cast<buffer_word<T>*>(address), &expected, &value, false, __ATOMIC_SEQ_CST,
                            __ATOMIC_SEQ_CST);
  return expected;
}

/// Replaces the value x by update(x).
template <typename T, typename Update>
inline T atomic_update(std::byte* address, const Update& update) {
  using Word = machine_word_t<T>;
  const auto updated = [&](Word x) { return kernel::bit_cast<Word>(update(kernel::bit_cast<T>(x))); };
  Word before = atomic_load<Word>(address);
  Word after = updated(before);
  while (!__atomic_compare_exchange(reinterpret_cast<buffer_word<Word>*>(address), &before, &after, true,
                                    __ATOMIC_SEQ_CST, __ATOMIC_SEQ_CST))
    after = updated(before);
  return kernel::bit_cast<T>(before);
}

template <typename T>
inline T atomic_add(std::byte* address, T value) {
  if constexpr (std::is_integral_v<T>)
    return __atomic_fetch_add(reinterpret_cast<buffer_word<T>*>(address), value, __ATOMIC_SEQ_CST);
  else
    return atomic_update<T>(address, [=](T x) { return x + value; });
}
template <typename T>
inline T atomic_subtract(std::byte* address, T value) {
  return __atomic_fetch_sub(reinterpret_cast<buffer_word<T>*>(address), value, __ATOMIC_SEQ_CST);
}
template <typename T>
inline T atomic_and(std::byte* address, T value) {
  return __atomic_fetch_and(reinterpret_cast<buffer_word<T>*>(address), value, __ATOMIC_SEQ_CST);
}
template <typename T>
inline T atomic_or(std::byte* address, T value) {
  return __atomic_fetch_or(reinterpret_cast<buffer_word<T>*>(address), value, __ATOMIC_SEQ_CST);
}
template <typename T>
inline T atomic_xor(std::byte* address, T value) {
  return __atomic_fetch_xor(reinterpret_cast<buffer_word<T>*>(address), value, __ATOMIC_SEQ_CST);
}
template <typename T>
inline T atomic_min(std::byte* address, T value) {
  return atomic_update<T>(address, [=](T x) { return value < x || x != x ? value : x; });
}
template <typename T>
inline T atomic_max(std::byte* address, T value) {
  return atomic_update<T>(address, [=](T x) { return x < value || x != x ? value : x; });
}

/// A number that grows with time, of the machine's choice.
inline std::uint64_t read_clock() {
#if defined(__x86_64__)
  return __builtin_ia32_rdtsc();
#elif defined(__aarch64__)
  std::uint64_t ticks;
  asm volatile("mrs %0, cntvct_el0" : "=r"(ticks));
  return ticks;
#else
  return static_cast<std::uint64_t>(std::clock());
#endif
}

inline void memory_barrier() { __atomic_thread_fence(__ATOMIC_SEQ_CST); }

}  // namespace tandem::kernel
