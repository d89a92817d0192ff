#include "base/atomic_file.hpp"

#include <doctest/doctest.h>

#include <string>

#include "base/error.hpp"
#include "tests/support/scratch_folder.hpp"

namespace tandem {
namespace {

void write(const std::filesystem::path& path, const std::string& text) {
  AtomicFile file(path);
  file.write(std::as_bytes(std::span(text)));
  file.commit();
}

}  // namespace

TEST_CASE("A file is replaced whole, and without commit left as it was") {
  const test::ScratchFolder folder;
  const std::filesystem::path path = folder.write("file", "old");
  { AtomicFile(path).write({}); }
  CHECK(test::read_text(path) == "old");
  write(path, "new");
  CHECK(test::read_text(path) == "new");
  CHECK(folder.names().size() == 1);
}

TEST_CASE("A symbolic link stays, and what it names is written") {
  const test::ScratchFolder folder;
  const std::filesystem::path disk = folder.path() / "disk";
  std::filesystem::create_directory(disk);
  const auto link = [&](const char* name, const std::filesystem::path& target) {
    std::filesystem::create_symlink(target, folder.path() / name);
    return folder.path() / name;
  };
  test::write_text(disk / "old", "old");
  for (const std::filesystem::path& path : {link("relative", "disk/old"), link("absolute", disk / "old"),
                                            link("twice", "relative"), link("dangling", "disk/new")}) {
    CAPTURE(path);
    write(path, path.string());
    CHECK(std::filesystem::is_symlink(path));
    CHECK(test::read_text(path) == path.string());
    CHECK(std::filesystem::is_regular_file(link_target(path)));
  }
  CHECK(test::read_text(disk / "old") == (folder.path() / "twice").string());
  CHECK(test::read_text(disk / "new") == (folder.path() / "dangling").string());
  CHECK(std::distance(std::filesystem::directory_iterator(disk), {}) == 2);
}

TEST_CASE("A link that leads to no file is refused by its own name") {
  const test::ScratchFolder folder;
  const auto link = [&](const char* name, const std::filesystem::path& target) {
    std::filesystem::create_symlink(target, folder.path() / name);
    return folder.path() / name;
  };
  for (const std::filesystem::path& path :
       {link("circle", "circle"), link("folder", "."), link("device", "/dev/null"), link("nowhere", "missing/file")}) {
    CHECK_THROWS_WITH_AS(AtomicFile{path}, doctest::Contains(path.c_str()), Error);
    CHECK(std::filesystem::is_symlink(path));
  }
  CHECK(folder.names().size() == 4);
}

}  // namespace tandem
