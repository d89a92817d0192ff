#include "rhi_cpu/cache/kernel_cache.hpp"

#include <doctest/doctest.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <thread>

#include "rhi/error.hpp"
#include "rhi_cpu/cache/kernel_compiler.hpp"
#include "rhi_cpu/cache/kernel_seal.hpp"
#include "tests/support/environment_variable.hpp"
#include "tests/support/messages.hpp"
#include "tests/support/run_summary.hpp"
#include "tests/support/scratch_folder.hpp"

namespace tandem::cpu {
namespace {

/// Nobody's, on every system.
constexpr uid_t other_user = 65534;

namespace fs = std::filesystem;
using namespace std::chrono_literals;
using test::EnvironmentVariable;
using test::Messages;
using test::ScratchFolder;

ContentHash key_of(std::uint64_t number) { return ContentHasher().add(number).hash(); }

/// A kernel of no resources whose push constant size is `mark`, so that a loaded library can be recognised.
std::string source_of(std::uint32_t mark, std::uint32_t abi_version = kernel::abi_version) {
  return R"(
#include "rhi_cpu/kernel/abi.hpp"
namespace {
void run(const tandem::kernel::Dispatch&, std::uint64_t, std::uint64_t) {}
const tandem::kernel::KernelInfo info{)" +
         std::to_string(abi_version) + ", {1, 1, 1}, " + std::to_string(mark) + R"(, 0, 0, nullptr, run};
}
extern "C" __attribute__((visibility("default"))) const tandem::kernel::KernelInfo* tandem_kernel() { return &info; })";
}

/// Compiles the source into `folder`.
fs::path compile(const fs::path& folder, const std::string& source) {
  std::ofstream(folder / "kernel.cpp") << source;
  const std::string problem = compile_kernel(find_kernel_compiler("test"), folder);
  CHECK(problem == "");
  return folder / "kernel.so";
}

KernelLibraryHandle add(KernelCache& cache, const ContentHash& key, std::uint32_t mark) {
  const TemporaryFolder work = cache.make_work_folder("test");
  return cache.add(key, compile(work.path(), source_of(mark)), "test");
}

fs::path file_of(const KernelCache& cache, const ContentHash& key) { return cache.folder() / (key.hex() + ".so"); }

/// A file of that size and age in place of a kernel.
fs::path put_old_file(const fs::path& folder, const std::string& name, std::size_t size, std::chrono::seconds age) {
  const fs::path path = folder / name;
  std::ofstream(path, std::ios::binary) << std::string(size, 'x');
  fs::last_write_time(path, fs::file_time_type::clock::now() - age);
  return path;
}

FileDescriptor opened(const fs::path& path) { return FileDescriptor(::open(path.c_str(), O_RDWR | O_CLOEXEC)); }

bool seal(const fs::path& path, const ContentHash& key) { return seal_kernel_file(opened(path).get(), key); }

bool is_sound(const fs::path& path, const ContentHash& key) { return kernel_file_is_sound(opened(path).get(), key); }

std::size_t file_count(const fs::path& folder) {
  return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

}  // namespace

TEST_CASE("The seal tells a whole file from any other") {
  const ScratchFolder folder;
  const fs::path path = folder.path() / "file";
  std::ofstream(path, std::ios::binary) << std::string(1000, 'k');
  CHECK_FALSE(is_sound(path, key_of(1)));
  REQUIRE(seal(path, key_of(1)));
  CHECK(is_sound(path, key_of(1)));
  CHECK_FALSE(is_sound(path, key_of(2)));

  SUBCASE("truncated") { fs::resize_file(path, 999); }
  SUBCASE("truncated within the seal") { fs::resize_file(path, fs::file_size(path) - 1); }
  SUBCASE("empty") { fs::resize_file(path, 0); }
  SUBCASE("a changed byte") {
    std::fstream file(path, std::ios::binary | std::ios::in | std::ios::out);
    file.seekp(500);
    file << 'K';
  }
  SUBCASE("a byte more") { std::ofstream(path, std::ios::binary | std::ios::app) << 'k'; }
  SUBCASE("gone") { fs::remove(path); }
  CHECK_FALSE(is_sound(path, key_of(1)));
}

TEST_CASE("What is added is found, also by another cache object; what is not added is not") {
  const ScratchFolder folder;
  const fs::path path = folder.path() / "cache" / "below";
  {
    KernelCache cache(path);
    CHECK(cache.find(key_of(1), "test") == nullptr);
    CHECK(add(cache, key_of(1), 11)->info().push_constant_size == 11);
    CHECK(cache.statistics().added == 1);
    CHECK(cache.statistics().hits == 0);
  }
  KernelCache cache(path);
  const KernelLibraryHandle found = cache.find(key_of(1), "test");
  REQUIRE(found != nullptr);
  CHECK(found->info().push_constant_size == 11);
  CHECK(cache.find(key_of(2), "test") == nullptr);
  CHECK(cache.statistics().hits == 1);
  CHECK(cache.statistics().damaged == 0);
  // Nothing but the kernel is left: no work folder.
  CHECK(file_count(path) == 1);
}

TEST_CASE("A cache folder is the user's alone") {
  const ScratchFolder folder;
  const KernelCache cache(folder.path() / "cache");
  CHECK(fs::status(cache.folder()).permissions() == fs::perms::owner_all);
}

TEST_CASE("A damaged file is removed and counts as not there") {
  const ScratchFolder folder;
  Messages messages;
  const ContentHash key = key_of(1);
  {
    KernelCache cache(folder.path());
    add(cache, key, 11);
  }
  KernelCache cache(folder.path(), messages.callback());
  const fs::path path = file_of(cache, key);
  SUBCASE("truncated") { fs::resize_file(path, fs::file_size(path) / 2); }
  SUBCASE("empty") { fs::resize_file(path, 0); }
  SUBCASE("a changed byte") {
    std::fstream file(path, std::ios::binary | std::ios::in | std::ios::out);
    file.seekp(4096);
    file << '\x7f';
  }
  SUBCASE("another key's file") {
    fs::remove(path);
    add(cache, key_of(2), 22);
    fs::rename(file_of(cache, key_of(2)), path);
  }
  SUBCASE("sealed, but no library") {
    std::ofstream(path, std::ios::binary | std::ios::trunc) << "no library";
    REQUIRE(seal(path, key));
  }
  SUBCASE("a library, but no kernel") {
    const ScratchFolder work;
    fs::copy_file(compile(work.path(), "int nothing;"), path, fs::copy_options::overwrite_existing);
    REQUIRE(seal(path, key));
  }
  SUBCASE("a kernel of another version") {
    const ScratchFolder work;
    fs::copy_file(compile(work.path(), source_of(1, kernel::abi_version + 1)), path,
                  fs::copy_options::overwrite_existing);
    REQUIRE(seal(path, key));
  }
  SUBCASE("writable by the group") { REQUIRE(::chmod(path.c_str(), 0775) == 0); }
  SUBCASE("a link to a sound file") {
    fs::rename(path, folder.path() / "elsewhere");
    fs::create_symlink("elsewhere", path);
  }
  SUBCASE("a link to nothing") {
    fs::remove(path);
    fs::create_symlink("nothing", path);
  }
  SUBCASE("a folder with something in it") {
    fs::remove(path);
    fs::create_directories(path / "below");
  }
  SUBCASE("a pipe that nobody writes to") {
    fs::remove(path);
    REQUIRE(::mkfifo(path.c_str(), 0700) == 0);
  }
  CHECK(cache.find(key, "glow") == nullptr);
  CHECK_FALSE(fs::exists(fs::symlink_status(path)));
  CHECK(cache.statistics().damaged == 1);
  CHECK(messages.count(rhi::Severity::info, "glow") == 1);
  CHECK(add(cache, key, 33)->info().push_constant_size == 33);
  CHECK(cache.find(key, "glow") != nullptr);
}

TEST_CASE("A sound file of another user is not run") {
  if (::geteuid() != 0) TANDEM_SKIP("only root can give files away");
  const ScratchFolder folder;
  Messages messages;
  KernelCache cache(folder.path(), messages.callback());
  add(cache, key_of(1), 11);
  REQUIRE(::chown(file_of(cache, key_of(1)).c_str(), other_user, other_user) == 0);
  CHECK(cache.find(key_of(1), "glow") == nullptr);
  CHECK_FALSE(fs::exists(file_of(cache, key_of(1))));
  CHECK(messages.count(rhi::Severity::info, "it belongs to another user") == 1);
}

TEST_CASE("The library that is loaded is the one that was checked, whatever has its name by now") {
  const ScratchFolder folder;
  const fs::path first = folder.path() / "first";
  const fs::path second = folder.path() / "second";
  fs::create_directories(first);
  fs::create_directories(second);
  const fs::path one = compile(first, source_of(11));
  const fs::path other = compile(second, source_of(22));
  std::vector<KernelLibraryHandle> loaded;
  for (int i = 0; i < 3; ++i) {
    // The same number of a descriptor each time: the loader must not take its path for a library that it knows.
    const FileDescriptor file = opened(i == 1 ? other : one);
    fs::rename(i == 1 ? other : one, folder.path() / "renamed");
    fs::copy_file(i == 1 ? one : other, i == 1 ? other : one);
    auto result = load_kernel_library(file.get());
    REQUIRE(std::holds_alternative<KernelLibraryHandle>(result));
    loaded.push_back(std::get<KernelLibraryHandle>(result));
    CHECK(loaded.back()->info().push_constant_size == (i == 1 ? 22 : 11));
    fs::rename(folder.path() / "renamed", i == 1 ? other : one);
  }
}

TEST_CASE("The files that were not used for longest go when the bound is passed") {
  const ScratchFolder folder;
  const EnvironmentVariable bound("TANDEM_CACHE_MAX_MB", "1");
  KernelCache cache(folder.path());
  constexpr std::size_t size = 400 << 10;  // two of them and a kernel fit into one MiB, three do not
  const fs::path oldest = put_old_file(folder.path(), "a.so", size, 300s);
  const fs::path middle = put_old_file(folder.path(), "b.so", size, 200s);
  const fs::path newest = put_old_file(folder.path(), "c.so", size, 100s);
  add(cache, key_of(1), 11);
  CHECK_FALSE(fs::exists(oldest));
  CHECK(fs::exists(middle));
  CHECK(fs::exists(newest));
  CHECK(cache.find(key_of(1), "test") != nullptr);
  CHECK(cache.statistics().evicted == 1);
}

TEST_CASE("A file that is found counts as used") {
  const ScratchFolder folder;
  KernelCache cache(folder.path());
  add(cache, key_of(1), 11);
  const fs::path path = file_of(cache, key_of(1));
  fs::last_write_time(path, fs::file_time_type::clock::now() - 1h);
  REQUIRE(cache.find(key_of(1), "test") != nullptr);
  CHECK(fs::file_time_type::clock::now() - fs::last_write_time(path) < 1min);
}

TEST_CASE("A file that was used just now stays, for another process may be about to open it") {
  const ScratchFolder folder;
  const EnvironmentVariable bound("TANDEM_CACHE_MAX_MB", "0");
  KernelCache cache(folder.path());
  const fs::path recent = put_old_file(folder.path(), "a.so", 1000, 1s);
  const fs::path old = put_old_file(folder.path(), "b.so", 1000, 60s);
  add(cache, key_of(1), 11);
  CHECK(fs::exists(recent));
  CHECK_FALSE(fs::exists(old));
}

TEST_CASE("Work folders of processes that are gone are cleared away, those in use are not") {
  const ScratchFolder folder;
  KernelCache cache(folder.path());
  fs::create_directories(folder.path() / "work-gone" / "below");
  fs::last_write_time(folder.path() / "work-gone", fs::file_time_type::clock::now() - 2h);
  fs::create_directories(folder.path() / "work-now");
  add(cache, key_of(1), 11);
  CHECK_FALSE(fs::exists(folder.path() / "work-gone"));
  CHECK(fs::exists(folder.path() / "work-now"));
}

TEST_CASE("A bound that is no number is a warning") {
  Messages messages;
  const EnvironmentVariable bound("TANDEM_CACHE_MAX_MB", "12 MB");
  CHECK(kernel_cache_bound(messages.callback()) == 256u << 20);
  CHECK(messages.count(rhi::Severity::warning, "12 MB") == 1);
}

TEST_CASE("A folder that cannot be used is replaced by a temporary one, with a warning") {
  const ScratchFolder folder;
  Messages messages;
  fs::path wanted = folder.path() / "cache";
  SUBCASE("below a file") {
    std::ofstream(folder.path() / "file") << "x";
    wanted = folder.path() / "file" / "cache";
  }
  SUBCASE("a file") { std::ofstream(wanted) << "x"; }
  SUBCASE("where nothing can be created") { wanted = "/proc/tandem"; }
  SUBCASE("open to everybody") {
    fs::create_directory(wanted);
    fs::permissions(wanted, fs::perms::all);
  }
  SUBCASE("open to its group") {
    fs::create_directory(wanted);
    fs::permissions(wanted, fs::perms::owner_all | fs::perms::group_all);
  }
  SUBCASE("below a folder that is open to everybody") {
    fs::create_directory(wanted);
    fs::permissions(wanted, fs::perms::all);
    wanted /= "below";
  }
  fs::path temporary;
  {
    KernelCache cache(wanted, messages.callback());
    temporary = cache.folder();
    CHECK(temporary != wanted);
    CHECK(messages.count(rhi::Severity::warning, wanted.string()) == 1);
    CHECK(add(cache, key_of(1), 11)->info().push_constant_size == 11);
    CHECK(cache.find(key_of(1), "test") != nullptr);
  }
  CHECK_FALSE(fs::exists(temporary));
}

TEST_CASE("The environment names the folder when the device does not") {
  const ScratchFolder folder;
  const fs::path root = folder.path();
  const EnvironmentVariable home("HOME", (root / "home").string());
  const EnvironmentVariable xdg("XDG_CACHE_HOME", std::nullopt);
  const EnvironmentVariable own("TANDEM_CACHE_DIR", std::nullopt);
  CHECK(KernelCache("").folder() == root / "home/.cache/tandem");
  {
    const EnvironmentVariable set("XDG_CACHE_HOME", (root / "xdg").string());
    CHECK(KernelCache("").folder() == root / "xdg/tandem");
    const EnvironmentVariable set_own("TANDEM_CACHE_DIR", (root / "own").string());
    CHECK(KernelCache("").folder() == root / "own");
    CHECK(KernelCache(root / "chosen").folder() == root / "chosen");
  }
  {
    const EnvironmentVariable relative("XDG_CACHE_HOME", "relative");
    CHECK(KernelCache("").folder() == root / "home/.cache/tandem");
  }
  const EnvironmentVariable no_home("HOME", std::nullopt);
  Messages messages;
  const KernelCache cache("", messages.callback());
  CHECK(messages.count(rhi::Severity::warning, "HOME") == 1);
}

TEST_CASE("A failed compilation is kept for the user, once") {
  const ScratchFolder folder;
  KernelCache cache(folder.path());
  for (int i = 0; i < 2; ++i) {
    TemporaryFolder work = cache.make_work_folder("test");
    std::ofstream(work.path() / "compiler.log") << i;
    const fs::path kept = cache.keep_failure(std::move(work), key_of(1));
    std::ifstream log(kept / "compiler.log");
    CHECK(log.get() == '0' + i);
  }
  CHECK(file_count(folder.path()) == 1);
}

}  // namespace tandem::cpu
