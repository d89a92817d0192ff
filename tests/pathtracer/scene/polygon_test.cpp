#include "pathtracer/scene/polygon.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <random>

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

using namespace tandem::pathtracer;

namespace {

/// The sum of the signed areas along `normal`, and of the absolute ones: equal when nothing overlaps or is flipped.
struct Areas {
  double signed_area = 0;
  double absolute_area = 0;
};

Areas areas(const std::vector<glm::vec3>& corners, glm::dvec3 normal) {
  Areas sum;
  const auto triangles = triangulate(corners);
  CHECK(triangles.size() == corners.size() - 2);
  for (const auto& [a, b, c] : triangles) {
    const glm::dvec3 origin(corners[a]);
    const double area =
        0.5 * glm::dot(normal, glm::cross(glm::dvec3(corners[b]) - origin, glm::dvec3(corners[c]) - origin));
    sum.signed_area += area;
    sum.absolute_area += std::abs(area);
  }
  return sum;
}

}  // namespace

TEST_CASE("A triangle stays as it is") {
  const auto triangles = triangulate(std::vector<glm::vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
  REQUIRE(triangles.size() == 1);
  CHECK(triangles[0] == std::array<std::uint32_t, 3>{0, 1, 2});
}

TEST_CASE("A concave quadrilateral is split inside, whichever corner is the concave one") {
  // A dart whose outer diagonal (1-3) is the shorter one.
  const std::vector<glm::vec3> dart = {{0, 10, 0}, {-1, 0, 0}, {0, 1, 0}, {1, 0, 0}};
  for (std::size_t shift = 0; shift < 4; ++shift) {
    std::vector<glm::vec3> corners = dart;
    std::rotate(corners.begin(), corners.begin() + static_cast<std::ptrdiff_t>(shift), corners.end());
    const Areas sum = areas(corners, {0, 0, 1});
    CHECK(sum.signed_area == doctest::Approx(9));
    CHECK(sum.absolute_area == doctest::Approx(9));
  }
}

TEST_CASE("A convex quadrilateral is split along its shorter diagonal") {
  const auto triangles = triangulate(std::vector<glm::vec3>{{-5, 0, 0}, {0, 0, -1}, {5, 0, 0}, {0, 0, 1}});
  for (const auto& triangle : triangles) {
    CHECK(std::count(triangle.begin(), triangle.end(), 1u) == 1);
    CHECK(std::count(triangle.begin(), triangle.end(), 3u) == 1);
  }
}

TEST_CASE("A concave polygon is covered once, in every orientation in space") {
  // A comb of 5 teeth: width 10, bars of height 1, teeth 1 x 4.
  std::vector<glm::vec3> comb = {{0, 0, 0}, {10, 0, 0}};
  for (int tooth = 4; tooth >= 0; --tooth) {
    const float x = 2.0f * static_cast<float>(tooth);
    comb.insert(comb.end(), {{x + 1.5f, 1, 0}, {x + 1.5f, 5, 0}, {x + 0.5f, 5, 0}, {x + 0.5f, 1, 0}});
  }
  const double expected = [&] {  // shoelace formula
    double twice = 0;
    for (std::size_t i = 0; i < comb.size(); ++i) {
      const glm::dvec3 a(comb[i]), b(comb[(i + 1) % comb.size()]);
      twice += a.x * b.y - a.y * b.x;
    }
    return twice / 2;
  }();
  for (int axis = 0; axis < 3; ++axis)
    for (const float flip : {1.0f, -1.0f}) {
      std::vector<glm::vec3> corners;
      glm::dvec3 normal(0);
      for (const glm::vec3& p : comb) {
        glm::vec3 turned(0);
        turned[axis] = flip * p.x;
        turned[(axis + 1) % 3] = p.y;
        turned[(axis + 2) % 3] = 3;
        corners.push_back(turned);
      }
      normal[(axis + 2) % 3] = flip;
      const Areas sum = areas(corners, normal);
      CHECK(sum.signed_area == doctest::Approx(expected));
      CHECK(sum.absolute_area == doctest::Approx(expected));
    }
}

TEST_CASE("A polygon without area still gives its triangles") {
  CHECK(triangulate(std::vector<glm::vec3>(6, glm::vec3(1, 2, 3))).size() == 4);
  CHECK(triangulate(std::vector<glm::vec3>{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {4, 0, 0}}).size() == 3);
}

TEST_CASE("A large polygon that crosses itself everywhere is triangulated in reasonable time") {
  std::vector<glm::vec3> corners;
  std::minstd_rand random(1);
  const auto unit = [&] { return static_cast<float>(random() % 1024) / 1024; };
  for (int i = 0; i < 20000; ++i) {
    const float x = unit();
    corners.push_back({x, unit(), 0});
  }
  const auto start = std::chrono::steady_clock::now();
  CHECK(triangulate(corners).size() == corners.size() - 2);
  // It takes about one; with a search for each corner, a hundred times as long.
  CHECK(std::chrono::steady_clock::now() - start < std::chrono::seconds(30));
}
