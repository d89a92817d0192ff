#pragma once

#include <memory>
#include <optional>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "pathtracer/scene/scene.hpp"
#include "tools/weekend/random.hpp"
#include "tools/weekend/texture.hpp"

namespace tandem::weekend {

/// A BSDF times the cosine of wi, and the solid-angle density with which `scatter` finds wi.
struct Scattering {
  glm::dvec3 value{0};
  double density = 0;
};

/// A direction that a material scatters to.
struct Scattered {
  glm::dvec3 direction{0, 0, 1};
  glm::dvec3 weight{1};      ///< of a specular material: BSDF * |cos| / probability
  bool transmitted = false;  ///< to the other side
};

/// A colour or a number times a texture, if there is one.
struct Factor {
  glm::dvec3 value{1};
  std::shared_ptr<const Texture> texture;
  pathtracer::Texture use;  ///< of the texture: which channel a number is read from

  glm::dvec3 color(const glm::dvec2& uv) const;
  double number(const glm::dvec2& uv) const;
};

/// How a surface scatters. Directions are unit vectors in the frame of the shading normal, z, and point away from the
/// surface; wo, where the path came from, is above it. Written from the formulas of the sources named at each model.
class Material {
 public:
  virtual ~Material() = default;

  /// Whether it scatters by a density; else by specular lobes alone, which no light sampling finds.
  virtual bool has_density() const { return true; }
  /// Whether what would leave to the wrong side of the true surface is mirrored back there (see Tracer::value).
  virtual bool folds() const { return false; }
  /// Nothing where nothing is scattered.
  virtual std::optional<Scattered> scatter(const glm::dvec3& wo, bool outside, const glm::dvec2& uv,
                                           Random& random) const = 0;
  /// @param glossy_only the value without the diffuse part; the density remains whole
  virtual Scattering value(const glm::dvec3& wo, const glm::dvec3& wi, const glm::dvec2& uv, bool glossy_only) const;

  /// Radiance to both sides.
  glm::dvec3 emission(const glm::dvec2& uv) const { return emission_.color(uv); }
  bool emits() const { return emission_.value != glm::dvec3(0); }
  /// The fraction of rays that meet it.
  double opacity(const glm::dvec2& uv) const;

  void set_emission(Factor factor) { emission_ = std::move(factor); }
  void set_opacity(Factor factor, double cutoff);

 private:
  Factor emission_{.value = glm::dvec3(0), .texture = {}, .use = {}};
  Factor opacity_;
  double cutoff_ = 0;
  bool opaque_ = true;
};

}  // namespace tandem::weekend
