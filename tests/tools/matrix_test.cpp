#include <doctest/doctest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/support/device_test.hpp"
#include "tests/support/process.hpp"
#include "tests/support/scratch_folder.hpp"

namespace tandem::test {
namespace {

const std::string box = TANDEM_SOURCE_DIRECTORY "/scenes/cornell_box.obj";

TEST_CASE("matrix compares each two devices, and lets all vote") {
  const ScratchFolder folder;
  const std::vector<std::string> names = {device_names().front(), "cpu-exact", device_names().back()};
  const Outcome outcome = run_tandem(
      words("matrix {} --size 24x16 --spp 2 --json x.json --device {} {} {}", {box, names[0], names[1], names[2]}),
      {.folder = folder.path()});
  CHECK(outcome.errors == "");
  CHECK(outcome.exit_code == 0);
  CHECK(outcome.output.find("verdict           agree\n") != std::string::npos);
  const nlohmann::json json = nlohmann::json::parse(read_text(folder.path() / "x.json"));
  CHECK(json.at("verdict") == "agree");
  CHECK(json.at("reasons").empty());
  CHECK(json.at("outvoted").empty());
  REQUIRE(json.at("devices").size() == 3);
  CHECK(json.at("devices").at(1).at("name") == "cpu-exact");
  REQUIRE(json.at("pairs").size() == 3);
  for (const nlohmann::json& pair : json.at("pairs")) CHECK(pair.at("within_1e3") >= 0.99);
  const nlohmann::json& vote = json.at("vote");
  CHECK(vote.at("pixels") == 24 * 16);
  CHECK(vote.at("unanimous").get<int>() + vote.at("within_tolerance").get<int>() + vote.at("decided").get<int>() +
            vote.at("tied").get<int>() ==
        24 * 16);
  CHECK(json.at("settings").at("spp") == 2);
}

TEST_CASE("matrix takes three devices or more, and no tier that has other samples") {
  const Outcome two = run_tandem(words("matrix {} --device cpu cpu-exact", {box}));
  CHECK(two.exit_code == 2);
  CHECK(two.errors == "tandem: --device: a vote needs at least three devices; 'tandem diff' compares two\n");
  const Outcome statistical = run_tandem(words("matrix {} --tier statistical --device cpu cpu cpu", {box}));
  CHECK(statistical.exit_code == 2);
  CHECK(statistical.errors.find("tier statistical is for 'tandem diff' only") != std::string::npos);
}

TEST_CASE("matrix of pictures that are not finite is exit code 1, and nobody is outvoted by his own bits") {
  const ScratchFolder folder;
  write_text(folder.path() / "sun.mtl", "newmtl sun\nKe 3e38 3e38 3e38\n");
  write_text(folder.path() / "sun.obj", "mtllib sun.mtl\nusemtl sun\nv -9 -9 0\nv 9 -9 0\nv 0 9 0\nf 1 2 3\n");
  const Outcome outcome =
      run_tandem("matrix sun.obj --size 8x8 --spp 4 --json x.json --device cpu cpu cpu", {.folder = folder.path()});
  CHECK(outcome.exit_code == 1);
  const nlohmann::json json = nlohmann::json::parse(read_text(folder.path() / "x.json"));
  CHECK(json.at("verdict") == "differ");
  CHECK(json.at("vote").at("unanimous") == 64);
  CHECK(json.at("outvoted").empty());
}

TEST_CASE("matrix names the device that the others outvote") {
  const ScratchFolder folder;
  // Two quadrilaterals in one tilted plane, cut along different diagonals: which is nearer is decided by rounding
  // alone, and the exact tracer rounds otherwise.
  write_text(folder.path() / "pair.mtl", "newmtl red\nKd 0.8 0.1 0.1\nnewmtl green\nKd 0.1 0.8 0.1\n");
  write_text(folder.path() / "pair.obj",
             "mtllib pair.mtl\nv -1 -1 0.3\nv 1 -1 -0.4\nv 1 1 -0.1\nv -1 1 0.6\n"
             "usemtl red\nf 1 2 3\nf 1 3 4\nusemtl green\nf 2 3 4\nf 2 4 1\n");
  const Outcome outcome = run_tandem(
      "matrix pair.obj --size 32x32 --spp 2 --depth 2 --camera-position 0.2,0.1,3 --json x.json --device cpu cpu-exact "
      "cpu",
      {.folder = folder.path()});
  CHECK(outcome.exit_code == 1);
  CHECK(outcome.output.find("cpu-exact is outvoted: most of the devices agree with each other") != std::string::npos);
  const nlohmann::json json = nlohmann::json::parse(read_text(folder.path() / "x.json"));
  CHECK(json.at("outvoted") == std::vector<std::string>{"cpu-exact"});
  const nlohmann::json& exact = json.at("devices").at(1);
  CHECK(exact.at("beyond_tolerance").get<int>() > 10);
  CHECK(exact.at("outvoted") == json.at("vote").at("decided"));
  CHECK(json.at("vote").at("tied") == 0);
  CHECK(json.at("devices").at(0).at("outvoted") == 0);
  CHECK(json.at("devices").at(2).at("outvoted") == 0);
}

}  // namespace
}  // namespace tandem::test
