#include "pathtracer/render/renderer.hpp"

#include <array>
#include <cmath>
#include <filesystem>
#include <memory>

#include <doctest/doctest.h>

#include "base/error.hpp"
#include "devices/devices.hpp"
#include "pathtracer/load/obj/obj_loader.hpp"
#include "tests/pathtracer/render/picture.hpp"
#include "tests/support/device_test.hpp"
#include "tests/support/run_summary.hpp"
#include "tests/support/scratch_folder.hpp"

using namespace tandem;
using namespace tandem::pathtracer;
using tandem::test::Estimate;
using tandem::test::estimate;
using tandem::test::rendered;
using tandem::test::ScratchFolder;

namespace {

const std::filesystem::path source_directory = TANDEM_SOURCE_DIRECTORY;

Scene load_text(const std::string& obj, const std::string& mtl) {
  const ScratchFolder folder;
  folder.write("test.mtl", mtl);
  return load_obj(folder.write("test.obj", "mtllib test.mtl\nusemtl a\n" + obj));
}

const std::string room =
    "v -1 -1 -1\nv 1 -1 -1\nv -1 1 -1\nv 1 1 -1\nv -1 -1 1\nv 1 -1 1\nv -1 1 1\nv 1 1 1\n"
    "f 3 7 5 1\nf 6 8 4 2\nf 5 6 2 1\nf 4 8 7 3\nf 2 4 3 1\nf 7 8 6 5\n";

const Camera in_room{.position = {0.1f, 0.2f, 0.3f}, .target = {-1, -0.5f, -1}, .up = {0, 1, 0}, .vertical_fov = 80};

/// Form factor from a point to a rectangle parallel to its surface at distance c, of which one corner is straight above
/// the point and the sides are a and b (Howell, configuration C-13, for instance).
double corner_form_factor(double a, double b, double c) {
  const double x = a / c, y = b / c;
  const double along_x = std::sqrt(1 + x * x), along_y = std::sqrt(1 + y * y);
  constexpr double two_pi = 6.283185307179586;
  return (x / along_x * std::atan(y / along_x) + y / along_y * std::atan(x / along_y)) / two_pi;
}

}  // namespace

TANDEM_DEVICE_TEST("Furnace: in a closed box of albedo 1/2 that emits 1 the radiance is 2 everywhere") {
  const Scene scene = load_text(room, "newmtl a\nKd 0.5 0.5 0.5\nKe 1 1 1\n");
  // Longer paths would add 2^-31.
  const Estimate result =
      estimate(rendered(device_handle, scene, {.width = 40, .height = 40, .max_depth = 32, .camera = in_room}, 256));
  CHECK(result.standard_error < 0.02);  // lights that meet in the edges of the box are noisy
  CHECK(std::abs(result.mean - 2) < 4 * result.standard_error);
}

TANDEM_DEVICE_TEST("Depth bounds the bounces that are seen: 1, 1 + 1/2, 1 + 1/2 + 1/4") {
  const Scene scene = load_text(room, "newmtl a\nKd 0.5 0.5 0.5\nKe 1 1 1\n");
  double expected = 0;
  double bounce = 1;
  for (std::uint32_t depth = 1; depth <= 3; ++depth, bounce /= 2) {
    expected += bounce;
    const Estimate result = estimate(
        rendered(device_handle, scene, {.width = 40, .height = 40, .max_depth = depth, .camera = in_room}, 256));
    CHECK(result.standard_error < 0.02);
    // Depth 1 has no variance: every sample is exactly 1.
    CHECK(std::abs(result.mean - expected) <= 4 * result.standard_error);
  }
}

