#include <filesystem>

#include <doctest/doctest.h>

#include "pathtracer/load/scene_loader.hpp"
#include "tests/pathtracer/render/picture.hpp"
#include "tests/support/device_test.hpp"

using namespace tandem;
using namespace tandem::pathtracer;
using tandem::test::rendered;

TANDEM_DEVICE_TEST("Features that are on and not used change no bit of a picture") {
  const std::filesystem::path scenes = std::filesystem::path(TANDEM_SOURCE_DIRECTORY) / "scenes";
  const RenderSettings few{.width = 40, .height = 30};
  RenderSettings many = few;
  for (const char* name : {"cornell_box.obj", "cornell_spheres.obj", "foliage.obj"}) {
    CAPTURE(name);
    const Scene scene = load_scene(scenes / name);
    const Image plain = rendered(device_handle, scene, few, 3, TracingMode::query);
    many.further_features = feature::samplers;
    CHECK(rendered(device_handle, scene, many, 3, TracingMode::query).pixels == plain.pixels);
    many.further_features = feature::all;
    CHECK(rendered(device_handle, scene, many, 3, TracingMode::query).pixels == plain.pixels);
  }
}
