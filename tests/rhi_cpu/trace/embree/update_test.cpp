// Updates: after one, a structure answers as one that is built from the new geometries.

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "rhi/error.hpp"
#include "rhi_cpu/trace/embree/acceleration_structure.hpp"
#include "tests/rhi_cpu/trace/embree/brute_force.hpp"

using namespace tandem;
using namespace tandem::test;
using namespace tandem::kernel;

namespace {

constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN();

cpu::TopLevel top_level_over(const cpu::EmbreeDevice& device, const cpu::BottomLevel& bottom_level,
                             std::size_t instance_count) {
  const std::vector<rhi::InstanceDesc> instances(instance_count, instance_of(0));
  return cpu::TopLevel::build(
      device, instances, [&](std::uint64_t) { return &bottom_level; }, rhi::BuildFlags::none, "top");
}

std::vector<Hit> hits_of(const cpu::TopLevel& top_level, const Ray& ray) {
  std::vector<Hit> hits(1000);
  hits.resize(top_level.view().functions->next_hits(top_level.view(), ray, nullptr, hits.data(), 1000));
  return hits;
}

/// Every hit is the same to the last bit: the primitives are, and a refit only changes what is around them.
void check_equal(const cpu::TopLevel& updated, const cpu::TopLevel& built, std::mt19937& random) {
  std::size_t count = 0;
  for (int i = 0; i < 300; ++i) {
    const Ray ray = random_ray(random, ray_flag_no_opaque, 0xFF);
    const std::vector<Hit> a = hits_of(updated, ray), b = hits_of(built, ray);
    REQUIRE(a.size() == b.size());
    for (std::size_t k = 0; k < a.size(); ++k) {
      CHECK(a[k].t == b[k].t);
      CHECK(a[k].barycentrics[0] == b[k].barycentrics[0]);
      CHECK(a[k].geometry_index == b[k].geometry_index);
      CHECK(a[k].primitive_index == b[k].primitive_index);
    }
    count += a.size();
  }
  CHECK(count > 300);
}

}  // namespace

TEST_CASE("an updated bottom level answers as a new one") {
  const cpu::EmbreeDevice device;
  std::mt19937 random(51);
  for (const std::size_t level : {std::size_t{0}, std::size_t{2}}) {
    for (const std::size_t instance_count : {std::size_t{1}, std::size_t{2}}) {
      std::vector<SoupGeometry> geometries = random_soup(random, 3, 200).bottom_levels[level];
      cpu::BottomLevel updated =
          cpu::BottomLevel::build(device, inputs_of(geometries), rhi::BuildFlags::allow_update, "updated");
      const auto* scene = updated.scene().get();
      for (int round = 0; round < 6; ++round) {
        CAPTURE(round);
        const std::vector<SoupGeometry> moved = random_soup(random, 3, 200).bottom_levels[level];
        if (round != 2) geometries = moved;  // round 2 changes nothing but what follows
        // Primitives that were active and no longer are, and the other way round in the next rounds.
        if (round == 1 || round == 2) {
          if (level == 0) {
            geometries[1].triangles[7][0] = not_a_number;
            geometries[2].triangles[round == 1 ? 0 : 199] = {};
          } else {
            geometries[1].boxes[3][0] = not_a_number;
          }
        }
        if (round == 4) geometries[0].opaque = !geometries[0].opaque;
        updated.update(device, inputs_of(geometries), "updated");
        CHECK(updated.scene().get() == scene);
        const cpu::BottomLevel built =
            cpu::BottomLevel::build(device, inputs_of(geometries), rhi::BuildFlags::none, "built");
        check_equal(top_level_over(device, updated, instance_count), top_level_over(device, built, instance_count),
                    random);
      }
    }
  }
}

TEST_CASE("build flags do not change what is hit") {
  const cpu::EmbreeDevice device;
  std::mt19937 random(52);
  using enum rhi::BuildFlags;
  for (const std::size_t level : {std::size_t{0}, std::size_t{2}}) {
    const std::vector<SoupGeometry> geometries = random_soup(random, 2, 300).bottom_levels[level];
    const cpu::BottomLevel plain = cpu::BottomLevel::build(device, inputs_of(geometries), none, "plain");
    for (const rhi::BuildFlags flags :
         {prefer_fast_trace, prefer_fast_build, allow_update, allow_compaction, allow_update | prefer_fast_build}) {
      const cpu::BottomLevel other = cpu::BottomLevel::build(device, inputs_of(geometries), flags, "other");
      CHECK(other.bytes() > 0);
      check_equal(top_level_over(device, other, 1), top_level_over(device, plain, 1), random);
    }
  }
}

TEST_CASE("a structure takes more memory than the positions in it") {
  const cpu::EmbreeDevice device;
  std::mt19937 random(53);
  const std::vector<SoupGeometry> geometries = random_soup(random, 1, 10000).bottom_levels[0];
  const cpu::BottomLevel large = cpu::BottomLevel::build(device, inputs_of(geometries), rhi::BuildFlags::none, "large");
  CHECK(large.bytes() > 10000 * sizeof(Triangle));
  CHECK(large.bytes() < 10000 * 1000);
  const cpu::TopLevel top_level = top_level_over(device, large, 100);
  CHECK(top_level.bytes() > 100 * sizeof(Instance));
  CHECK(top_level.bytes() < large.bytes());
}

TEST_CASE("an update that does not fit is an error, and changes nothing") {
  const cpu::EmbreeDevice device;
  std::mt19937 random(54);
  const std::vector<SoupGeometry> geometries = random_soup(random, 2, 200).bottom_levels[0];
  cpu::BottomLevel level =
      cpu::BottomLevel::build(device, inputs_of(geometries), rhi::BuildFlags::allow_update, "bunny");
  const auto update = [&](const auto& change) {
    std::vector<SoupGeometry> changed = geometries;
    changed[0].triangles[0][0] = 100;
    change(changed);
    level.update(device, inputs_of(changed), "bunny");
  };
  CHECK_THROWS_WITH_AS(update([](auto& changed) { changed.pop_back(); }),
                       doctest::Contains("bunny: it was built from 2 geometries, the update has 1"), rhi::Error);
  CHECK_THROWS_WITH_AS(update([](auto& changed) { changed[1].triangles.pop_back(); }),
                       doctest::Contains("geometry 1 was built from 200 primitives, the update has 199"), rhi::Error);
  CHECK_THROWS_WITH_AS(update([](auto& changed) { changed[1].boxes.resize(200); }),
                       doctest::Contains("geometry 1 is not of the kind"), rhi::Error);
  const cpu::BottomLevel built = cpu::BottomLevel::build(device, inputs_of(geometries), rhi::BuildFlags::none, "built");
  check_equal(top_level_over(device, level, 1), top_level_over(device, built, 1), random);
  cpu::BottomLevel fixed = cpu::BottomLevel::build(device, inputs_of(geometries), rhi::BuildFlags::none, "fixed");
  CHECK_THROWS_WITH_AS(fixed.update(device, inputs_of(geometries), "fixed"),
                       doctest::Contains("without BuildFlags::allow_update"), rhi::Error);
}
