#pragma once

#include <glm/vec3.hpp>

#include "pathtracer/scene/scene.hpp"

namespace tandem::pathtracer {

/// The point of a scene's file that is to be 0,0,0 of the scene. Floats far from 0 are coarse: at map coordinates of
/// 5,400,000 m they are half a metre apart, and rays start metres off their surfaces. So where the centre of the scene
/// lies more than 16 times half its largest extent from 0 along an axis, loaders subtract a point near it in double
/// precision; along other axes the coordinate is 0. It is a multiple of a power of two of about half the extent, so
/// that the difference from the coordinates of a file is exact.
/// @param scene loaded without an origin
glm::dvec3 local_origin(const Scene& scene);

}  // namespace tandem::pathtracer
