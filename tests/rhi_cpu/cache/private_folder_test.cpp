#include "rhi_cpu/cache/private_folder.hpp"

#include <doctest/doctest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "tests/support/run_summary.hpp"
#include "tests/support/scratch_folder.hpp"

namespace tandem::cpu {
namespace {

namespace fs = std::filesystem;
using test::ScratchFolder;

/// Nobody's, on every system.
constexpr uid_t other_user = 65534;

/// Why the folder is refused, "" when it is not.
std::string refusal(const fs::path& path) {
  const auto opened = PrivateFolder::open(path);
  const std::string* problem = std::get_if<std::string>(&opened);
  return problem == nullptr ? "" : *problem;
}

fs::path make_folder(const fs::path& path, mode_t mode) {
  fs::create_directory(path);
  REQUIRE(::chmod(path.c_str(), mode) == 0);
  return path;
}

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace

TEST_CASE("A private folder is made with all above it, for this user alone") {
  const ScratchFolder scratch;
  const auto opened = PrivateFolder::open(scratch.path() / "a" / "b");
  REQUIRE(std::holds_alternative<PrivateFolder>(opened));
  for (const char* name : {"a", "a/b"}) CHECK(fs::status(scratch.path() / name).permissions() == fs::perms::owner_all);
}

TEST_CASE("Only the owner may write a private folder and what is above it") {
  const ScratchFolder scratch;
  CHECK(contains(refusal(make_folder(scratch.path() / "group", 0775)), "written by its group"));
  CHECK(contains(refusal(make_folder(scratch.path() / "all", 0777)), "written by everybody"));
  CHECK(contains(refusal(make_folder(scratch.path() / "sticky", 01777)), "written by everybody"));
  CHECK(contains(refusal(scratch.path() / "group" / "below"), "is below"));
  CHECK(contains(refusal(scratch.path() / "all" / "below" / "further"), "is below"));
  // Nobody can rename what is another's in a sticky folder.
  CHECK(refusal(scratch.path() / "sticky" / "below") == "");
  CHECK(refusal(make_folder(scratch.path() / "readable", 0755)) == "");
}

TEST_CASE("A private folder is where its links lead") {
  const ScratchFolder scratch;
  make_folder(scratch.path() / "target", 0700);
  make_folder(scratch.path() / "open", 0777);
  fs::create_symlink("target", scratch.path() / "link");
  fs::create_symlink(scratch.path() / "link", scratch.path() / "link_to_link");
  fs::create_symlink("open/../target", scratch.path() / "around");
  fs::create_symlink("open", scratch.path() / "link_to_open");
  fs::create_symlink("circle", scratch.path() / "circle");
  const auto opened = PrivateFolder::open(scratch.path() / "link_to_link");
  REQUIRE(std::holds_alternative<PrivateFolder>(opened));
  CHECK(std::get<PrivateFolder>(opened).path() == fs::canonical(scratch.path() / "target"));
  CHECK(contains(refusal(scratch.path() / "link_to_open"), "everybody"));
  CHECK(contains(refusal(scratch.path() / "link_to_open" / "below"), "everybody"));
  CHECK(contains(refusal(scratch.path() / "around"), "everybody"));
  CHECK(contains(refusal(scratch.path() / "circle"), "cannot be opened"));
}

TEST_CASE("A private folder and what is above it belong to this user or to root") {
  if (::geteuid() != 0) TANDEM_SKIP("only root can give files away");
  const ScratchFolder scratch;
  const fs::path other = make_folder(scratch.path() / "other", 0755);
  make_folder(other / "own", 0700);
  fs::create_symlink("/", scratch.path() / "link");
  REQUIRE(::chown(other.c_str(), other_user, other_user) == 0);
  REQUIRE(::lchown((scratch.path() / "link").c_str(), other_user, other_user) == 0);
  CHECK(contains(refusal(other), "belongs to another user"));
  CHECK(contains(refusal(other / "own"), "belongs to another user"));
  CHECK(contains(refusal(scratch.path() / "link" / "tmp"), "link"));
  // A sticky folder protects from everybody but its owner.
  REQUIRE(::chmod(other.c_str(), 01777) == 0);
  CHECK(contains(refusal(other / "own"), "belongs to another user"));
}

TEST_CASE("Files of a private folder are regular, this user's, and written by nobody else") {
  const ScratchFolder scratch;
  make_folder(scratch.path(), 0700);
  auto opened = PrivateFolder::open(scratch.path());
  REQUIRE(std::holds_alternative<PrivateFolder>(opened));
  const PrivateFolder& folder = std::get<PrivateFolder>(opened);
  const fs::path path = scratch.path() / "file";
  CHECK_FALSE(folder.open_file("file").descriptor);
  CHECK(folder.open_file("file").problem == "");
  std::ofstream(path) << "text";
  REQUIRE(::chmod(path.c_str(), 0644) == 0);
  CHECK(folder.open_file("file").descriptor);
  REQUIRE(::chmod(path.c_str(), 0664) == 0);
  CHECK(folder.open_file("file").problem == "may be written by other users");
  CHECK_FALSE(folder.open_file("file").descriptor);
  REQUIRE(::chmod(path.c_str(), 0646) == 0);
  CHECK(folder.open_file("file").problem == "may be written by other users");
  fs::create_symlink("file", scratch.path() / "link");
  CHECK(folder.open_file("link").problem == "is a symbolic link");
  fs::create_directory(scratch.path() / "folder");
  CHECK(folder.open_file("folder").problem == "is not a regular file");
  REQUIRE(::mkfifo((scratch.path() / "pipe").c_str(), 0600) == 0);
  CHECK(folder.open_file("pipe").problem == "is not a regular file");
}

}  // namespace tandem::cpu
