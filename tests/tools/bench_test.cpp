// `tandem bench` of scenes, and its parts.

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>
#include <pugixml.hpp>

#include "base/error.hpp"
#include "tests/pathtracer/load/description/json_schema.hpp"
#include "tests/support/device_test.hpp"
#include "tests/support/process.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tools/bench/slower.hpp"
#include "tools/plot/plot.hpp"
#include "tools/plot/ticks.hpp"
#include "tools/report/interval.hpp"

namespace tandem::test {
namespace {

using Json = nlohmann::ordered_json;
using namespace tandem::tools;

const std::string box = TANDEM_SOURCE_DIRECTORY "/scenes/cornell_box.obj";

TEST_CASE("the interval of a median is that of its order statistics") {
  // Binomial sums by hand: of 5 values all lie on one side of the median with probability 2/32, of 8 with 2/256, and
  // at most one lies on a side with 2 (1 + 8)/256.
  const MedianInterval five = median_interval({3, 1, 2, 5, 4});
  CHECK(five.median == 3);
  CHECK(five.least == 1);
  CHECK(five.most == 5);
  CHECK(five.confidence == doctest::Approx(1 - 2.0 / 32));
  const MedianInterval eight = median_interval({8, 7, 6, 5, 4, 3, 2, 1});
  CHECK(eight.least == 1);
  CHECK(eight.confidence == doctest::Approx(1 - 2.0 / 256));
  const MedianInterval looser = median_interval({8, 7, 6, 5, 4, 3, 2, 1}, 0.9);
  CHECK(looser.least == 2);
  CHECK(looser.most == 7);
  CHECK(looser.confidence == doctest::Approx(1 - 18.0 / 256));
  CHECK(median_interval({7}).confidence == doctest::Approx(0));
}

TEST_CASE("the interval holds the median of a skewed distribution as often as it says") {
  std::mt19937 random(5);
  std::exponential_distribution<double> times(1);
  const double median = std::log(2.0);
  int held = 0;
  constexpr int trials = 4000;
  double confidence = 0;
  for (int trial = 0; trial < trials; ++trial) {
    std::vector<double> values(11);
    for (double& value : values) value = times(random);
    const MedianInterval interval = median_interval(values);
    confidence = interval.confidence;
    held += interval.least <= median && median <= interval.most ? 1 : 0;
  }
  CHECK(confidence >= 0.95);
  // Four standard deviations of a binomial: 1 of 16,000 right programs fails, and the seed is fixed.
  CHECK(std::fabs(held / double{trials} - confidence) < 4 * std::sqrt(confidence * (1 - confidence) / trials));
}

TEST_CASE("a ratio is taken round by round") {
  // The machine is three times as slow in the second round, for both.
  const std::vector<double> reference = {10, 30, 10}, values = {5, 15, 5};
  const MedianInterval ratio = ratio_interval(reference, values);
  CHECK(ratio.least == 2);
  CHECK(ratio.most == 2);
  CHECK(relative_noise({10, 10, 10, 10}) == 0);
  CHECK(relative_noise({8, 9, 10, 11, 12}) == doctest::Approx(0.2));
}

TEST_CASE("axes end at round numbers") {
  const Ticks linear = linear_ticks(0, 9.3);
  CHECK(linear.least == 0);
  CHECK(linear.most == 10);
  CHECK(linear.values == std::vector<double>{0, 2, 4, 6, 8, 10});
  CHECK(linear_ticks(3, 3).most > 3);
  CHECK(linear_ticks(0, 0).most > 0);
  const Ticks decades = logarithmic_ticks(0.02, 3000);
  CHECK(decades.least == doctest::Approx(0.01));
  CHECK(decades.most == doctest::Approx(10000));
  CHECK(decades.values.size() == 7);
  CHECK(logarithmic_ticks(2, 3).values.size() == 4);  // 1, 2, 5, 10
  CHECK(tick_text(0.1 + 0.2) == "0.3");
}

pugi::xml_document parsed(const Plot& plot) {
  pugi::xml_document document;
  const std::string text = svg(plot);
  const auto result = document.load_string(text.c_str());
  CHECK_MESSAGE(result.status == pugi::status_ok, result.description());
  return document;
}

TEST_CASE("a plot shows every finite point, and its labels as they are") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Plot plot{.title = "a < b & \"c\"",
            .x = {.label = "x", .is_logarithmic = true, .names = {}},
            .y = {.label = "y"},
            .series = {{.label = "one", .points = {{1, 2}, {10, 3}, {0, 4}, {100, nan}, {1000, 5}}}}};
  const pugi::xml_document document = parsed(plot);
  CHECK(std::string(document.select_node("/svg/text[1]").node().text().get()) == plot.title);
  // Three marks, and that of the legend; 0 has no place on a logarithmic axis, and NaN on none.
  CHECK(document.select_nodes("/svg/circle").size() == 4);
  // Behind the gap the line begins again.
  const std::string line = document.select_node("/svg/path[@class='line']").node().attribute("d").value();
  CHECK(std::ranges::count(line, 'M') == 2);
  CHECK(std::ranges::count(line, 'L') == 1);
}

TEST_CASE("a plot without a point says so") {
  CHECK(svg(Plot{}).find("there is nothing to show") != std::string::npos);
  CHECK(parsed(Plot{.title = "", .x = {}, .y = {}, .series = {{.label = "none", .points = {}}}}).first_child());
}

Json stored(std::vector<double> times, const std::string& hash = "a") {
  return {{"runs",
           {{{"varied", Json::object()},
             {"settings", {{"scene", "x.obj"}, {"scene_hash", hash}}},
             {"devices", {{{"name", "cpu"}, {"trace", "query"}, {"threads", 0}, {"ms_rounds", std::move(times)}}}}}}}};
}

TEST_CASE("slower is what is slower than before by more than it scatters") {
  const Json before = stored({10, 11, 10, 9, 10, 10});
  CHECK(speed_changes(before, stored({20, 21, 20, 19, 20, 20})).slower.size() == 1);
  CHECK(speed_changes(before, stored({5, 5, 5, 5, 5})).faster.size() == 1);
  CHECK(speed_changes(before, stored({20, 9, 20, 19, 20, 20})).unchanged == 1);  // it scatters as much
  const Json steady = stored({10, 10, 10, 10, 10});
  CHECK(speed_changes(steady, stored({10.2, 10.2, 10.2, 10.2, 10.2})).unchanged == 1);  // 2 % are within tolerance
  CHECK_THROWS_AS(speed_changes(steady, stored({20, 20, 20, 20})), Error);              // too few
  CHECK_THROWS_AS(speed_changes(steady, stored({20, 20, 20, 20, 20}, "b")), Error);     // nothing in common
  Json both = steady;
  both["runs"].push_back(stored({1, 1, 1, 1, 1}, "b")["runs"][0]);
  CHECK(speed_changes(both, steady).gone.size() == 1);
  CHECK(speed_changes(steady, both).unmatched.size() == 1);
  CHECK_THROWS_AS(speed_changes(Json{{"runs", 1}}, before), Error);
  CHECK_THROWS_AS(speed_changes(Json::array(), before), Error);
}

TEST_CASE("bench measures all values of options, and its JSON is as the schema says") {
  const ScratchFolder folder;
  // A first picture costs each device two starts more, so it is asked of one.
  const bool on_cpu = device_names() == std::vector<std::string>{"cpu"};
  std::vector<std::string> words = {"bench",    box, "--size", "16x16",  "--vary", "spp=1,2", "--vary", "threads=1,2",
                                    "--repeat", "3", "--json", "b.json", "--csv",  "b.csv",   "--html", "b.html"};
  if (on_cpu) words.emplace_back("--first-picture");
  for (const std::string& name : device_names()) words.insert(words.end(), {"--device", name});
  const Outcome outcome = run_tandem(words, {.folder = folder.path()});
  CHECK(outcome.errors == "");
  REQUIRE(outcome.exit_code == 0);
  const Json report = Json::parse(read_text(folder.path() / "b.json"));
  const JsonSchema schema(nlohmann::json::parse(read_text(TANDEM_SOURCE_DIRECTORY "/docs/schema/bench.schema.json")));
  CHECK(schema.accepts(report));
  for (const auto& [member, value] : report.items())
    CHECK_MESSAGE(schema.root().at("properties").contains(member), member);
  REQUIRE(report.at("runs").size() == 4);
  const Json& root_series = schema.root().at("$defs").at("series").at("properties");
  std::vector<std::string> varied;
  for (const Json& run : report.at("runs")) {
    varied.push_back(run.at("varied").at("spp").get<std::string>() + run.at("varied").at("threads").get<std::string>());
    CHECK(run.at("settings").at("spp") == std::stoi(run.at("varied").at("spp").get<std::string>()));
    REQUIRE(run.at("devices").size() == device_names().size());
    for (const Json& device : run.at("devices")) {
      for (const auto& [member, value] : device.items()) CHECK_MESSAGE(root_series.contains(member), member);
      CHECK(device.at("ms_rounds").size() == 3);
      CHECK(device.at("wall_ms_rounds").size() == 3);
      CHECK(device.at("structure_bytes") > 0);
      CHECK(device.contains("first_picture_ms") == on_cpu);
      CHECK(device.at("threads") == std::stoi(run.at("varied").at("threads").get<std::string>()));
    }
    // All 256 or 512 paths are recorded: their rays are those that the device has counted.
    if (run.contains("recorded_paths")) {
      const Json& paths = run.at("recorded_paths");
      CHECK(paths.at("complete") == true);
      CHECK(paths.at("camera_rays") == paths.at("paths"));
      CHECK(paths.at("camera_rays").get<int>() + paths.at("bounced_rays").get<int>() +
                paths.at("shadow_rays").get<int>() ==
            run.at("devices").at(0).at("rays"));
    }
  }
  CHECK(varied == std::vector<std::string>{"11", "12", "21", "22"});

  const std::string csv = read_text(folder.path() / "b.csv");
  CHECK(std::ranges::count(csv, '\n') == 1 + static_cast<std::ptrdiff_t>(4 * 3 * device_names().size()));
  const std::string page = read_text(folder.path() / "b.html");
  CHECK(page.find("frame time against spp") != std::string::npos);
  CHECK(page.find("frame time against threads") != std::string::npos);
}

TEST_CASE("a stored run is the baseline of the next, and a much slower one fails") {
  const ScratchFolder folder;
  const std::vector<std::string> words = {"bench", box, "--size", "16x16", "--spp", "1", "--device", "cpu"};
  const auto bench = [&](std::vector<std::string> more) {
    more.insert(more.begin(), words.begin(), words.end());
    return run_tandem(more, {.folder = folder.path()});
  };
  REQUIRE(bench({"--json", "b.json"}).exit_code == 0);
  Json report = Json::parse(read_text(folder.path() / "b.json"));
  // As if it had taken no time then: any machine is slower now.
  for (Json& time : report.at("runs").at(0).at("devices").at(0).at("ms_rounds")) time = 1e-6;
  folder.write("fast.json", report.dump());
  const Outcome slower = bench({"--baseline", "fast.json"});
  CHECK(slower.exit_code == 1);
  CHECK(slower.output.find("1 slower, 0 faster, 0 unchanged, 0 new, 0 gone") != std::string::npos);
  for (Json& time : report.at("runs").at(0).at("devices").at(0).at("ms_rounds")) time = 1e9;
  folder.write("slow.json", report.dump());
  CHECK(bench({"--baseline", "slow.json"}).exit_code == 0);
  folder.write("no.json", "{}");
  const Outcome bad = bench({"--baseline", "no.json"});
  CHECK(bad.exit_code == 2);
  CHECK(bad.errors.find("no.json: it is not what 'tandem bench --json' writes") != std::string::npos);
}

TEST_CASE("an option that cannot vary is refused by its name") {
  const auto errors = [](const std::string& variation) {
    const Outcome outcome = run_tandem({"bench", box, "--device", "cpu", "--vary", variation}, {});
    CHECK(outcome.exit_code == 2);
    return outcome.errors;
  };
  CHECK(errors("foo=1") == "tandem: --vary: '--foo' is not an option of rendering that takes a value\n");
  CHECK(errors("validation=1") == "tandem: --vary: '--validation' is not an option of rendering that takes a value\n");
  CHECK(errors("spp") == "tandem: --vary: 'spp' is not of the form NAME=VALUE,VALUE,...\n");
  CHECK(errors("spp=1,x") == "tandem: --vary: --spp: 'x' is not a whole number from 1 to 16777216\n");
  CHECK(errors("spp=1,1") == "tandem: --vary: 'spp=1,1' has the value '1' twice\n");
  CHECK(errors("background=[0,0,0") == "tandem: --vary: 'background=[0,0,0' has a bracket without its other\n");
}

}  // namespace
}  // namespace tandem::test
