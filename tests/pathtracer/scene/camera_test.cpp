#include "pathtracer/scene/camera.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <optional>

#include <doctest/doctest.h>
#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "base/error.hpp"
#include "pathtracer/load/generate.hpp"
#include "pathtracer/load/obj/obj_loader.hpp"
#include "tests/support/run_summary.hpp"
#include "tests/support/scratch_folder.hpp"

using namespace tandem::pathtracer;
using tandem::test::ScratchFolder;

namespace {

const std::filesystem::path source_directory = TANDEM_SOURCE_DIRECTORY;
const std::filesystem::path thesis_directory = source_directory.parent_path() / "shared" / "scenes" / "thesis";

/// Distance to the nearest triangle, by trying all of them (Möller and Trumbore 1997).
std::optional<double> nearest(const Scene& scene, glm::dvec3 origin, glm::dvec3 direction) {
  double best = std::numeric_limits<double>::infinity();
  for (const GpuTriangle& triangle : scene.triangles) {
    const glm::dvec3 a(scene.positions[triangle.vertices[0]]);
    const glm::dvec3 ab = glm::dvec3(scene.positions[triangle.vertices[1]]) - a;
    const glm::dvec3 ac = glm::dvec3(scene.positions[triangle.vertices[2]]) - a;
    const glm::dvec3 p = glm::cross(direction, ac);
    const double determinant = glm::dot(ab, p);
    if (determinant == 0) continue;
    const glm::dvec3 s = origin - a;
    const double u = glm::dot(s, p) / determinant;
    const glm::dvec3 q = glm::cross(s, ab);
    const double v = glm::dot(direction, q) / determinant;
    const double t = glm::dot(ac, q) / determinant;
    if (u >= 0 && v >= 0 && u + v <= 1 && t > 0) best = std::min(best, t);
  }
  if (std::isinf(best)) return std::nullopt;
  return best;
}

struct View {
  double coverage = 0;  ///< fraction of the picture that shows a triangle
  double extent = 0;    ///< largest |x| or |y| of a vertex on the picture plane; 1 is its edge
  bool all_in_front = true;
};

View look(const Scene& scene, const Camera& camera, std::uint32_t width, std::uint32_t height) {
  RenderConstants constants{};
  set_camera(constants, camera, width, height);
  const glm::dvec3 right(constants.camera_right), up(constants.camera_up), forward(constants.camera_forward);
  View view;
  for (const GpuTriangle& triangle : scene.triangles)
    for (const std::uint32_t vertex : triangle.vertices) {
      const glm::dvec3 p = glm::dvec3(scene.positions[vertex]) - glm::dvec3(constants.camera_position);
      const double depth = glm::dot(p, forward);
      view.all_in_front = view.all_in_front && depth > 0;
      view.extent = std::max({view.extent, std::abs(glm::dot(p, right) / glm::dot(right, right) / depth),
                              std::abs(glm::dot(p, up) / glm::dot(up, up) / depth)});
    }
  constexpr int side = 16;
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      const glm::dvec3 direction = forward + right * ((x + 0.5) / side * 2 - 1) + up * ((y + 0.5) / side * 2 - 1);
      view.coverage += nearest(scene, glm::dvec3(constants.camera_position), direction) ? 1.0 / (side * side) : 0.0;
    }
  return view;
}

/// An axis-aligned box from `low` to `high`, its faces counter-clockwise seen from outside, or from inside.
std::string box(glm::vec3 low, glm::vec3 high, bool inwards) {
  std::string text;
  for (int i = 0; i < 8; ++i)
    text += fmt::format("v {} {} {}\n", (i & 1) != 0 ? high.x : low.x, (i & 2) != 0 ? high.y : low.y,
                        (i & 4) != 0 ? high.z : low.z);
  constexpr std::array<std::array<int, 4>, 6> faces = {
      {{1, 5, 7, 3}, {2, 4, 8, 6}, {1, 2, 6, 5}, {3, 7, 8, 4}, {1, 3, 4, 2}, {5, 6, 8, 7}}};
  for (const auto& [a, b, c, d] : faces)
    text += inwards ? fmt::format("f {} {} {} {}\n", d - 9, c - 9, b - 9, a - 9)
                    : fmt::format("f {} {} {} {}\n", a - 9, b - 9, c - 9, d - 9);
  return text;
}

