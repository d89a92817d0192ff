#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "pathtracer/image/image_io.hpp"
#include "tests/support/device_test.hpp"
#include "tests/support/process.hpp"
#include "tests/support/scratch_folder.hpp"

namespace tandem::test {
namespace {

const std::string box = TANDEM_SOURCE_DIRECTORY "/scenes/cornell_box.obj";

TEST_CASE("the path tracer gives the same bits in lanes as one invocation after the other") {
  // Packets and rays may choose different triangles where two are equally far, of which this view has none.
  const Outcome outcome = run_tandem("diff " + box + " --device cpu-scalar,cpu-wide --size 24x24 --spp 4");
  CHECK(outcome.exit_code == 0);
  CHECK(outcome.output.find("bit-equal         100.00000 %  576 pixels") != std::string::npos);
}

TEST_CASE("devices lists every device under test, for people and for programs") {
  const Outcome text = run_tandem("devices");
  CHECK(text.exit_code == 0);
  const Outcome json = run_tandem("devices --json");
  CHECK(json.exit_code == 0);
  const nlohmann::json devices = nlohmann::json::parse(json.output);
  REQUIRE(devices.is_array());
  CHECK(devices.at(0).at("name") == "cpu");
  for (const std::string& name : device_names()) {
    CAPTURE(name);
    bool listed = false;
    for (const nlohmann::json& entry : devices) {
      // "vulkan" stands for the first of its backend.
      if (entry.at("name") != name && entry.at("backend") != name) continue;
      listed = true;
      CHECK(entry.at("capabilities").at("ray_query") == true);
      CHECK(text.output.find(entry.at("name").get<std::string>()) != std::string::npos);
      CHECK(text.output.find(entry.at("driver").get<std::string>()) != std::string::npos);
    }
    CHECK(listed);
  }
}

TANDEM_DEVICE_TEST("render writes the picture that was asked for, with its settings") {
  const ScratchFolder folder;
  for (const std::string file : {"x.exr", "x.png"}) {
    const Outcome outcome = run_tandem(
        words("render {} --device {} --size 24x16 --spp 4 --depth 4 --seed 7 -o {}", {box, device_name, file}),
        {.folder = folder.path()});
    CHECK(outcome.errors == "");
    REQUIRE(outcome.exit_code == 0);
    CHECK(outcome.output.find(file) == 0);
    pathtracer::ImageMetadata metadata;
    const pathtracer::Image image = pathtracer::read_image(folder.path() / file, &metadata);
    CHECK(image.width == 24);
    CHECK(image.height == 16);
    double sum = 0.0;
    for (const glm::vec3& pixel : image.pixels) sum += pixel.x;
    CHECK(sum > 0.0);
    CHECK(metadata["samples"] == "4");
    CHECK(metadata["seed"] == "7");
  }
  CHECK(folder.names() == std::vector<std::string>{"x.exr", "x.png"});
}

TEST_CASE("the camera and background options reach the picture") {
  // From a metre in front of the box's opening, away from it: nothing but background.
  const ScratchFolder folder;
  const Outcome outcome = run_tandem(words("render {} --size 8x8 --spp 1 --background 0.25,0.5,0.75 --camera-position "
                                           "278,273,-1000 --camera-target 278,273,-2000 --fov 20 -o x.exr",
                                           {box}),
                                     {.folder = folder.path()});
  REQUIRE(outcome.exit_code == 0);
  for (const glm::vec3& pixel : pathtracer::read_image(folder.path() / "x.exr").pixels) {
    CHECK(pixel == glm::vec3(0.25F, 0.5F, 0.75F));
  }
}

TEST_CASE("the camera may look straight down") {
  const ScratchFolder folder;
  const Outcome outcome = run_tandem(
      words("render {} --size 8x8 --spp 1 --camera-position 278,400,280 --camera-target 278,0,280 -o x.exr", {box}),
      {.folder = folder.path()});
  CHECK(outcome.errors == "");
  CHECK(outcome.exit_code == 0);
}

TEST_CASE("a missing MTL file is an error, unless it is allowed") {
  const ScratchFolder folder;
  std::ofstream(folder.path() / "grey.obj") << "mtllib absent.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl paint\nf 1 2 3\n";
  const std::string line = "render grey.obj --size 8x8 --spp 1 -o grey.png";
  const Outcome refused = run_tandem(line, {.folder = folder.path()});
  CHECK(refused.exit_code == 2);
  CHECK(refused.errors.find("absent.mtl") != std::string::npos);
  CHECK_FALSE(std::filesystem::exists(folder.path() / "grey.png"));

  const Outcome allowed = run_tandem(line + " --allow-missing-mtl", {.folder = folder.path()});
  CHECK(allowed.exit_code == 0);
  CHECK(allowed.errors.find("absent.mtl") != std::string::npos);
  CHECK(std::filesystem::exists(folder.path() / "grey.png"));
}

TEST_CASE("diff of both forms of tracing on a device agrees in every bit") {
  const ScratchFolder folder;
  const Outcome outcome = run_tandem(words("diff {} --a cpu --b cpu --trace query --trace-b pipeline --size 32x24 "
                                           "--spp 2 --json x.json --min-bit-equal 1",
                                           {box}),
                                     {.folder = folder.path()});
  CHECK(outcome.errors == "");
  REQUIRE(outcome.exit_code == 0);
  const nlohmann::json json = nlohmann::json::parse(read_text(folder.path() / "x.json"));
  CHECK(json.at("trace_a") == "query");
  CHECK(json.at("trace_b") == "pipeline");
  CHECK(json.at("rays_a") == json.at("rays_b"));
}

TEST_CASE("diff of a device with itself agrees in every bit, and writes all that it promises") {
  const ScratchFolder folder;
  const Outcome outcome = run_tandem(words("diff {} --a cpu --b cpu --size 32x24 --spp 2 --json deep/diff.json --out "
                                           "deep --min-bit-equal 1 --metrics all",
                                           {box}),
                                     {.folder = folder.path()});
  CHECK(outcome.errors == "");
  REQUIRE(outcome.exit_code == 0);
  CHECK(outcome.output.find("verdict           agree\n") != std::string::npos);

  const nlohmann::json json = nlohmann::json::parse(read_text(folder.path() / "deep/diff.json"));
  CHECK(json.at("pixels") == 32 * 24);
  CHECK(json.at("bit_equal") == 1.0);
  CHECK(json.at("within_1e5") == 1.0);
  CHECK(json.at("within_1e3") == 1.0);
  CHECK(json.at("max_abs") == 0.0);
  CHECK(json.at("mean_a").get<double>() > 0.0);
  CHECK(json.at("mean_b") == json.at("mean_a"));
  CHECK(json.at("rmse") == 0.0);
  CHECK(json.at("psnr").is_null());
  CHECK(json.at("verdict") == "agree");
  CHECK(json.at("reasons").empty());
  CHECK(json.at("metrics").at("ulp").at("values") == 3 * 32 * 24);
  CHECK(json.at("metrics").at("ulp").at("bins").size() == 1);
  CHECK(json.at("metrics").at("ssim") == 1.0);
  CHECK(json.at("metrics").at("flip").at("max") == 0.0);
  CHECK(json.at("metrics").at("hdr_flip").at("max") == 0.0);
  CHECK(json.at("metrics").at("worst_region").is_null());
  CHECK(json.at("rays_a") == json.at("rays_b"));
  // Every camera path is a ray, and no path has more than 8 segments and as many shadow rays.
  CHECK(json.at("rays_a").get<int>() >= 32 * 24 * 2);
  CHECK(json.at("rays_a").get<int>() <= 32 * 24 * 2 * 16);
  for (const char* side : {"a", "b"}) {
    const double milliseconds = json.at(std::string("ms_") + side);
    const double mrays = json.at(std::string("mrays_") + side);
    CHECK(milliseconds > 0.0);
    CHECK(mrays == doctest::Approx(json.at("rays_a").get<double>() / milliseconds / 1000.0));
  }
  CHECK(json.at("device_a").at("name") == "cpu");
  CHECK(json.at("settings").at("spp") == 2);

  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder.path() / "deep")) {
    names.push_back(entry.path().filename().string());
  }
  std::sort(names.begin(), names.end());
  CHECK(names == std::vector<std::string>{"a.exr", "a.png", "b.exr", "b.png", "diff.json", "difference.exr",
                                          "difference.png", "flip.png"});
  for (const glm::vec3& pixel : pathtracer::read_image(folder.path() / "deep/difference.exr").pixels) {
    CHECK(pixel == glm::vec3(0.0F));
  }
}

