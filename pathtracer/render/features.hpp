#pragma once

#include <cstdint>
#include <vector>

#include "pathtracer/scene/scene.hpp"
#include "rhi/pipeline.hpp"

namespace tandem::pathtracer {

/// A set of the features of shaders/features.glsl: bit i is the specialisation constant i.
using Features = std::uint32_t;

namespace feature {
inline constexpr Features transparency = 1u << 0;
inline constexpr Features spheres = 1u << 1;
inline constexpr Features textures = 1u << 2;
inline constexpr Features materials = 1u << 3;
inline constexpr Features lights = 1u << 4;
inline constexpr Features cameras = 1u << 5;
inline constexpr Features samplers = 1u << 6;
inline constexpr Features options = 1u << 7;
inline constexpr Features media = 1u << 8;
inline constexpr std::uint32_t count = 9;
inline constexpr Features all = (1u << count) - 1;
}  // namespace feature

/// What the shaders must be able to do for the scene; the settings may need more.
Features features_of(const Scene& scene);

/// The smallest set with all of `needed` that the shaders are built for (the SPECIALIZATIONS of
/// shaders/CMakeLists.txt), so that no device has to compile one of 512.
Features built_features(Features needed);

/// For the desc of a pipeline.
std::vector<rhi::SpecializationValue> specialization(Features features);

}  // namespace tandem::pathtracer
