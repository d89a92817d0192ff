#pragma once

#include <string>

#include "pathtracer/scene/scene.hpp"

namespace tandem::pathtracer {

/// 32 hexadecimal digits that stand for all of a scene that a picture of it can depend on, whatever files it came from:
/// equal scenes have equal hashes, different ones practically never (XXH3, 128 bits). Names and the scene's own wishes
/// for settings do not count.
std::string scene_hash(const Scene& scene);

}  // namespace tandem::pathtracer
