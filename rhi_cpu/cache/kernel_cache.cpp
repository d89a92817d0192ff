#include "rhi_cpu/cache/kernel_cache.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <system_error>
#include <vector>

#include <fmt/format.h>

#include "rhi/error.hpp"
#include "rhi_cpu/cache/kernel_seal.hpp"

namespace tandem::cpu {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

constexpr const char* message_source = "cpu kernel cache";
/// A work folder this old has no process behind it any more.
constexpr auto abandoned_after = 1h;
/// A file used this recently may be about to be opened by another process.
constexpr auto in_use_for = 10s;

/// The variable's value, nothing when it is unset or empty.
std::optional<std::string> environment_variable(const char* name) {
  const char* value = std::getenv(name);
  if (value == nullptr || *value == '\0') return std::nullopt;
  return value;
}

/// Where the cache is to be; "" when the environment names no place.
fs::path wanted_folder(const fs::path& chosen) {
  if (!chosen.empty()) return fs::absolute(chosen);
  if (const auto folder = environment_variable("TANDEM_CACHE_DIR")) return fs::absolute(*folder);
  // The XDG base directory specification has relative paths ignored.
  if (const auto folder = environment_variable("XDG_CACHE_HOME"); folder && fs::path(*folder).is_absolute())
    return fs::path(*folder) / "tandem";
  if (const auto home = environment_variable("HOME")) return fs::path(*home) / ".cache" / "tandem";
  return {};
}

/// A new folder, named `prefix` and six characters, that only this user can enter; "" when it cannot be made.
fs::path make_private_folder(const fs::path& prefix) {
  std::string path = prefix.string() + "XXXXXX";
  return ::mkdtemp(path.data()) == nullptr ? fs::path() : fs::path(path);
}

struct Entry {
  fs::path path;
  fs::file_time_type used;
  std::uint64_t size = 0;
};

std::uint64_t size_of(const fs::path& path) {
  std::error_code error;
  if (!fs::is_directory(path, error)) {
    const std::uint64_t size = fs::file_size(path, error);
    return error ? 0 : size;
  }
  std::uint64_t sum = 0;
  for (fs::recursive_directory_iterator file(path, error), end; !error && file != end; file.increment(error)) {
    std::error_code ignored;
    if (file->is_regular_file(ignored)) sum += size_of(file->path());
  }
  return sum;
}

}  // namespace

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  if (!path_.empty()) fs::remove_all(path_, ignored);
}

std::uint64_t kernel_cache_bound(const rhi::MessageCallback& on_message) {
  constexpr std::uint64_t mebibyte = 1 << 20;
  constexpr std::uint64_t usual = 256 * mebibyte;
  const auto text = environment_variable("TANDEM_CACHE_MAX_MB");
  if (!text) return usual;
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(text->data(), text->data() + text->size(), value);
  if (error == std::errc() && end == text->data() + text->size() && value < (1ull << 40)) return value * mebibyte;
  if (on_message)
    on_message({.severity = rhi::Severity::warning,
                .source = message_source,
                .text = fmt::format("TANDEM_CACHE_MAX_MB={} is not a whole number of MiB; the limit is 256", *text)});
  return usual;
}

KernelCache::KernelCache(fs::path folder, rhi::MessageCallback on_message)
    : on_message_(std::move(on_message)), bound_(kernel_cache_bound(on_message_)) {
  const fs::path wanted = wanted_folder(std::move(folder));
  std::string problem = "no folder for compiled kernels is known (HOME is not set)";
  if (!wanted.empty()) {
    problem = prepare(wanted);
    if (problem.empty()) return;
    problem = fmt::format("the folder {} {}", wanted.string(), problem);
  }
  std::error_code ignored;
  fallback_ = TemporaryFolder(make_private_folder(fs::temp_directory_path(ignored) / "tandem-"));
  const std::string temporary_problem =
      fallback_.path().empty() ? std::strerror(errno) : prepare(fs::absolute(fallback_.path()));
  if (!temporary_problem.empty())
    throw rhi::Error(rhi::ErrorCode::io, message_source,
                     fmt::format("{}, and a temporary folder cannot be used either ({}); set TANDEM_CACHE_DIR to a "
                                 "folder that only you can write",
                                 problem, temporary_problem));
  say(rhi::Severity::warning, problem + "; kernels compiled now are lost when the program ends");
}

/// Makes the folder the cache's. @return why it cannot be, "" if it is
std::string KernelCache::prepare(const fs::path& folder) {
  auto opened = PrivateFolder::open(folder);
  if (std::string* const problem = std::get_if<std::string>(&opened)) return std::move(*problem);
  folder_ = std::move(std::get<PrivateFolder>(opened));
  const TemporaryFolder probe(make_private_folder(folder_->path() / "work-"));
  return probe.path().empty() ? fmt::format("cannot be written: {}", std::strerror(errno)) : std::string();
}

KernelCacheStatistics KernelCache::statistics() const {
  return {.hits = hits_, .added = added_, .damaged = damaged_, .evicted = evicted_};
}

