#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/mat3x3.hpp>

#include "compare/geometry/bounding_volumes.hpp"
#include "compare/geometry/intersection.hpp"
#include "compare/probe/answer.hpp"
#include "compare/probe/trial.hpp"
#include "pathtracer/scene/scene.hpp"

namespace tandem::compare {

/// An affine map in doubles.
struct AffineMap {
  glm::dmat3 linear{1.0};
  glm::dvec3 translation{0};

  glm::dvec3 point(const glm::dvec3& p) const { return linear * p + translation; }
};
AffineMap map_of(const Transform& transform);
AffineMap inverse(const AffineMap& map);

/// A primitive as a device names it.
struct PrimitiveId {
  AnswerType type = AnswerType::miss;
  std::uint32_t instance = 0;
  std::uint32_t geometry = 0;
  std::uint32_t primitive = 0;

  bool operator==(const PrimitiveId&) const = default;
};

/// A surface that a ray of a trial may meet.
struct ProbeHit {
  PrimitiveId id;
  Intersection intersection;
  bool counts = false;  ///< for certain: the ray meets it, and the trial lets it count
};

/// One instance of a trial.
struct ProbeInstance {
  AffineMap world_to_geometry;  ///< to the scene's own coordinates
  Transform transform{};        ///< of the instance
  std::uint32_t custom_index = 0;
  std::uint32_t hit_record = 0;
  std::uint32_t mask = 0;
  rhi::InstanceFlags flags = rhi::InstanceFlags::none;
  bool spheres = false;            ///< else triangles
  bool mirrored_at_build = false;  ///< which changes their facing
};

/// What the answers to trials of a scene must be, in doubles. It knows how far single precision may be off, and says
/// what that leaves open.
class ProbeReference {
 public:
  /// The scene must outlive it.
  explicit ProbeReference(const pathtracer::Scene& scene);

  /// The instances of an instance_setup, in a top level's order.
  std::vector<ProbeInstance> instances(InstanceSetup instance_setup) const;

  /// What a ray may meet first, in no order: no hit is behind one that counts.
  std::vector<ProbeHit> hits(const Trial& trial, std::span<const ProbeInstance> instances, const ProbeRay& ray) const;

 private:
  /// @param index of the scene's triangle or sphere
  std::vector<Intersection> meet_primitive(const GeometryRay& ray, const ProbeInstance& instance,
                                           std::uint32_t index) const;

  const pathtracer::Scene& scene_;
  BoundingVolumes triangles_;
  BoundingVolumes spheres_;
};

/// Of a point that is mapped: the largest of the sums of magnitudes that its coordinates are computed by.
double mapped_magnitude(const AffineMap& map, const glm::dvec3& point);

}  // namespace tandem::compare
