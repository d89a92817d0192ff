#include <doctest/doctest.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>

#include <nlohmann/json.hpp>

#include "tests/support/device_test.hpp"
#include "tests/support/process.hpp"
#include "tests/support/scratch_folder.hpp"

namespace tandem::test {
namespace {

nlohmann::json read_json(const std::filesystem::path& path) {
  std::ifstream file(path);
  return nlohmann::json::parse(file);
}

TEST_CASE("diff --classify says that two surfaces lie in one place") {
  const ScratchFolder folder;
  // A red and a green quadrilateral in one tilted plane, cut into triangles along different diagonals: which is nearer
  // is decided by rounding alone.
  std::ofstream(folder.path() / "pair.mtl") << "newmtl red\nKd 0.8 0.1 0.1\nnewmtl green\nKd 0.1 0.8 0.1\n";
  std::ofstream(folder.path() / "pair.obj") << "mtllib pair.mtl\n"
                                               "v -1 -1 0.3\nv 1 -1 -0.4\nv 1 1 -0.1\nv -1 1 0.6\n"
                                               "usemtl red\nf 1 2 3\nf 1 3 4\n"
                                               "usemtl green\nf 2 3 4\nf 2 4 1\n";
  const Outcome outcome = run_tandem(
      "diff pair.obj --a cpu --b cpu-exact --size 64x64 --spp 2 --depth 2 --camera-position 0.2,0.1,3 --classify "
      "--classify-pixels 50 --survey 10 --json diff.json --out out",
      {.folder = folder.path()});
  CHECK(outcome.exit_code == 3);  // too many pixels differ, for a reason that the scene owns
  CHECK(outcome.errors.find("error") == std::string::npos);
  const nlohmann::json found = read_json(folder.path() / "diff.json").at("classification");
  REQUIRE(found.at("differing_pixels").get<int>() > 50);
  CHECK(found.at("classed_pixels") == 50);
  CHECK(found.at("surveyed_pixels") == 9);  // 3 by 3
  CHECK(found.at("mismatches") == 0);
  CHECK(found.at("pixel_classes").at("coincident geometry").get<int>() > 40);
  const nlohmann::json& first = found.at("divergences").at(0);
  CHECK(first.at("class") == "coincident geometry");
  CHECK(first.at("field") == "answer");
  CHECK(first.at("a") != first.at("b"));
  CHECK(first.at("b") == std::to_string(first.at("exact").get<std::uint32_t>()));  // b is the arbiter's kind
  CHECK(outcome.output.find("50 of") != std::string::npos);
  CHECK(outcome.output.find("both lie in the same place") != std::string::npos);
  CHECK(std::filesystem::exists(folder.path() / "out" / "classes.png"));
}

TEST_CASE("diff --classify of devices that agree has nothing to say") {
  const ScratchFolder folder;
  const Outcome outcome = run_tandem(words("diff {} --a cpu --b cpu --classify --size 16x16 --spp 1 --json diff.json",
                                           {TANDEM_SOURCE_DIRECTORY "/scenes/cornell_box.obj"}),
                                     {.folder = folder.path()});
  CHECK(outcome.exit_code == 0);
  const nlohmann::json found = read_json(folder.path() / "diff.json").at("classification");
  CHECK(found.at("differing_pixels") == 0);
  CHECK(found.at("surveyed_pixels") == 256);
  CHECK(found.at("differing_paths") == 0);
  CHECK(found.at("pixels").empty());
  CHECK(found.at("divergences").empty());
}

}  // namespace
}  // namespace tandem::test