KernelLibraryHandle KernelCache::find(const ContentHash& key, const std::string& label) {
  const std::string name = key.hex() + ".so";
  const PrivateFile file = folder_->open_file(name);
  if (!file.descriptor && file.problem.empty()) return nullptr;
  const fs::path path = folder() / name;
  std::string problem = "it " + file.problem;
  if (file.descriptor) {
    problem = "it is damaged";
    if (kernel_file_is_sound(file.descriptor.get(), key)) {
      auto loaded = load_kernel_library(file.descriptor.get());
      if (const auto* library = std::get_if<KernelLibraryHandle>(&loaded)) {
        ::futimens(file.descriptor.get(), nullptr);
        ++hits_;
        say(rhi::Severity::info, fmt::format("{}: loaded {}", label, path.string()));
        return *library;
      }
      problem = std::get<std::string>(loaded);
    }
  }
  std::error_code ignored;
  fs::remove_all(path, ignored);
  ++damaged_;
  say(rhi::Severity::info, fmt::format("{}: {} is compiled anew: {}", label, path.string(), problem));
  return nullptr;
}

TemporaryFolder KernelCache::make_work_folder(const std::string& label) {
  TemporaryFolder folder(make_private_folder(folder_->path() / "work-"));
  if (folder.path().empty())
    throw rhi::Error(rhi::ErrorCode::io, label,
                     fmt::format("the kernel cache {} cannot be written: {}; set TANDEM_CACHE_DIR to a folder that can",
                                 folder_->path().string(), std::strerror(errno)));
  return folder;
}

KernelLibraryHandle KernelCache::add(const ContentHash& key, const fs::path& library, const std::string& label) {
  const fs::path path = folder() / (key.hex() + ".so");
  const FileDescriptor file(::open(library.c_str(), O_RDWR | O_NOFOLLOW | O_CLOEXEC));
  std::error_code error;
  if (file && seal_kernel_file(file.get(), key))
    fs::rename(library, path, error);
  else
    error = std::make_error_code(std::errc::io_error);
  if (error)
    throw rhi::Error(rhi::ErrorCode::io, label,
                     fmt::format("the compiled kernel {} cannot be written: {}", path.string(), error.message()));
  ++added_;
  auto loaded = load_kernel_library(file.get());
  if (const auto* problem = std::get_if<std::string>(&loaded))
    throw rhi::Error(rhi::ErrorCode::io, label,
                     fmt::format("the compiled kernel cannot be loaded: {}; if its folder does not allow programs to "
                                 "run, set TANDEM_CACHE_DIR to one that does",
                                 *problem));
  enforce_bound(path);
  return std::get<KernelLibraryHandle>(loaded);
}

fs::path KernelCache::find_headers(const ContentHash& key, std::string_view file) {
  fs::path headers = folder() / ("headers-" + key.hex());
  const fs::path wanted = headers / file;
  std::error_code error;
  if (!fs::exists(wanted, error)) return {};
  const auto opened = PrivateFolder::open(wanted.parent_path());
  const auto* place = std::get_if<PrivateFolder>(&opened);
  if (place == nullptr || !place->open_file(wanted.filename().string()).descriptor) return {};
  fs::last_write_time(headers, fs::file_time_type::clock::now(), error);
  return headers;
}

fs::path KernelCache::add_headers(const ContentHash& key, TemporaryFolder made) {
  fs::path headers = folder() / ("headers-" + key.hex());
  std::error_code error;
  fs::rename(made.path(), headers, error);
  if (error) return {};  // another process was faster, or the disk is full
  made.release();
  enforce_bound(headers);
  return headers;
}

bool KernelCache::has_libraries() const {
  std::error_code error;
  for (fs::directory_iterator item(folder(), error), end; !error && item != end; item.increment(error))
    if (item->path().extension() == ".so") return true;
  return false;
}

fs::path KernelCache::keep_failure(TemporaryFolder folder, const ContentHash& key) {
  fs::path kept = folder_->path() / ("failed-" + key.hex());
  std::error_code error;
  fs::remove_all(kept, error);
  fs::rename(folder.path(), kept, error);
  if (error) return folder.release();
  folder.release();
  enforce_bound(kept);
  return kept;
}

void KernelCache::enforce_bound(const fs::path& newest) {
  const auto now = fs::file_time_type::clock::now();
  std::vector<Entry> entries;
  std::uint64_t sum = 0;
  std::error_code error;
  for (fs::directory_iterator item(folder(), error), end; !error && item != end; item.increment(error)) {
    std::error_code gone;
    const fs::file_time_type used = item->last_write_time(gone);
    if (gone) continue;
    const std::string name = item->path().filename().string();
    if (name.starts_with("work-")) {
      if (now - used > abandoned_after) fs::remove_all(item->path(), gone);
    } else if (name.starts_with("failed-") || name.starts_with("headers-") || item->path().extension() == ".so") {
      entries.push_back({.path = item->path(), .used = used, .size = size_of(item->path())});
      sum += entries.back().size;
    }
  }
  std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) { return a.used < b.used; });
  for (const Entry& entry : entries) {
    if (sum <= bound_) return;
    if (entry.path == newest || now - entry.used < in_use_for) continue;
    std::error_code gone;
    fs::remove_all(entry.path, gone);
    sum -= entry.size;
    ++evicted_;
  }
}

void KernelCache::say(rhi::Severity severity, const std::string& text) const {
  if (on_message_) on_message_({.severity = severity, .source = message_source, .text = text});
}

}  // namespace tandem::cpu
