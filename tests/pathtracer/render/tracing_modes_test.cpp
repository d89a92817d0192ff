// Both forms of the path tracer on one device.

#include <filesystem>

#include <doctest/doctest.h>

#include "pathtracer/load/obj/obj_loader.hpp"
#include "tests/pathtracer/render/device_without_queries.hpp"
#include "tests/pathtracer/render/picture.hpp"
#include "tests/support/device_test.hpp"
#include "tests/support/run_summary.hpp"

using namespace tandem;
using namespace tandem::pathtracer;

namespace {

const std::filesystem::path scenes = std::filesystem::path(TANDEM_SOURCE_DIRECTORY) / "scenes";

}  // namespace

TANDEM_DEVICE_TEST("Ray queries and a ray tracing pipeline render the scenes that ship alike to the last bit") {
  if (test::tracing_modes(device).size() < 2)
    TANDEM_SKIP(device_name + " has one form only, so there is nothing to compare");
  // Further scenes are compared by whoever asks for it: some drivers take minutes to compile a pipeline with all
  // features.
  for (const char* file : {"cornell_box.obj", "cornell_spheres.obj", "foliage.obj"}) {
    CAPTURE(file);
    const Scene scene = load_obj(scenes / file);
    const RenderSettings settings{.width = 90, .height = 70, .max_depth = 8};
    Renderer query(device_handle, scene, settings, TracingMode::query);
    Renderer pipeline(device_handle, scene, settings, TracingMode::pipeline);
    REQUIRE(query.render(4));
    REQUIRE(pipeline.render(4));
    CHECK(query.image().pixels == pipeline.image().pixels);
    CHECK(query.ray_count() == pipeline.ray_count());
    CHECK(test::estimate(query.image()).mean > 0.01);
    CHECK(query.metadata().at("trace") == "query");
    CHECK(pipeline.metadata().at("trace") == "pipeline");
  }
}

TANDEM_DEVICE_TEST("A device without ray queries renders through a pipeline, in whatever tiles and batches") {
  if (!device.info().capabilities.ray_tracing_pipeline) TANDEM_SKIP(device_name + " has no ray tracing pipelines");
  const Scene scene = load_obj(scenes / "foliage.obj");
  const RenderSettings settings{.width = 33, .height = 19, .max_depth = 5};
  const rhi::DeviceHandle limited = test::device_without_queries(device);
  Renderer renderer(limited, scene, settings);
  CHECK(renderer.scene().trace() == TracingMode::pipeline);
  REQUIRE(renderer.render(6));
  const Image expected = test::rendered(device_handle, scene, settings, 6);
  CHECK(renderer.image().pixels == expected.pixels);

  RenderSettings tiled = settings;
  tiled.maximum_tile = 8;
  renderer.restart(tiled);
  for (int i = 0; i < 6; ++i) REQUIRE(renderer.render(1));
  CHECK(renderer.image().pixels == expected.pixels);
  CHECK_THROWS_AS(Renderer(limited, scene, settings, TracingMode::query), rhi::Error);
}
