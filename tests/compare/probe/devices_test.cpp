#include <doctest/doctest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "compare/probe/answer_check.hpp"
#include "compare/probe/prober.hpp"
#include "compare/probe/probing.hpp"
#include "compare/probe/reference.hpp"
#include "pathtracer/load/scene_loader.hpp"
#include "tests/compare/probe/rays.hpp"
#include "tests/support/device_test.hpp"

using namespace tandem;
using namespace tandem::compare;
using pathtracer::Scene;
using pathtracer::TracingMode;

namespace {

const std::filesystem::path scenes = std::filesystem::path(TANDEM_SOURCE_DIRECTORY) / "scenes";

Scene shipped(const char* name) { return pathtracer::load_scene(scenes / name, {}); }

std::vector<TracingMode> forms_of(const rhi::Device& device) {
  std::vector<TracingMode> forms;
  if (device.info().capabilities.ray_query) forms.push_back(TracingMode::query);
  if (device.info().capabilities.ray_tracing_pipeline) forms.push_back(TracingMode::pipeline);
  REQUIRE_FALSE(forms.empty());
  return forms;
}

/// Every answer of the device to every trial is one that doubles allow.
void check_against_reference(rhi::Device& device, const Scene& scene) {
  const std::vector<PathRay> rays = test::rays_through(scene, 1000, 7);
  const ProbeReference reference(scene);
  for (const TracingMode form : forms_of(device)) {
    CAPTURE(pathtracer::name(form));
    Prober prober(device, scene, form);
    for (const Trial& trial : trials()) {
      if (!prober.supports(trial)) continue;
      CAPTURE(std::string(trial.name));
      const std::vector<ProbeRay> asked = rays_of(trial, rays, reference, scene);
      const std::vector<ProbeAnswer> answers = prober.answer(trial, asked);
      const std::vector<ProbeInstance> instances = reference.instances(trial.instance_setup);
      REQUIRE(answers.size() == asked.size());
      std::size_t wrong = 0, hits = 0;
      for (std::size_t i = 0; i < asked.size(); ++i) {
        hits += answers[i].type == AnswerType::triangle || answers[i].type == AnswerType::sphere ? 1 : 0;
        wrong += is_right(trial, instances, asked[i], reference.hits(trial, instances, asked[i]), answers[i]) ? 0 : 1;
      }
      CHECK(wrong == 0);
      // Where a trial leaves something to meet, rays meet it.
      const bool meets_nothing = trial.window == Window::until_before ||
                                 ((trial.flags & ray_flag::skip_triangles) != 0 && scene.spheres.empty());
      if (!meets_nothing) CHECK(hits > asked.size() / 10);
    }
  }
}

/// What `b` is found to do otherwise than `a`, in every form of either.
void check_no_mismatch(rhi::Device& a, rhi::Device& b, const Scene& scene) {
  const std::vector<PathRay> rays = test::rays_through(scene, 400, 11);
  for (const TracingMode form_a : forms_of(a)) {
    for (const TracingMode form_b : forms_of(b)) {
      CAPTURE(pathtracer::name(form_a));
      CAPTURE(pathtracer::name(form_b));
      const Probing probing = probe(a, b, scene, rays, form_a, form_b);
      CHECK(probing.rays == rays.size());
      CHECK(probing.trials.size() + probing.left_out.size() == trials().size());
      CHECK(probing.count(DifferenceClass::mismatch) == 0);
      CHECK(probing.count(DifferenceClass::flipped_decision) == 0);
      // Seldom does a ray pass an edge within rounding that was not aimed at one.
      CHECK(probing.differences.size() < rays.size() * trials().size() / 50);
      if (&a != &b) continue;
      CHECK(probing.differences.empty());
      for (const ProbeTrial& trial : probing.trials) CHECK(trial.bit_equal == trial.rays);
    }
  }
}

}  // namespace

TANDEM_DEVICE_TEST("Devices answer every trial as doubles do: a soup of triangles and spheres") {
  check_against_reference(device, test::soup(400, 30, 1));
}

TANDEM_DEVICE_TEST("Devices answer every trial as doubles do: the Cornell box") {
  check_against_reference(device, shipped("cornell_box.obj"));
}

TANDEM_DEVICE_TEST("Devices answer every trial as doubles do: foliage") {
  check_against_reference(device, shipped("foliage.obj"));
}

TANDEM_DEVICE_TEST("Probes find nothing between a device and the exact one, nor between a device's own forms") {
  rhi::Device& exact = *test::device("cpu-exact");
  for (const Scene& scene : {test::soup(300, 20, 2), shipped("cornell_box.obj")}) {
    check_no_mismatch(device, exact, scene);
    check_no_mismatch(device, device, scene);
  }
}

TANDEM_DEVICE_TEST("Probes find nothing between a device and the CPU on shipped scenes") {
  rhi::Device& cpu = *test::device("cpu");
  for (const char* name : {"cornell_box.obj", "cornell_spheres.obj", "foliage.obj", "in_one_weekend.json"}) {
    CAPTURE(name);
    check_no_mismatch(cpu, device, shipped(name));
  }
}
