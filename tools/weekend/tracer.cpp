#include "tools/weekend/tracer.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <numbers>

#include <glm/geometric.hpp>

#include "base/error.hpp"
#include "tools/weekend/frame.hpp"

namespace tandem::weekend {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Where a path scatters.
struct Vertex {
  const Hit& hit;
  Frame frame;
  glm::dvec3 wo;  ///< in the frame
};

/// The image of a direction in the true surface.
glm::dvec3 folded(const Hit& hit, const glm::dvec3& direction) {
  return direction - 2 * glm::dot(direction, hit.normal) * hit.normal;
}

bool folds(const Hit& hit) { return hit.material->folds() && hit.shading_normal != hit.normal; }

/// The BSDF times the cosine, and the density, towards a direction in world space. Interpolated normals can send light
/// below the true surface: a diffuse material loses it, a glossy one mirrors it back.
Scattering value(const Vertex& vertex, const glm::dvec3& direction) {
  if (!(glm::dot(direction, vertex.hit.normal) > 0)) return {};
  Scattering sum = vertex.hit.material->value(vertex.wo, vertex.frame.to_local(direction), vertex.hit.uv, false);
  if (!folds(vertex.hit)) return sum;
  const glm::dvec3 image = vertex.frame.to_local(folded(vertex.hit, direction));
  const Scattering back = vertex.hit.material->value(vertex.wo, image, vertex.hit.uv, true);
  return {.value = sum.value + back.value, .density = sum.density + back.density};
}

class Path {
 public:
  Path(const World& world, Random& random) : world_(world), random_(random) {}

  /// Radiance that comes back along the ray, by recursion as in the books. `depth`: segments left, this one included.
  glm::dvec3 color(const Ray& ray, std::uint32_t depth) {
    ++rays;
    const std::optional<Hit> hit = world_.objects->hit(ray, world_.nearest, infinity, random_);
    if (!hit) return world_.background;
    const glm::dvec3 emitted = hit->material->emission(hit->uv);
    if (depth == 1) return emitted;
    if (!hit->material->has_density()) return emitted + specular(*hit, ray, depth);
    const Frame frame(hit->shading_normal);
    const Vertex vertex{.hit = *hit, .frame = frame, .wo = frame.to_local(-ray.direction)};
    return emitted + punctual(vertex) + scattered(vertex, depth);
  }

  std::uint64_t rays = 0;

 private:
  glm::dvec3 specular(const Hit& hit, const Ray& ray, std::uint32_t depth) {
    // Where the shading normal sends the ray to the wrong side, the true one decides.
    for (const glm::dvec3& normal : {hit.shading_normal, hit.normal}) {
      const Frame frame(normal);
      const std::optional<Scattered> next =
          hit.material->scatter(frame.to_local(-ray.direction), hit.outside, hit.uv, random_);
      if (!next) return glm::dvec3(0);
      const glm::dvec3 direction = glm::normalize(frame.to_world(next->direction));
      const double side = glm::dot(direction, hit.normal);
      if (next->transmitted ? side < 0 : side > 0)
        return next->weight * color({.origin = hit.position, .direction = direction}, depth - 1);
    }
    return glm::dvec3(0);
  }

  /// Light that the mixture finds.
  glm::dvec3 scattered(const Vertex& vertex, std::uint32_t depth) {
    const bool has_lights = !world_.lights.empty();
    glm::dvec3 direction;
    if (has_lights && random_.uniform() < 0.5) {
      const auto count = static_cast<double>(world_.lights.size());
      const auto index = static_cast<std::size_t>(random_.uniform() * count);
      direction = world_.lights[index]->sample_direction(vertex.hit.position, random_);
      if (!(glm::length(direction) > 0)) return glm::dvec3(0);
      direction = glm::normalize(direction);
    } else {
      const std::optional<Scattered> next =
          vertex.hit.material->scatter(vertex.wo, vertex.hit.outside, vertex.hit.uv, random_);
      if (!next) return glm::dvec3(0);
      direction = glm::normalize(vertex.frame.to_world(next->direction));
      if (folds(vertex.hit) && glm::dot(direction, vertex.hit.normal) < 0) direction = folded(vertex.hit, direction);
    }
    const Scattering found = value(vertex, direction);
    if (found.value == glm::dvec3(0)) return glm::dvec3(0);
    const Ray ray{.origin = vertex.hit.position, .direction = direction};
    double density = found.density;
    if (has_lights) {
      double towards_lights = 0;
      for (const std::shared_ptr<const Hittable>& light : world_.lights)
        towards_lights += light->direction_density(ray);
      density = 0.5 * density + 0.5 * towards_lights / static_cast<double>(world_.lights.size());
    }
    if (!(density > 0)) return glm::dvec3(0);
    return found.value / density * color(ray, depth - 1);
  }

