// Cameras beyond the still pinhole, in whole pictures.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include <doctest/doctest.h>

#include "tests/pathtracer/render/picture.hpp"
#include "tests/support/device_test.hpp"

using namespace tandem;
using namespace tandem::pathtracer;

namespace {

/// One sphere around `centre`.
Scene ball(glm::vec3 centre, float radius, const GpuMaterial& material) {
  Scene scene;
  scene.name = "ball";
  scene.materials = {material};
  scene.material_names = {"ball"};
  scene.spheres = {{.centre = centre, .radius = radius}};
  return scene;
}

RenderSettings view(const Camera& camera) {
  return {.width = 64, .height = 64, .max_depth = 1, .camera = camera, .background = glm::vec3(1)};
}

/// At z = 10, looking at the origin; 2 high there.
constexpr Camera front{.position = {0, 0, 10}, .vertical_fov = 11.42118627f};

std::vector<Camera> all_kinds() {
  Camera lens = front;
  lens.lens_radius = 0.5f;
  Camera orthographic = front;
  orthographic.kind = CameraKind::orthographic;
  Camera equirectangular = front;
  equirectangular.kind = CameraKind::equirectangular;
  equirectangular.position = {0, 0, 1};
  Camera moving = lens;
  moving.motion = {0.3f, -0.2f, 1};
  return {front, lens, orthographic, equirectangular, moving};
}

}  // namespace

TANDEM_DEVICE_TEST("A white ball in a white world is white in every camera") {
  const Scene scene = ball({0, 0, 0}, 0.75f, diffuse_material(glm::vec3(1)));
  RenderSettings settings = view(front);
  settings.max_depth = 64;
  Renderer renderer(device_handle, scene, settings);
  for (const Camera& camera : all_kinds()) {
    settings.camera = camera;
    renderer.restart(settings);
    REQUIRE(renderer.render(4));
    // A convex white ball sends every path out again with all of its weight, but for its rounding.
    CHECK(test::estimate(renderer.image()).mean == doctest::Approx(1).epsilon(1e-5));
  }
}

TANDEM_DEVICE_TEST("Out of focus a point is a disk as large as the lens makes it") {
  // Focus at 10, where the picture is 2 high; a small ball at 5 or 20.
  constexpr double lens_radius = 0.25, radius = 0.01;
  for (const double distance : {5.0, 20.0}) {
    CAPTURE(distance);
    Camera camera = front;
    camera.lens_radius = lens_radius;
    const Scene scene =
        ball({0, 0, 10 - distance}, static_cast<float>(radius), diffuse_material(glm::vec3(0), glm::vec3(100)));
    RenderSettings settings = view(camera);
    settings.background = glm::vec3(0);
    const Image image = test::rendered(device_handle, scene, settings, 256);
    // Similar triangles, from the rim of the lens past the ball to the plane of focus.
    const double blurred = lens_radius * std::abs(10 - distance) / distance + radius * 10 / distance;
    double farthest = 0, sum = 0, at_rim = 0;
    for (std::uint32_t y = 0; y < 64; ++y)
      for (std::uint32_t x = 0; x < 64; ++x) {
        const double r = std::hypot((x + 0.5) / 32 - 1, (y + 0.5) / 32 - 1);
        if (image.at(x, y).x > 0) farthest = std::max(farthest, r);
        sum += image.at(x, y).x;
        if (r > 0.8 * blurred) at_rim += image.at(x, y).x;
      }
    // A pixel is 1/32 wide, its corner 0.022 from its centre.
    CHECK(farthest < blurred + 0.023);
    CHECK(farthest > blurred - 0.023);
    // The disk is uniform: 36 % of it lie beyond 80 % of its radius, give or take the pixels that straddle the circle.
    CHECK(at_rim / sum == doctest::Approx(0.36).epsilon(0.2));
  }
}

TANDEM_DEVICE_TEST("In focus a lens draws what a pinhole does") {
  const Scene scene = ball({0, 0, 0}, 0.02f, diffuse_material(glm::vec3(0)));
  Camera camera = front;
  camera.lens_radius = 0.25f;
  const Image image = test::rendered(device_handle, scene, view(camera), 16);
  for (std::uint32_t y = 0; y < 64; ++y)
    for (std::uint32_t x = 0; x < 64; ++x) {
      const bool near = (x == 31 || x == 32) && (y == 31 || y == 32);
      if (near)
        CHECK(image.at(x, y).x < 1.0f);
      else
        REQUIRE(image.at(x, y).x == 1.0f);
    }
}

