#include "pathtracer/render/accumulation.hpp"

#include <filesystem>

#include <doctest/doctest.h>

#include "base/error.hpp"
#include "pathtracer/load/scene_loader.hpp"
#include "tests/pathtracer/render/picture.hpp"
#include "tests/support/device_test.hpp"

using namespace tandem;
using namespace tandem::pathtracer;
using tandem::test::rendered;

namespace {

Scene box() { return load_scene(std::filesystem::path(TANDEM_SOURCE_DIRECTORY) / "scenes" / "cornell_box.obj"); }

const RenderSettings small{.width = 24, .height = 16};

}  // namespace

TANDEM_DEVICE_TEST("Frames add up to the picture of all their samples, and stop at the cap") {
  const Scene scene = box();
  Renderer renderer(device_handle, scene, small);
  Accumulation accumulation(renderer);
  const AccumulationSettings frames{.samples_per_frame = 2, .maximum_samples = 5};
  CHECK(accumulation.next_frame(small, frames));
  CHECK(renderer.samples() == 2);
  CHECK(accumulation.next_frame(small, frames));
  CHECK(accumulation.next_frame(small, frames));
  CHECK(renderer.samples() == 5);
  CHECK_FALSE(accumulation.next_frame(small, frames));
  CHECK(renderer.samples() == 5);
  CHECK(renderer.image().pixels == rendered(device_handle, scene, small, 5).pixels);
}

TANDEM_DEVICE_TEST("A change of the camera or of a setting begins anew; what changes no picture does not") {
  const Scene scene = box();
  Renderer renderer(device_handle, scene, small);
  Accumulation accumulation(renderer);
  const AccumulationSettings frames{.samples_per_frame = 1, .maximum_samples = 100};
  RenderSettings settings = small;
  settings.camera = renderer.scene().camera();
  const auto samples_after_frame = [&] {
    accumulation.next_frame(settings, frames);
    return renderer.samples();
  };
  CHECK(samples_after_frame() == 1);
  CHECK(samples_after_frame() == 2);
  settings.submission_seconds = 0.1;
  settings.maximum_tile = 8;
  CHECK(samples_after_frame() == 3);
  settings.camera->position.x += 1;
  CHECK(samples_after_frame() == 1);
  CHECK(samples_after_frame() == 2);
  settings.max_depth = 3;
  CHECK(samples_after_frame() == 1);
  settings.width = 20;
  CHECK(samples_after_frame() == 1);
  CHECK(samples_after_frame() == 2);
  CHECK(renderer.image().pixels == rendered(device_handle, scene, settings, 2).pixels);
}

TANDEM_DEVICE_TEST("Without accumulation every frame is a picture of its own") {
  const Scene scene = box();
  Renderer renderer(device_handle, scene, small);
  Accumulation accumulation(renderer);
  const AccumulationSettings single{.samples_per_frame = 2, .maximum_samples = 5, .accumulate = false};
  REQUIRE(accumulation.next_frame(small, single));
  const Image first = renderer.image();
  REQUIRE(accumulation.next_frame(small, single));
  CHECK(renderer.samples() == 2);
  CHECK(renderer.image().pixels != first.pixels);
  // Back to accumulating: nothing of those frames is kept.
  AccumulationSettings frames = single;
  frames.accumulate = true;
  REQUIRE(accumulation.next_frame(small, frames));
  CHECK(renderer.image().pixels == rendered(device_handle, scene, small, 2).pixels);
}

TANDEM_DEVICE_TEST("A frame without samples is an error") {
  Renderer renderer(device_handle, box(), small);
  Accumulation accumulation(renderer);
  CHECK_THROWS_AS(accumulation.next_frame(small, {.samples_per_frame = 0}), Error);
  CHECK_THROWS_AS(accumulation.next_frame(small, {.maximum_samples = 0}), Error);
}
