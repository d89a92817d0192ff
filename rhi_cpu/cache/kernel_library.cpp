#include "rhi_cpu/cache/kernel_library.hpp"

#include <dlfcn.h>
#include <unistd.h>

#include <atomic>
#include <cstdint>

#include <fmt/format.h>

namespace tandem::cpu {

namespace {

/// The descriptor's path, written as it never was before in this process: the loader takes a name that it has seen for
/// the library that it knows, and numbers of descriptors come again. The bits of a serial number become "/." and "/".
std::string fresh_path(int file) {
  static std::atomic<std::uint64_t> count = 0;
  std::string path = fmt::format("/proc/{}/fd", ::getpid());
  for (std::uint64_t rest = ++count; rest != 0; rest >>= 1) path += (rest & 1) != 0 ? "/." : "/";
  return fmt::format("{}/{}", path, file);
}

}  // namespace

void KernelLibrary::Close::operator()(void* library) const { ::dlclose(library); }

std::variant<KernelLibraryHandle, std::string> load_kernel_library(int file) {
  KernelLibrary::Library library(::dlopen(fresh_path(file).c_str(), RTLD_NOW | RTLD_LOCAL));
  if (library == nullptr) return std::string(::dlerror());
  const auto entry = reinterpret_cast<kernel::EntryFunction>(::dlsym(library.get(), kernel::entry_symbol));
  if (entry == nullptr) return fmt::format("it exports no {}", kernel::entry_symbol);
  const kernel::KernelInfo* info = entry();
  if (info == nullptr || info->abi_version != kernel::abi_version) return "it was made for another version of Tandem";
  return std::make_shared<KernelLibrary>(std::move(library), *info);
}

}  // namespace tandem::cpu
