#include <doctest/doctest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <numbers>
#include <vector>

#include <glm/geometric.hpp>

#include "base/statistics/means.hpp"
#include "pathtracer/scene/environment.hpp"
#include "tests/shaders/light_samples.hpp"
#include "tests/shaders/random_source.hpp"
#include "tests/shaders/scene_kernel.hpp"
#include "tests/support/device_test.hpp"
#include "tests/support/statistics/chi_square.hpp"

using namespace tandem;
using namespace tandem::pathtracer;
using tandem::test::irradiances;
using tandem::test::light_samples;
using tandem::test::LightSample;

namespace {

constexpr double pi = std::numbers::pi;
constexpr std::size_t count = 200000;

// Each statistical check fails by chance once in 100,000 (fixed seeds: if it passes, it always does).
constexpr double least_p_value = 1e-5;
constexpr double most_standard_errors = 4.4;

constexpr std::uint32_t width = 12, height = 6;

/// Mostly dim, a fifth of it black, with a texel a thousand times as bright as the others: in the middle, or at a pole.
std::vector<float> levels(std::size_t hot) {
  std::vector<float> values;
  for (std::uint32_t i = 0; i < width * height; ++i)
    values.push_back(i % 5 == 0 ? 0.0f : static_cast<float>(1 + i % 3));
  values[hot] = 2000;
  return values;
}

constexpr std::size_t hot_texels[] = {width * 2 + 7, 4, width * 5 + 9};

Scene scene_with_map(const std::vector<float>& texels, TextureFilter filter) {
  Scene scene;
  scene.name = "test";
  scene.positions = {{-1, -5, 0}, {1, -5, 0}, {0, -5, 1}};
  scene.normals.resize(3);
  scene.triangles.push_back({{0, 1, 2}, 0});
  scene.materials.push_back(diffuse_material(glm::vec3(0.5f)));
  TextureImage image{.name = "map", .format = TexelFormat::float32, .width = width, .height = height, .texels = {}};
  std::vector<float> values;
  for (const float texel : texels) values.insert(values.end(), {texel, texel, texel, 1.0f});
  image.texels.resize(values.size() * sizeof(float));
  std::memcpy(image.texels.data(), values.data(), image.texels.size());
  scene.environment = Environment{.texture = add_texture(scene, image), .radiance = glm::vec3(0.5f), .rotation = 25};
  scene.textures.back().gpu.filter = filter;
  return scene;
}

struct Arriving {
  double radiance;
  double density;
};

/// What the shader says of directions.
std::vector<Arriving> arriving(rhi::Device& device, const Scene& scene, const std::vector<glm::dvec3>& directions) {
  const test::FunctionKernel kernel = {.includes = "#include \"light/light.glsl\"",
                                       .body = R"(
    vec3 direction = vec3(input_float(0), input_float(1), input_float(2));
    output_float(0, environment_radiance(direction).x);
    output_float(1, environment_density(direction));)",
                                       .input_count = 3,
                                       .output_count = 2};
  std::vector<std::uint32_t> inputs;
  for (const glm::dvec3& direction : directions)
    for (int k = 0; k < 3; ++k) inputs.push_back(std::bit_cast<std::uint32_t>(static_cast<float>(direction[k])));
  const std::vector<std::uint32_t> bits = test::run_bits(device, scene, kernel, inputs);
  std::vector<Arriving> result;
  for (std::size_t i = 0; i < bits.size(); i += 2)
    result.push_back({std::bit_cast<float>(bits[i]), std::bit_cast<float>(bits[i + 1])});
  return result;
}

/// The direction that is seen at a place of the map, x from its left and y from its upper edge in texels.
glm::dvec3 direction_at(const Scene& scene, double x, double y) {
  const double azimuth = 2 * pi * x / width - pi - scene.environment->rotation * pi / 180;
  const double polar = pi * y / height;
  return {std::sin(polar) * std::sin(azimuth), std::cos(polar), -std::sin(polar) * std::cos(azimuth)};
}

