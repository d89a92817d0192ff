#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <set>
#include <string>

#include "pathtracer/load/obj/wavefront_text.hpp"
#include "pathtracer/scene/buffers.hpp"

namespace tandem::pathtracer {

/// What a statement of an MTL file says about a texture, such as "map_Kd -s 2 2 -clamp on wood.jpg".
struct MtlMap {
  std::filesystem::path file;            ///< as written, with / in place of a backslash
  GpuTexture texture;                    ///< how it is read: -s, -o, -clamp, the gain of -mm
  std::optional<std::uint32_t> channel;  ///< -imfchan r, g, b, m (alpha) or l (luminance)
  float multiplier = 1;                  ///< -bm
};

/// Throws Error, naming file and line, where there is no file name or an option lacks its number. Options that have no
/// effect are added to `ignored`.
MtlMap parse_mtl_map(const WavefrontText& text, const Statement& statement, std::set<std::string>& ignored);

}  // namespace tandem::pathtracer
