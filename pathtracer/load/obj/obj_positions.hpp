#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "pathtracer/load/obj/wavefront_text.hpp"

namespace tandem::pathtracer {

/// The vertices of an OBJ file, as exactly as it has them. One that is no position (nan, inf, a word, too far away) is
/// an error only where a face uses it: exporters leave such vertices behind.
class ObjPositions {
 public:
  /// Takes "v x y z ...". Throws Error, naming file and line, for fewer than three coordinates.
  void add(const WavefrontText& text, const Statement& statement);

  std::size_t size() const noexcept { return positions_.size(); }
  /// Throws Error, naming file and line of the vertex, for one that is no position. @param index less than size()
  const glm::dvec3& at(std::uint32_t index) const;

  std::size_t unusable() const noexcept { return unusable_.size(); }
  bool has_colors() const noexcept { return has_colors_; }  ///< three numbers behind the coordinates of some vertex

 private:
  std::vector<glm::dvec3> positions_;
  std::map<std::uint32_t, std::string> unusable_;  ///< why, with file and line
  bool has_colors_ = false;
};

}  // namespace tandem::pathtracer
