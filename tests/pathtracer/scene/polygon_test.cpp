#include "pathtracer/scene/polygon.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <random>
#include <string>

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include "pathtracer/scene/point_tree.hpp"

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

namespace {

/// The algorithm in its plain form, which looks at all pairs of corners.
std::vector<std::array<std::uint32_t, 3>> plainly_triangulated(const std::vector<glm::vec3>& corners) {
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::uint32_t> ring(corners.size());
  std::iota(ring.begin(), ring.end(), 0u);
  const auto point = [&](std::uint32_t i) { return glm::dvec2(corners[i].x, corners[i].y); };
  const auto is_ear = [&](std::size_t at) {
    const glm::dvec2 a = point(ring[(at + ring.size() - 1) % ring.size()]);
    const glm::dvec2 b = point(ring[at]);
    const glm::dvec2 c = point(ring[(at + 1) % ring.size()]);
    if (orientation(a, b, c) <= 0) return false;
    return std::ranges::none_of(ring, [&](std::uint32_t index) {
      const glm::dvec2 p = point(index);
      return p != a && p != b && p != c && orientation(a, b, p) >= 0 && orientation(b, c, p) >= 0 &&
             orientation(c, a, p) >= 0;
    });
  };
  std::size_t start = 1;
  for (int searches = 64; ring.size() > 3 && searches > 0;) {
    std::size_t ear = start % ring.size();
    std::size_t tried = 0;
    while (tried < ring.size() && !is_ear((start + tried) % ring.size())) ++tried;
    if (tried < ring.size())
      ear = (start + tried) % ring.size();
    else
      --searches;
    const std::size_t count = ring.size();
    triangles.push_back({ring[(ear + count - 1) % count], ring[ear], ring[(ear + 1) % count]});
    ring.erase(ring.begin() + static_cast<std::ptrdiff_t>(ear));
    start = ear;
  }
  for (std::size_t i = 2; i < ring.size(); ++i) triangles.push_back({ring[0], ring[i - 1], ring[i]});
  return triangles;
}

/// Counter-clockwise polygons of about `count` corners, by name.
std::map<std::string, std::vector<glm::vec3>> polygons(int count) {
  std::map<std::string, std::vector<glm::vec3>> all;
  const auto at = [](double angle, double radius) {
    return glm::vec3(float(radius * std::cos(angle)), float(radius * std::sin(angle)), 0);
  };
  constexpr double turn = 6.283185307179586;
  std::minstd_rand random(7);
  const auto unit = [&] { return double(random()) / double(std::minstd_rand::max()); };
  for (int i = 0; i < count; ++i) {
    all["circle"].push_back(at(turn * i / count, 1));
    all["star"].push_back(at(turn * i / count, i % 2 == 0 ? 1 : 0.5));
    all["spikes"].push_back(at(turn * i / count, i % 2 == 0 ? 1 : 0.001));
    all["coast"].push_back(at(turn * i / count, 0.5 + 0.5 * unit()));
  }
  // Teeth of a comb, upwards from right to left.
  all["comb"] = {{0, -1, 0}, {float(count), -1, 0}};
  for (int i = count - 1; i > 0; --i) all["comb"].push_back({float(i), i % 4 < 2 ? 5.0f : 0.0f, 0});
  // A band along a spiral, out and back.
  for (int i = 0; i < count / 2; ++i) all["spiral"].push_back(at(0.05 * i, 1 + 0.05 * i / turn));
  for (int i = count / 2 - 1; i >= 0; --i) all["spiral"].push_back(at(0.05 * i, 0.5 + 0.05 * i / turn));
  std::ranges::reverse(all["spiral"]);
  // Nested corners: a band that is folded like an accordion's side.
  for (int i = 0; i < count / 6; ++i)
    for (const glm::vec2 p : {glm::vec2(-1, 0), glm::vec2(0, 1), glm::vec2(1, 0)})
      all["folded"].push_back({i % 2 == 0 ? p.x : -p.x, float(i) * 0.01f + p.y, 0});
  const std::vector<glm::vec3> there = all["folded"];
  for (auto p = there.rbegin(); p != there.rend(); ++p) all["folded"].push_back(*p + glm::vec3(0, 0.004f, 0));
  return all;
}

}  // namespace

TEST_CASE("Searches that remember find the same triangles as the plain algorithm") {
  const auto check_as_plain = [](std::vector<glm::vec3> corners) {
    double area = 0;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const glm::vec3 a = corners[i], b = corners[(i + 1) % corners.size()];
      area += double(a.x) * double(b.y) - double(a.y) * double(b.x);
    }
    if (area < 0) std::ranges::reverse(corners);  // the plain one takes them as they are
    CHECK(triangulate(corners) == plainly_triangulated(corners));
  };
  for (const auto& [name, corners] : polygons(300)) {
    CAPTURE(name);
    check_as_plain(corners);
  }
  std::minstd_rand random(3);
  const auto unit = [&] { return static_cast<float>(random() % 64) / 64; };
  for (int polygon = 0; polygon < 200; ++polygon) {
    std::vector<glm::vec3> corners;
    for (int i = 0; i < 5 + polygon; ++i) {
      const float x = unit();
      corners.push_back({x, unit(), 0});
    }
    CAPTURE(polygon);
    check_as_plain(corners);
  }
}

TEST_CASE("A polygon of any shape takes work in proportion to its corners") {
  // Counted, not measured: triangulate refuses what takes more than 4000 looks for each corner, where the plain
  // algorithm takes 20,000 and more.
  for (auto& [name, corners] : polygons(40000)) {
    CAPTURE(name);
    CHECK(triangulate(corners).size() == corners.size() - 2);
  }
}

TEST_CASE("A large polygon that crosses itself everywhere is split or refused") {
  std::vector<glm::vec3> corners;
  std::minstd_rand random(1);
  const auto unit = [&] { return static_cast<float>(random() % 1024) / 1024; };
  for (int i = 0; i < 20000; ++i) {
    const float x = unit();
    corners.push_back({x, unit(), 0});
  }
  CHECK(triangulate(corners).size() == corners.size() - 2);
}

TEST_CASE("A search of the tree finds a point inside, where there is one left") {
  std::vector<glm::dvec2> points;
  for (int y = 0; y < 50; ++y)
    for (int x = 0; x < 50; ++x) points.emplace_back(x, y);
  PointTree tree(points);
  const auto find = [&] { return tree.find_in_triangle({9.5, 9.5}, {11.5, 9.5}, {9.5, 11.5}); };
  // (10, 10) and, on the edge, (10, 11) and (11, 10)
  for (int found = 0; found < 3; ++found) {
    const auto point = find();
    REQUIRE(point);
    CHECK(points[*point].x + points[*point].y <= 21);
    tree.remove(*point);
    tree.remove(*point);  // has no effect
  }
  CHECK_FALSE(find());
  CHECK_FALSE(tree.find_in_triangle({0, 0}, {1, 0}, {0, 1}));  // its corners do not count
  CHECK(tree.find_in_triangle({0, 0}, {2, 0}, {0, 2}));
}
