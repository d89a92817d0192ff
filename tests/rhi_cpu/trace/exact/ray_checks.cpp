#include "tests/rhi_cpu/trace/exact/ray_checks.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <bit>
#include <tuple>

namespace tandem::test {
namespace {

using namespace tandem::kernel;

std::uint32_t bits(float x) { return std::bit_cast<std::uint32_t>(x); }

auto id_of(const Hit& hit) { return std::make_tuple(hit.instance_index, hit.geometry_index, hit.primitive_index); }

bool equal(const Hit& a, const Hit& b) {
  return bits(a.t) == bits(b.t) && bits(a.barycentrics[0]) == bits(b.barycentrics[0]) &&
         bits(a.barycentrics[1]) == bits(b.barycentrics[1]) && id_of(a) == id_of(b) && a.front_face == b.front_face &&
         a.opaque == b.opaque && a.is_box == b.is_box;
}

/// A shader's decision about a candidate, as arbitrary as it can be.
bool is_accepted(const Hit& hit) { return (hit.instance_index + hit.geometry_index + hit.primitive_index) % 3 == 0; }

/// What a box's shader makes of it: a hit where the ray enters, if any.
struct Recorder {
  std::vector<Hit> offered;
  float last_t_max = 0;
};

CandidateDecision on_triangle(void* context, const Hit& candidate) {
  static_cast<Recorder*>(context)->offered.push_back(candidate);
  return is_accepted(candidate) ? CandidateDecision::commit : CandidateDecision::ignore;
}

CandidateDecision on_box(void* context, Hit& candidate, float t_max) {
  Recorder& recorder = *static_cast<Recorder*>(context);
  recorder.offered.push_back(candidate);
  CHECK(candidate.t <= t_max);
  recorder.last_t_max = t_max;
  return is_accepted(candidate) ? CandidateDecision::commit : CandidateDecision::ignore;
}

void check_next_hits(const TopLevel& scene, const Ray& ray, const std::vector<Hit>& expected, std::uint32_t capacity) {
  std::vector<Hit> found;
  std::vector<Hit> page(capacity);
  for (;;) {
    const Hit previous = found.empty() ? Hit{} : found.back();
    const std::uint32_t count =
        scene.functions->next_hits(scene, ray, found.empty() ? nullptr : &previous, page.data(), capacity);
    REQUIRE(count <= capacity);
    found.insert(found.end(), page.begin(), page.begin() + count);
    REQUIRE(found.size() <= expected.size());
    if (count < capacity) break;
  }
  CHECK(std::equal(found.begin(), found.end(), expected.begin(), expected.end(), equal));
}

void check_visit(const TopLevel& scene, const Ray& ray, const std::vector<Hit>& expected, bool visits_opaque) {
  Recorder recorder;
  const CandidateVisitor visitor{
      .context = &recorder, .triangle = &on_triangle, .box = &on_box, .visits_opaque_triangles = visits_opaque};
  const auto commits = [&](const Hit& hit) {
    return (hit.opaque && !hit.is_box && !visits_opaque) || is_accepted(hit);
  };
  Hit committed;
  const bool found = scene.functions->visit(scene, ray, visitor, committed);
  const auto nearest = std::find_if(expected.begin(), expected.end(), commits);
  REQUIRE(found == (nearest != expected.end()));
  std::vector<Hit> offered = recorder.offered;
  std::sort(offered.begin(), offered.end(), [](const Hit& a, const Hit& b) { return id_of(a) < id_of(b); });
  CHECK(std::adjacent_find(offered.begin(), offered.end(),
                           [](const Hit& a, const Hit& b) { return id_of(a) == id_of(b); }) == offered.end());
  for (const Hit& hit : recorder.offered) {
    CHECK(std::any_of(expected.begin(), expected.end(), [&](const Hit& each) { return equal(each, hit); }));
  }
  if ((ray.flags & ray_flag_terminate_on_first_hit) != 0) {
    if (found)
      CHECK(std::any_of(expected.begin(), expected.end(),
                        [&](const Hit& each) { return commits(each) && equal(each, committed); }));
    return;
  }
  // A box and another hit at the same t may replace each other.
  if (found) CHECK((equal(committed, *nearest) || (committed.t == nearest->t && commits(committed))));
  for (auto hit = expected.begin(); hit != nearest && (!found || hit->t < nearest->t); ++hit) {
    const bool must_be_offered = hit->is_box || !hit->opaque || visits_opaque;
    if (must_be_offered)
      CHECK(std::any_of(offered.begin(), offered.end(), [&](const Hit& each) { return equal(each, *hit); }));
  }
}

}  // namespace

void check_ray(const TopLevel& scene, const Ray& ray, const std::vector<Hit>& expected) {
  CAPTURE(ray.flags);
  CAPTURE(ray.mask);
  const auto triangle = std::find_if(expected.begin(), expected.end(), [](const Hit& hit) { return !hit.is_box; });
  const bool any = triangle != expected.end();
  Hit hit;
  REQUIRE(scene.functions->closest(scene, ray, hit) == any);
  CHECK(scene.functions->occluded(scene, ray) == any);
  if (any) {
    Hit nearest = *triangle;
    nearest.opaque = true;
    CHECK(equal(hit, nearest));
  }
  for (const std::uint32_t capacity : {1u, 3u, 64u}) check_next_hits(scene, ray, expected, capacity);
  check_visit(scene, ray, expected, false);
  check_visit(scene, ray, expected, true);
}

std::size_t check_ray(const RationalScene& scene, const TopLevel& built, const Ray& ray) {
  const std::vector<Hit> expected = all_hits(scene, ray);
  check_ray(built, ray, expected);
  return expected.size();
}

}  // namespace tandem::test
