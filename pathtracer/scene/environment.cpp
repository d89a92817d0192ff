#include "pathtracer/scene/environment.hpp"

#include <cmath>
#include <cstddef>
#include <numbers>
#include <numeric>

#include <fmt/format.h>
#include <glm/trigonometric.hpp>

#include "base/error.hpp"
#include "pathtracer/scene/alias_table.hpp"
#include "pathtracer/scene/lights.hpp"
#include "pathtracer/scene/texel.hpp"

namespace tandem::pathtracer {
namespace {

constexpr double pi = std::numbers::pi;

struct Grid {
  std::uint32_t width = 1;
  std::uint32_t height = 1;

  /// Of a texel in that row: its width in radians times the difference of the cosines of its edges.
  double solid_angle(std::uint32_t row) const {
    const double middle = pi * (row + 0.5) / height;
    return 2 * pi / width * 2 * std::sin(middle) * std::sin(0.5 * pi / height);
  }
};

const TextureImage& map_of(const Scene& scene) {
  const Texture& texture = scene.textures[scene.environment->texture];
  const GpuTexture whole;
  if (texture.gpu.kind != TextureKind::image || texture.gpu.u_row != whole.u_row || texture.gpu.v_row != whole.v_row)
    throw Error(fmt::format("the environment of {} is not a whole image", scene.name));
  return scene.images[texture.image];
}

Grid grid_of(const Scene& scene) {
  if (scene.environment->texture == no_texture) return {};
  const TextureImage& map = map_of(scene);
  return {.width = map.width, .height = map.height};
}

/// The mean luminance of each texel with the texture's filter: a linear one gives a texel an eighth of each neighbour,
/// in either direction. The map repeats in azimuth and ends at the poles.
std::vector<double> filtered_luminances(const Scene& scene) {
  const Environment& environment = *scene.environment;
  if (environment.texture == no_texture) return {luminance(environment.radiance)};
  const TextureImage& map = map_of(scene);
  const GpuTexture& texture = scene.textures[environment.texture].gpu;
  const Grid grid = grid_of(scene);
  const std::size_t count = std::size_t{grid.width} * grid.height;
  std::vector<double> luminances(count);
  for (std::size_t i = 0; i < count; ++i)
    luminances[i] = luminance(glm::vec3(texel_at(map, i)) * texture.color_a * environment.radiance);
  if (texture.filter == TextureFilter::nearest) return luminances;

  const auto blurred = [](double before, double self, double after) {
    return 0.125 * before + 0.75 * self + 0.125 * after;
  };
  std::vector<double> rows(count);
  for (std::uint32_t y = 0; y < grid.height; ++y)
    for (std::uint32_t x = 0; x < grid.width; ++x) {
      const auto at = [&](std::uint32_t column) { return luminances[std::size_t{y} * grid.width + column]; };
      rows[std::size_t{y} * grid.width + x] =
          blurred(at((x + grid.width - 1) % grid.width), at(x), at((x + 1) % grid.width));
    }
  for (std::uint32_t y = 0; y < grid.height; ++y)
    for (std::uint32_t x = 0; x < grid.width; ++x) {
      const auto at = [&](std::uint32_t row) { return rows[std::size_t{row} * grid.width + x]; };
      luminances[std::size_t{y} * grid.width + x] =
          blurred(at(y == 0 ? 0 : y - 1), at(y), at(y + 1 == grid.height ? y : y + 1));
    }
  return luminances;
}

/// Times the solid angle.
std::vector<double> cell_weights(const Scene& scene) {
  const Grid grid = grid_of(scene);
  std::vector<double> weights = filtered_luminances(scene);
  for (std::size_t i = 0; i < weights.size(); ++i)
    weights[i] *= grid.solid_angle(static_cast<std::uint32_t>(i / grid.width));
  return weights;
}

}  // namespace

double environment_luminance(const Scene& scene) {
  if (!scene.environment) return 0;
  const std::vector<double> weights = cell_weights(scene);
  return std::accumulate(weights.begin(), weights.end(), 0.0);
}

std::vector<GpuEnvironmentCell> environment_cells(const Scene& scene) {
  if (!scene.environment) return {};
  const Grid grid = grid_of(scene);
  const std::vector<double> weights = cell_weights(scene);
  if (!(std::accumulate(weights.begin(), weights.end(), 0.0) > 0)) return {};
  const std::vector<AliasEntry> table = build_alias_table(weights);
  const std::vector<double> probabilities = alias_probabilities(table);
  std::vector<GpuEnvironmentCell> cells;
  cells.reserve(table.size());
  for (std::size_t i = 0; i < table.size(); ++i) {
    const double density = probabilities[i] / grid.solid_angle(static_cast<std::uint32_t>(i / grid.width));
    cells.push_back({.threshold = table[i].threshold, .alias = table[i].alias, .density = static_cast<float>(density)});
  }
  return cells;
}

void set_environment_frame(RenderConstants& constants, const Environment& environment) {
  const double angle = glm::radians(double{environment.rotation});
  const double cosine = std::cos(angle);
  const double sine = std::sin(angle);
  constants.environment_right = glm::vec3(glm::dvec3(cosine, 0, -sine));
  constants.environment_up = {0, 1, 0};
  constants.environment_forward = glm::vec3(glm::dvec3(-sine, 0, -cosine));
}

}  // namespace tandem::pathtracer