/// Where the map shows a direction, in texels.
struct Place {
  double x;
  double y;
};
Place place_of(const Scene& scene, const glm::dvec3& direction) {
  const double azimuth = std::atan2(direction.x, -direction.z) + scene.environment->rotation * pi / 180;
  const double turns = azimuth / (2 * pi) + 0.5;
  return {width * (turns - std::floor(turns)),
          height / pi * std::atan2(std::hypot(direction.x, direction.z), direction.y)};
}

double solid_angle(std::size_t row) {
  return 2 * pi / width * (std::cos(pi * double(row) / height) - std::cos(pi * double(row + 1) / height));
}

}  // namespace

TANDEM_DEVICE_TEST("The environment shows the map: its centre ahead, its upper edge above") {
  std::vector<float> texels;
  for (std::uint32_t i = 0; i < width * height; ++i) texels.push_back(static_cast<float>(i));
  for (const TextureFilter filter : {TextureFilter::nearest, TextureFilter::linear}) {
    const Scene scene = scene_with_map(texels, filter);
    std::vector<glm::dvec3> directions;
    for (std::uint32_t i = 0; i < width * height; ++i)
      directions.push_back(direction_at(scene, i % width + 0.5, i / width + 0.5));
    const std::vector<Arriving> seen = arriving(device, scene, directions);
    // The centres of texels have their own values; those of coordinates have errors of some 1e-7 of the map.
    for (std::size_t i = 0; i < seen.size(); ++i)
      CHECK(seen[i].radiance == doctest::Approx(0.5 * double(i)).epsilon(2e-5));
  }
  const Scene scene = scene_with_map(texels, TextureFilter::linear);
  // Between texels; around the back, where the right edge meets the left one; and at the poles.
  const std::vector<Arriving> seen =
      arriving(device, scene,
               {direction_at(scene, 3.0, 2.5), direction_at(scene, 12.0, 2.5), direction_at(scene, 3.5, 3.0),
                direction_at(scene, 3.5, 0.01), direction_at(scene, 3.5, 5.99)});
  const double expected[] = {26.5, (24 + 35) / 2.0, (27 + 39) / 2.0, 3, 63};
  for (std::size_t i = 0; i < seen.size(); ++i)
    CHECK(seen[i].radiance == doctest::Approx(0.5 * expected[i]).epsilon(2e-5));
}

TANDEM_DEVICE_TEST("Texels of an environment are chosen by their luminance and solid angle, and filled uniformly") {
  for (const TextureFilter filter : {TextureFilter::nearest, TextureFilter::linear})
    for (const std::size_t hot : hot_texels) {
      const Scene scene = scene_with_map(levels(hot), filter);
      CAPTURE(hot);
      const std::vector<GpuEnvironmentCell> cells = environment_cells(scene);
      std::vector<double> expected;
      for (std::size_t i = 0; i < cells.size(); ++i) expected.push_back(cells[i].density * solid_angle(i / width));
      const std::vector<LightSample> samples = light_samples(device, scene, glm::vec3(1, 2, 3), count);
      std::vector<double> counts(cells.size(), 0.0);
      std::vector<double> within(10 * 10, 0.0);
      std::size_t different = 0;
      double worst_length = 0;
      for (const LightSample& sample : samples) {
        REQUIRE(sample.infinite);
        different += sample.density != sample.scattering_density;
        worst_length = std::max(worst_length, std::abs(glm::length(glm::dvec3(sample.direction)) - 1));
        const Place place = place_of(scene, glm::dvec3(sample.direction));
        // Rounding puts one in some ten thousand directions on the other side of an edge, where a black texel may be.
        const auto at_edge = [](double x) { return std::abs(x - std::round(x)) < 1e-5; };
        if (at_edge(place.x) || at_edge(place.y)) continue;
        const auto row = static_cast<std::size_t>(place.y);
        const std::size_t cell = row * width + static_cast<std::size_t>(place.x);
        counts[cell] += 1;
        CHECK(sample.density == cells[cell].density);
        if (cell != hot) continue;
        const double top = std::cos(pi * double(row) / height), bottom = std::cos(pi * double(row + 1) / height);
        const double down = (top - std::cos(pi * place.y / height)) / (top - bottom);
        within[test::unit_interval_bin(place.x - std::floor(place.x), 10) * 10 + test::unit_interval_bin(down, 10)] +=
            1;
      }
      CHECK(different == 0);
      CHECK(worst_length < 4e-7);
      CHECK(test::chi_square(counts, expected).p_value > least_p_value);
      CHECK(test::chi_square_uniform(within).p_value > least_p_value);
    }
}

