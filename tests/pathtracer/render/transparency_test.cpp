// Cut-outs and stochastic transparency, in each form of the path tracer that a device has.

#include <cmath>
#include <filesystem>
#include <string>

#include <doctest/doctest.h>
#include <fmt/format.h>

#include "pathtracer/load/obj/obj_loader.hpp"
#include "tests/pathtracer/render/picture.hpp"
#include "tests/support/device_test.hpp"
#include "tests/support/scratch_folder.hpp"

using namespace tandem;
using namespace tandem::pathtracer;
using test::Estimate;
using test::estimate;
using test::rendered;

namespace {

Scene load_text(const std::string& obj, const std::string& mtl, const std::string& mask = "") {
  const test::ScratchFolder folder;
  folder.write("test.mtl", mtl);
  if (!mask.empty()) folder.write("mask.pgm", mask);
  return load_obj(folder.write("test.obj", "mtllib test.mtl\n" + obj));
}

/// A square of side 2 `half` that faces +z.
std::string square(const std::string& material, float half, float z) {
  return fmt::format("usemtl {0}\nv -{1} -{1} {2}\nv {1} -{1} {2}\nv {1} {1} {2}\nv -{1} {1} {2}\nf -4 -3 -2 -1\n",
                     material, half, z);
}

/// From (0, 0, 1) along -z, 90 degrees: the plane z = 0 is seen from -1 to 1.
const Camera ahead{.position = {0, 0, 1}, .target = {0, 0, 0}, .up = {0, 1, 0}, .vertical_fov = 90};

const RenderSettings emission_only{
    .width = 64, .height = 64, .max_depth = 1, .camera = ahead, .background = glm::vec3(1)};

/// A floor of albedo 0.8 at y = 0 under a light of 0.2 x 0.2 at height 2, seen from the side, away from the light.
const std::string lit_floor =
    "usemtl floor\nv -5 0 -5\nv -5 0 5\nv 5 0 5\nv 5 0 -5\nf -4 -3 -2 -1\n"
    "usemtl light\nv -0.1 2 -0.1\nv 0.1 2 -0.1\nv 0.1 2 0.1\nv -0.1 2 0.1\nf -4 -3 -2 -1\n";
const std::string plate_below_light = "usemtl plate\nv -3 1.5 -3\nv 3 1.5 -3\nv 3 1.5 3\nv -3 1.5 3\nf -4 -3 -2 -1\n";
const std::string floor_materials = "newmtl floor\nKd 0.8\nnewmtl light\nKd 0\nKe 50\n";
// The camera sees a thousandth of a unit, over which the light is the same to 1e-3.
const RenderSettings floor_view{
    .width = 64,
    .height = 64,
    .max_depth = 2,
    .camera = Camera{.position = {0.2f, 0.5f, 2}, .target = {0.2f, 0, 0}, .up = {0, 1, 0}, .vertical_fov = 0.02f}};

}  // namespace

TANDEM_DEVICE_TEST("A plate of opacity 1/4 lets 3/4 of the background pass, two of them 9/16") {
  const std::string plate = "newmtl plate\nKd 0\nd 0.25\n";
  const Scene one = load_text(square("plate", 4, 0), plate);
  const Scene two = load_text(square("plate", 4, 0) + square("plate", 8, -1), plate);
  for (const TracingMode form : test::tracing_modes(device)) {
    CAPTURE(name(form));
    // 2^18 samples that are each 0 or 1: a standard error of 1e-3. Four of them are missed once in 16000 seeds.
    const Estimate once = estimate(rendered(device_handle, one, emission_only, 64, form));
    CHECK(once.standard_error < 1e-3);
    CHECK(std::abs(once.mean - 0.75) < 4 * once.standard_error);
    const Estimate twice = estimate(rendered(device_handle, two, emission_only, 64, form));
    CHECK(twice.standard_error < 1.1e-3);
    CHECK(std::abs(twice.mean - 0.5625) < 4 * twice.standard_error);
  }
}

