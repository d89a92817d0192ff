#include <bit>
#include <cmath>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "pathtracer/load/obj/obj_loader.hpp"
#include "pathtracer/render/first_hits.hpp"
#include "pathtracer/render/renderer.hpp"
#include "tests/pathtracer/render/picture.hpp"
#include "tests/support/device_test.hpp"
#include "tests/support/scratch_folder.hpp"

using namespace tandem;
using namespace tandem::pathtracer;
using tandem::test::ScratchFolder;
using tandem::test::tracing_modes;

namespace {

/// A red square of side 2 in the plane z = 0, and beside it a mirror tilted by 45 degrees about y.
Scene two_squares() {
  const ScratchFolder folder;
  folder.write("test.mtl", "newmtl red\nKd 0.8 0.1 0.2\nnewmtl shiny\nillum 3\nKs 0.5 0.6 0.7\n");
  return load_obj(folder.write("test.obj",
                               "mtllib test.mtl\nv -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nv 3 -1 0\nv 5 -1 2\nv 5 1 2\n"
                               "v 3 1 0\nusemtl red\nf 1 2 3 4\nusemtl shiny\nf 5 6 7 8\n"));
}

RenderSettings looking_at(float x) {
  // Along -z, about 1 x 1 units around (x, 0).
  Camera camera{.position = {x, 0, 10}, .target = {x, 0, 0}, .vertical_fov = 5.7f};
  return {.width = 8, .height = 8, .camera = camera};
}

float value(const std::vector<ImageChannel>& channels, const std::string& name, std::size_t pixel) {
  for (const ImageChannel& channel : channels)
    if (channel.name == name) return std::bit_cast<float>(channel.words.at(pixel));
  FAIL("no channel ", name);
  return 0;
}

std::uint32_t whole(const std::vector<ImageChannel>& channels, const std::string& name, std::size_t pixel) {
  for (const ImageChannel& channel : channels)
    if (channel.name == name && channel.is_integer) return channel.words.at(pixel);
  FAIL("no whole numbers ", name);
  return 0;
}

}  // namespace

TANDEM_DEVICE_TEST("First hits are colour, normal, distance and numbers of what is seen, in both forms") {
  const Scene scene = two_squares();
  for (const TracingMode form : tracing_modes(device)) {
    CAPTURE(name(form));
    SceneOnDevice at_red(device_handle, scene, looking_at(0), form);
    const auto red = first_hits(at_red, 6);
    for (const std::size_t pixel : {0u, 27u, 63u}) {
      CHECK(value(red, "albedo.R", pixel) == doctest::Approx(0.8));
      CHECK(value(red, "albedo.B", pixel) == doctest::Approx(0.2));
      CHECK(value(red, "normal.Z", pixel) == 1);
      // The corners of the picture are a quarter of a percent farther away.
      CHECK(value(red, "depth.Z", pixel) == doctest::Approx(10).epsilon(0.005));
      CHECK(value(red, "coverage.Y", pixel) == 1);
      CHECK(whole(red, "id.primitive", pixel) < 2);
      CHECK(whole(red, "id.material", pixel) == 0);
    }
    SceneOnDevice at_shiny(device_handle, scene, looking_at(4), form);
    const auto shiny = first_hits(at_shiny, 6);
    CHECK(value(shiny, "albedo.G", 20) == doctest::Approx(0.6));
    CHECK(value(shiny, "normal.X", 20) == doctest::Approx(-std::sqrt(0.5)));
    CHECK(value(shiny, "normal.Z", 20) == doctest::Approx(std::sqrt(0.5)));
    CHECK(whole(shiny, "id.primitive", 20) >= 2);
    CHECK(whole(shiny, "id.material", 20) == 1);
    // The surface rises by as much as it goes to the right: pixel columns are 1/8 apart.
    CHECK(value(shiny, "depth.Z", 0) - value(shiny, "depth.Z", 7) == doctest::Approx(7.0 / 8).epsilon(0.2));
  }
}

TANDEM_DEVICE_TEST("Where nothing is seen, first hits are nothing; at an edge they are in between") {
  const Scene scene = two_squares();
  Renderer renderer(device_handle, scene, looking_at(-20));
  const auto nothing = first_hits(renderer.scene(), 3);
  CHECK(value(nothing, "coverage.Y", 5) == 0);
  CHECK(value(nothing, "albedo.R", 5) == 0);
  CHECK(value(nothing, "depth.Z", 5) == 0);
  CHECK(whole(nothing, "id.primitive", 5) == 0xffffffffu);
  CHECK(whole(nothing, "id.material", 5) == 0xffffffffu);
  // The square's left edge at x = -1 halves the only pixel.
  RenderSettings settings = looking_at(-1);
  settings.width = settings.height = 1;
  renderer.restart(settings);
  const auto edge = first_hits(renderer.scene(), 400);
  // Five deviations of the mean of 400 draws.
  CHECK(value(edge, "coverage.Y", 0) == doctest::Approx(0.5).epsilon(0.25));
  CHECK(value(edge, "albedo.R", 0) == doctest::Approx(0.8 * value(edge, "coverage.Y", 0)));
  CHECK(value(edge, "depth.Z", 0) == doctest::Approx(10).epsilon(0.005));
}

TANDEM_DEVICE_TEST("Looking at first hits changes no picture") {
  const Scene scene = two_squares();
  Renderer renderer(device_handle, scene, looking_at(0));
  renderer.render(2);
  const Image before = renderer.image();
  first_hits(renderer.scene(), 2);
  CHECK(renderer.image().pixels == before.pixels);
  renderer.render(2);
  CHECK(renderer.image().pixels == test::rendered(device_handle, scene, looking_at(0), 4).pixels);
}
