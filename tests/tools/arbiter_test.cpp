#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include <nlohmann/json.hpp>

#include "tests/support/device_test.hpp"
#include "tests/tools/process.hpp"

namespace tandem::test {
namespace {

nlohmann::json read_json(const std::filesystem::path& path) {
  std::ifstream file(path);
  return nlohmann::json::parse(file);
}

TEST_CASE("the arbiter calls it a tie where two surfaces lie in one place") {
  const TemporaryFolder folder;
  // A red and a green quadrilateral in one tilted plane, cut into triangles along different diagonals: which is nearer
  // is decided by rounding alone.
  std::ofstream(folder.path() / "pair.mtl") << "newmtl red\nKd 0.8 0.1 0.1\nnewmtl green\nKd 0.1 0.8 0.1\n";
  std::ofstream(folder.path() / "pair.obj") << "mtllib pair.mtl\n"
                                               "v -1 -1 0.3\nv 1 -1 -0.4\nv 1 1 -0.1\nv -1 1 0.6\n"
                                               "usemtl red\nf 1 2 3\nf 1 3 4\n"
                                               "usemtl green\nf 2 3 4\nf 2 4 1\n";
  const Outcome outcome = run_tandem(
      {"diff",   "pair.obj", "--a", "cpu",     "--b", "cpu-exact",         "--arbiter", "cpu-exact",        "--size",
       "64x64",  "--spp",    "2",   "--depth", "2",   "--camera-position", "0.2,0.1,3", "--arbiter-pixels", "50",
       "--json", "diff.json"},
      {.folder = folder.path()});
  CHECK(outcome.errors.find("error") == std::string::npos);
  const nlohmann::json arbiter = read_json(folder.path() / "diff.json").at("arbiter");
  REQUIRE(arbiter.at("differing_pixels").get<int>() > 50);
  CHECK(arbiter.at("device") == "cpu-exact");
  CHECK(arbiter.at("examined_pixels") == 50);
  CHECK(arbiter.at("disputes").size() >= 50);
  CHECK(arbiter.at("ties") == arbiter.at("disputes").size());
  CHECK(arbiter.at("unparted_pixels") == 0);
  const nlohmann::json& first = arbiter.at("disputes").at(0);
  CHECK(first.at("kind") == "closest");
  CHECK(first.at("a") != first.at("b"));
  CHECK(first.at("b") == first.at("exact"));  // the arbiter is b
  CHECK(outcome.output.find("50 of") != std::string::npos);
  CHECK(outcome.output.find("exact is triangle") != std::string::npos);
}

TEST_CASE("devices that agree leave the arbiter nothing to do") {
  const TemporaryFolder folder;
  const Outcome outcome =
      run_tandem({"diff", TANDEM_SOURCE_DIRECTORY "/scenes/cornell_box.obj", "--a", "cpu", "--b", "cpu", "--arbiter",
                  "cpu-exact", "--size", "16x16", "--spp", "1", "--json", "diff.json"},
                 {.folder = folder.path()});
  CHECK(outcome.exit_code == 0);
  const nlohmann::json arbiter = read_json(folder.path() / "diff.json").at("arbiter");
  CHECK(arbiter.at("differing_pixels") == 0);
  CHECK(arbiter.at("disputes").empty());
}

}  // namespace
}  // namespace tandem::test