TEST_CASE("diff of the devices under test agrees") {
  const std::vector<std::string>& devices = device_names();
  const Outcome outcome = run_tandem(
      words("diff {} --a {} --b {} --size 48x48 --spp 4 --validation", {box, devices.front(), devices.back()}));
  CHECK(outcome.errors == "");
  CAPTURE(outcome.output);
  CHECK(outcome.exit_code == 0);
}

TEST_CASE("images that do not agree are exit code 1 with the reason") {
  // Radiance so large that the sum of two samples is infinite wherever the camera sees the emitter.
  const ScratchFolder folder;
  write_text(folder.path() / "sun.mtl", "newmtl sun\nKe 3e38 3e38 3e38\n");
  write_text(folder.path() / "sun.obj", "mtllib sun.mtl\nusemtl sun\nv -9 -9 0\nv 9 -9 0\nv 0 9 0\nf 1 2 3\n");
  const Outcome outcome =
      run_tandem("diff sun.obj --a cpu --b cpu --size 8x8 --spp 4 --json diff.json", {.folder = folder.path()});
  CAPTURE(outcome.output);
  CHECK(outcome.exit_code == 1);
  CHECK(outcome.output.find("verdict           differ\n") != std::string::npos);
  CHECK(outcome.output.find("with a NaN or an infinity") != std::string::npos);
  const nlohmann::json json = nlohmann::json::parse(read_text(folder.path() / "diff.json"));
  CHECK(json.at("verdict") == "differ");
  CHECK(json.at("non_finite_a").get<int>() > 0);
  CHECK(json.at("reasons").size() >= 2);
}

