#include "compare/image/vote.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "base/error.hpp"
#include "compare/image/image_pair.hpp"

namespace tandem::compare {
namespace {

bool is_within(const glm::vec3& a, const glm::vec3& b, double tolerance) {
  if (is_bit_equal(a, b)) return true;
  if (!is_finite(a) || !is_finite(b)) return false;
  for (int channel = 0; channel < 3; ++channel) {
    const double value_a = a[channel];
    const double value_b = b[channel];
    if (std::abs(value_a - value_b) > tolerance * std::max(std::abs(value_a), std::abs(value_b))) return false;
  }
  return true;
}

/// The values of one pixel, of each device.
using Values = std::vector<glm::vec3>;

/// The largest set of devices that are alike, each to each, as far as it is found by beginning with each device in turn
/// and adding the others in their order.
template <typename Alike>
DeviceIndices largest_group(std::size_t count, Alike alike) {
  DeviceIndices largest;
  for (std::size_t first = 0; first < count; ++first) {
    DeviceIndices group = {first};
    for (std::size_t other = 0; other < count; ++other)
      if (other != first && std::ranges::all_of(group, [&](std::size_t member) { return alike(member, other); }))
        group.push_back(other);
    if (group.size() > largest.size()) largest = std::move(group);
  }
  std::ranges::sort(largest);
  return largest;
}

bool is_majority(const DeviceIndices& group, std::size_t count) { return 2 * group.size() > count; }

bool contains(const DeviceIndices& devices, std::size_t device) { return std::ranges::count(devices, device) > 0; }

/// Each device joins the first side whose first device it is within tolerance of.
std::vector<DeviceIndices> sides_of(const Values& values, double tolerance) {
  std::vector<DeviceIndices> sides;
  for (std::size_t device = 0; device < values.size(); ++device) {
    const auto side = std::ranges::find_if(
        sides, [&](const DeviceIndices& each) { return is_within(values[each.front()], values[device], tolerance); });
    if (side == sides.end()) {
      sides.push_back({device});
    } else {
      side->push_back(device);
    }
  }
  return sides;
}

void check(std::span<const pathtracer::Image> images) {
  if (images.size() < 3) throw Error("fewer than three images cannot vote");
  for (const pathtracer::Image& image : images) check_pair(images.front(), image);
}

}  // namespace

Vote vote(std::span<const pathtracer::Image> images, double tolerance) {
  check(images);
  const std::size_t count = images.size();
  Vote result;
  result.pixels = images.front().pixels.size();
  result.devices.resize(count);
  std::map<std::vector<DeviceIndices>, SplitVote> splits;
  for (std::size_t index = 0; index < result.pixels; ++index) {
    Values values;
    for (const pathtracer::Image& image : images) values.push_back(image.pixels[index]);
    const glm::uvec2 pixel(index % images.front().width, index / images.front().width);
    const auto equal = [&](std::size_t a, std::size_t b) { return is_bit_equal(values[a], values[b]); };
    const auto near = [&](std::size_t a, std::size_t b) { return is_within(values[a], values[b], tolerance); };

    DeviceIndices group = largest_group(count, equal);
    if (group.size() == count) {
      ++result.unanimous;
      continue;
    }
    if (!is_majority(group, count)) group = largest_group(count, near);
    if (group.size() == count) {
      ++result.within_tolerance;
      continue;
    }
    if (!is_majority(group, count)) {
      ++result.undecided;
      std::vector<DeviceIndices> sides = sides_of(values, tolerance);
      const auto [split, is_new] = splits.try_emplace(sides);
      if (is_new) split->second = {.sides = std::move(sides), .pixels = 0, .first = pixel};
      ++split->second.pixels;
      continue;
    }
    ++result.decided;
    for (std::size_t device = 0; device < count; ++device) {
      if (contains(group, device)) continue;
      DeviceVotes& votes = result.devices[device];
      ++votes.outvoted;
      if (std::ranges::all_of(group, [&](std::size_t member) { return near(member, device); })) continue;
      if (votes.beyond_tolerance++ == 0) votes.first_beyond = pixel;
    }
  }
  for (auto& [sides, split] : splits) result.splits.push_back(std::move(split));
  std::ranges::stable_sort(result.splits, [](const SplitVote& a, const SplitVote& b) { return a.pixels > b.pixels; });
  return result;
}

DeviceIndices outvoted_devices(const std::vector<std::vector<bool>>& agree) {
  const std::size_t count = agree.size();
  const DeviceIndices majority = largest_group(count, [&](std::size_t a, std::size_t b) { return agree[a][b]; });
  DeviceIndices outvoted;
  if (!is_majority(majority, count)) return outvoted;
  for (std::size_t device = 0; device < count; ++device)
    if (!contains(majority, device) &&
        std::ranges::none_of(majority, [&](std::size_t member) { return agree[member][device]; }))
      outvoted.push_back(device);
  return outvoted;
}

}  // namespace tandem::compare