Scene load_text(const std::string& text) {
  const ScratchFolder folder;
  return load_obj(folder.write("test.obj", text));
}

Scene load_scene(const std::filesystem::path& path) { return load_obj(path, {.allow_missing_mtl = true}); }

}  // namespace

TEST_CASE("Camera vectors are orthogonal and have the lengths of the field of view") {
  RenderConstants constants{};
  set_camera(constants, {.position = {1, 2, 3}, .target = {1, 2, -7}, .up = {0, 5, 1}, .vertical_fov = 90}, 200, 100);
  CHECK(constants.camera_position == glm::vec3(1, 2, 3));
  CHECK(constants.camera_forward == glm::vec3(0, 0, -1));
  CHECK(constants.camera_right.x == doctest::Approx(2));
  CHECK(constants.camera_up.y == doctest::Approx(1));
  // Forward and up are parallel to axes here, so the other components are rounding of the normalisation at most.
  CHECK(glm::length(constants.camera_right - glm::vec3(2, 0, 0)) < 1e-6f);
  CHECK(glm::length(constants.camera_up - glm::vec3(0, 1, 0)) < 1e-6f);
}

TEST_CASE("A camera that looks nowhere is an error") {
  RenderConstants constants{};
  const Camera good{.position = {0, 0, 1}, .target = {0, 0, 0}, .up = {0, 1, 0}, .vertical_fov = 40};
  Camera camera = good;
  camera.target = camera.position;
  CHECK_THROWS_AS(set_camera(constants, camera, 1, 1), tandem::Error);
  camera = good;
  camera.up = {0, 0, 3};
  CHECK_THROWS_AS(set_camera(constants, camera, 1, 1), tandem::Error);
  camera = good;
  camera.up = {0, 0, 0};
  CHECK_THROWS_AS(set_camera(constants, camera, 1, 1), tandem::Error);
  camera = good;
  camera.position.x = std::numeric_limits<float>::quiet_NaN();
  CHECK_THROWS_AS(set_camera(constants, camera, 1, 1), tandem::Error);
  for (const float fov : {0.0f, 180.0f, -40.0f, std::numeric_limits<float>::quiet_NaN()}) {
    camera = good;
    camera.vertical_fov = fov;
    CHECK_THROWS_AS(set_camera(constants, camera, 1, 1), tandem::Error);
  }
}

TEST_CASE("An orthographic camera is as high as it says, an equirectangular one has unit vectors") {
  RenderConstants constants{};
  Camera camera{.kind = CameraKind::orthographic, .position = {0, 0, 5}, .height = 3};
  set_camera(constants, camera, 200, 100);
  CHECK(constants.camera_kind == CameraKind::orthographic);
  CHECK(constants.camera_right == glm::vec3(3, 0, 0));
  CHECK(constants.camera_up == glm::vec3(0, 1.5f, 0));
  camera.kind = CameraKind::equirectangular;
  set_camera(constants, camera, 200, 100);
  CHECK(constants.camera_kind == CameraKind::equirectangular);
  CHECK(constants.camera_right == glm::vec3(1, 0, 0));
  CHECK(constants.camera_up == glm::vec3(0, 1, 0));
}

