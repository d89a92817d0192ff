#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <pugixml.hpp>
#include <set>
#include <string>
#include <vector>

#include "tests/pathtracer/load/description/json_schema.hpp"
#include "tests/support/process.hpp"
#include "tests/support/scratch_folder.hpp"

namespace tandem::test {
namespace {

using Json = nlohmann::json;

const std::string scenes = TANDEM_SOURCE_DIRECTORY "/scenes/";

Json read_json(const std::filesystem::path& path) { return Json::parse(read_text(path)); }

/// A folder with two boxes, one of which may be changed, and a scene that overflows.
class Sandbox : public ScratchFolder {
 public:
  Sandbox() {
    const std::string obj = read_text(scenes + "cornell_box.obj");
    write_text(path() / "box.obj", obj);
    write_text(path() / "cornell_box.mtl", read_text(scenes + "cornell_box.mtl"));
    write_text(path() / "other.obj", "mtllib other.mtl\n" + obj.substr(obj.find('\n', obj.find("mtllib"))));
    write_text(path() / "other.mtl", read_text(scenes + "cornell_box.mtl"));
    write_text(path() / "sun.mtl", "newmtl sun\nKe 3e38 3e38 3e38\n");
    write_text(path() / "sun.obj", "mtllib sun.mtl\nusemtl sun\nv -9 -9 0\nv 9 -9 0\nv 0 9 0\nf 1 2 3\n");
  }
  Outcome run(const Json& suite, std::vector<std::string> more = {}, unsigned interrupt_after_ms = 0) const {
    write_text(path() / "suite.json", suite.dump());
    more.insert(more.begin(), {"suite", "suite.json", "--out", "out"});
    return run_tandem(more, {.folder = path(), .interrupt_after_ms = interrupt_after_ms});
  }
  /// The only error of a suite, without what every error begins with.
  std::string error(const Json& suite) const {
    const Outcome outcome = run(suite);
    CHECK(outcome.exit_code == 2);
    CHECK_FALSE(std::filesystem::exists(path() / "out"));
    const std::string start = "tandem: suite.json: ";
    CHECK(outcome.errors.find(start) == 0);
    return outcome.errors.substr(start.size());
  }
};

const Json tiny = {{"name", "tiny"}, {"size", "8x8"}, {"spp", 1}};
const Json on_the_cpu = Json::array({Json::array({"cpu", "cpu"})});

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TEST_CASE("a suite compares every scene on every pair of devices under every settings") {
  const Sandbox folder;
  Json reported = tiny;
  reported["report"] = true;
  const Json seeded = {{"name", "seed 3"}, {"size", "8x8"}, {"seed", 3}, {"nee", false}, {"roulette", true}};
  const Json wide = {
      {"file", "other.obj"}, {"name", "wide"}, {"settings", {{"size", "16x8"}, {"camera_position", {278, 273, -900}}}}};
  const Outcome outcome = folder.run({{"title", "Two <boxes>"},
                                      {"scenes", {"box.obj", wide}},
                                      {"devices", Json::parse(R"([["cpu", "cpu"], ["cpu", "cpu-exact"]])")},
                                      {"settings", {reported, seeded}}},
                                     {"--json", "x.json", "--junit", "x.xml"});
  CHECK(outcome.errors == "");
  CHECK(outcome.exit_code == 0);
  CHECK(contains(outcome.output, "8 comparisons: 8 agree, 0 are explained, 0 differ, 0 failed; 0 were reused"));

  const Json json = read_json(folder.path() / "x.json");
  CHECK(json == read_json(folder.path() / "out/suite.json"));
  CHECK(json.at("verdict") == "agree");
  REQUIRE(json.at("cells").size() == 8);
  const Json& first = json.at("cells").at(0);
  CHECK(first.at("name") == "box-cpu-cpu-tiny");
  CHECK(first.at("report").at("settings").at("spp") == 1);
  CHECK(first.at("report").at("settings").at("width") == 8);
  CHECK(first.at("report").at("bit_equal") == 1.0);
  const Json& last = json.at("cells").at(7);
  CHECK(last.at("name") == "wide-cpu-cpu-exact-seed-3");
  CHECK(last.at("report").at("device_b").at("name") == "cpu-exact");
  CHECK(last.at("report").at("settings").at("seed") == 3);
  CHECK(last.at("report").at("settings").at("nee") == false);
  CHECK(last.at("report").at("settings").at("width") == 16);  // the scene's own settings win
  CHECK(last.at("report").at("settings").at("camera_position").at(2) == -900.0);

  const std::string page = read_text(folder.path() / "out/index.html");
  CHECK(contains(page, "<title>Two &lt;boxes&gt;</title>"));
  CHECK(contains(page, "cpu against cpu-exact"));
  CHECK(contains(page, "src=\"data:image/png;base64,iVBORw0KGgo"));
  // It needs no other file.
  CHECK_FALSE(contains(page, "http"));
  CHECK_FALSE(contains(page, "<link"));
  CHECK(contains(page, "<a href=\"cells/box-cpu-cpu-tiny/index.html\">"));
  CHECK(contains(read_text(folder.path() / "out/cells/box-cpu-cpu-tiny/index.html"), "<!doctype html>"));
  std::size_t pictures = 0;
  for (std::size_t at = page.find("<img"); at != std::string::npos; at = page.find("<img", at + 1)) ++pictures;
  CHECK(pictures == 2 * 8);

  pugi::xml_document document;
  REQUIRE(document.load_file((folder.path() / "x.xml").c_str()));
  const pugi::xml_node suite = document.child("testsuites").child("testsuite");
  CHECK(std::string(suite.attribute("name").value()) == "Two <boxes>");
  CHECK(suite.attribute("tests").as_int() == 8);
  CHECK(suite.attribute("failures").as_int() == 0);
  CHECK(std::string(suite.first_child().attribute("name").value()) == "cpu against cpu, tiny");
}

TEST_CASE("what has been compared is taken over until anything that it depends on changes") {
  const Sandbox folder;
  const Json suite = {{"scenes", {"box.obj", "other.obj"}}, {"devices", on_the_cpu}, {"settings", {tiny}}};
  const auto taken_over = [&](const Json& wanted, const std::vector<std::string>& more = {}) {
    const Outcome outcome = folder.run(wanted, more);
    CHECK(outcome.exit_code == 0);
    const std::size_t end = outcome.output.find(" were reused");
    REQUIRE(end != std::string::npos);
    return std::stoi(outcome.output.substr(outcome.output.rfind(' ', end - 1) + 1));
  };
  CHECK(taken_over(suite) == 0);
  const std::string page = read_text(folder.path() / "out/index.html");
  CHECK(taken_over(suite) == 2);
  CHECK(read_text(folder.path() / "out/index.html") == page);
  CHECK(taken_over(suite, {"--threads", "1"}) == 2);  // changes no bit
  CHECK(taken_over(suite, {"--fresh"}) == 0);

  // The scene, through a file that it names.
  std::string materials = read_text(folder.path() / "other.mtl");
  materials.replace(materials.find("Kd 0.63"), 7, "Kd 0.64");
  write_text(folder.path() / "other.mtl", materials);
  CHECK(taken_over(suite) == 1);
  CHECK(taken_over(suite) == 2);
  // Its thresholds.
  write_text(folder.path() / "other.thresholds.json",
             R"({"rules": [{"metric": "bit_equal", "limit": 0.5, "reason": "a test"}]})");
  CHECK(taken_over(suite) == 1);
  // Settings.
  Json reseeded = suite;
  reseeded["settings"][0]["seed"] = 1;
  CHECK(taken_over(reseeded) == 0);
  // What is not whole.
  std::filesystem::remove(folder.path() / "out/cells/box-cpu-cpu-tiny.png");
  write_text(folder.path() / "out/cells/other-cpu-cpu-tiny.json", "{");
  CHECK(taken_over(reseeded) == 0);
  // Another driver than that of the run before.
  Json result = read_json(folder.path() / "out/cells/box-cpu-cpu-tiny.json");
  result["key"]["device_b"]["driver"] = "an older one";
  write_text(folder.path() / "out/cells/box-cpu-cpu-tiny.json", result.dump());
  CHECK(taken_over(reseeded) == 1);
}

TEST_CASE("an interrupted suite goes on where it was") {
  const Sandbox folder;
  Json suite = {{"scenes", {"box.obj", {{"file", "other.obj"}, {"settings", {{"spp", 16777216}}}}}},
                {"devices", on_the_cpu},
                {"settings", {tiny}}};
  const Outcome interrupted = folder.run(suite, {}, 5000);
  CHECK(interrupted.exit_code == 130);
  CHECK(interrupted.errors.starts_with("tandem: interrupted"));
  CHECK_FALSE(std::filesystem::exists(folder.path() / "out/cells/other-cpu-cpu-tiny.json"));
  suite["scenes"][1]["settings"]["spp"] = 1;
  const Outcome finished = folder.run(suite);
  CHECK(finished.exit_code == 0);
  CHECK(contains(finished.output, "2 comparisons: 2 agree, 0 are explained, 0 differ, 0 failed; 1 were reused"));
}

TEST_CASE("a comparison that fails and one that differs are results, worst first, and exit code 1") {
  const Sandbox folder;
  const Json suite = {{"scenes", {"box.obj", "sun.obj"}},
                      {"devices", Json::parse(R"([["cpu", "cpu"], ["cpu", "teapot"]])")},
                      {"settings", {tiny, {{"name", "two"}, {"size", "8x8"}, {"spp", 2}}}}};
  const Outcome outcome = folder.run(suite, {"--junit", "x.xml"});
  CHECK(outcome.exit_code == 1);
  const Json json = read_json(folder.path() / "out/suite.json");
  CHECK(json.at("verdict") == "differ");
  CHECK(json.at("agree") == 3);
  CHECK(json.at("differ") == 1);
  CHECK(json.at("failed") == 4);
  for (const Json& cell : json.at("cells")) {
    CAPTURE(cell.at("name"));
    const bool no_device = cell.at("b") == "teapot";
    const bool overflows = cell.at("scene") == "sun" && cell.at("settings") == "two";
    CHECK(cell.at("state") == (no_device ? "failed" : overflows ? "differ" : "agree"));
    CHECK(cell.at("report").is_null() == no_device);
    CHECK(cell.at("reasons").empty() == (!no_device && !overflows));
  }
  const std::string page = read_text(folder.path() / "out/index.html");
  CHECK(contains(page, "there is no such device"));
  CHECK(contains(page, "<span class=\"differ\">1 differ</span>"));

  pugi::xml_document document;
  REQUIRE(document.load_file((folder.path() / "x.xml").c_str()));
  const pugi::xml_node root = document.child("testsuites").child("testsuite");
  CHECK(root.attribute("failures").as_int() == 1);
  CHECK(root.attribute("errors").as_int() == 4);
  const pugi::xpath_node failure = root.select_node("testcase/failure");
  CHECK(contains(failure.node().text().get(), "with a NaN or an infinity"));

  // What failed is tried again, what was compared is not.
  CHECK(contains(folder.run(suite).output, "4 failed; 4 were reused"));

  Json only_good = suite;
  only_good["devices"] = on_the_cpu;
  CHECK(folder.run(only_good).exit_code == 1);
  const std::string sorted = read_text(folder.path() / "out/index.html");
  CHECK(sorted.find("<th>sun</th>") < sorted.find("<th>box</th>"));
}

TEST_CASE("errors in a suite name the place") {
  const Sandbox folder;
  const auto with = [](const Json& settings) {
    Json named = settings;
    named["name"] = "x";
    return Json{{"scenes", {"box.obj"}}, {"devices", on_the_cpu}, {"settings", Json::array({named})}};
  };
  CHECK(folder.error(with({{"spp", 0}})) ==
        "settings[0].spp cannot be used: '0' is not a whole number from 1 to 16777216\n");
  CHECK(folder.error(with({{"sampler", "dice"}})).find("settings[0].sampler cannot be used: 'dice' is not one of") ==
        0);
  CHECK(folder.error(with({{"size", 8}})).find("settings[0].size cannot be used: '8' is not a size") == 0);
  for (const char* unknown : {"colour", "threads", "help", "min-bit-equal", "a", "out"}) {
    CAPTURE(unknown);
    CHECK(folder.error(with({{unknown, "1"}})) ==
          "settings[0]." + std::string(unknown) + " is not an option of 'tandem diff' that a suite can set\n");
  }
  CHECK(folder.error(with({{"spp", nullptr}})) ==
        "settings[0].spp must be a text, a number, a list of numbers, true or false\n");
  CHECK(folder.error(with({{"allow_missing_mtl", 1}})) == "settings[0].allow_missing_mtl must be true or false\n");
  CHECK(folder.error({{"scenes", {"teapot.obj"}}}) == "scenes[0] names 'teapot.obj', which does not exist\n");
  CHECK(
      folder.error({{"scenes", {{{"file", "box.obj"}, {"settings", {{"spp", -1}}}}}}}).find("scenes[0].settings.spp") ==
      0);
  CHECK(folder.error({{"scenes", {"box.obj", "box.obj"}}}) ==
        "two comparisons would be called 'box-cpu-vulkan-default'\n");
  CHECK(folder.error({{"scenes", Json::array()}}) == "scenes must not be empty\n");
  CHECK(folder.error({{"scenes", {"box.obj"}}, {"devices", {{"cpu"}}}}) ==
        "devices[0] must name at least two devices\n");
  CHECK(folder.error({{"scenes", {"box.obj"}}, {"settings", {{{"spp", 1}}}}}) == "settings[0] must have a name\n");
}

TEST_CASE("the suite that ships has every scene of the gallery, and the schema takes it") {
  const JsonSchema schema(read_json(TANDEM_SOURCE_DIRECTORY "/docs/schema/suite.schema.json"));
  const Json suite = read_json(scenes + "suite.json");
  CHECK(schema.accepts(suite));
  std::set<std::string> files;
  for (const Json& scene : suite.at("scenes")) files.insert(scene.get<std::string>());
  for (const Json& scene : read_json(scenes + "gallery.json").at("scenes")) {
    CAPTURE(scene.at("file"));
    CHECK(files.count(scene.at("file").get<std::string>()) == 1);
  }
  Json spoilt = suite;
  spoilt["settings"][0].erase("name");
  CHECK_FALSE(schema.accepts(spoilt));
  spoilt = suite;
  spoilt["devices"][0] = {"cpu"};
  CHECK_FALSE(schema.accepts(spoilt));
}

}  // namespace
}  // namespace tandem::test