TANDEM_DEVICE_TEST("Direct light of a small light is that of the analytic form factor") {
  // A light of 0.4 x 0.2 at height 2 over a floor of albedo 0.8.
  const Scene scene = load_text(
      "v -20 0 -20\nv -20 0 20\nv 20 0 20\nv 20 0 -20\nf 1 2 3 4\n"
      "v -0.2 2 -0.1\nv 0.2 2 -0.1\nv 0.2 2 0.1\nv -0.2 2 0.1\nusemtl b\nf 5 6 7 8\n",
      "newmtl a\nKd 0.8 0.8 0.8\nnewmtl b\nKd 0 0 0\nKe 50 50 50\n");
  for (const float x : {0.0f, 0.5f, 2.0f, 6.0f}) {
    double form_factor = 0;
    for (const int i : {0, 1})
      for (const int k : {0, 1}) {
        const double a = (i == 0 ? 0.2 : -0.2) - double{x};
        const double b = k == 0 ? 0.1 : -0.1;
        form_factor += (i == k ? 1 : -1) * corner_form_factor(a, b, 2);
      }
    // The camera sees a thousandth of a unit of the floor, over which the light varies by less than 1e-3 relative and
    // evenly to both sides.
    const Camera camera{.position = {x, 1, 3}, .target = {x, 0, 0}, .up = {0, 1, 0}, .vertical_fov = 0.02f};
    const Estimate result =
        estimate(rendered(device_handle, scene, {.width = 32, .height = 32, .max_depth = 2, .camera = camera}, 64));
    const double expected = 0.8 * 50 * form_factor;
    CAPTURE(x);
    CHECK(result.standard_error < 1e-3 * expected);
    CHECK(std::abs(result.mean - expected) < 4 * result.standard_error + 1e-5 * expected);
  }
}

TANDEM_DEVICE_TEST("16 samples are 16 times one sample, in whatever tiles, to the last bit") {
  const Scene scene = load_obj(source_directory / "scenes" / "cornell_box.obj");
  const RenderSettings settings{.width = 33, .height = 19, .max_depth = 5, .seed = 3};
  Renderer reference(device_handle, scene, settings);
  reference.render(16);
  const Image expected = reference.image();

  Renderer one_by_one(device_handle, scene, settings);
  for (int i = 0; i < 16; ++i) one_by_one.render(1);
  CHECK(one_by_one.image().pixels == expected.pixels);
  CHECK(one_by_one.samples() == 16);
  CHECK(one_by_one.ray_count() == reference.ray_count());

  for (const std::uint32_t maximum_tile : {8u, 17u}) {
    RenderSettings tiled = settings;
    tiled.maximum_tile = maximum_tile;
    CHECK(rendered(device_handle, scene, tiled, 16).pixels == expected.pixels);
  }
  RenderSettings hasty = settings;
  hasty.submission_seconds = 1e-9;  // the smallest tiles there can be
  CHECK(rendered(device_handle, scene, hasty, 16).pixels == expected.pixels);

  RenderSettings other_seed = settings;
  other_seed.seed = 4;
  CHECK(rendered(device_handle, scene, other_seed, 16).pixels != expected.pixels);
}

TANDEM_DEVICE_TEST("Rays are counted exactly") {
  const Scene dark = load_text(room, "newmtl a\nKd 0.5 0.5 0.5\n");
  // Without lights each segment is one ray, and in a closed room none is lost before roulette begins at depth 3.
  for (const std::uint32_t depth : {1u, 2u, 3u}) {
    Renderer renderer(device_handle, dark, {.width = 13, .height = 9, .max_depth = depth, .camera = in_room});
    renderer.render(5);
    CHECK(renderer.ray_count() == 13u * 9u * 5u * depth);
  }
}

TANDEM_DEVICE_TEST("A scene without lights has a white background, unless one is given") {
  const Scene scene = load_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "newmtl a\nKd 0 0 0\n");
  RenderSettings settings{.width = 16, .height = 16};
  Renderer renderer(device_handle, scene, settings);
  CHECK(renderer.scene().warnings().size() == 1);
  renderer.render(2);
  CHECK(renderer.image().at(15, 0) == glm::vec3(1));  // beyond the diagonal of the black triangle
  CHECK(renderer.metadata().at("background") == "1 1 1");
  settings.background = glm::vec3(0, 0.5f, 2);
  renderer.restart(settings);
  CHECK(renderer.scene().warnings().empty());
  renderer.render(2);
  CHECK(renderer.image().at(15, 0) == glm::vec3(0, 0.5f, 2));
}

