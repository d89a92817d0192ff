#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>

/// Atomic operations on buffers, sequentially consistent, which is at least as strong as any SPIR-V memory semantics.
/// T is a 32- or 64-bit integer, or float. Each returns the value before the operation.
namespace tandem::kernel {

/// A T in a buffer: may alias whatever type the bytes were written as.
template <typename T>
using buffer_word [[gnu::may_alias]] = T;

template <typename T>
inline T atomic_load(const std::byte* address) {
  T value;
  __atomic_load(reinterpret_cast<const buffer_word<T>*>(address), &value, __ATOMIC_SEQ_CST);
  return value;
}

template <typename T>
inline void atomic_store(std::byte* address, T value) {
  __atomic_store(reinterpret_cast<buffer_word<T>*>(address), &value, __ATOMIC_SEQ_CST);
}

template <typename T>
inline T atomic_exchange(std::byte* address, T value) {
  T before;
  __atomic_exchange(reinterpret_cast<buffer_word<T>*>(address), &value, &before, __ATOMIC_SEQ_CST);
  return before;
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
  T before = atomic_load<T>(address);
  T after = update(before);
  while (!__atomic_compare_exchange(reinterpret_cast<buffer_word<T>*>(address), &before, &after, true, __ATOMIC_SEQ_CST,
                                    __ATOMIC_SEQ_CST))
    after = update(before);
  return before;
}

template <typename T>
inline T atomic_add(std::byte* address, T value) {
  if constexpr (std::is_floating_point_v<T>)
    return atomic_update<T>(address, [=](T x) { return x + value; });
  else
    return __atomic_fetch_add(reinterpret_cast<buffer_word<T>*>(address), value, __ATOMIC_SEQ_CST);
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
  return atomic_update<T>(address, [=](T x) { return value < x ? value : x; });
}
template <typename T>
inline T atomic_max(std::byte* address, T value) {
  return atomic_update<T>(address, [=](T x) { return x < value ? value : x; });
}

inline void memory_barrier() { __atomic_thread_fence(__ATOMIC_SEQ_CST); }

}  // namespace tandem::kernel
