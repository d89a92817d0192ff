// Verdicts of tandem diff: tiers, and the thresholds of a scene.

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

/// `diff` of a device with itself, of few pixels and samples, with the further words of `more`.
Outcome diff(const ScratchFolder& folder, const std::string& scene, const std::string& device,
             const std::string& more = "") {
  return run_tandem(words("diff {} --a {} --b {} --size 16x16 --spp 8 --json x.json " + more, {scene, device, device}),
                    {.folder = folder.path()});
}

nlohmann::json report(const ScratchFolder& folder) {
  return nlohmann::json::parse(read_text(folder.path() / "x.json"));
}

}  // namespace

TANDEM_DEVICE_TEST("tier statistical accepts a device under other seeds, and says what it would have found") {
  const ScratchFolder folder;
  const Outcome outcome = diff(folder, box, device_name, "--tier statistical --tile 8 --seed 3 --seed-b 100");
  CHECK(outcome.errors == "");
  REQUIRE(outcome.exit_code == 0);
  CHECK(outcome.output.find("would have been found with probability 0.9") != std::string::npos);
  const nlohmann::json json = report(folder);
  CHECK(json.at("tier") == "statistical");
  CHECK(json.at("bit_equal") < 0.5);  // other seeds
  const nlohmann::json& statistics = json.at("statistics");
  CHECK(statistics.at("batches") == 8);
  CHECK(statistics.at("batch_samples") == 1);
  CHECK(statistics.at("seeds") == nlohmann::json({{"a", 3}, {"control_a", 11}, {"b", 100}, {"control_b", 108}}));
  CHECK(statistics.at("tile_tests") == 4 * 4);
  for (const nlohmann::json& test : {statistics, statistics.at("control_a"), statistics.at("control_b")}) {
    CHECK(test.at("p_value") > 1e-4);
    CHECK(test.at("p_value") <= 1);
    CHECK(test.at("rmse") > 0);
  }
  CHECK(statistics.at("power").at("picture") > 0);
  CHECK(statistics.at("power").at("median_tile") > 0);
  CHECK(json.at("thresholds").at("bias_p_value").at("limit") == 1e-4);
  CHECK_FALSE(json.at("thresholds").contains("bit_equal"));
}

TEST_CASE("a p-value below the level is a difference, in a sentence with its place") {
  const ScratchFolder folder;
  const Outcome outcome = diff(folder, box, "cpu", "--tier statistical --min-p-value 1 --batches 9 --tile 8");
  CHECK(outcome.exit_code == 1);
  const nlohmann::json json = report(folder);
  CHECK(json.at("statistics").at("batch_samples") == 1);  // at least as many samples in all as were asked for
  REQUIRE_FALSE(json.at("reasons").empty());
  CHECK(json.at("reasons").at(0).get<std::string>().find("differ by more than noise: in the mean ") !=
        std::string::npos);
}

TEST_CASE("a scene's own thresholds hold, and the command line wins over them") {
  const ScratchFolder folder;
  write_text(folder.path() / "tiny.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  write_text(folder.path() / "tiny.thresholds.json",
             R"({"tier": "exact", "rules": [{"metric": "bit_equal", "limit": 0.25, "reason": "it is tiny"}]})");
  CHECK(diff(folder, "tiny.obj", "cpu").exit_code == 0);
  CHECK(report(folder).at("tier") == "exact");
  CHECK(diff(folder, "tiny.obj", "cpu", "--tier tolerance").exit_code == 0);
  CHECK(report(folder).at("tier") == "tolerance");
  CHECK(report(folder).at("thresholds").at("bit_equal").at("limit") == 0.25);
  CHECK(report(folder).at("thresholds").at("bit_equal").at("reason") == "it is tiny");
  CHECK(diff(folder, "tiny.obj", "cpu", "--tier tolerance --min-bit-equal 0.5").exit_code == 0);
  CHECK(report(folder).at("thresholds").at("bit_equal").at("limit") == 0.5);

  const auto complaint = [&](const std::string& more) {
    const Outcome outcome = diff(folder, "tiny.obj", "cpu", more);
    CHECK(outcome.exit_code == 2);
    return outcome.errors;
  };
  CHECK(complaint("--min-bit-equal 0.5").ends_with("tandem: --min-bit-equal has no meaning in tier exact\n"));
  CHECK(complaint("--tier statistical --classify").find("--classify cannot be combined with --tier statistical") !=
        std::string::npos);
  write_text(folder.path() / "tiny.thresholds.json", R"({"rules": [{"metric": "bit_equal", "limit": 0.25}]})");
  CHECK(complaint("").ends_with("tandem: tiny.thresholds.json: rules[0] must have a reason\n"));
}

}  // namespace tandem::test
