#pragma once

#include <string>

#include "pathtracer/scene/scene.hpp"

namespace tandem::pathtracer {

/// What lights a scene by itself.
enum class OwnLight {
  none,        ///< nothing emits
  negligible,  ///< what emits would leave it all but black, such as an indicator lamp painted on a device
  sufficient
};

/// Judged by the radiance of white surfaces if all emitted light spread evenly over the sphere around the scene:
/// negligible below 0.01, and below 0.05 where all of it comes from textures, which mostly are decoration.
OwnLight own_light(const Scene& scene);

/// Gives a scene without an environment a neutral one in which any model is seen well: a large soft lamp above the left
/// of the automatic camera, a weak one at its right, and grey around, darker below. White surfaces are up to 0.95
/// bright in it, and stand out from what is behind them as black ones do.
void add_studio(Scene& scene);

}  // namespace tandem::pathtracer
