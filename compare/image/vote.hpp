#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec2.hpp>

#include "pathtracer/image/image.hpp"

/// Several devices on one picture: who stands against the others.
namespace tandem::compare {

/// Devices are counted from 0, in the order of their images.
using DeviceIndices = std::vector<std::size_t>;

/// How often the majority was against a device.
struct DeviceVotes {
  std::uint64_t outvoted = 0;          ///< pixels whose bits are not those of the majority
  std::uint64_t beyond_tolerance = 0;  ///< of them, those that differ from the majority by more than the tolerance
  glm::uvec2 first_beyond{0};          ///< the first of those, row by row from the top left
};

/// Pixels in which the devices stood against each other in the same way, without a majority.
struct SplitVote {
  std::vector<DeviceIndices> sides;  ///< devices of a side are within the tolerance of the first of it
  std::uint64_t pixels = 0;
  glm::uvec2 first{0};
};

/// Every pixel is exactly one of: unanimous, within tolerance, decided, undecided.
struct Vote {
  std::uint64_t pixels = 0;
  std::uint64_t unanimous = 0;  ///< the same bits on all devices
  std::uint64_t within_tolerance =
      0;                             ///< no majority of equal bits, but every device is within tolerance of all others
  std::uint64_t decided = 0;         ///< a majority stood against the others
  std::uint64_t undecided = 0;       ///< neither
  std::vector<DeviceVotes> devices;  ///< one for each
  std::vector<SplitVote> splits;     ///< the most frequent first
};

/// Counts the votes on each pixel. A majority is more than half of the devices: those with the same bits, or, where
/// not so many have the same, those that are within tolerance, each of each. A value with a NaN or an infinity is
/// within tolerance of its own bits only.
/// @param images at least three of one size, of the same scene and settings. Throws Error.
/// @param tolerance largest |a - b| / max(|a|, |b|) of a channel
Vote vote(std::span<const pathtracer::Image> images, double tolerance = 1e-3);

/// Devices that a majority of all stands against as a whole: more than half of the devices agree with each other, each
/// with each, and not one of them with this.
/// @param agree whether two devices agree, for each pair, as rows of a symmetric matrix
DeviceIndices outvoted_devices(const std::vector<std::vector<bool>>& agree);

}  // namespace tandem::compare