TEST_CASE("A lens is focused on the target unless told otherwise, and the shutter is open while the camera moves") {
  RenderConstants constants{};
  Camera camera{.position = {0, 0, 5}, .target = {0, 0, 1}, .lens_radius = 0.5f};
  set_camera(constants, camera, 1, 1);
  CHECK(constants.lens_radius == 0.5f);
  CHECK(constants.focus_distance == 4);
  CHECK(constants.shutter == 0);
  camera.focus_distance = 2.5f;
  camera.motion = {0, 1, 0};
  set_camera(constants, camera, 1, 1);
  CHECK(constants.focus_distance == 2.5f);
  CHECK(constants.camera_motion == glm::vec3(0, 1, 0));
  CHECK(constants.shutter == 1);
  camera.motion = glm::vec3(0);
  set_camera(constants, camera, 1, 1);
  CHECK(constants.shutter == 0);
}

TEST_CASE("A number of a camera that is out of range is named") {
  RenderConstants constants{};
  const auto message = [&](const Camera& camera) -> std::string {
    try {
      set_camera(constants, camera, 1, 1);
    } catch (const tandem::Error& error) {
      return error.what();
    }
    return "";
  };
  const float nan = std::numeric_limits<float>::quiet_NaN(), infinite = std::numeric_limits<float>::infinity();
  for (const float value : {-1.0f, nan, infinite}) {
    CHECK(message({.lens_radius = value}).find("lens radius") != std::string::npos);
    CHECK(message({.focus_distance = value}).find("focus distance") != std::string::npos);
    CHECK(message({.kind = CameraKind::orthographic, .height = value}).find("height") != std::string::npos);
  }
  CHECK(message({.kind = CameraKind::orthographic, .height = 0}).find("height") != std::string::npos);
  CHECK(message({.motion = {0, nan, 0}}).find("motion") != std::string::npos);
  CHECK(message({.kind = CameraKind::orthographic, .lens_radius = 1}).find("perspective") != std::string::npos);
  CHECK(message({.kind = CameraKind::equirectangular, .vertical_fov = 0}).empty());
}

TEST_CASE("The automatic camera fits spheres into the picture, wherever they move") {
  Scene scene;
  scene.materials = {diffuse_material(glm::vec3(0.5f))};
  scene.spheres = {{.centre = {1, 2, 3}, .radius = 2}, {.centre = {9, 2, 3}, .radius = 0.5f, .motion = {0, 4, 0}}};
  for (const float aspect : {0.5f, 1.0f, 2.0f}) {
    RenderConstants constants{};
    set_camera(constants, automatic_camera(scene, aspect), static_cast<std::uint32_t>(100 * aspect), 100);
    const glm::dvec3 forward(constants.camera_forward);
    double extent = 0;
    for (const GpuSphere& sphere : scene.spheres)
      for (const glm::vec3& centre : {sphere.centre, sphere.centre + sphere.motion}) {
        const glm::dvec3 p = glm::dvec3(centre) - glm::dvec3(constants.camera_position);
        CHECK(glm::dot(p, forward) > double{sphere.radius});
        for (const glm::dvec3& axis : {glm::dvec3(constants.camera_right), glm::dvec3(constants.camera_up)}) {
          // Of the sphere's side that is nearest to the plane through the camera and this side of the picture; 1 is on
          // it.
          const double tangent = glm::length(axis);
          const double side = std::abs(glm::dot(p, axis)) / tangent + sphere.radius * std::sqrt(1 + tangent * tangent);
          extent = std::max(extent, side / (glm::dot(p, forward) * tangent));
        }
      }
    CHECK(extent < 1);
    CHECK(extent > 0.95);  // 1 / margin
  }
}

TEST_CASE("The automatic camera looks into a Cornell box through its open side") {
  for (const char* name : {"cornell_box.obj", "cornell_spheres.obj"}) {
    const Scene scene = load_scene(source_directory / "scenes" / name);
    const Camera camera = automatic_camera(scene, 1);
    CHECK(camera.position.z < -500);
    CHECK(camera.position.x == doctest::Approx(278));
    const View view = look(scene, camera, 256, 256);
    CHECK(view.all_in_front);
    CHECK(view.extent <= 1);
    CHECK(view.coverage > 0.9);  // 1 / margin^2, less what the grid of rays rounds off
  }
  const ScratchFolder folder;
  generate_spheres(3000, folder.path() / "spheres.obj");
  CHECK(automatic_camera(load_scene(folder.path() / "spheres.obj"), 1).position.z < -500);
}