TANDEM_DEVICE_TEST("A plate of opacity 1/4 in front of a light transmits 3/4 of it") {
  const Scene without = load_text(lit_floor, floor_materials);
  const Scene with = load_text(lit_floor + plate_below_light, floor_materials + "newmtl plate\nKd 0\nd 0.25\n");
  for (const TracingMode form : test::tracing_modes(device)) {
    CAPTURE(name(form));
    const Estimate all = estimate(rendered(device_handle, without, floor_view, 64, form));
    const Estimate part = estimate(rendered(device_handle, with, floor_view, 64, form));
    CHECK(part.standard_error < 2e-3 * all.mean);
    CHECK(std::abs(part.mean - 0.75 * all.mean) < 4 * (part.standard_error + all.standard_error));
  }
}

TANDEM_DEVICE_TEST("An opacity of 0 changes no bit of the picture behind") {
  const Scene without = load_text(lit_floor, floor_materials);
  const Scene with = load_text(plate_below_light + lit_floor, "newmtl plate\nd 0\n" + floor_materials);
  RenderSettings settings = floor_view;
  settings.camera->vertical_fov = 60;
  settings.max_depth = 6;
  for (const TracingMode form : test::tracing_modes(device)) {
    CAPTURE(name(form));
    CHECK(rendered(device_handle, with, settings, 4, form).pixels ==
          rendered(device_handle, without, settings, 4, form).pixels);
  }
}

TANDEM_DEVICE_TEST("A light of opacity 1/2 gives half its radiance, seen and sampled") {
  const std::string half = "newmtl floor\nKd 0.8\nnewmtl light\nKd 0\nKe 100\nd 0.5\n";
  const Scene seen = load_text(square("light", 4, 0), "newmtl light\nKd 0\nKe 2\nd 0.5\n");
  RenderSettings black = emission_only;
  black.background = glm::vec3(0);
  for (const TracingMode form : test::tracing_modes(device)) {
    CAPTURE(name(form));
    const Estimate direct = estimate(rendered(device_handle, seen, black, 64, form));
    CHECK(std::abs(direct.mean - 1) < 4 * direct.standard_error);
    // Where lights are sampled the opacity is a factor; scattered rays meet the light half of the time.
    const Estimate covered = estimate(rendered(device_handle, load_text(lit_floor, half), floor_view, 64, form));
    const Estimate dimmed =
        estimate(rendered(device_handle, load_text(lit_floor, floor_materials), floor_view, 64, form));
    CHECK(covered.standard_error < 0.01 * covered.mean);
    CHECK(std::abs(covered.mean - dimmed.mean) < 4 * std::hypot(covered.standard_error, dimmed.standard_error));
  }
}

TANDEM_DEVICE_TEST("A cut-out is seen texel by texel, repeated, upright") {
  const std::string mask = "P2\n4 2\n255\n0 255 255 0\n255 0 0 0\n";
  const bool covered[2][4] = {{false, true, true, false}, {true, false, false, false}};
  // The texture twice in each direction, over a square that the picture just holds: 4 x 8 pixels for each texel.
  const Scene scene = load_text(
      "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nvt -1 3\nvt 1 3\nvt 1 5\nvt -1 5\nusemtl a\nf 1/1 2/2 3/3 4/4\n",
      "newmtl a\nKd 0\nmap_d mask.pgm\n", mask);
  RenderSettings settings = emission_only;
  settings.width = 32;
  settings.height = 32;
  for (const TracingMode form : test::tracing_modes(device)) {
    CAPTURE(name(form));
    const Image image = rendered(device_handle, scene, settings, 8, form);
    int wrong = 0;
    for (std::uint32_t y = 0; y < 32; ++y)
      for (std::uint32_t x = 0; x < 32; ++x)
        wrong += image.at(x, y) != glm::vec3(covered[y / 8 % 2][x / 4 % 4] ? 0.0f : 1.0f) ? 1 : 0;
    CHECK(wrong == 0);
  }
}

TANDEM_DEVICE_TEST("A texel between 0 and 255 is an opacity, which d multiplies") {
  const Scene scene = load_text(square("a", 4, 0), "newmtl a\nKd 0\nd 0.5\nmap_d mask.pgm\n", "P2\n1 1\n255\n153\n");
  for (const TracingMode form : test::tracing_modes(device)) {
    CAPTURE(name(form));
    const Estimate result = estimate(rendered(device_handle, scene, emission_only, 64, form));
    CHECK(std::abs(result.mean - (1 - 0.5 * 153 / 255)) < 4 * result.standard_error);
  }
}
