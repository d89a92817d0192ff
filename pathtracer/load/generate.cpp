#include "pathtracer/load/generate.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "base/atomic_file.hpp"
#include "base/error.hpp"

namespace tandem::pathtracer {
namespace {

/// Walls and light of scenes/cornell_box.obj, in millimetres.
constexpr std::string_view room = R"(v 552.8 0 0
v 0 0 0
v 0 0 559.2
v 549.6 0 559.2
v 556 548.8 0
v 0 548.8 0
v 0 548.8 559.2
v 556 548.8 559.2
v 343 548.8 227
v 213 548.8 227
v 213 548.8 332
v 343 548.8 332
usemtl white
f 1 2 3 4
f 4 3 7 8
f 5 8 12 9
f 8 7 11 12
f 7 6 10 11
f 6 5 9 10
usemtl green
f 3 2 6 7
usemtl red
f 1 4 8 5
usemtl light
f 9 12 11 10
)";
constexpr std::uint64_t room_vertices = 12;
constexpr std::uint64_t room_triangles = 18;

constexpr std::string_view materials = R"(newmtl white
Kd 0.725 0.71 0.68
newmtl green
Kd 0.14 0.45 0.091
newmtl red
Kd 0.63 0.065 0.05
newmtl light
Kd 0.78 0.78 0.78
Ke 17 12 4
newmtl sphere0
Kd 0.725 0.71 0.68
newmtl sphere1
Kd 0.2 0.4 0.7
newmtl sphere2
Kd 0.75 0.6 0.2
newmtl sphere3
Kd 0.3 0.6 0.35
)";
constexpr std::uint64_t sphere_materials = 4;

constexpr std::uint64_t grid = 3;  ///< spheres along each axis
/// The grid ends well below the ceiling: a sphere close to the light would leave the room dark.
constexpr glm::dvec3 grid_size{549.6, 420, 559.2};
constexpr double radius = 58;
/// Largest relative displacement: 58 * 1.18 stays inside a cell of the grid (420 / 3 / 2).
constexpr double displacement = 0.18;

/// A well-mixed number in [0, 1) (the finaliser of MurmurHash3).
double hashed_unit(std::uint32_t key) {
  key ^= key >> 16;
  key *= 0x85ebca6bu;
  key ^= key >> 13;
  key *= 0xc2b2ae35u;
  key ^= key >> 16;
  return key / 4294967296.0;
}

/// Displaced distance from the centre of sphere `sphere` into the unit direction: plane waves of three scales.
double displaced_radius(std::uint32_t sphere, const glm::dvec3& direction) {
  constexpr std::array<double, 3> frequencies = {4, 11, 37};
  constexpr std::array<double, 3> amplitudes = {0.6, 0.3, 0.1};
  double height = 0;
  for (std::uint32_t octave = 0; octave < 3; ++octave) {
    const std::uint32_t key = (sphere * 3 + octave) * 4 + 1;
    const glm::dvec3 wave(hashed_unit(key) - 0.5, hashed_unit(key + 1) - 0.5, hashed_unit(key + 2) - 0.5);
    const double phase = 6.283185307179586 * hashed_unit(key + 3);
    height += amplitudes[octave] * std::sin(frequencies[octave] * 2 * glm::dot(wave, direction) + phase);
  }
  return radius * (1 + displacement * height);
}

/// An octahedron with each face divided into subdivisions^2 triangles, pushed out to a sphere. Its vertices form rings
/// around the y axis: 1, 4, 8, ..., 4 m, ..., 8, 4, 1.
struct SphereGrid {
  std::uint64_t subdivisions;

  std::uint64_t ring_count() const { return 2 * subdivisions + 1; }
  std::uint64_t quadrant_size(std::uint64_t ring) const { return std::min(ring, 2 * subdivisions - ring); }
  std::uint64_t ring_size(std::uint64_t ring) const { return std::max<std::uint64_t>(1, 4 * quadrant_size(ring)); }
  std::uint64_t vertex_count() const { return 4 * subdivisions * subdivisions + 2; }

  glm::dvec3 direction(std::uint64_t ring, std::uint64_t index) const {
    constexpr std::array<glm::dvec3, 5> axes = {glm::dvec3(1, 0, 0), glm::dvec3(0, 0, -1), glm::dvec3(-1, 0, 0),
                                                glm::dvec3(0, 0, 1), glm::dvec3(1, 0, 0)};
    const double y = double(subdivisions) - double(ring);
    const std::uint64_t size = quadrant_size(ring);
    if (size == 0) return {0, y > 0 ? 1 : -1, 0};
    const std::uint64_t quadrant = index / size;
    const double along = double(index % size);
    return glm::normalize(axes[quadrant] * (double(size) - along) + axes[quadrant + 1] * along + glm::dvec3(0, y, 0));
  }
};

using Output = std::back_insert_iterator<fmt::memory_buffer>;

