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

const std::string gallery = TANDEM_SOURCE_DIRECTORY "/scenes/gallery.json";

std::vector<std::string> arguments(const std::string& list, const std::string& more) {
  const std::vector<std::string>& names = device_names();
  return words("gallery {} --out out --device {} {} " + more, {list, names.front(), names.back()});
}

}  // namespace

TEST_CASE("gallery renders every scene that ships, alike on two devices, into a page") {
  const ScratchFolder folder;
  const Outcome outcome = run_tandem(arguments(gallery, "--size 24x24 --spp 1"), {.folder = folder.path()});
  CHECK(outcome.exit_code == 0);
  CHECK(outcome.errors == "");
  const nlohmann::json listed = nlohmann::json::parse(read_text(gallery)).at("scenes");
  const nlohmann::json report = nlohmann::json::parse(read_text(folder.path() / "out/gallery.json"));
  const std::string page = read_text(folder.path() / "out/gallery.md");
  REQUIRE(report.at("scenes").size() == listed.size());
  bool agree = true;
  for (const nlohmann::json& scene : report.at("scenes")) {
    const std::string name = scene.at("name");
    CAPTURE(name);
    CHECK(scene.at("bit_equal") >= scene.at("thresholds").at("bit_equal").at("limit"));
    CHECK(scene.at("thresholds").at("bit_equal").at("reason") != "");
    CHECK(scene.at("non_finite_a") == 0);
    CHECK(scene.at("non_finite_b") == 0);
    CHECK(scene.at("mean_a") > 0.0);
    agree = agree && scene.at("verdict") == "agree";
    for (const char* suffix : {".png", "_difference.png"}) {
      const std::string picture = "images/gallery/" + name + suffix;
      CHECK(page.find("(" + picture + ")") != std::string::npos);
      CHECK(pathtracer::read_image(folder.path() / "out" / picture).width == 24);
    }
  }
  CHECK(outcome.exit_code == (agree ? 0 : 1));
  CHECK(report.at("verdict") == (agree ? "agree" : "differ"));
}

TEST_CASE("gallery says what is wrong with a list, and makes pictures small") {
  const ScratchFolder folder;
  const std::string box = TANDEM_SOURCE_DIRECTORY "/scenes/cornell_box.obj";
  const auto run = [&](const std::string& text, const std::string& more) {
    write_text(folder.path() / "list.json", text);
    return run_tandem(arguments("list.json", more), {.folder = folder.path()});
  };
  const auto list = [&](const std::string& entry) {
    return R"({"scenes": [{"file": ")" + box + R"(", "title": "box")" + entry + "}]}";
  };
  const std::string tiny = "--size 8x8 --spp 1";
  CHECK(run(list(R"(, "spp": 5)"), tiny).errors.find("scenes[0].spp is not known") != std::string::npos);
  CHECK(run(list(""), "--only teapot").errors == "tandem: list.json lists no scene 'teapot'\n");
  CHECK(run(R"({"scenes": []})", tiny).exit_code == 2);
  CHECK_FALSE(std::filesystem::exists(folder.path() / "out"));

  const Outcome good = run(list(""), "--size 300x8 --spp 1 --only cornell_box");
  CHECK(good.exit_code == 0);
  // Halved, so that no side is longer than 256.
  CHECK(pathtracer::read_image(folder.path() / "out/images/gallery/cornell_box.png").width == 150);
}

}  // namespace tandem::test
