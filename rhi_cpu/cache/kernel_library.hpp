#pragma once

#include <memory>
#include <string>
#include <variant>

#include "rhi_cpu/kernel/abi.hpp"

namespace tandem::cpu {

/// A kernel in a shared library of its own, which stays loaded as long as the object lives.
class KernelLibrary {
 public:
  struct Close {
    void operator()(void* library) const;
  };
  using Library = std::unique_ptr<void, Close>;

  KernelLibrary(Library library, const kernel::KernelInfo& info) : library_(std::move(library)), info_(&info) {}

  const kernel::KernelInfo& info() const noexcept { return *info_; }

 private:
  Library library_;
  const kernel::KernelInfo* info_;
};

using KernelLibraryHandle = std::shared_ptr<const KernelLibrary>;

/// Loads the library of a kernel, or says in a few words why it is none that this program can run. What the descriptor
/// stands for is loaded, not what has its name by now. Needs /proc.
/// @param file open for reading; it may be closed afterwards
std::variant<KernelLibraryHandle, std::string> load_kernel_library(int file);

}  // namespace tandem::cpu
