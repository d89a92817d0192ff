#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>

namespace tandem::pathtracer {

inline constexpr std::uint64_t minimum_generated_triangles = 26;
inline constexpr std::uint64_t maximum_generated_triangles = 100'000'000;

/// Writes the Cornell box filled with up to 27 displaced spheres, about `triangle_count` triangles in all (within 2 %
/// from 1000 triangles on), as `obj_path` and an MTL file of the same stem beside it. The same count gives the same
/// bytes. Both files appear whole or not at all. Returns the exact number of triangles. `progress` is called with
/// the finished fraction; when it returns false nothing is written and 0 is returned. Throws Error when the count is
/// out of range or a file cannot be written.
std::uint64_t generate_spheres(std::uint64_t triangle_count, const std::filesystem::path& obj_path,
                               const std::function<bool(double fraction)>& progress = {});

}  // namespace tandem::pathtracer