TANDEM_DEVICE_TEST("An orthographic camera shows things as large as they are, however far") {
  for (const float z : {-100.0f, 5.0f}) {
    Camera camera = front;
    camera.kind = CameraKind::orthographic;
    camera.height = 4;
    RenderSettings settings = view(camera);
    settings.width = 96;
    const Image image =
        test::rendered(device_handle, ball({1, -0.5f, z}, 0.75f, diffuse_material(glm::vec3(0))), settings, 16);
    double covered = 0;
    for (std::uint32_t y = 0; y < 64; ++y)
      for (std::uint32_t x = 0; x < 96; ++x) {
        // Pixels are squares with sides of 4 / 64.
        const double r = std::hypot((x + 0.5 - 48) / 16 - 1, (31.5 - y) / 16 + 0.5);
        CAPTURE(x);
        CAPTURE(y);
        CAPTURE(z);
        if (r < 0.75 - 0.045) REQUIRE(image.at(x, y).x == 0.0f);
        if (r > 0.75 + 0.045) REQUIRE(image.at(x, y).x == 1.0f);
        covered += (1 - image.at(x, y).x) / 256;
      }
    // 150 pixels on the rim are known to 1/8 each; the rest exactly.
    CHECK(covered == doctest::Approx(3.14159265 * 0.75 * 0.75).epsilon(0.01));
  }
}

TANDEM_DEVICE_TEST("An equirectangular camera sees all around, as many pixels to an angle everywhere on the equator") {
  // Balls that fill 10 degrees to each side, before, right of, behind and above the camera.
  const double angle = 10, half_width = std::sin(angle * 3.14159265358979 / 180) * 5;
  struct View {
    glm::vec3 direction;
    double x, y;  // of its centre, in fractions of the picture
  };
  Camera camera{.kind = CameraKind::equirectangular, .position = {0, 0, 0}, .target = {0, 0, -1}};
  RenderSettings settings = view(camera);
  settings.width = 144;
  settings.height = 72;  // 2.5 degrees to a pixel
  for (const View& place :
       {View{{0, 0, -5}, 0.5, 0.5}, {{5, 0, 0}, 0.75, 0.5}, {{0, 0, 5}, 0, 0.5}, {{-5, 0, 0}, 0.25, 0.5}}) {
    const Image image = test::rendered(
        device_handle, ball(place.direction, static_cast<float>(half_width), diffuse_material(glm::vec3(0))), settings,
        4);
    for (std::uint32_t x = 0; x < 144; ++x) {
      double degrees = std::abs((x + 0.5) / 144 - place.x) * 360;
      degrees = std::min(degrees, 360 - degrees);
      // The rows next to the equator; a pixel may lie on the rim.
      for (const std::uint32_t y : {35u, 36u}) {
        if (degrees < angle - 2) REQUIRE(image.at(x, y).x == 0.0f);
        if (degrees > angle + 1.3) REQUIRE(image.at(x, y).x == 1.0f);
      }
    }
  }
  const Image above = test::rendered(
      device_handle, ball({0, 5, 0}, static_cast<float>(half_width), diffuse_material(glm::vec3(0))), settings, 4);
  for (std::uint32_t y = 0; y < 72; ++y)
    for (std::uint32_t x = 0; x < 144; ++x) REQUIRE(above.at(x, y).x == (y < 4 ? 0.0f : 1.0f));
}

TANDEM_DEVICE_TEST("A camera that moves blurs a ball that stands still as if the ball moved the other way") {
  Camera moving = front;
  moving.position.x = 0.6f;
  moving.target.x = 0.6f;
  moving.motion = {-1.2f, 0, 0};
  const Scene still = ball({0, 0, 0}, 0.25f, diffuse_material(glm::vec3(0)));
  Scene moved = ball({-0.6f, 0, 0}, 0.25f, diffuse_material(glm::vec3(0)));
  moved.spheres[0].motion = {1.2f, 0, 0};
  for (const TracingMode form : test::tracing_modes(device)) {
    CAPTURE(name(form));
    const Image a = test::rendered(device_handle, still, view(moving), 64, form);
    const Image b = test::rendered(device_handle, moved, view(front), 64, form);
    // The same samples at the same times: they differ where rounding moves the rim past one.
    std::size_t different = 0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i) different += a.pixels[i] != b.pixels[i] ? 1 : 0;
    CHECK(different <= 8);
    CHECK(test::estimate(a).mean < 0.96);
  }
}