TEST_CASE("A wide and a tall picture show all of the opening") {
  const Scene scene = load_scene(source_directory / "scenes" / "cornell_box.obj");
  CHECK(look(scene, automatic_camera(scene, 4), 400, 100).extent <= 1);
  CHECK(look(scene, automatic_camera(scene, 0.25f), 100, 400).extent <= 1);
}

TEST_CASE("The automatic camera is inside a closed room and outside of a solid") {
  const Scene room = load_text(box({-2, 0, -3}, {2, 3, 3}, true));
  const Camera inside = automatic_camera(room, 1);
  const Bounds bounds_of_room = bounds(room);
  for (int axis = 0; axis < 3; ++axis) {
    CHECK(inside.position[axis] > bounds_of_room.minimum[axis]);
    CHECK(inside.position[axis] < bounds_of_room.maximum[axis]);
  }
  CHECK(look(room, inside, 64, 64).coverage == doctest::Approx(1));
  // Along the longest side.
  CHECK(inside.position.z > 2);

  const Scene solid = load_text(box({-2, 0, -3}, {2, 3, 3}, false));
  const View view = look(solid, automatic_camera(solid, 1), 64, 64);
  CHECK(view.all_in_front);
  CHECK(view.extent <= 1);
  CHECK(view.extent > 0.9);
}

TEST_CASE("In a closed room the automatic camera is in none of the things") {
  const Scene scene = load_text(box({0, 0, 0}, {10, 4, 10}, true) + box({3, 0, 3}, {7, 3, 7}, false));
  const Camera camera = automatic_camera(scene, 1);
  const bool in_block = camera.position.x > 3 && camera.position.x < 7 && camera.position.y < 3 &&
                        camera.position.z > 3 && camera.position.z < 7;
  CHECK_FALSE(in_block);
  CHECK(look(scene, camera, 64, 64).coverage == doctest::Approx(1));
}

TEST_CASE("Flat and degenerate scenes have a camera too") {
  RenderConstants constants{};
  for (const char* text : {"v 0 0 0\nv 1 0 0\nv 0 0 1\nf 1 2 3\n", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
                           "v 5 5 5\nv 5 5 5\nv 5 5 5\nf 1 2 3\n", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n"}) {
    const Scene scene = load_text(text);
    CHECK_NOTHROW(set_camera(constants, automatic_camera(scene, 1), 10, 10));
  }
}

TEST_CASE("The automatic camera sees the scenes of the thesis") {
  if (!std::filesystem::is_directory(thesis_directory)) TANDEM_SKIP(thesis_directory.string() + " is not there");
  for (const std::filesystem::directory_entry& entry : std::filesystem::directory_iterator(thesis_directory)) {
    if (entry.path().extension() != ".obj") continue;
    const Scene scene = load_scene(entry.path());
    CAPTURE(entry.path().filename().string());
    const Camera camera = automatic_camera(scene, 1);
    const View view = look(scene, camera, 64, 64);
    CHECK(view.all_in_front);
    CHECK(view.extent <= 1);
    CHECK(view.extent > 0.9);
    const bool is_cornell_box = entry.path().filename().string().starts_with("cornell_box");
    // The lowest of the boxes fills 1.59 / 2.02 of the height of a square picture, less the margins.
    CHECK(view.coverage > (is_cornell_box ? 0.7 : 0.1));
    const bool opens_backwards = entry.path().stem() == "cornell_box_saturada";
    if (is_cornell_box) CHECK((camera.position.z < camera.target.z) == opens_backwards);
  }
}