TANDEM_DEVICE_TEST("An environment's density integrates to 1 and is positive wherever there is radiance") {
  for (const TextureFilter filter : {TextureFilter::nearest, TextureFilter::linear}) {
    const Scene scene = scene_with_map(levels(hot_texels[0]), filter);
    test::SphereBins bins{.rows = 64, .columns = 96};
    const std::vector<Arriving> nodes = arriving(device, scene, bins.nodes(4));
    double integral = 0;
    for (const Arriving& node : nodes) {
      integral += node.density * bins.solid_angle() / 16;
      if (node.radiance > 0) CHECK(node.density > 0);
    }
    // The midpoint rule misses parts of the edges of texels.
    CHECK(integral == doctest::Approx(1).epsilon(0.02));

    test::RandomSource random(4);
    std::vector<glm::dvec3> directions = {{0, 1, 0}, {0, -1, 0}, {1, 0, 0}, {-1, 0, 0}, {0, 0, 1}, {0, 0, -1}};
    for (int i = 0; i < 100000; ++i) {
      // A third of them close to the poles.
      const double scale = i % 3 == 0 ? std::exp2(random.uniform(-30, 0)) : 1.0;
      directions.push_back(glm::normalize(
          glm::dvec3(random.uniform(-scale, scale), random.uniform(-1, 1), random.uniform(-scale, scale))));
    }
    std::size_t undiscoverable = 0;
    for (const Arriving& seen : arriving(device, scene, directions)) {
      CHECK(std::isfinite(seen.radiance));
      CHECK(std::isfinite(seen.density));
      undiscoverable += seen.radiance > 0 && !(seen.density > 0);
    }
    CHECK(undiscoverable == 0);
  }
}

TANDEM_DEVICE_TEST("Irradiance from an environment is the integral of its radiance") {
  for (const std::size_t hot : hot_texels)
    for (const TextureFilter filter : {TextureFilter::nearest, TextureFilter::linear}) {
      const Scene scene = scene_with_map(levels(hot), filter);
      const glm::dvec3 normal = direction_at(scene, double(hot % width) + 2, double(hot / width) + 0.1);
      // By the midpoint rule over the map: 40 x 40 places in each texel, whose products of a bilinear function and a
      // cosine the rule gets right to 1e-4.
      constexpr int side = 40;
      std::vector<glm::dvec3> directions;
      for (std::uint32_t y = 0; y < height * side; ++y)
        for (std::uint32_t x = 0; x < width * side; ++x)
          directions.push_back(direction_at(scene, (x + 0.5) / side, (y + 0.5) / side));
      const std::vector<Arriving> seen = arriving(device, scene, directions);
      double truth = 0;
      for (std::size_t i = 0; i < seen.size(); ++i)
        truth += seen[i].radiance * std::max(glm::dot(directions[i], normal), 0.0) *
                 std::sqrt(1 - directions[i].y * directions[i].y) * (pi / height / side) * (2 * pi / width / side);
      const statistics::Mean mean =
          statistics::mean_of(irradiances(light_samples(device, scene, glm::vec3(0), count), normal));
      CAPTURE(truth);
      CAPTURE(mean.value);
      CHECK(mean.standard_error < 5e-3 * truth);
      CHECK(std::abs(mean.value - truth) < most_standard_errors * mean.standard_error + 1e-4 * truth);
    }
}

