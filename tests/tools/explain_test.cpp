#include <doctest/doctest.h>

#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "pathtracer/image/image_io.hpp"
#include "tests/support/device_test.hpp"
#include "tests/support/process.hpp"
#include "tests/support/scratch_folder.hpp"

namespace tandem::test {
namespace {

const std::string box = TANDEM_SOURCE_DIRECTORY "/scenes/cornell_box.obj";

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

/// A red and a green quadrilateral in one tilted plane, cut into triangles along different diagonals: which is nearer
/// is decided by rounding alone.
void write_coincident_quadrilaterals(const std::filesystem::path& folder) {
  write_text(folder / "pair.mtl", "newmtl red\nKd 0.8 0.1 0.1\nnewmtl green\nKd 0.1 0.8 0.1\n");
  write_text(folder / "pair.obj",
             "mtllib pair.mtl\n"
             "v -1 -1 0.3\nv 1 -1 -0.4\nv 1 1 -0.1\nv -1 1 0.6\n"
             "usemtl red\nf 1 2 3\nf 1 3 4\n"
             "usemtl green\nf 2 3 4\nf 2 4 1\n");
}

const std::string view = " --size 32x32 --spp 2 --depth 2 --camera-position 0.2,0.1,3 --background 1,1,1";

TANDEM_DEVICE_TEST("explain says of paths that are the same that they are, and asks their rays in other ways") {
  const ScratchFolder folder;
  const Outcome outcome = run_tandem(words("explain {} --pixel 7,5 --a {} --b {} --size 16x16 --spp 3 --json path.json",
                                           {box, device_name, device_name}),
                                     {.folder = folder.path()});
  CHECK(outcome.errors == "");
  REQUIRE(outcome.exit_code == 0);
  CHECK(contains(outcome.output, "7,5: all 3 samples are the same on both devices"));
  CHECK_FALSE(contains(outcome.output, "first difference"));
  CHECK_FALSE(contains(outcome.output, "\033"));  // colours are for terminals
  const nlohmann::json json = nlohmann::json::parse(read_text(folder.path() / "path.json"));
  CHECK(json.at("pixel") == nlohmann::json({7, 5}));
  CHECK(json.at("sample") == 0);
  CHECK(json.at("samples").size() == 3);
  CHECK(json.at("first_difference").is_null());
  CHECK(json.at("mismatches") == 0);
  CHECK(json.at("probes").at("rays").get<int>() > 0);
  CHECK(json.at("events").at(0).at("event") == "camera");
  CHECK(json.at("events").at(0).at("fields").at("pixel x") == nlohmann::json({{"a", 7}}));
  for (const nlohmann::json& event : json.at("events")) {
    CHECK_FALSE(event.contains("only"));
    for (const nlohmann::json& field : event.at("fields")) CHECK_FALSE(field.contains("b"));
  }
}

TEST_CASE("explain names a tie, the triangles and their materials, where two surfaces lie in one place") {
  const ScratchFolder folder;
  write_coincident_quadrilaterals(folder.path());
  const std::string options = " --a cpu --b cpu-exact" + view;
  const Outcome diff = run_tandem("diff pair.obj --out diff" + options, {.folder = folder.path()});
  REQUIRE(diff.exit_code < 2);
  const pathtracer::Image a = pathtracer::read_image(folder.path() / "diff/a.exr");
  const pathtracer::Image b = pathtracer::read_image(folder.path() / "diff/b.exr");
  std::optional<std::string> pixel;
  for (std::uint32_t y = 0; y < a.height && !pixel; ++y)
    for (std::uint32_t x = 0; x < a.width && !pixel; ++x)
      if (a.at(x, y) != b.at(x, y)) pixel = fmt::format("{},{}", x, y);
  REQUIRE(pixel);
  const Outcome outcome =
      run_tandem("explain pair.obj --json path.json --pixel " + *pixel + options, {.folder = folder.path()});
  CHECK(outcome.errors == "");
  CHECK(outcome.exit_code == 0);  // a tie is no mismatch
  CHECK(contains(outcome.output, "segment 0, ray, answer"));
  CHECK(contains(outcome.output, "coincident geometry"));
  CHECK(contains(outcome.output, "(red)"));
  CHECK(contains(outcome.output, "(green)"));
  const nlohmann::json json = nlohmann::json::parse(read_text(folder.path() / "path.json"));
  const nlohmann::json& first = json.at("first_difference");
  CHECK(first.at("segment") == 0);
  CHECK(first.at("event") == "ray");
  CHECK(first.at("field") == "answer");
  CHECK(first.at("a") != first.at("b"));
  CHECK_FALSE(first.contains("ulp"));
  const nlohmann::json& event = json.at("events").at(first.at("index").get<std::size_t>());
  CHECK(event.at("fields").at("answer").at("a") == first.at("a"));
  CHECK(event.at("fields").at("answer").at("name_a") == first.at("name_a"));
  bool judged = false;
  for (const nlohmann::json& sample : json.at("samples")) {
    if (sample.at("sample") != json.at("sample")) continue;
    judged = true;
    CHECK(sample.at("differs") == true);
    CHECK(sample.at("class") == "coincident geometry");
    CHECK(sample.at("divergences").at(0).at("sentence").get<std::string>().size() > 20);
  }
  CHECK(judged);
  CHECK_FALSE(json.contains("probes"));

  // One sample alone, whole.
  const std::string sample = std::to_string(json.at("sample").get<int>());
  const Outcome whole = run_tandem("explain pair.obj --all-events --sample " + sample + " --pixel " + *pixel + options,
                                   {.folder = folder.path()});
  CHECK(whole.exit_code == 0);
  CHECK(contains(whole.output, "coincident geometry"));
  CHECK(contains(whole.output, "pixel x"));
}

TEST_CASE("explain refuses what is not there in one sentence") {
  struct Bad {
    std::string arguments;
    std::string sentence;
  };
  const std::vector<Bad> all = {
      {"", "--pixel is required"},
      {"--pixel 3", "--pixel: '3' is not a pixel such as 200,310"},
      {"--pixel 3,-1", "--pixel: '3,-1' is not a pixel"},
      {"--pixel 1,2,3", "--pixel: '1,2,3' is not a pixel"},
      {"--pixel 16,0 --size 16x16", "--pixel 16,0 is outside the image of 16x16 pixels"},
      {"--pixel 0,600", "--pixel 0,600 is outside the image of 512x512 pixels"},
      {"--pixel 0,0 --spp 4 --sample 4", "--sample 4 does not exist: the pixel has samples 0 to 3"},
      {"--pixel 0,0 --arbiter nobody", "nobody"},
      {"--pixel 0,0 --json missing/path.json", "missing"}};
  for (const Bad& bad : all) {
    CAPTURE(bad.sentence);
    const ScratchFolder folder;
    const Outcome outcome =
        run_tandem(words("explain {} --a cpu --b cpu " + bad.arguments, {box}), {.folder = folder.path()});
    CHECK(outcome.exit_code == 2);
    CHECK(outcome.output == "");
    CHECK(contains(outcome.errors, bad.sentence));
    CHECK(outcome.errors.find('\n') == outcome.errors.size() - 1);
    CHECK(folder.names().empty());
  }
}

}  // namespace
}  // namespace tandem::test
