#include "pathtracer/scene/conductors.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>

using namespace tandem::pathtracer;

namespace {

/// At normal incidence: ((n - 1)^2 + k^2) / ((n + 1)^2 + k^2).
glm::dvec3 reflectance(const Conductor& metal) {
  const glm::dvec3 n(metal.eta), k(metal.absorption);
  return ((n - 1.0) * (n - 1.0) + k * k) / ((n + 1.0) * (n + 1.0) + k * k);
}

}  // namespace

TEST_CASE("Metals reflect as they are known to") {
  const auto of = [](const char* name) {
    const Conductor* metal = find_conductor(name);
    REQUIRE(metal != nullptr);
    return reflectance(*metal);
  };
  // As handbooks give them, which differ by some hundredths from one sample to the next.
  const auto close = [](glm::dvec3 a, glm::dvec3 b) {
    return std::ranges::max({std::abs(a.x - b.x), std::abs(a.y - b.y), std::abs(a.z - b.z)}) < 0.04;
  };
  CHECK(close(of("silver"), {0.98, 0.97, 0.96}));
  CHECK(close(of("gold"), {0.96, 0.79, 0.39}));
  CHECK(close(of("copper"), {0.95, 0.64, 0.54}));
  CHECK(close(of("aluminium"), {0.91, 0.92, 0.92}));
  CHECK(close(of("chromium"), {0.55, 0.55, 0.55}));
  CHECK(close(of("iron"), {0.54, 0.52, 0.50}));
  CHECK(close(of("nickel"), {0.69, 0.63, 0.57}));
  CHECK(close(of("titanium"), {0.61, 0.58, 0.54}));
}

TEST_CASE("Metals are found by their name and listed in its order") {
  CHECK(conductors().size() == 8);
  CHECK(std::ranges::is_sorted(conductors(), {}, &Conductor::name));
  for (const Conductor& metal : conductors()) CHECK(find_conductor(metal.name) == &metal);
  CHECK(find_conductor("Gold") == nullptr);
  CHECK(find_conductor("") == nullptr);
}
