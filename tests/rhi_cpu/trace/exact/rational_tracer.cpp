#include "tests/rhi_cpu/trace/exact/rational_tracer.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <tuple>
#include <utility>

namespace tandem::test {
namespace {

using kernel::Hit;
using kernel::Ray;
using Point = std::array<mpq_class, 3>;

struct Meeting {
  mpq_class t, u, v;
  bool front_face = false;
};

Point point_of(const float* p) { return {mpq_class(p[0]), mpq_class(p[1]), mpq_class(p[2])}; }
Point difference(const Point& a, const Point& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
mpq_class inner(const Point& a, const Point& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Point outer(const Point& a, const Point& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

struct ObjectRay {
  Point origin, direction;
};

/// Solves transform * object = world by Cramer's rule; nothing when the transform is singular or not finite.
std::optional<ObjectRay> to_object(const Ray& ray, const rhi::InstanceDesc& instance) {
  Point columns[4];
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t column = 0; column < 4; ++column) {
      if (!std::isfinite(instance.object_to_world[row][column])) return std::nullopt;
      columns[column][row] = instance.object_to_world[row][column];
    }
  }
  const mpq_class determinant = inner(columns[0], outer(columns[1], columns[2]));
  if (determinant == 0) return std::nullopt;
  const auto solve = [&](const Point& b) -> Point {
    return {inner(b, outer(columns[1], columns[2])) / determinant,
            inner(columns[0], outer(b, columns[2])) / determinant,
            inner(columns[0], outer(columns[1], b)) / determinant};
  };
  return ObjectRay{solve(difference(point_of(ray.origin), columns[3])), solve(point_of(ray.direction))};
}

std::optional<Meeting> meet(const ObjectRay& ray, const Ray&, const Triangle& triangle) {
  for (const float coordinate : triangle) {
    if (!std::isfinite(coordinate)) return std::nullopt;
  }
  const Point a = point_of(&triangle[0]);
  const Point ab = difference(point_of(&triangle[3]), a);
  const Point ac = difference(point_of(&triangle[6]), a);
  const Point p = outer(ray.direction, ac);
  const mpq_class determinant = inner(ab, p);
  if (determinant == 0) return std::nullopt;
  const Point s = difference(ray.origin, a);
  const Point q = outer(s, ab);
  const mpq_class u = inner(s, p) / determinant;
  const mpq_class v = inner(ray.direction, q) / determinant;
  if (u < 0 || v < 0 || u + v > 1) return std::nullopt;
  return Meeting{
      .t = inner(ac, q) / determinant, .u = u, .v = v, .front_face = inner(ray.direction, outer(ab, ac)) < 0};
}

std::optional<Meeting> meet(const ObjectRay& object, const Ray& ray, const BoxExtent& box) {
  mpq_class first = ray.t_min;
  std::optional<mpq_class> last;
  if (std::isfinite(ray.t_max)) last = mpq_class(ray.t_max);
  for (std::size_t i = 0; i < 3; ++i) {
    if (!(box[i] <= box[i + 3])) return std::nullopt;
    mpq_class minimum = box[i], maximum = box[i + 3];
    if (object.direction[i] == 0) {
      if (object.origin[i] < minimum || object.origin[i] > maximum) return std::nullopt;
      continue;
    }
    mpq_class enter = (minimum - object.origin[i]) / object.direction[i];
    mpq_class exit = (maximum - object.origin[i]) / object.direction[i];
    if (exit < enter) std::swap(enter, exit);
    if (enter > first) first = enter;
    if (!last || exit < *last) last = exit;
  }
  if (last && first > *last) return std::nullopt;
  return Meeting{.t = first, .u = 0, .v = 0};
}

bool has_flag(const rhi::InstanceDesc& instance, rhi::InstanceFlags flag) {
  return rhi::has(static_cast<rhi::InstanceFlags>(instance.flags), flag);
}

bool opaque_of(const rhi::InstanceDesc& instance, const PrimitiveSet& set, std::uint32_t ray_flags) {
  if (ray_flags & kernel::ray_flag_opaque) return true;
  if (ray_flags & kernel::ray_flag_no_opaque) return false;
  if (has_flag(instance, rhi::InstanceFlags::force_opaque)) return true;
  if (has_flag(instance, rhi::InstanceFlags::force_no_opaque)) return false;
  return rhi::has(set.flags, rhi::GeometryFlags::opaque);
}

bool is_culled(const rhi::InstanceDesc& instance, std::uint32_t flags, const Hit& hit) {
  if (flags & (hit.is_box ? kernel::ray_flag_skip_aabbs : kernel::ray_flag_skip_triangles)) return true;
  if (hit.opaque && (flags & kernel::ray_flag_cull_opaque)) return true;
  if (!hit.opaque && (flags & kernel::ray_flag_cull_no_opaque)) return true;
  if (hit.is_box || has_flag(instance, rhi::InstanceFlags::triangle_facing_cull_disable)) return false;
  if (hit.front_face && (flags & kernel::ray_flag_cull_front_facing_triangles)) return true;
  return !hit.front_face && (flags & kernel::ray_flag_cull_back_facing_triangles);
}

}  // namespace

float nearest_float(const mpq_class& value) {
  constexpr float infinity = std::numeric_limits<float>::infinity();
  const mpq_class magnitude = abs(value);
  // The largest float that is not above it, by bisection: floats order like their bits.
  std::uint32_t low = 0, high = 0x7F800000;
  while (high - low > 1) {
    const std::uint32_t middle = low + (high - low) / 2;
    (mpq_class(std::bit_cast<float>(middle)) <= magnitude ? low : high) = middle;
  }
  const mpq_class below = std::bit_cast<float>(low);
  const mpq_class above = high == 0x7F800000 ? mpq_class(0x1p128) : mpq_class(std::bit_cast<float>(high));
  const int side = cmp(mpq_class(magnitude - below), mpq_class(above - magnitude));
  const bool up = side > 0 || (side == 0 && low % 2 == 1);
  const float nearest = up ? (high == 0x7F800000 ? infinity : std::bit_cast<float>(high)) : std::bit_cast<float>(low);
  return value < 0 && nearest > 0 ? -nearest : nearest;
}

rhi::InstanceDesc instance_of(std::size_t index) {
  rhi::InstanceDesc instance{};
  for (int i = 0; i < 3; ++i) instance.object_to_world[i][i] = 1;
  instance.mask = 0xFF;
  instance.blas_address = index + 1;
  return instance;
}

std::vector<cpu::GeometryInput> inputs_of(const std::vector<PrimitiveSet>& sets) {
  std::vector<cpu::GeometryInput> inputs;
  for (const PrimitiveSet& set : sets) {
    if (const auto* triangles = std::get_if<std::vector<Triangle>>(&set.primitives)) {
      const auto count = static_cast<std::uint32_t>(triangles->size());
      inputs.emplace_back(cpu::TriangleInput{.vertices = std::as_bytes(std::span(*triangles)),
                                             .vertex_count = 3 * count,
                                             .triangle_count = count,
                                             .flags = set.flags});
    } else {
      const auto& boxes = std::get<std::vector<BoxExtent>>(set.primitives);
      inputs.emplace_back(cpu::BoxInput{.boxes = std::as_bytes(std::span(boxes)),
                                        .box_count = static_cast<std::uint32_t>(boxes.size()),
                                        .flags = set.flags});
    }
  }
  return inputs;
}

BuiltScene build(const RationalScene& scene) {
  std::vector<cpu::exact::BottomLevel> bottom_levels;
  for (const auto& sets : scene.bottom_levels) {
    bottom_levels.push_back(cpu::exact::BottomLevel::build(inputs_of(sets), "scene"));
  }
  auto top_level = cpu::exact::TopLevel::build(
      scene.instances, [&](std::uint64_t address) { return &bottom_levels.at(address - 1); }, "scene");
  return {std::move(bottom_levels), std::move(top_level)};
}

std::vector<Hit> all_hits(const RationalScene& scene, const Ray& ray) {
  std::vector<Hit> hits;
  for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
    const rhi::InstanceDesc& instance = scene.instances[i];
    if ((instance.mask & ray.mask) == 0 || instance.blas_address == 0) continue;
    const std::optional<ObjectRay> object = to_object(ray, instance);
    if (!object) continue;
    const std::vector<PrimitiveSet>& sets = scene.bottom_levels[instance.blas_address - 1];
    for (std::uint32_t g = 0; g < sets.size(); ++g) {
      std::visit(
          [&](const auto& primitives) {
            for (std::uint32_t p = 0; p < primitives.size(); ++p) {
              const std::optional<Meeting> meeting = meet(*object, ray, primitives[p]);
              if (!meeting) continue;
              Hit hit{.t = nearest_float(meeting->t),
                      .barycentrics = {nearest_float(meeting->u), nearest_float(meeting->v)},
                      .instance_index = i,
                      .geometry_index = g,
                      .primitive_index = p,
                      .front_face = false,
                      .opaque = opaque_of(instance, sets[g], ray.flags),
                      .is_box = std::holds_alternative<std::vector<BoxExtent>>(sets[g].primitives)};
              if (!hit.is_box) {
                hit.front_face = meeting->front_face != has_flag(instance, rhi::InstanceFlags::triangle_flip_facing);
                if (!(hit.t > ray.t_min && hit.t < ray.t_max)) continue;
              }
              if (std::isfinite(hit.t) && !is_culled(instance, ray.flags, hit)) hits.push_back(hit);
            }
          },
          sets[g].primitives);
    }
  }
  const auto order = [](const Hit& hit) {
    return std::make_tuple(hit.t, hit.instance_index, hit.geometry_index, hit.primitive_index);
  };
  std::sort(hits.begin(), hits.end(), [&](const Hit& a, const Hit& b) { return order(a) < order(b); });
  return hits;
}

}  // namespace tandem::test
