#include "compare/image/vote.hpp"

#include <doctest/doctest.h>

#include <limits>
#include <vector>

#include "base/error.hpp"

namespace tandem::compare {
namespace {

using pathtracer::Image;

/// One image for each device; `pixels[p][d]` is the grey of pixel p on device d.
std::vector<Image> images(const std::vector<std::vector<float>>& pixels) {
  std::vector<Image> result(pixels.front().size());
  for (std::size_t device = 0; device < result.size(); ++device) {
    result[device].width = static_cast<std::uint32_t>(pixels.size());
    result[device].height = 1;
    for (const std::vector<float>& pixel : pixels) result[device].pixels.emplace_back(pixel[device]);
  }
  return result;
}

constexpr float nan = std::numeric_limits<float>::quiet_NaN();

TEST_CASE("a device that stands alone against a majority of equal bits is outvoted") {
  const Vote result = vote(images({{1, 1, 1}, {1, 1, 2}, {1, 2, 1}, {3, 4, 4}, {5, 5, 6}, {1, 1, 1.0001f}}));
  CHECK(result.pixels == 6);
  CHECK(result.unanimous == 1);
  CHECK(result.decided == 5);
  CHECK(result.within_tolerance == 0);
  CHECK(result.undecided == 0);
  REQUIRE(result.devices.size() == 3);
  CHECK(result.devices[0].outvoted == 1);
  CHECK(result.devices[0].beyond_tolerance == 1);
  CHECK(result.devices[0].first_beyond == glm::uvec2(3, 0));
  CHECK(result.devices[1].outvoted == 1);
  CHECK(result.devices[1].first_beyond == glm::uvec2(2, 0));
  CHECK(result.devices[2].outvoted == 3);
  CHECK(result.devices[2].beyond_tolerance == 2);  // not the last pixel
  CHECK(result.devices[2].first_beyond == glm::uvec2(1, 0));
}

TEST_CASE("with rounding everywhere, the vote is taken within tolerance") {
  const Vote result = vote(images({{1, 1.0001f, 0.9999f}, {1, 1.0001f, 2}, {1.0001f, 7, 1}}));
  CHECK(result.within_tolerance == 1);
  CHECK(result.decided == 2);
  CHECK(result.devices[0].outvoted == 0);
  CHECK(result.devices[1].beyond_tolerance == 1);
  CHECK(result.devices[2].beyond_tolerance == 1);
  // A stricter tolerance leaves three opinions each.
  CHECK(vote(images({{1, 1.0001f, 0.9999f}}), 1e-6).undecided == 1);
}

TEST_CASE("closeness is no chain: the ends may be apart") {
  // Each is within 1e-3 of its neighbours only; two of the three are a majority, and the third is not close to both.
  const Vote result = vote(images({{1, 1.0009f, 1.0018f}}));
  CHECK(result.decided == 1);
  CHECK(result.devices[2].outvoted == 1);
  CHECK(result.devices[2].beyond_tolerance == 1);
}

TEST_CASE("ties are counted by who stands with whom") {
  // A line each: two against two, twice; all alone; two against two otherwise.
  const Vote result = vote(images({{1, 1, 2, 2}, {3, 3, 4, 4.00001f}, {1, 2, 3, 4}, {1, 2, 2, 1}}));
  CHECK(result.undecided == 4);
  CHECK(result.decided == 0);
  REQUIRE(result.splits.size() == 3);
  CHECK(result.splits[0].pixels == 2);
  CHECK(result.splits[0].sides == std::vector<DeviceIndices>{{0, 1}, {2, 3}});
  CHECK(result.splits[0].first == glm::uvec2(0, 0));
  CHECK(result.splits[1].pixels == 1);
  CHECK(result.splits[2].pixels == 1);
  CHECK(result.splits[1].sides == std::vector<DeviceIndices>{{0}, {1}, {2}, {3}});
  CHECK(result.splits[2].sides == std::vector<DeviceIndices>{{0, 3}, {1, 2}});
  for (const DeviceVotes& device : result.devices) CHECK(device.outvoted == 0);
}

TEST_CASE("a NaN is close to nothing but its own bits") {
  const Vote result = vote(images({{nan, nan, nan}, {nan, nan, 1}, {1, 1, nan}, {nan, 1, 2}}));
  CHECK(result.unanimous == 1);
  CHECK(result.decided == 2);
  CHECK(result.devices[2].outvoted == 2);
  CHECK(result.devices[2].beyond_tolerance == 2);
  CHECK(result.undecided == 1);
}

TEST_CASE("every pixel is counted once") {
  std::vector<std::vector<float>> pixels;
  for (int code = 0; code < 256; ++code)  // every way in which four devices can have four values
    pixels.push_back({float(code & 3), float(code >> 2 & 3), float(code >> 4 & 3), float(code >> 6)});
  const Vote result = vote(images(pixels));
  CHECK(result.unanimous == 4);
  // Three alike and one not: 4 places, 4 values, 3 others.
  CHECK(result.decided == 48);
  CHECK(result.undecided == 256 - 4 - 48);
  std::uint64_t in_splits = 0;
  for (const SplitVote& split : result.splits) in_splits += split.pixels;
  CHECK(in_splits == result.undecided);
  for (const DeviceVotes& device : result.devices) CHECK(device.outvoted == 12);
}

TEST_CASE("two images, and images of different sizes, cannot vote") {
  CHECK_THROWS_AS(vote(images({{1, 1}})), tandem::Error);
  std::vector<Image> uneven = images({{1, 1, 1}});
  uneven.back() = images({{1, 1, 1}, {2, 2, 2}}).back();
  CHECK_THROWS_AS(vote(uneven), tandem::Error);
}

TEST_CASE("the device that agrees with none of a majority is outvoted as a whole") {
  const auto outvoted = [](const std::vector<std::vector<bool>>& agree) { return outvoted_devices(agree); };
  CHECK(outvoted({{1, 1, 1}, {1, 1, 1}, {1, 1, 1}}).empty());
  CHECK(outvoted({{1, 1, 0}, {1, 1, 0}, {0, 0, 1}}) == DeviceIndices{2});
  CHECK(outvoted({{1, 0, 0}, {0, 1, 1}, {0, 1, 1}}) == DeviceIndices{0});
  CHECK(outvoted({{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}).empty());                         // nobody agrees
  CHECK(outvoted({{1, 1, 0}, {1, 1, 1}, {0, 1, 1}}).empty());                         // it agrees with one of them
  CHECK(outvoted({{1, 1, 0, 0}, {1, 1, 0, 0}, {0, 0, 1, 1}, {0, 0, 1, 1}}).empty());  // two against two
  CHECK(outvoted({{1, 0, 1, 1, 0}, {0, 1, 0, 0, 0}, {1, 0, 1, 1, 0}, {1, 0, 1, 1, 0}, {0, 0, 0, 0, 1}}) ==
        DeviceIndices{1, 4});
}

}  // namespace
}  // namespace tandem::compare
