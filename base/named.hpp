#pragma once

#include <span>

namespace tandem {

/// A value and what files and command lines call it.
template <typename T>
struct Named {
  T value;
  const char* name;
};

/// The name of a value that the table has.
template <typename T>
const char* name_of(std::span<const Named<T>> names, T value) {
  for (const Named<T>& named : names)
    if (named.value == value) return named.name;
  return "unknown";
}

}  // namespace tandem
