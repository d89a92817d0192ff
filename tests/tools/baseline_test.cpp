#include <doctest/doctest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "pathtracer/image/image_io.hpp"
#include "tests/support/device_test.hpp"
#include "tests/support/process.hpp"
#include "tests/support/scratch_folder.hpp"

namespace tandem::test {
namespace {

const std::string scenes = TANDEM_SOURCE_DIRECTORY "/scenes/";

/// `diff` of the first and the last device under test, of few pixels and samples, with the further words of `more`.
Outcome diff(const ScratchFolder& folder, const std::string& scene, const std::string& more = "") {
  const std::vector<std::string>& names = device_names();
  return run_tandem(words("diff {} --a {} --b {} --size 16x8 --spp 2 " + more, {scene, names.front(), names.back()}),
                    {.folder = folder.path()});
}

nlohmann::json read_json(const std::filesystem::path& path) { return nlohmann::json::parse(read_text(path)); }

TEST_CASE("a run agrees with the stored one in every bit, and what changed since is told") {
  const ScratchFolder folder;
  REQUIRE(diff(folder, scenes + "cornell_box.obj", "--out run").exit_code == 0);
  const Outcome same = diff(folder, scenes + "cornell_box.obj", "--baseline run --json x.json");
  CHECK(same.errors == "");
  CHECK(same.exit_code == 0);
  CHECK(same.output.find("changed           nothing\n") != std::string::npos);
  CHECK(same.output.find("in all            agree\n") != std::string::npos);
  nlohmann::json baseline = read_json(folder.path() / "x.json").at("baseline");
  CHECK(baseline.at("verdict") == "agree");
  CHECK(baseline.at("a").at("bit_equal") == 1.0);
  CHECK(baseline.at("b").at("bit_equal") == 1.0);
  CHECK(baseline.at("changes").empty());

  // As if an older driver had rendered the run.
  nlohmann::json report = read_json(folder.path() / "run/diff.json");
  const std::string driver = report.at("device_b").at("driver");
  report["device_b"]["driver"] = "an older one";
  report["ms_a"] = 12345.0;
  write_text(folder.path() / "run/diff.json", report.dump());
  const Outcome later = diff(folder, scenes + "cornell_box.obj", "--baseline run --json x.json");
  CHECK(later.exit_code == 0);
  baseline = read_json(folder.path() / "x.json").at("baseline");
  REQUIRE(baseline.at("changes").size() == 1);
  CHECK(baseline.at("changes").at(0).at("what") == "driver of b");
  CHECK(baseline.at("changes").at(0).at("before") == "an older one");
  CHECK(baseline.at("changes").at(0).at("now") == driver);
  CHECK(baseline.at("a").at("ms_before") == 12345.0);
  CHECK(later.output.find("12345.00 ms then") != std::string::npos);
}

TEST_CASE("a picture that is no longer the stored one is exit code 1, and it is said whose") {
  const ScratchFolder folder;
  REQUIRE(diff(folder, scenes + "cornell_box.obj", "--out run").exit_code == 0);
  pathtracer::Image image = pathtracer::read_image(folder.path() / "run/b.exr");
  for (glm::vec3& pixel : image.pixels) pixel.y += 0.25f;
  pathtracer::write_image(folder.path() / "run/b.exr", image, {});
  const Outcome outcome = diff(folder, scenes + "cornell_box.obj", "--baseline run --json x.json --junit x.xml");
  CHECK(outcome.exit_code == 1);
  CHECK(outcome.output.find("nothing") == std::string::npos);
  CHECK(outcome.output.find("in all            differ: b and its baseline\n") != std::string::npos);
  const nlohmann::json json = read_json(folder.path() / "x.json");
  CHECK(json.at("verdict") == "agree");  // of a and b today
  CHECK(json.at("baseline").at("verdict") == "differ");
  CHECK(json.at("baseline").at("a").at("verdict") == "agree");
  CHECK(json.at("baseline").at("b").at("verdict") == "differ");
  CHECK(json.at("baseline").at("b").at("bit_equal") == 0.0);
  CHECK(json.at("baseline").at("b").at("max_abs").get<double>() == doctest::Approx(0.25).epsilon(1e-6));
  CHECK(read_text(folder.path() / "x.xml").find("Since 'run', b has changed: Only 0.0000 %") != std::string::npos);
}

TEST_CASE("the stored run of another job is refused before anything is rendered") {
  const ScratchFolder folder;
  std::filesystem::copy_file(scenes + "cornell_box.obj", folder.path() / "box.obj");
  std::filesystem::copy_file(scenes + "cornell_box.mtl", folder.path() / "cornell_box.mtl");
  REQUIRE(diff(folder, "box.obj", "--out run").exit_code == 0);
  const auto refusal = [&](const std::string& scene, const std::string& more) {
    const Outcome outcome = diff(folder, scene, "--baseline run " + more);
    CHECK(outcome.exit_code == 2);
    CHECK(outcome.output == "");
    return outcome.errors;
  };
  const std::string start = "tandem: the run in 'run' cannot be the baseline: ";
  CHECK(refusal("box.obj", "--seed 3") == start + "its seed is 0, not 3\n");
  CHECK(refusal("box.obj", "--sampler sobol") == start + "its sampler is independent, not sobol\n");
  CHECK(refusal("box.obj", "--lens-radius 2").find("its lens_radius is 0.0, not 2.0") != std::string::npos);
  CHECK(refusal("box.obj", "--background 1,0,0").find("its background is") != std::string::npos);
  const Outcome statistical = diff(folder, "box.obj", "--baseline run --tier statistical");
  CHECK(statistical.exit_code == 2);
  CHECK(statistical.errors ==
        "tandem: --baseline cannot be combined with --tier statistical: its images have other samples\n");
  // What a file that the scene's file names says, counts too.
  CHECK(diff(folder, "box.obj", "--baseline run").exit_code == 0);
  std::string materials = read_text(folder.path() / "cornell_box.mtl");
  const std::size_t at = materials.find("Kd 0.63");
  REQUIRE(at != std::string::npos);
  materials.replace(at, 7, "Kd 0.64");
  write_text(folder.path() / "cornell_box.mtl", materials);
  CHECK(refusal("box.obj", "") == start + "the content of box.obj has changed since\n");
}

TEST_CASE("a folder without a whole run is no baseline") {
  const ScratchFolder folder;
  const std::string box = scenes + "cornell_box.obj";
  const auto refusal = [&](const std::string& more) {
    const Outcome outcome = diff(folder, box, more);
    CHECK(outcome.exit_code == 2);
    return outcome.errors;
  };
  const std::string start = "tandem: 'run' does not hold a run of 'tandem diff --out': ";
  CHECK(refusal("--baseline run") == start + "cannot read 'run/diff.json': it does not exist\n");
  REQUIRE(diff(folder, box, "--out run").exit_code == 0);
  CHECK(refusal("--baseline run --out ./run") ==
        "tandem: --out and --baseline are both './run': the baseline would be overwritten\n");
  std::filesystem::remove(folder.path() / "run/b.exr");
  CHECK(refusal("--baseline run").find(start) == 0);
  write_text(folder.path() / "run/diff.json", "{}");
  CHECK(refusal("--baseline run").find(start + "diff.json: ") == 0);
  write_text(folder.path() / "run/diff.json", R"({"settings": 3, "device_a": {}, "device_b": {}})");
  CHECK(refusal("--baseline run") == start + "'settings' of diff.json is not an object\n");
}

}  // namespace
}  // namespace tandem::test
