#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "pathtracer/scene/buffers.hpp"
#include "tests/shaders/function_kernel.hpp"

/// Materials of every model, and kernels that call a BSDF for them.
namespace tandem::test {

struct BsdfMaterial {
  std::string name;
  pathtracer::GpuMaterial parameters;
  bool outside = true;  ///< wo is outside of the dielectric
};

/// Materials whose lobes are wide enough to integrate over a grid of directions; all have a density.
std::vector<BsdfMaterial> wide_materials();

/// Materials with a density that are as sharp, as smooth or as degenerate as they can be.
std::vector<BsdfMaterial> extreme_materials();

/// Materials without a density.
std::vector<BsdfMaterial> specular_materials();

/// A kernel whose body may call `BsdfParameters material(uint index)` and all functions of bsdf/models.glsl, with
/// FEATURE_MATERIALS on.
FunctionKernel bsdf_kernel(const std::vector<BsdfMaterial>& materials, const std::string& body,
                           std::uint32_t input_count, std::uint32_t output_count);

/// A unit vector with that cosine to z.
glm::vec3 direction_at(double cosine, double azimuth);

}  // namespace tandem::test
