#include "base/input_file.hpp"

#include <doctest/doctest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstring>
#include <string>

#include "base/error.hpp"
#include "base/text_file.hpp"
#include "tests/support/scratch_folder.hpp"

namespace tandem {
namespace {

std::string refusal(const std::filesystem::path& path) {
  std::string sentence;
  try {
    check_input(path);
  } catch (const Error& error) {
    sentence = error.what();
  }
  CHECK_THROWS_WITH_AS(read_bytes(path, 100), sentence.c_str(), Error);
  CHECK_THROWS_WITH_AS(read_text(path), sentence.c_str(), Error);
  return sentence;
}

}  // namespace

TEST_CASE("A file is read whole, whatever its bytes") {
  const test::ScratchFolder folder;
  CHECK(read_bytes(folder.write("empty", ""), 0).empty());
  const std::string bytes("a\0b\n", 4);
  CHECK(read_bytes(folder.write("bytes", bytes), 4) == bytes);
  std::string large(100000, 'x');
  large += 'y';
  CHECK(read_bytes(folder.write("large", large), 1u << 20) == large);
  CHECK_THROWS_WITH_AS(read_bytes(folder.path() / "large", 100000), doctest::Contains("more than 100000 bytes"), Error);
  CHECK(read_text(folder.path() / "large") == large);
  // Its size is 0 until it is read.
  CHECK(read_bytes("/proc/self/status", 1u << 20).starts_with("Name:"));
}

TEST_CASE("What is no regular file is refused at once, by what it is") {
  const test::ScratchFolder folder;
  const std::filesystem::path pipe = folder.path() / "pipe";
  REQUIRE(::mkfifo(pipe.c_str(), 0600) == 0);
  CHECK(refusal(pipe) == "cannot read '" + pipe.string() + "': it is a pipe, not a regular file");
  CHECK(refusal("/dev/zero") == "cannot read '/dev/zero': it is a device, not a regular file");
  CHECK(refusal("/dev/null") == "cannot read '/dev/null': it is a device, not a regular file");
  CHECK(refusal(folder.path()) == "cannot read '" + folder.path().string() + "': it is a folder");
  const std::filesystem::path absent = folder.path() / "absent";
  CHECK(refusal(absent) == "cannot read '" + absent.string() + "': it does not exist");
  const std::filesystem::path link = folder.path() / "link";
  std::filesystem::create_symlink("pipe", link);
  CHECK(refusal(link) == "cannot read '" + link.string() + "': it is a pipe, not a regular file");

  const int listener = ::socket(AF_UNIX, SOCK_STREAM, 0);
  REQUIRE(listener >= 0);
  const std::filesystem::path name = folder.path() / "socket";
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::strncpy(address.sun_path, name.c_str(), sizeof(address.sun_path) - 1);
  REQUIRE(::bind(listener, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) == 0);
  CHECK(refusal(name) == "cannot read '" + name.string() + "': it is a socket, not a regular file");
  ::close(listener);
}

}  // namespace tandem
