#include "compare/probe/probing.hpp"

#include <bit>

#include "compare/image/ulp.hpp"
#include "compare/probe/answer_check.hpp"
#include "compare/probe/prober.hpp"
#include "compare/probe/reference.hpp"

namespace tandem::compare {
namespace {

std::size_t index_of(DifferenceClass kind) { return static_cast<std::size_t>(kind); }

}  // namespace

std::uint64_t Probing::count(DifferenceClass kind) const { return classes()[index_of(kind)]; }

ClassCounts Probing::classes() const {
  ClassCounts sums{};
  for (const ProbeTrial& trial : trials)
    for (std::size_t i = 0; i < sums.size(); ++i) sums[i] += trial.classes[i];
  return sums;
}

Probing probe(rhi::Device& a, rhi::Device& b, const pathtracer::Scene& scene, std::span<const PathRay> rays,
              std::optional<pathtracer::TracingMode> form_a, std::optional<pathtracer::TracingMode> form_b) {
  std::vector<PathRay> askable;
  for (const PathRay& ray : rays)
    if (is_askable(ray.ray)) askable.push_back(ray);
  Probing probing;
  probing.rays = askable.size();
  if (askable.empty()) return probing;

  Prober prober_a(a, scene, form_a), prober_b(b, scene, form_b);
  const ProbeReference reference(scene);
  for (const Trial& trial : trials()) {
    if (!prober_a.supports(trial) || !prober_b.supports(trial)) {
      const rhi::Device& device = prober_a.supports(trial) ? b : a;
      probing.left_out.push_back(std::string(trial.name) + ": the pipelines of " + device.info().name +
                                 " cannot skip primitives");
      continue;
    }
    const std::vector<ProbeRay> asked = rays_of(trial, askable, reference, scene);
    const std::vector<ProbeAnswer> answers_a = prober_a.answer(trial, asked);
    const std::vector<ProbeAnswer> answers_b = prober_b.answer(trial, asked);
    const std::vector<ProbeInstance> instances = reference.instances(trial.instance_setup);
    ProbeTrial summary{.name = trial.name, .rays = asked.size()};
    for (std::size_t i = 0; i < asked.size(); ++i) {
      // Nothing has to be traced in doubles where both devices say the same.
      if (!differ(trial, answers_a[i], answers_b[i])) {
        ++summary.bit_equal;
        continue;
      }
      const std::vector<ProbeHit> hits = reference.hits(trial, instances, asked[i]);
      const AnswerCheck check = check_answers(trial, instances, asked[i], hits, answers_a[i], answers_b[i]);
      ++summary.classes[index_of(check.kind)];
      if (check.kind == DifferenceClass::rounding) continue;
      const std::uint32_t bits_a = bits_of(answers_a[i], *check.field);
      const std::uint32_t bits_b = bits_of(answers_b[i], *check.field);
      const bool is_number = check.field->kind == ProbeField::Kind::number;
      probing.differences.push_back(
          {.path = askable[i].path,
           .ray_index = askable[i].index,
           .trial = trial.name,
           .field = check.field,
           .a = bits_a,
           .b = bits_b,
           .ulp = is_number ? ulp_distance(std::bit_cast<float>(bits_a), std::bit_cast<float>(bits_b)) : 0,
           .kind = check.kind,
           .ruling = check.ruling});
    }
    probing.trials.push_back(summary);
  }
  return probing;
}

}  // namespace tandem::compare
