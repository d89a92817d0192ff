// Pictures whose radiance is known from optics alone.

#include <cmath>
#include <numbers>
#include <string>

#include <doctest/doctest.h>

#include "pathtracer/load/obj/obj_loader.hpp"
#include "tests/pathtracer/render/picture.hpp"
#include "tests/support/device_test.hpp"
#include "tests/support/scratch_folder.hpp"

using namespace tandem;
using namespace tandem::pathtracer;
using tandem::test::rendered;
using tandem::test::ScratchFolder;

namespace {

Scene load_text(const std::string& obj, const std::string& mtl) {
  const ScratchFolder folder;
  folder.write("test.mtl", mtl);
  return load_obj(folder.write("test.obj", "mtllib test.mtl\n" + obj));
}

double mean(const Image& image) {
  double sum = 0;
  for (const glm::vec3& pixel : image.pixels) sum += pixel.x;
  return sum / double(image.pixels.size());
}

}  // namespace

TANDEM_DEVICE_TEST("Between parallel mirrors every reflection takes its part") {
  // Walls at x = -1 and 1 from z = 0 to -10. A ray from the middle goes to the side by 10 slopes until it is out, and
  // meets a wall every 2, first after 1.
  const Scene corridor = load_text(
      "v -1 -50 0\nv -1 -50 -10\nv -1 50 -10\nv -1 50 0\nv 1 -50 0\nv 1 -50 -10\nv 1 50 -10\nv 1 50 0\n"
      "usemtl mirror\nf 1 2 3 4\nf 8 7 6 5\n",
      "newmtl mirror\nillum 3\nKs 0.9 0.9 0.9\n");
  for (const int reflections : {0, 1, 2, 5, 12}) {
    CAPTURE(reflections);
    // In the middle between two numbers of reflections.
    const float slope = static_cast<float>(2 * reflections) / 10;
    const Camera camera{.position = {0, 0, 0}, .target = {slope, 0, -1}, .vertical_fov = 0.5f};
    const RenderSettings settings{
        .width = 8, .height = 8, .max_depth = 20, .camera = camera, .background = glm::vec3(1)};
    // Roulette, which begins at the fourth vertex, is noise: its paths die with at most 5 %, or with what is lost.
    const double expected = std::pow(0.9, reflections);
    const double tolerance = reflections < 4 ? 1e-5 : 0.03;
    CHECK(mean(rendered(device_handle, corridor, settings, reflections < 4 ? 1 : 256)) ==
          doctest::Approx(expected).epsilon(tolerance));
  }
}

TANDEM_DEVICE_TEST("A slab of glass displaces what is behind it and takes what Fresnel's equations say") {
  constexpr double ior = 1.5, thickness = 0.6;
  const std::string light = "v -20 -20 -5\nv 0 -20 -5\nv 0 20 -5\nv -20 20 -5\nusemtl light\nf 1 2 3 4\n";
  const std::string slab =
      "v -20 -20 0\nv 20 -20 0\nv 20 20 0\nv -20 20 0\nv -20 -20 -0.6\nv 20 -20 -0.6\nv 20 20 -0.6\nv -20 20 -0.6\n"
      "usemtl glass\nf 5 6 7 8\nf 12 11 10 9\nf 6 10 11 7\nf 9 5 8 12\nf 8 7 11 12\nf 9 10 6 5\n";
  const std::string materials = "newmtl light\nKd 0\nKe 1\nnewmtl glass\nillum 7\nKs 1\nTf 1 1 1\nNi 1.5\n";
  for (const double degrees : {0.0, 20.0, 40.0, 60.0}) {
    CAPTURE(degrees);
    const double angle = degrees * std::numbers::pi / 180;
    // Parallel rays, of which without glass one half meets the light, whose edge is at x = 0.
    const glm::vec3 forward(std::sin(angle), 0, -std::cos(angle));
    const glm::vec3 edge(0, 0, -5);
    const Camera camera{
        .kind = CameraKind::orthographic, .position = edge - 20.0f * forward, .target = edge, .height = 0.5f};
    // Three segments: to the glass, through it, to the light. What is reflected inside would need more.
    const RenderSettings settings{
        .width = 64, .height = 8, .max_depth = 3, .camera = camera, .background = glm::vec3(0)};
    constexpr double view_width = 4;
    CHECK(view_width * mean(rendered(device_handle, load_text(light, materials), settings, 16)) ==
          doctest::Approx(view_width / 2).epsilon(0.01));

    const double refracted = std::asin(std::sin(angle) / ior);
    const double s = (std::cos(angle) - ior * std::cos(refracted)) / (std::cos(angle) + ior * std::cos(refracted));
    const double p = (ior * std::cos(angle) - std::cos(refracted)) / (ior * std::cos(angle) + std::cos(refracted));
    const double transmitted = std::pow(1 - 0.5 * (s * s + p * p), 2);
    const double displacement = thickness * std::sin(angle - refracted) / std::cos(refracted);
    const double lit = view_width * mean(rendered(device_handle, load_text(light + slab, materials), settings, 256));
    // A path is transmitted or not: five deviations of the mean of 131072 of them are 0.7 % of the width.
    CHECK(lit == doctest::Approx(transmitted * (view_width / 2 + displacement)).epsilon(0.007));
  }
}
