#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "rhi/message.hpp"
#include "rhi_cpu/cache/content_hash.hpp"
#include "rhi_cpu/cache/kernel_library.hpp"
#include "rhi_cpu/cache/private_folder.hpp"

namespace tandem::cpu {

/// A folder that is removed, with all in it, at the end of its life. An empty path stands for none.
class TemporaryFolder {
 public:
  TemporaryFolder() = default;
  explicit TemporaryFolder(std::filesystem::path path) : path_(std::move(path)) {}
  ~TemporaryFolder();
  TemporaryFolder(TemporaryFolder&& other) noexcept : path_(std::move(other.path_)) { other.path_.clear(); }
  TemporaryFolder& operator=(TemporaryFolder&& other) noexcept {
    std::swap(path_, other.path_);
    return *this;
  }

  const std::filesystem::path& path() const noexcept { return path_; }
  /// Leaves the folder to the caller.
  std::filesystem::path release() noexcept { return std::exchange(path_, {}); }

 private:
  std::filesystem::path path_;
};

/// What a cache has done since it was opened.
struct KernelCacheStatistics {
  std::uint64_t hits = 0;     ///< libraries found and loaded
  std::uint64_t added = 0;    ///< libraries stored
  std::uint64_t damaged = 0;  ///< libraries found but useless, and removed
  std::uint64_t evicted = 0;  ///< libraries removed to keep the size bound
};

/// The folder of kernels compiled at run time, one file KEY.so each. Any number of processes and threads may use it at
/// once: files appear whole, by rename, and are never changed afterwards; each ends with a seal (key and checksum) that
/// is checked before the file is loaded. The file that was checked is the one that is loaded. Whatever is not right, or
/// not this user's, is removed and counts as not there.
class KernelCache {
 public:
  /// Opens or creates the folder. When it cannot be written, or when others could change what is in it (its files are
  /// executed; see PrivateFolder), a temporary folder that lives as long as the object takes its place, with a warning.
  /// @param folder as DeviceDesc::kernel_cache: empty for $TANDEM_CACHE_DIR, else $XDG_CACHE_HOME/tandem, else
  ///        ~/.cache/tandem
  explicit KernelCache(std::filesystem::path folder, rhi::MessageCallback on_message = {});

  /// Without symbolic links.
  const std::filesystem::path& folder() const noexcept { return folder_->path(); }
  KernelCacheStatistics statistics() const;

  /// The library of that key, loaded and marked as used now; nothing when there is none that is whole.
  KernelLibraryHandle find(const ContentHash& key, const std::string& label);

  /// An empty folder inside the cache, in which the file of `add` is made.
  TemporaryFolder make_work_folder(const std::string& label);

  /// Moves a freshly compiled library into the cache, loads it and removes the files that have not been used for
  /// longest until the bound holds again. Throws Error(io) when that cannot be written or loaded.
  KernelLibraryHandle add(const ContentHash& key, const std::filesystem::path& library, const std::string& label);

  /// The folder of headers of that key, marked as used now; "" when there is none that is this user's.
  /// @param file that must be in it
  std::filesystem::path find_headers(const ContentHash& key, std::string_view file);

  /// Moves a work folder of headers to where find_headers() finds it; "" when it cannot be moved.
  std::filesystem::path add_headers(const ContentHash& key, TemporaryFolder folder);

  /// Whether there is a library already.
  bool has_libraries() const;

  /// Moves a work folder to where it is kept for the user to read; it counts against the bound.
  std::filesystem::path keep_failure(TemporaryFolder folder, const ContentHash& key);

 private:
  std::string prepare(const std::filesystem::path& folder);
  void enforce_bound(const std::filesystem::path& newest);
  void say(rhi::Severity severity, const std::string& text) const;

  rhi::MessageCallback on_message_;
  TemporaryFolder fallback_;
  std::optional<PrivateFolder> folder_;  ///< set by the constructor
  std::uint64_t bound_;                  ///< bytes
  std::atomic<std::uint64_t> hits_ = 0;
  std::atomic<std::uint64_t> added_ = 0;
  std::atomic<std::uint64_t> damaged_ = 0;
  std::atomic<std::uint64_t> evicted_ = 0;
};

/// Bytes that the cache may hold: $TANDEM_CACHE_MAX_MB * 2^20, or 256 MiB.
std::uint64_t kernel_cache_bound(const rhi::MessageCallback& on_message);

}  // namespace tandem::cpu
