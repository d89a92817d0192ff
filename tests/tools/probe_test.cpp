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

}  // namespace

TANDEM_DEVICE_TEST("diff --probe finds nothing to object to between two devices, and says what it tried") {
  const ScratchFolder folder;
  const Outcome outcome =
      run_tandem(words("diff {} --a cpu --b {} --size 16x16 --spp 1 --probe --probe-rays 300 --json diff.json",
                       {TANDEM_SOURCE_DIRECTORY "/scenes/cornell_box.obj", device_name}),
                 {.folder = folder.path()});
  CHECK(outcome.exit_code == 0);
  CHECK(outcome.output.find("trials of 300 rays") != std::string::npos);
  const nlohmann::json probes = read_json(folder.path() / "diff.json").at("probes");
  CHECK(probes.at("rays") == 300);
  CHECK(probes.at("classes").at("mismatch") == 0);
  CHECK(probes.at("trials").size() + probes.at("left_out").size() == 29);
  for (const nlohmann::json& trial : probes.at("trials")) {
    std::uint64_t sum = trial.at("bit_equal").get<std::uint64_t>();
    for (const nlohmann::json& count : trial.at("classes")) sum += count.get<std::uint64_t>();
    CHECK(sum == 300);
  }
}

TEST_CASE("diff --probe knows two surfaces that lie in one place") {
  const ScratchFolder folder;
  std::ofstream(folder.path() / "pair.mtl") << "newmtl red\nKd 0.8 0.1 0.1\nnewmtl green\nKd 0.1 0.8 0.1\n";
  std::ofstream(folder.path() / "pair.obj") << "mtllib pair.mtl\n"
                                               "v -1 -1 0.3\nv 1 -1 -0.4\nv 1 1 -0.1\nv -1 1 0.6\n"
                                               "usemtl red\nf 1 2 3\nf 1 3 4\n"
                                               "usemtl green\nf 2 3 4\nf 2 4 1\n";
  run_tandem(
      "diff pair.obj --a cpu --b cpu-exact --size 16x16 --spp 1 --depth 2 --camera-position 0.2,0.1,3 --probe --json "
      "diff.json",
      {.folder = folder.path()});
  const nlohmann::json probes = read_json(folder.path() / "diff.json").at("probes");
  CHECK(probes.at("classes").at("mismatch") == 0);
  CHECK(probes.at("classes").at("coincident geometry").get<int>() > 50);
  const nlohmann::json& first = probes.at("differences").at(0);
  CHECK(first.at("class") != "rounding");
  CHECK(first.at("ruling") == "tie");
  CHECK(first.at("a") != first.at("b"));
}

}  // namespace tandem::test