/// Calls triangle(a, b, c) with vertex numbers from `first` on, counter-clockwise seen from outside.
template <typename Emit>
void for_each_triangle(const SphereGrid& sphere, std::uint64_t first, const Emit& triangle) {
  std::uint64_t ring_start = first;
  for (std::uint64_t ring = 0; ring + 1 < sphere.ring_count(); ++ring) {
    const std::uint64_t next_start = ring_start + sphere.ring_size(ring);
    const bool widening = ring < sphere.subdivisions;
    // `wide` is the ring of the two with more vertices; `narrow` lies towards its pole.
    const std::uint64_t wide = widening ? ring + 1 : ring;
    const std::uint64_t narrow = widening ? ring : ring + 1;
    const std::uint64_t wide_start = widening ? next_start : ring_start;
    const std::uint64_t narrow_start = widening ? ring_start : next_start;
    const std::uint64_t wide_quadrant = sphere.quadrant_size(wide);
    const std::uint64_t narrow_quadrant = sphere.quadrant_size(narrow);
    const auto in_wide = [&](std::uint64_t i) { return wide_start + i % sphere.ring_size(wide); };
    const auto in_narrow = [&](std::uint64_t i) { return narrow_start + i % sphere.ring_size(narrow); };
    const auto oriented = [&](std::uint64_t a, std::uint64_t b, std::uint64_t c) {
      widening ? triangle(a, b, c) : triangle(a, c, b);
    };
    for (std::uint64_t quadrant = 0; quadrant < 4; ++quadrant)
      for (std::uint64_t k = 0; k < wide_quadrant; ++k) {
        const std::uint64_t outer = quadrant * wide_quadrant + k;
        const std::uint64_t inner = quadrant * narrow_quadrant + k;
        oriented(in_narrow(inner), in_wide(outer), in_wide(outer + 1));
        if (k < narrow_quadrant) oriented(in_narrow(inner), in_wide(outer + 1), in_narrow(inner + 1));
      }
    ring_start = next_start;
  }
}

/// The subdivisions of each sphere: nearly equal, and as near to `triangle_count` in all as that can be.
std::vector<std::uint64_t> plan_spheres(std::uint64_t triangle_count) {
  constexpr std::uint64_t octahedron = 8;
  constexpr std::uint64_t triangles_of_a_round_sphere = 4 * octahedron;
  const std::uint64_t available = triangle_count - room_triangles;
  const std::uint64_t count = std::clamp<std::uint64_t>(available / triangles_of_a_round_sphere, 1, grid * grid * grid);
  std::uint64_t subdivisions =
      std::max<std::uint64_t>(1, static_cast<std::uint64_t>(std::sqrt(double(available) / double(octahedron * count))));
  const std::uint64_t coarse = octahedron * subdivisions * subdivisions * count;
  const std::uint64_t step = octahedron * (2 * subdivisions + 1);
  const std::uint64_t finer = available > coarse ? std::min(count, (available - coarse + step / 2) / step) : 0;
  std::vector<std::uint64_t> plan(count, subdivisions);
  std::fill_n(plan.begin(), finer, subdivisions + 1);
  return plan;
}

void write(std::ofstream& file, const AtomicFile& target, std::string_view text) {
  if (!file.write(text.data(), static_cast<std::streamsize>(text.size())).flush())
    throw Error(fmt::format("cannot write '{}': the disk may be full", target.temporary_path().string()));
}

glm::dvec3 sphere_centre(std::uint64_t sphere) {
  const glm::dvec3 cell = grid_size / double(grid);
  const glm::dvec3 place(double(sphere % grid), double(sphere / (grid * grid)), double(sphere / grid % grid));
  return cell * (place + 0.5);
}

}  // namespace

std::uint64_t generate_spheres(std::uint64_t triangle_count, const std::filesystem::path& obj_path,
                               const std::function<bool(double fraction)>& progress) {
  if (triangle_count < minimum_generated_triangles || triangle_count > maximum_generated_triangles)
    throw Error(fmt::format("{} triangles cannot be generated, only {} to {}", triangle_count,
                            minimum_generated_triangles, maximum_generated_triangles));
  if (obj_path.extension() != ".obj")
    throw Error(fmt::format("cannot write '{}': the name of a generated scene ends in .obj", obj_path.string()));
  std::filesystem::path mtl_path = obj_path;
  mtl_path.replace_extension(".mtl");
  AtomicFile obj_target(obj_path);
  AtomicFile mtl_target(mtl_path);
  std::ofstream mtl_file(mtl_target.temporary_path(), std::ios::binary);
  write(mtl_file, mtl_target, materials);

  const std::vector<std::uint64_t> plan = plan_spheres(triangle_count);
  std::ofstream obj_file(obj_target.temporary_path(), std::ios::binary);
  write(obj_file, obj_target,
        fmt::format("# Cornell box with {} displaced spheres, made by tandem generate. Millimetres, y upwards.\n"
                    "mtllib {}\n{}",
                    plan.size(), mtl_path.filename().string(), room));
  std::uint64_t written = room_triangles;
  std::uint64_t first_vertex = room_vertices + 1;
  for (std::uint32_t index = 0; index < plan.size(); ++index) {
    if (progress && !progress(double(index) / double(plan.size()))) return 0;
    const SphereGrid sphere{plan[index]};
    const glm::dvec3 centre = sphere_centre(index);
    fmt::memory_buffer text;
    Output output(text);
    fmt::format_to(output, "usemtl sphere{}\n", (index + index / grid) % sphere_materials);
    for (std::uint64_t ring = 0; ring < sphere.ring_count(); ++ring)
      for (std::uint64_t i = 0; i < sphere.ring_size(ring); ++i) {
        const glm::dvec3 direction = sphere.direction(ring, i);
        const glm::dvec3 vertex = centre + direction * displaced_radius(index, direction);
        fmt::format_to(output, "v {:.4f} {:.4f} {:.4f}\n", vertex.x, vertex.y, vertex.z);
      }
    for_each_triangle(sphere, first_vertex, [&](std::uint64_t a, std::uint64_t b, std::uint64_t c) {
      fmt::format_to(output, "f {} {} {}\n", a, b, c);
      ++written;
    });
    first_vertex += sphere.vertex_count();
    write(obj_file, obj_target, {text.data(), text.size()});
  }
  obj_file.close();
  mtl_file.close();
  mtl_target.commit();
  obj_target.commit();
  return written;
}

}  // namespace tandem::pathtracer
