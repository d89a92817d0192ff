#include <doctest/doctest.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <functional>
#include <string>
#include <vector>

#include "compare/probe/answer_check.hpp"
#include "compare/probe/prober.hpp"
#include "compare/probe/ray.hpp"
#include "compare/probe/reference.hpp"
#include "tests/compare/probe/rays.hpp"
#include "tests/support/device_test.hpp"

using namespace tandem;
using namespace tandem::compare;

namespace {

const Trial& trial_named(const std::string& name) {
  for (const Trial& trial : trials())
    if (trial.name == name) return trial;
  FAIL("no such trial: " << name);
  return trials().front();
}

void set_bits(ProbeAnswer& answer, const ProbeField& field, std::uint32_t bits) {
  std::memcpy(reinterpret_cast<std::byte*>(&answer) + field.offset, &bits, sizeof(bits));
}

/// A trial on the CPU, and what the reference says of each ray.
struct Asked {
  Asked(const pathtracer::Scene& scene, const Trial& asked_trial, std::size_t ray_count)
      : trial(asked_trial), prober(*test::device("cpu"), scene), reference(scene) {
    instances = reference.instances(trial.instance_setup);
    rays = rays_of(trial, test::rays_through(scene, ray_count, 13), reference, scene);
    answers = prober.answer(trial, rays);
    for (const ProbeRay& ray : rays) hits.push_back(reference.hits(trial, instances, ray));
  }

  AnswerCheck check(std::size_t ray, const ProbeAnswer& b) const {
    return check_answers(trial, instances, rays[ray], hits[ray], answers[ray], b);
  }

  Trial trial;
  Prober prober;
  ProbeReference reference;
  std::vector<ProbeInstance> instances;
  std::vector<ProbeRay> rays;
  std::vector<ProbeAnswer> answers;
  std::vector<std::vector<ProbeHit>> hits;
};

/// How many answers are mismatches in which b is wrong, when b does as `change` makes of the trial and its rays.
std::size_t mismatches(const char* name, const std::function<void(Trial&, std::vector<ProbeRay>&)>& change) {
  CAPTURE(std::string(name));
  static const pathtracer::Scene scene = test::soup(200, 30, 4);
  Asked asked(scene, trial_named(name), 400);
  Trial changed = asked.trial;
  std::vector<ProbeRay> rays = asked.rays;
  change(changed, rays);
  const std::vector<ProbeAnswer> answers = asked.prober.answer(changed, rays);
  std::size_t count = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (!differ(asked.trial, asked.answers[i], answers[i])) continue;
    const AnswerCheck check = asked.check(i, answers[i]);
    if (check.kind != DifferenceClass::mismatch) continue;
    CHECK(check.ruling == Ruling::a_right);
    ++count;
  }
  return count;
}

}  // namespace

TEST_CASE("A field that is off is named, and one that is a unit in the last place off is rounding") {
  const pathtracer::Scene scene = test::soup(200, 30, 4);
  for (const char* name : {"plain", "turned instance", "mirrored instance", "sheared instance"}) {
    CAPTURE(std::string(name));
    const Asked asked(scene, trial_named(name), 300);
    std::size_t checked = 0;
    for (std::size_t i = 0; i < asked.rays.size(); ++i) {
      // Of a ray that passes an edge more than one answer is right.
      if (asked.hits[i].size() != 1 || !asked.hits[i].front().counts) continue;
      const bool is_triangle = asked.answers[i].type == AnswerType::triangle;
      for (const ProbeField& field : probe_fields()) {
        const bool is_barycentric = field.offset == offsetof(ProbeAnswer, barycentrics) ||
                                    field.offset == offsetof(ProbeAnswer, barycentrics) + sizeof(float);
        if (is_barycentric && !is_triangle) continue;
        CAPTURE(std::string(field.name));
        const std::uint32_t bits = bits_of(asked.answers[i], field);
        ProbeAnswer wrong = asked.answers[i];
        if (field.kind == ProbeField::Kind::number) {
          ProbeAnswer rounded = asked.answers[i];
          const float value = std::bit_cast<float>(bits);
          set_bits(rounded, field, std::bit_cast<std::uint32_t>(std::nextafter(value, 10.0f)));
          if (value != 0) CHECK(asked.check(i, rounded).kind == DifferenceClass::rounding);
          set_bits(wrong, field, std::bit_cast<std::uint32_t>(value + 0.125f));
          // Of a triangle that is met as flat as that nothing better is known.
          if (is_barycentric && asked.hits[i].front().intersection.barycentric_errors[0] > 0.05) continue;
          if (is_barycentric && asked.hits[i].front().intersection.barycentric_errors[1] > 0.05) continue;
        } else {
          set_bits(wrong, field, bits + 1);
        }
        const AnswerCheck check = asked.check(i, wrong);
        CHECK(check.kind == DifferenceClass::mismatch);
        CHECK(check.ruling == Ruling::a_right);
        CHECK(std::string(check.field->name) == field.name);
        ++checked;
      }
    }
    CHECK(checked > 1000);
  }
}

