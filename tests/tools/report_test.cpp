#include <doctest/doctest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "tests/support/device_test.hpp"
#include "tests/support/process.hpp"
#include "tests/support/scratch_folder.hpp"

namespace tandem::test {
namespace {

const std::string box = TANDEM_SOURCE_DIRECTORY "/scenes/cornell_box.obj";

/// What stands in the page under an id.
std::string embedded(const std::string& page, const std::string& id) {
  const std::string begin = "<script type=\"application/json\" id=\"" + id + "\">";
  const std::size_t from = page.find(begin);
  REQUIRE(from != std::string::npos);
  return page.substr(from + begin.size(), page.find("</script>", from) - from - begin.size());
}

TEST_CASE("--report writes a page that holds the very numbers of --json") {
  const ScratchFolder folder;
  const std::vector<std::string> names = device_names();
  const Outcome outcome =
      run_tandem(words("diff {} --a {} --b {} --size 16x8 --spp 2 --report new/report --json x.json",
                       {box, names.front(), names.back()}),
                 {.folder = folder.path()});
  CHECK(outcome.errors == "");
  REQUIRE(outcome.exit_code == 0);
  const std::string page = read_text(folder.path() / "new/report/index.html");
  CHECK(page.find("<!doctype html>") == 0);
  const auto numbers = nlohmann::json::parse(read_text(folder.path() / "x.json"));
  CHECK(nlohmann::json::parse(embedded(page, "numbers")) == numbers);
  CHECK(numbers.at("metrics").contains("flip"));  // a map on the page
  const auto data = nlohmann::json::parse(embedded(page, "data"));
  CHECK(data.at("width") == 16);
  CHECK(data.at("height") == 8);
  CHECK(data.at("bytes") == 4);
}

TEST_CASE("a device against itself has no pixel to look at, and no path is recorded") {
  const ScratchFolder folder;
  const std::string device = device_names().front();
  const Outcome outcome =
      run_tandem(words("diff {} --a {} --b {} --size 16x8 --spp 2 --report report", {box, device, device}),
                 {.folder = folder.path()});
  REQUIRE(outcome.exit_code == 0);
  const auto data = nlohmann::json::parse(embedded(read_text(folder.path() / "report/index.html"), "data"));
  CHECK(data.at("differing_pixels") == 0);
  CHECK(data.at("path_count") == 0);
}

TEST_CASE("a folder for the report that cannot be made is an error before anything is rendered") {
  const ScratchFolder folder;
  write_text(folder.path() / "file", "");
  const Outcome outcome = run_tandem(words("diff {} --a {} --b {} --size 16x8 --spp 1 --report file/report",
                                           {box, device_names().front(), device_names().front()}),
                                     {.folder = folder.path()});
  CHECK(outcome.exit_code == 2);
  CHECK(outcome.output == "");
  CHECK(outcome.errors.find("file") != std::string::npos);
}

}  // namespace
}  // namespace tandem::test