TANDEM_DEVICE_TEST("A constant environment gives pi L") {
  Scene scene = scene_with_map(levels(0), TextureFilter::linear);
  scene.environment = Environment{.radiance = glm::vec3(0.75f)};
  const std::vector<LightSample> samples = light_samples(device, scene, glm::vec3(1), count);
  const test::SphereBins bins;
  std::vector<double> counts(bins.count(), 0.0);
  for (const LightSample& sample : samples) {
    CHECK(sample.radiance == glm::vec3(0.75f));
    CHECK(sample.density == doctest::Approx(1 / (4 * pi)).epsilon(1e-6));
    CHECK(sample.density == sample.scattering_density);
    counts[bins.bin(glm::dvec3(sample.direction))] += 1;
  }
  CHECK(test::chi_square_uniform(counts).p_value > least_p_value);
  const statistics::Mean mean = statistics::mean_of(irradiances(samples, glm::normalize(glm::dvec3(3, 1, -2))));
  CHECK(std::abs(mean.value - 0.75 * pi) < most_standard_errors * mean.standard_error);
}

TANDEM_DEVICE_TEST("Within a large map, samples follow its texels too") {
  // 1024 x 512 texels: many more than a light's random bits can tell apart twice over.
  Scene scene = scene_with_map(levels(0), TextureFilter::linear);
  TextureImage& image = scene.images[scene.textures[scene.environment->texture].image];
  image.width = 1024;
  image.height = 512;
  std::vector<float> values;
  for (std::uint32_t y = 0; y < image.height; ++y)
    for (std::uint32_t x = 0; x < image.width; ++x) {
      const float level = 1.0f + static_cast<float>((x / 64 + y / 64) % 3) + (y < 2 ? 500.0f : 0.0f);
      values.insert(values.end(), {level, level, level, 1.0f});
    }
  image.texels.resize(values.size() * sizeof(float));
  std::memcpy(image.texels.data(), values.data(), image.texels.size());
  const std::vector<LightSample> samples = light_samples(device, scene, glm::vec3(0), count);
  const test::SphereBins bins{.rows = 128, .columns = 16};
  std::vector<double> counts(bins.count(), 0.0);
  // The map's y is the bins' z.
  const auto turned = [](const glm::dvec3& d) { return glm::dvec3(d.z, d.x, d.y); };
  for (const LightSample& sample : samples) counts[bins.bin(glm::normalize(turned(glm::dvec3(sample.direction))))] += 1;
  std::vector<glm::dvec3> directions;
  for (const glm::dvec3& node : bins.nodes(16)) directions.emplace_back(node.y, node.z, node.x);
  std::vector<double> densities;
  for (const Arriving& seen : arriving(device, scene, directions)) densities.push_back(seen.density);
  // The bright cap is smaller than a bin and than what the nodes see of it: it counts apart.
  std::size_t bright = 0;
  for (const LightSample& sample : samples) bright += std::acos(double{sample.direction.y}) < pi * 2 / 512;
  double bright_share = 0, all = 0;
  for (std::uint32_t y = 0; y < 512; ++y)
    for (std::uint32_t x = 0; x < 1024; ++x) {
      const double weight =
          values[4 * (std::size_t{y} * 1024 + x)] * (std::cos(pi * y / 512) - std::cos(pi * (y + 1) / 512));
      all += weight;
      if (y < 2) bright_share += weight;
    }
  bright_share /= all;
  CHECK(double(bright) / count == doctest::Approx(bright_share).epsilon(0.1));
  std::vector<double> expected = bins.integrals(densities);
  for (std::size_t i = 0; i < bins.columns; ++i) {
    // The row of bins around the upper pole.
    counts[counts.size() - 1 - i] = 0;
    expected[expected.size() - 1 - i] = 0;
  }
  CHECK(test::chi_square(counts, expected).p_value > least_p_value);
}
