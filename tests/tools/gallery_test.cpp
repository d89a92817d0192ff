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
  CHECK(run(list(R"(, "colour": 5)"), tiny).errors.find("scenes[0].colour is not known") != std::string::npos);
  CHECK(run(list(""), "--only teapot").errors == "tandem: list.json lists no scene 'teapot'; it lists cornell_box\n");
  CHECK(run(R"({"scenes": []})", tiny).exit_code == 2);
  CHECK_FALSE(std::filesystem::exists(folder.path() / "out"));

  const Outcome good = run(list(""), "--size 300x8 --spp 1 --only cornell_box");
  CHECK(good.exit_code == 0);
  // Halved, so that no side is longer than 256.
  CHECK(pathtracer::read_image(folder.path() / "out/images/gallery/cornell_box.png").width == 150);
}

TEST_CASE("gallery shows titles and names as they are, whatever they hold") {
  const ScratchFolder folder;
  std::filesystem::copy_file(TANDEM_SOURCE_DIRECTORY "/scenes/cornell_box.mtl", folder.path() / "cornell_box.mtl");
  std::filesystem::copy_file(TANDEM_SOURCE_DIRECTORY "/scenes/cornell_box.obj", folder.path() / "a (b) #1.obj");
  write_text(
      folder.path() / "list.json",
      R"({"scenes": [{"file": "a (b) #1.obj", "title": "<script>x</script> | [a](b) `c`\n\"d\"", "samples": 1}]})");
  const Outcome outcome =
      run_tandem("gallery list.json --out out --device cpu cpu-exact --size 8x8", {.folder = folder.path()});
  CHECK(outcome.errors == "");
  CHECK(outcome.exit_code == 0);
  const std::string html = read_text(folder.path() / "out/index.html");
  CHECK(html.find("<script>") == std::string::npos);
  CHECK(html.find("&lt;script&gt;x&lt;/script&gt; | [a](b) `c`&#10;&quot;d&quot;") != std::string::npos);
  CHECK(html.find("src=\"images/gallery/a%20%28b%29%20%231.png\"") != std::string::npos);
  CHECK(std::filesystem::exists(folder.path() / "out/images/gallery/a (b) #1.png"));
  CHECK(html.find("<code>tandem gallery list.json --out out --device cpu cpu-exact --size 8x8</code>") !=
        std::string::npos);
  const std::string page = read_text(folder.path() / "out/gallery.md");
  CHECK(page.find(R"(\<script\>x\</script\> \| \[a\]\(b\) \`c\` "d")") != std::string::npos);
  CHECK(page.find("](images/gallery/a%20%28b%29%20%231.png)") != std::string::npos);
}

TEST_CASE("a gallery that ends early shows what was finished, and nothing else") {
  const ScratchFolder folder;
  const std::string box = TANDEM_SOURCE_DIRECTORY "/scenes/cornell_box.obj";
  const std::string good = R"({"file": ")" + box + R"(", "title": "box", "spp": 1})";
  const auto run = [&](const std::string& entries, unsigned interrupt_after_ms) {
    write_text(folder.path() / "list.json", R"({"scenes": [)" + entries + "]}");
    return run_tandem("gallery list.json --out out --device cpu,cpu --size 16x16",
                      {.folder = folder.path(), .interrupt_after_ms = interrupt_after_ms});
  };
  const std::string endless =
      R"({"file": ")" TANDEM_SOURCE_DIRECTORY R"(/scenes/cornell_spheres.obj", "title": "spheres", "spp": 16777216})";
  const Outcome at_once = run(endless, 6000);
  CHECK(at_once.exit_code == 130);
  CHECK(at_once.errors == "tandem: interrupted; nothing was written\n");
  CHECK_FALSE(std::filesystem::exists(folder.path() / "out"));

  const Outcome later = run(good + ", " + endless, 6000);
  CHECK(later.exit_code == 130);
  CHECK(later.errors == "tandem: interrupted after 1 of 2 scenes, which 'out/index.html' shows\n");
  const nlohmann::json report = nlohmann::json::parse(read_text(folder.path() / "out/gallery.json"));
  CHECK(report.at("scenes").size() == 1);
  CHECK(report.at("listed") == 2);
  CHECK(read_text(folder.path() / "out/gallery.md").find("1 of 2 scenes were rendered") != std::string::npos);
  CHECK(read_text(folder.path() / "out/index.html").find("1 of 2 scenes were rendered") != std::string::npos);

  CHECK(run(R"({"file": "teapot.obj", "title": "none"})", 0).errors ==
        "tandem: list.json: scenes[0].file names 'teapot.obj', which does not exist\n");
  write_text(folder.path() / "teapot.obj", "v 1 2\n");
  const Outcome failed = run(good + R"(, {"file": "teapot.obj", "title": "none"})", 0);
  CHECK(failed.exit_code == 2);
  CHECK(failed.errors.starts_with("tandem: ended after 1 of 2 scenes, which 'out/index.html' shows: "));
  CHECK(failed.errors.find("teapot.obj") != std::string::npos);
}

TEST_CASE("gallery and suite find the lists that came with the program from any folder") {
  const ScratchFolder folder;
  const Outcome outcome = run_tandem("gallery --out out --device cpu,cpu --size 8x8 --spp 1 --only cube_default",
                                     {.folder = folder.path()});
  CHECK(outcome.errors == "");
  CHECK(outcome.exit_code == 0);
  CHECK(run_tandem("suite --help", {.folder = folder.path()}).output.find("/scenes/suite.json") != std::string::npos);
}

}  // namespace tandem::test
