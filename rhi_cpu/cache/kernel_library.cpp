#include "rhi_cpu/cache/kernel_library.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

namespace tandem::cpu {

void KernelLibrary::Close::operator()(void* library) const { ::dlclose(library); }

std::variant<KernelLibraryHandle, std::string> load_kernel_library(const std::filesystem::path& path) {
  // A path without a slash would be looked up in the system's library folders.
  KernelLibrary::Library library(::dlopen(std::filesystem::absolute(path).c_str(), RTLD_NOW | RTLD_LOCAL));
  if (library == nullptr) return std::string(::dlerror());
  const auto entry = reinterpret_cast<kernel::EntryFunction>(::dlsym(library.get(), kernel::entry_symbol));
  if (entry == nullptr) return fmt::format("it exports no {}", kernel::entry_symbol);
  const kernel::KernelInfo* info = entry();
  if (info == nullptr || info->abi_version != kernel::abi_version) return "it was made for another version of Tandem";
  return std::make_shared<KernelLibrary>(std::move(library), *info);
}

}  // namespace tandem::cpu
