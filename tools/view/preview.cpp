#include "tools/view/preview.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <string_view>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "pathtracer/render/first_hits.hpp"
#include "tools/view/camera_controls.hpp"

namespace tandem::view {

glm::vec3 headlight(const glm::vec3& albedo, const glm::vec3& normal, const glm::vec3& direction) {
  constexpr float ambient = 0.15f;
  return albedo * (ambient + (1 - ambient) * std::abs(glm::dot(normal, direction)));
}

pathtracer::Image preview(pathtracer::SceneOnDevice& scene) {
  const std::vector<pathtracer::ImageChannel> channels = pathtracer::first_hits(scene, 1);
  const auto channel = [&](std::string_view name) -> const std::vector<std::uint32_t>& {
    return std::ranges::find(channels, name, &pathtracer::ImageChannel::name)->words;
  };
  const std::vector<std::uint32_t>*albedo[] = {&channel("albedo.R"), &channel("albedo.G"), &channel("albedo.B")},
        *normal[] = {&channel("normal.X"), &channel("normal.Y"), &channel("normal.Z")};
  const std::vector<std::uint32_t>& coverage = channel("coverage.Y");
  const auto vector = [](const auto& words, std::size_t i) {
    return glm::vec3(std::bit_cast<float>((*words[0])[i]), std::bit_cast<float>((*words[1])[i]),
                     std::bit_cast<float>((*words[2])[i]));
  };
  const pathtracer::Camera& camera = scene.camera();
  const ViewAxes axes = view_axes(camera);
  const double slope =
      camera.kind == pathtracer::CameraKind::perspective ? std::tan(glm::radians(double{camera.vertical_fov}) / 2) : 0;
  pathtracer::Image image{scene.settings().width, scene.settings().height, {}};
  for (std::uint32_t y = 0; y < image.height; ++y)
    for (std::uint32_t x = 0; x < image.width; ++x) {
      const std::size_t i = image.pixels.size();
      const glm::dvec3 direction = axes.forward + axes.right * ((2 * (x + 0.5) - image.width) / image.height * slope) -
                                   axes.up * ((2 * (y + 0.5) / image.height - 1) * slope);
      image.pixels.push_back(std::bit_cast<float>(coverage[i]) == 0 ? scene.background()
                                                                    : headlight(vector(albedo, i), vector(normal, i),
                                                                                glm::vec3(glm::normalize(direction))));
    }
  return image;
}

}  // namespace tandem::view