TEST_CASE("generate writes a scene of about the size asked for, which renders") {
  const ScratchFolder folder;
  const Outcome outcome = run_tandem("generate --triangles 5000 -o many.obj", {.folder = folder.path()});
  CHECK(outcome.exit_code == 0);
  CHECK(folder.names() == std::vector<std::string>{"many.mtl", "many.obj"});
  const int triangles = std::stoi(outcome.output.substr(outcome.output.find(": ") + 2));
  CHECK(triangles >= 4900);  // within 2 %, as generate_spheres promises
  CHECK(triangles <= 5100);
  const Outcome rendered = run_tandem("render many.obj --size 16x16 --spp 1 -o x.png", {.folder = folder.path()});
  CHECK(rendered.errors == "");
  CHECK(rendered.exit_code == 0);
}

TEST_CASE("bench measures every device in every round") {
  const ScratchFolder folder;
  std::string line = "bench --device cpu {} --size 16x16 --spp 1 --repeat 3 --json bench.json";
  for (const std::string& name : device_names()) line += " --device " + name;
  const Outcome outcome = run_tandem(words(line, {box}), {.folder = folder.path()});
  CHECK(outcome.errors == "");
  REQUIRE(outcome.exit_code == 0);
  const nlohmann::json json = nlohmann::json::parse(read_text(folder.path() / "bench.json"));
  REQUIRE(json.at("runs").size() == 1);
  const nlohmann::json& devices = json.at("runs").at(0).at("devices");
  REQUIRE(devices.size() == 1 + device_names().size());
  CHECK(devices.at(0).at("speed_ratio").at("median") == 1.0);
  for (const nlohmann::json& device : devices) {
    CHECK(device.at("ms_rounds").size() == 3);
    CHECK(device.at("ms").at("min").get<double>() > 0.0);
    CHECK(device.at("ms").at("min") <= device.at("ms").at("median"));
    CHECK(device.at("ms").at("median") <= device.at("ms").at("max"));
    // Counted on each device; a path that rounding sends elsewhere may be a few rays longer or shorter.
    CHECK(device.at("rays").get<double>() == doctest::Approx(devices.at(0).at("rays").get<double>()).epsilon(0.01));
  }
}

TANDEM_DEVICE_TEST("an interrupt ends a long rendering soon and leaves nothing") {
  const ScratchFolder folder;
  const Outcome outcome =
      run_tandem(words("diff {} --a {} --b {} --spp 16777216 --json x.json --out new", {box, device_name, device_name}),
                 {.folder = folder.path(), .interrupt_after_ms = 3000});
  CHECK(outcome.exit_code == 130);
  CHECK(outcome.output.empty());
  CHECK(outcome.errors.starts_with("tandem: interrupted"));
  CHECK(folder.names().empty());
}

TEST_CASE("an interrupt ends the generation of a large scene and leaves nothing") {
  const ScratchFolder folder;
  const Outcome outcome =
      run_tandem("generate --triangles 100000000 -o x.obj", {.folder = folder.path(), .interrupt_after_ms = 3000});
  CHECK(outcome.exit_code == 130);
  CHECK(outcome.errors.starts_with("tandem: interrupted"));
  CHECK(folder.names().empty());
}

TEST_CASE("results that no disk takes are still printed, and no half file stays") {
  const ScratchFolder folder;
  // Enough for no image of noise of 64x64 pixels, nor for the JSON.
  const Outcome outcome =
      run_tandem(words("diff {} --a cpu --b cpu --size 64x64 --spp 1 --json x.json --out new", {box}),
                 {.folder = folder.path(), .file_size_limit = 256});
  CHECK(outcome.exit_code == 2);
  CHECK(outcome.output.find("verdict           agree\n") != std::string::npos);
  CHECK(outcome.errors.find("cannot write 'x.json': File too large; saving it elsewhere failed too") !=
        std::string::npos);
  CHECK(folder.names().empty());
}

}  // namespace
}  // namespace tandem::test
