#include "pathtracer/denoise/noisy_picture.hpp"

#include <doctest/doctest.h>

#include "base/error.hpp"
#include "pathtracer/load/obj/obj_loader.hpp"
#include "tests/support/device_test.hpp"
#include "tests/support/scratch_folder.hpp"

using namespace tandem;
using namespace tandem::pathtracer;
using tandem::test::ScratchFolder;

namespace {

/// A floor of 2 x 2 under a lamp, that a camera between them looks at.
Scene lit_floor() {
  const ScratchFolder folder;
  folder.write("test.mtl", "newmtl grey\nKd 0.5 0.5 0.5\nnewmtl lamp\nKd 0 0 0\nKe 5 4 3\n");
  return load_obj(folder.write("test.obj",
                               "mtllib test.mtl\nv -9 -9 0\nv 9 -9 0\nv 9 9 0\nv -9 9 0\nv -1 -1 3\nv -1 1 3\nv 1 1 3\n"
                               "v 1 -1 3\nusemtl grey\nf 1 2 3 4\nusemtl lamp\nf 5 6 7 8\n"));
}

RenderSettings floor_settings(std::uint32_t seed) {
  Camera camera{.position = {0, 0, 2.5f}, .target = {0, 0.01f, 0}, .vertical_fov = 60};
  return {.width = 24, .height = 24, .max_depth = 3, .seed = seed, .camera = camera};
}

}  // namespace

TANDEM_DEVICE_TEST("Measuring noise changes no bit of the picture, and tells how far two pictures differ") {
  const Scene scene = lit_floor();
  Renderer renderer(device_handle, scene, floor_settings(0));
  renderer.render(20);
  const Image plain = renderer.image();
  renderer.restart(floor_settings(0));
  const std::optional<NoisyPicture> picture = render_noisy_picture(renderer, 20);
  REQUIRE(picture);
  CHECK(picture->radiance.pixels == plain.pixels);
  CHECK(renderer.samples() == 20);
  renderer.restart(floor_settings(1));
  renderer.render(20);
  const Image other = renderer.image();
  double predicted = 0, found = 0;
  for (std::size_t i = 0; i < plain.pixels.size(); ++i) {
    predicted += picture->variance[i].x;
    const double difference = double{plain.pixels[i].x} - other.pixels[i].x;
    found += difference * difference / 2;
    CHECK(picture->coverage[i] == 1);
    CHECK(picture->albedo[i].x == doctest::Approx(0.5));
  }
  CHECK(found > 0);
  // 576 squares of nearly normal numbers: a deviation of sqrt(2 / 576), 6 %, and less for the prediction.
  CHECK(predicted == doctest::Approx(found).epsilon(0.3));
}

TANDEM_DEVICE_TEST("One sample tells no variance; no sample is no picture") {
  Renderer renderer(device_handle, lit_floor(), floor_settings(0));
  CHECK_THROWS_AS(render_noisy_picture(renderer, 0), Error);
  const std::optional<NoisyPicture> picture = render_noisy_picture(renderer, 1);
  REQUIRE(picture);
  for (const glm::vec3& variance : picture->variance) CHECK(variance.x < 0);
  CHECK_THROWS_AS(render_noisy_picture(renderer, 1), Error);
  renderer.restart(floor_settings(0));
  CHECK_FALSE(render_noisy_picture(renderer, 2, [](double) { return false; }));
}
