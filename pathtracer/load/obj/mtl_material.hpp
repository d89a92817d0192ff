#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>

#include "pathtracer/load/obj/mtl_loader.hpp"
#include "pathtracer/load/obj/mtl_map.hpp"

namespace tandem::pathtracer {

/// What the statements of an MTL file say about one material.
struct MtlStatements {
  std::string name;
  int illum = 0;
  std::map<std::string, glm::vec3, std::less<>> colors;  ///< Kd, Ks, Ke, Tf, where given
  std::map<std::string, float, std::less<>> numbers;     ///< Ni, Ns, Pr, Pm, d, Tr, where given
  std::map<std::string, MtlMap, std::less<>> maps;       ///< by the name of what they are of: Kd, d, bump, norm, ...
  std::map<std::string, std::string, std::less<>> unusable;  ///< of the above and illum: why, with file and line
};

/// Names of materials that were not taken as they stand, each kind worth one warning.
struct MtlRemarks {
  std::set<std::string> bright;       ///< more light leaves than arrives
  std::set<std::string> scaled;       ///< would have been, but for a factor on Kd and Ks
  std::set<std::string> without_ior;  ///< glass without Ni
  std::set<std::string> invisible;    ///< d 0
  std::set<std::string> unneeded;     ///< "Ns of a material", which cannot be used and is not needed
};

/// The material that is meant (docs/guide/scenes.md). Throws Error for a value that it needs and that cannot be used.
NamedMaterial material_of(const MtlStatements& statements, MtlRemarks& remarks);

}  // namespace tandem::pathtracer