TEST_CASE("A ray that starts on a surface may meet it, but not farther off than rounding") {
  pathtracer::Scene scene;
  scene.name = "two floors";
  scene.positions = {{-1, -1, 1}, {3, -1, 1}, {-1, 3, 1}, {-1, -1, 0}, {3, -1, 0}, {-1, 3, 0}};
  scene.triangles = {{.vertices = {0, 1, 2}, .material = 0}, {.vertices = {3, 4, 5}, .material = 0}};
  const Trial& trial = trial_named("plain");
  const ProbeReference reference(scene);
  const std::vector<ProbeInstance> instances = reference.instances(trial.instance_setup);
  const ProbeRay ray = {.origin = {0.25f, 0.5f, 1}, .t_min = 0, .direction = {0, 0, -1}, .t_max = 10};
  const std::vector<ProbeHit> hits = reference.hits(trial, instances, ray);
  ProbeAnswer far, near;
  far.type = near.type = AnswerType::triangle;
  far.geometry = 1;
  far.t = 1;
  near.t = 1e-7f;
  CHECK(check_answers(trial, instances, ray, hits, far, near).kind == DifferenceClass::coincident_geometry);
  near.t = 1e-3f;
  const AnswerCheck check = check_answers(trial, instances, ray, hits, far, near);
  CHECK(check.kind == DifferenceClass::mismatch);
  CHECK(check.ruling == Ruling::a_right);
  CHECK(std::string(check.field->name) == "geometry");
}

TEST_CASE("An answer that was not given is a mismatch") {
  const pathtracer::Scene scene = test::soup(200, 30, 4);
  for (const char* name : {"plain", "terminate on first hit"}) {
    const Asked asked(scene, trial_named(name), 50);
    ProbeAnswer none;
    none.type = AnswerType::missing;
    for (std::size_t i = 0; i < asked.rays.size(); ++i) {
      REQUIRE(differ(asked.trial, asked.answers[i], none));
      CHECK(asked.check(i, none).kind == DifferenceClass::mismatch);
      CHECK(asked.check(i, none).ruling == Ruling::a_right);
    }
  }
}

TEST_CASE("A device that does not heed what a trial asks for is found") {
  using Rays = std::vector<ProbeRay>;
  const auto without_flags = [](Trial& trial, Rays&) { trial.flags = ray_flag::none; };
  for (const char* name :
       {"back faces culled", "front faces culled", "opaque culled", "non-opaque culled", "all opaque", "none opaque",
        "triangles skipped", "boxes skipped", "mirrored, back faces culled", "flipped facing", "culling disabled"}) {
    CAPTURE(std::string(name));
    const std::size_t count = mismatches(name, without_flags);
    // An instance that disables culling has the same answers without.
    CHECK((count > 0) == (std::string(name) != "culling disabled"));
  }
  const auto accept_everything = [](Trial& trial, Rays&) { trial.acceptance = accept_all; };
  for (const char* name : {"candidates rejected", "forced non-opaque", "none opaque"})
    CHECK(mismatches(name, accept_everything) > 0);
  CHECK(mismatches("culling disabled", [](Trial& trial, Rays&) {
          trial.target = 0;
          trial.flags = 0x100;
        }) > 0);
  CHECK(mismatches("instance mask", [](Trial& trial, Rays&) { trial.mask = 0xff; }) > 0);
  CHECK(mismatches("instance mask", [](Trial& trial, Rays&) { trial.mask &= 0x0f; }) > 0);
  CHECK(mismatches("back faces culled", [](Trial& trial, Rays&) { trial.flags = ray_flag::cull_front_faces; }) > 0);
  CHECK(mismatches("from behind the hit", [](Trial&, Rays& rays) {
          for (ProbeRay& ray : rays) ray.t_min = 0;
        }) > 0);
  CHECK(mismatches("until before the hit", [](Trial&, Rays& rays) {
          for (ProbeRay& ray : rays) ray.t_max = 1e30f;
        }) > 0);
  // A range that is cut a little too much.
  CHECK(mismatches("from before the hit", [](Trial&, Rays& rays) {
          for (ProbeRay& ray : rays) ray.t_min *= 1.01f;
        }) > 0);
  CHECK(mismatches("until behind the hit", [](Trial&, Rays& rays) {
          for (ProbeRay& ray : rays) ray.t_max *= 0.99f;
        }) > 0);
  CHECK(mismatches("without indices",
                   [](Trial& trial, Rays&) { trial.instance_setup = InstanceSetup::build_transform; }) > 0);
}

TEST_CASE("Rays are spread evenly, and those that cannot be asked are known") {
  const pathtracer::Scene scene = test::soup(20, 0, 4);
  const std::vector<PathRay> rays = test::rays_through(scene, 100, 1);
  const std::vector<PathRay> some = spread_evenly(rays, 10);
  REQUIRE(some.size() == 10);
  for (std::size_t i = 0; i < some.size(); ++i) CHECK(some[i].ray.origin == rays[10 * i].ray.origin);
  CHECK(spread_evenly(rays, 1000).size() == 100);
  pathtracer::TracedRay ray = rays.front().ray;
  CHECK(is_askable(ray));
  ray.direction = glm::vec3(0);
  CHECK_FALSE(is_askable(ray));
  ray.direction = glm::vec3(0, std::nanf(""), 1);
  CHECK_FALSE(is_askable(ray));
}