  /// Light without extent: seen by a shadow ray to each.
  glm::dvec3 punctual(const Vertex& vertex) {
    glm::dvec3 sum(0);
    for (const pathtracer::PunctualLight& light : world_.punctual) {
      glm::dvec3 direction = -glm::normalize(glm::dvec3(light.direction));
      double distance = infinity;
      double falloff = 1;
      if (light.kind != pathtracer::LightKind::directional) {
        const glm::dvec3 to_light = glm::dvec3(light.position) - vertex.hit.position;
        distance = glm::length(to_light);
        if (!(distance > 0)) continue;
        direction = to_light / distance;
        falloff = spot(light, direction) / (distance * distance);
      }
      const Scattering found = value(vertex, direction);
      if (found.value == glm::dvec3(0) || falloff == 0) continue;
      ++rays;
      const Ray ray{.origin = vertex.hit.position, .direction = direction};
      if (!world_.objects->hit(ray, world_.nearest, distance, random_))
        sum += found.value * falloff * glm::dvec3(light.radiance);
    }
    return sum;
  }

  /// glTF's KHR_lights_punctual.
  static double spot(const pathtracer::PunctualLight& light, const glm::dvec3& to_light) {
    if (light.kind != pathtracer::LightKind::spot) return 1;
    const auto cosine_of = [](double degrees) { return std::cos(degrees * std::numbers::pi / 180); };
    const double cosine = -glm::dot(to_light, glm::normalize(glm::dvec3(light.direction)));
    const double inner = cosine_of(light.inner_angle);
    const double outer = cosine_of(light.outer_angle);
    const double ramp = std::clamp((cosine - outer) / (inner - outer), 0.0, 1.0);
    return ramp * ramp;
  }

  const World& world_;
  Random& random_;
};

/// A pinhole: position, and the vectors from the centre of the film, at distance 1, to its right and upper edge.
struct Film {
  glm::dvec3 position, forward, right, up;
};

Film film_of(const pathtracer::Camera& camera, const TraceSettings& settings) {
  if (camera.kind != pathtracer::CameraKind::perspective || camera.lens_radius != 0 || camera.motion != glm::vec3(0))
    throw Error("the baseline has no camera but a pinhole that stands still");
  const double half_height = std::tan(double{camera.vertical_fov} * std::numbers::pi / 360);
  const glm::dvec3 forward = glm::normalize(glm::dvec3(camera.target) - glm::dvec3(camera.position));
  const glm::dvec3 right = glm::normalize(glm::cross(forward, glm::dvec3(camera.up)));
  return {.position = camera.position,
          .forward = forward,
          .right = right * (half_height * settings.width / settings.height),
          .up = glm::cross(right, forward) * half_height};
}

}  // namespace

Traced trace(const World& world, const pathtracer::Camera& camera, const TraceSettings& settings,
             const Progress& progress) {
  const Film film = film_of(camera, settings);
  Traced result;
  result.image = {.width = settings.width, .height = settings.height, .pixels = {}};
  result.image.pixels.reserve(std::size_t{settings.width} * settings.height);
  const auto start = std::chrono::steady_clock::now();
  Random random(settings.seed);
  Path path(world, random);
  for (std::uint32_t y = 0; y < settings.height; ++y) {
    if (progress && !progress(static_cast<double>(y) / settings.height)) throw Cancelled();
    for (std::uint32_t x = 0; x < settings.width; ++x) {
      glm::dvec3 sum(0);
      for (std::uint32_t sample = 0; sample < settings.samples; ++sample) {
        const double u = 2 * (x + random.uniform()) / settings.width - 1;
        const double v = 1 - 2 * (y + random.uniform()) / settings.height;
        const Ray ray{.origin = film.position,
                      .direction = glm::normalize(film.forward + u * film.right + v * film.up)};
        sum += path.color(ray, settings.max_depth);
      }
      result.image.pixels.emplace_back(sum / static_cast<double>(settings.samples));
    }
  }
  result.rays = path.rays;
  result.milliseconds = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  return result;
}

}  // namespace tandem::weekend
