#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "compare/cause/classification.hpp"
#include "devices/devices.hpp"
#include "pathtracer/load/obj/obj_loader.hpp"
#include "pathtracer/scene/camera.hpp"
#include "tests/pathtracer/render/picture.hpp"
#include "tests/support/device_test.hpp"

using namespace tandem;
using namespace tandem::compare;
using namespace tandem::pathtracer;

namespace {

const std::filesystem::path scenes = std::filesystem::path(TANDEM_SOURCE_DIRECTORY) / "scenes";

constexpr RenderSettings small = {.width = 24, .height = 24, .max_depth = 6, .seed = 5};
constexpr std::uint32_t samples = 2;

/// Every scene is seen by the camera of the first one.
RenderSettings seen(const Scene& scene) {
  RenderSettings settings = small;
  settings.camera = automatic_camera(scene, 1.0f);
  return settings;
}

/// Two scenes, each on a device, and what comes out when they are taken for the same.
struct Comparison {
  Comparison(const rhi::DeviceHandle& device_a, const Scene& scene_a, const rhi::DeviceHandle& device_b,
             const Scene& scene_b)
      : exact(test::device("cpu-exact")),
        a(device_a, scene_a, seen(scene_a)),
        b(device_b, scene_b, seen(scene_a)),
        arbiter(exact, scene_a, seen(scene_a)),
        scene(scene_a) {
    REQUIRE(a.render(samples));
    REQUIRE(b.render(samples));
    result = classify({a.scene(), b.scene(), arbiter, scene}, a.image(), b.image(), samples, {.survey_pixels = 64});
  }

  std::uint64_t count(DifferenceClass difference_class) const {
    return result.divergence_counts[static_cast<std::size_t>(difference_class)];
  }

  rhi::DeviceHandle exact;
  Renderer a, b;
  SceneOnDevice arbiter;
  const Scene& scene;
  Classification result;
};

/// The first mismatch of the first path that has one.
const Divergence* first_mismatch(const Classification& result) {
  for (const ClassifiedPath& path : result.paths)
    for (const Divergence& divergence : path.divergences)
      if (divergence.difference_class == DifferenceClass::mismatch) return &divergence;
  return nullptr;
}

std::string field_of(const Divergence& divergence) {
  return std::string(name(divergence.a.kind())) + ": " + (divergence.field ? divergence.field->name : "");
}

}  // namespace

TANDEM_DEVICE_TEST("A device and the exact one differ in nothing that rounding does not explain") {
  const Scene scene = load_obj(scenes / "cornell_box.obj");
  const Comparison found(test::device("cpu-exact"), scene, device_handle, scene);
  CHECK(found.result.surveyed_pixels == 64);
  CHECK(found.result.traced_paths >= 64 * samples);
  CHECK(found.result.mismatches() == 0);
  for (const ClassifiedPath& path : found.result.paths)
    for (const Divergence& divergence : path.divergences)
      if (divergence.difference_class == DifferenceClass::mismatch) MESSAGE(divergence.sentence);
}

TANDEM_DEVICE_TEST("A device is the same as itself") {
  const Scene scene = load_obj(scenes / "cornell_box.obj");
  const Comparison found(device_handle, scene, device_handle, scene);
  CHECK(found.result.differing_pixels == 0);
  CHECK(found.result.differing_paths == 0);
  CHECK(found.result.paths.empty());
  if (const Divergence* const divergence = first_mismatch(found.result)) MESSAGE(divergence->sentence);
  CHECK(found.result.mismatches() == 0);
}

TANDEM_DEVICE_TEST("Another albedo is a mismatch of the weight with which a path scatters") {
  const Scene scene = load_obj(scenes / "cornell_box.obj");
  Scene other = scene;
  for (GpuMaterial& material : other.materials) material.base_color *= 0.99f;
  const Comparison found(device_handle, scene, device_handle, other);
  const Divergence* const divergence = first_mismatch(found.result);
  REQUIRE(divergence);
  CAPTURE(divergence->sentence);
  // Light that is reflected comes before: its estimate is the first value that knows of the albedo.
  const bool is_albedo = field_of(*divergence) == "light value: bsdf" || field_of(*divergence) == "scatter: weight";
  CAPTURE(field_of(*divergence));
  CHECK(is_albedo);
  CHECK(divergence->segment == 0);
  CHECK(found.result.mismatches() > 0);
  CHECK(found.count(DifferenceClass::mismatch) >= found.result.mismatches());  // a path may have several
}

TANDEM_DEVICE_TEST("Another light is a mismatch of what arrives from it") {
  const Scene scene = load_obj(scenes / "cornell_box.obj");
  Scene other = scene;
  for (GpuMaterial& material : other.materials) material.emission *= 1.01f;
  const Comparison found(device_handle, scene, device_handle, other);
  const Divergence* const divergence = first_mismatch(found.result);
  REQUIRE(divergence);
  CAPTURE(divergence->sentence);
  const bool is_light =
      field_of(*divergence) == "light sample: radiance" || field_of(*divergence) == "emission: radiance";
  CAPTURE(field_of(*divergence));
  CHECK(is_light);
}

TANDEM_DEVICE_TEST("A vertex in another place is a mismatch of a hit or of what lies there") {
  const Scene scene = load_obj(scenes / "cornell_box.obj");
  Scene other = scene;
  const Bounds box = bounds(scene);
  // A corner of the box, and so of walls that fill the picture.
  for (glm::vec3& position : other.positions)
    if (position.x == box.minimum.x && position.y == box.minimum.y) position.x -= 0.02f * box.extent().x;
  const Comparison found(device_handle, scene, device_handle, other);
  const Divergence* const divergence = first_mismatch(found.result);
  REQUIRE(divergence);
  CAPTURE(divergence->sentence);
  const bool is_geometry = divergence->a.kind() == EventKind::ray || divergence->a.kind() == EventKind::surface;
  CAPTURE(name(divergence->a.kind()));
  CHECK(is_geometry);
}

TANDEM_DEVICE_TEST("A picture that is not the sum of its paths is a mismatch by itself") {
  const Scene scene = load_obj(scenes / "cornell_box.obj");
  Comparison found(device_handle, scene, device_handle, scene);
  Image wrong = found.b.image();
  wrong.pixels[100] *= 1.5f;
  const Classification result = classify({found.a.scene(), found.b.scene(), found.arbiter, scene}, found.a.image(),
                                         wrong, samples, {.survey_pixels = 0});
  CHECK(result.differing_pixels == 1);
  CHECK(result.mismatches() == 1);
  REQUIRE(result.pixels.size() == 1);
  CHECK(result.pixels[0].wrong_sum == 'b');
  CHECK(result.pixels[0].difference_class == DifferenceClass::mismatch);
  CHECK(result.pixels[0].pixel == glm::uvec2(100 % small.width, 100 / small.width));
}
