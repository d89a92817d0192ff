#include <doctest/doctest.h>

#include <stdexcept>

#include "base/error.hpp"
#include "tests/support/process.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tools/output/output_file.hpp"
#include "tools/report/spread.hpp"

namespace tandem::tools {
namespace {

TEST_CASE("the median of an odd and an even number of values") {
  const Spread odd = spread({5.0, 1.0, 3.0});
  CHECK(odd.median == 3.0);
  CHECK(odd.least == 1.0);
  CHECK(odd.most == 5.0);
  CHECK(spread({4.0, 1.0, 2.0, 8.0}).median == 3.0);
  CHECK(spread({7.0}).median == 7.0);
}

TEST_CASE("a result that can no longer be written is saved elsewhere, and the sentence says where") {
  const test::ScratchFolder folder;
  // As when the folder went between the check and the write.
  const std::vector<OutputFile> files = {
      {folder.path() / "good.txt", [](const std::filesystem::path& path) { write_text(path, "good"); }},
      {folder.path() / "gone" / "one.txt", [](const std::filesystem::path& path) { write_text(path, "one"); }},
      {folder.path() / "gone" / "two.txt", [](const std::filesystem::path& path) { write_text(path, "two"); }}};
  std::string sentence;
  try {
    write_or_rescue(files);
  } catch (const tandem::Error& error) {
    sentence = error.what();
  }
  CHECK(sentence.find("gone") != std::string::npos);
  const std::size_t begin = sentence.find("saved in '") + 10;
  REQUIRE(begin > 10);
  const std::filesystem::path rescue = sentence.substr(begin, sentence.find('\'', begin) - begin);
  CHECK(test::read_text(rescue / "one.txt") == "one");
  CHECK(test::read_text(rescue / "two.txt") == "two");
  CHECK(test::read_text(folder.path() / "good.txt") == "good");
  std::filesystem::remove_all(rescue);
}

TEST_CASE("a result that cannot be written anywhere is an error with both reasons") {
  const auto fails = [](const std::filesystem::path&) { throw std::runtime_error("the disk is full"); };
  const OutputFile file{"x.txt", fails};
  CHECK_THROWS_WITH_AS(write_or_rescue({&file, 1}),
                       "the disk is full; saving it elsewhere failed too: the disk is full", tandem::Error);
}

TEST_CASE("a folder for results goes again unless something was written into it") {
  const test::ScratchFolder folder;
  { const OutputFolder unused(folder.path() / "unused"); }
  CHECK(folder.names().empty());
  {
    const OutputFolder used(folder.path() / "used");
    write_text(used.path() / "x.txt", "x");
  }
  { const OutputFolder again(folder.path() / "used"); }
  CHECK(folder.names() == std::vector<std::string>{"used"});
  CHECK_THROWS_AS(OutputFolder(folder.path() / "used" / "x.txt"), tandem::Error);
}

TEST_CASE("texts are written whole, over what was there") {
  const test::ScratchFolder folder;
  write_text(folder.path() / "x.txt", "a long first text");
  write_text(folder.path() / "x.txt", "second");
  CHECK(test::read_text(folder.path() / "x.txt") == "second");
  CHECK(folder.names() == std::vector<std::string>{"x.txt"});
}

}  // namespace
}  // namespace tandem::tools