TANDEM_DEVICE_TEST("Progress rises to 1, and cancelling leaves an empty picture that can be rendered again") {
  const Scene scene = load_obj(source_directory / "scenes" / "cornell_box.obj");
  const RenderSettings settings{.width = 32, .height = 32, .max_depth = 3, .maximum_tile = 16};
  const Image expected = rendered(device_handle, scene, settings, 3);
  Renderer renderer(device_handle, scene, settings);
  int calls = 0;
  CHECK_FALSE(renderer.render(3, [&](double) { return ++calls < 3; }));
  CHECK(calls == 3);
  CHECK(renderer.samples() == 0);
  CHECK(renderer.ray_count() == 0);
  CHECK(renderer.image().pixels == std::vector<glm::vec3>(32 * 32, glm::vec3(0)));

  double last = 0;
  CHECK(renderer.render(3, [&](double fraction) {
    CHECK(fraction > last);
    last = fraction;
    return true;
  }));
  CHECK(last == doctest::Approx(1));
  CHECK(renderer.image().pixels == expected.pixels);
}

TANDEM_DEVICE_TEST("Restarting with another size and depth is a new rendering with the same camera") {
  const Scene scene = load_obj(source_directory / "scenes" / "cornell_box.obj");
  Renderer renderer(device_handle, scene, {.width = 8, .height = 8});
  renderer.render(1);
  const RenderSettings settings{.width = 20, .height = 20, .max_depth = 2};
  renderer.restart(settings);
  CHECK(renderer.samples() == 0);
  renderer.render(2);
  CHECK(renderer.image().pixels == rendered(device_handle, scene, settings, 2).pixels);
}

TANDEM_DEVICE_TEST("Bad settings are one sentence, before anything is rendered") {
  const Scene scene = load_obj(source_directory / "scenes" / "cornell_box.obj");
  const auto refused = [&](const RenderSettings& settings) {
    CHECK_THROWS_AS(Renderer(device_handle, scene, settings), Error);
  };
  refused({.width = 0});
  refused({.height = 0});
  refused({.width = 70000});
  refused({.max_depth = 0});
  refused({.camera = Camera{.position = {1, 1, 1}, .target = {1, 1, 1}}});
  refused({.background = glm::vec3(-1)});
  refused({.background = glm::vec3(NAN)});
}

TANDEM_DEVICE_TEST("Metadata says how a picture came about") {
  const Scene scene = load_obj(source_directory / "scenes" / "cornell_box.obj");
  Renderer renderer(device_handle, scene, {.width = 16, .height = 8, .max_depth = 4, .seed = 9});
  renderer.render(2);
  const ImageMetadata metadata = renderer.metadata();
  CHECK(metadata.at("scene") == "cornell_box.obj");
  CHECK(metadata.at("device") == device.info().name);
  CHECK(metadata.at("driver") == device.info().driver);
  CHECK(metadata.at("trace") == name(renderer.scene().trace()));
  CHECK(metadata.at("size") == "16x8");
  CHECK(metadata.at("samples") == "2");
  CHECK(metadata.at("depth") == "4");
  CHECK(metadata.at("seed") == "9");
  for (const char* key : {"camera", "background", "rays", "milliseconds", "version"}) CHECK(metadata.contains(key));
  CHECK(renderer.device_milliseconds() > 0);
  CHECK(renderer.scene().build_milliseconds() > 0);
}

TEST_CASE("The picture of the CPU device does not depend on the number of threads") {
  const Scene scene = load_obj(source_directory / "scenes" / "cornell_spheres.obj");
  const RenderSettings settings{.width = 40, .height = 40};
  std::array<Image, 2> images;
  for (std::uint32_t threads : {1u, 3u}) {
    const rhi::DeviceHandle device = create_device({.name = "cpu", .thread_count = threads});
    images[threads == 1 ? 0 : 1] = rendered(device, scene, settings, 4);
  }
  CHECK(images[0].pixels == images[1].pixels);
}

TANDEM_DEVICE_TEST("The scenes of the thesis render") {
  const std::filesystem::path folder = source_directory.parent_path() / "shared" / "scenes" / "thesis";
  if (!std::filesystem::is_directory(folder)) TANDEM_SKIP(folder.string() + " is not there");
  for (const std::filesystem::directory_entry& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() != ".obj") continue;
    CAPTURE(entry.path().filename().string());
    const Scene scene = load_obj(entry.path(), {.allow_missing_mtl = true});
    double sum = 0;
    for (const glm::vec3& pixel : rendered(device_handle, scene, {.width = 32, .height = 32}, 2).pixels)
      sum += double{pixel.x} + double{pixel.y} + double{pixel.z};
    CHECK(std::isfinite(sum));
    CHECK(sum > 0);
  }
}
