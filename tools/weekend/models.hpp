#pragma once

#include <cstddef>
#include <memory>

#include "pathtracer/scene/scene.hpp"
#include "tools/weekend/material.hpp"

namespace tandem::weekend {

/// Throws Error, naming the material, for a model or a texture that the baseline does not have.
std::unique_ptr<Material> make_material(const pathtracer::Scene& scene, std::size_t index);

}  // namespace tandem::weekend
