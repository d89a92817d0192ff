#include <algorithm>
#include <string>
#include <vector>

#include "conformance/kit/cases.hpp"
#include "conformance/workgroup/shared_memory.hpp"
#include "conformance/workgroup/subgroup_run.hpp"

/// subgroups.idioms: what programs build from several operations, shared memory and barriers. Their answers do not
/// depend on the size of the subgroups.
namespace tandem::conformance {
namespace {

using Capabilities = rhi::Capabilities;

const std::string arithmetic =
    "#extension GL_KHR_shader_subgroup_basic : require\n#extension GL_KHR_shader_subgroup_arithmetic : require\n";

void add_workgroup_sums(const Group& group) {
  group.add("workgroup_sum", "sums of subgroups, summed by the first subgroup", [](Context& context) {
    check_workgroups(context,
                     {.label = "workgroup sum",
                      .extensions = arithmetic,
                      .declarations = "shared uint sums[128], total;",
                      .body = R"(
  const uint sum = subgroupAdd(i + 1u);
  if (subgroupElect()) sums[gl_SubgroupID] = sum;
  if (i == 0u) total = 0u;
  barrier();
  if (gl_SubgroupID == 0u) {
    uint mine = 0u;
    for (uint k = gl_SubgroupInvocationID; k < gl_NumSubgroups; k += gl_SubgroupSize) mine += sums[k];
    const uint all_sums = subgroupAdd(mine);
    if (subgroupElect()) total = all_sums * (group + 1u);
  }
  barrier();
  answers[first + i] = total;
)",
                      .local_size = {128, 1, 1},
                      .bytes = 516},
                     [](auto workgroup, auto) { return 128 * 129 / 2 * (workgroup + 1); });
  });
}

/// Those that pass a test, written side by side: one atomic of a subgroup makes room for all of them.
void check_compaction(Context& context) {
  const SubgroupKernel kernel = {.label = "compaction",
                                 .extensions = {"GL_KHR_shader_subgroup_ballot"},
                                 .declarations = "shared uint used, kept[100];",
                                 .body = R"(
  if (gl_LocalInvocationIndex == 0u) used = 0u;
  barrier();
  const bool passes = i % 7u < 3u;
  const uvec4 votes = subgroupBallot(passes);
  uint begin = 0u;
  if (subgroupElect()) begin = atomicAdd(used, subgroupBallotBitCount(votes));
  begin = subgroupBroadcastFirst(begin);
  if (passes) kept[begin + subgroupBallotExclusiveBitCount(votes)] = i;
  barrier();
  answers[at] = used;
  answers[at + 1] = gl_LocalInvocationIndex < used ? kept[gl_LocalInvocationIndex] : 0xffffffffu;
)",
                                 .columns = 2};
  require_workgroup_memory(context, 404);
  const SubgroupAnswers seen = run_subgroups(context, kernel);
  const std::uint32_t workgroup_size = kernel.local_size[0];
  for (std::uint32_t first = 0; first < seen.invocations.size(); first += workgroup_size) {
    Words expected, kept;
    for (std::uint32_t i = first; i < first + workgroup_size; ++i) {
      if (i % 7 < 3) expected.push_back(i);
      if (i - first < seen.invocations[i].answers[0]) kept.push_back(seen.invocations[i].answers[1]);
    }
    std::sort(kept.begin(), kept.end());
    check_words(kept, expected);
  }
}

/// A scan of the workgroup from scans of subgroups, which follow each other by their numbers.
void check_workgroup_scan(Context& context) {
  require_workgroup_memory(context, 512);
  const SubgroupAnswers seen = run_subgroups(context, {.label = "workgroup scan",
                                                       .extensions = {"GL_KHR_shader_subgroup_arithmetic"},
                                                       .declarations = "shared uint sums[128];",
                                                       .body = R"(
  const uint weight = 1u + gl_LocalInvocationIndex % 3u;
  const uint inside = subgroupInclusiveAdd(weight);
  const uint sum = subgroupAdd(weight);
  if (subgroupElect()) sums[gl_SubgroupID] = sum;
  barrier();
  uint before = 0u;
  for (uint k = 0u; k < gl_SubgroupID; ++k) before += sums[k];
  answers[at] = before + inside;
)"});
  check_values<std::uint32_t>(seen, 0, "the scan",
                              [&](const Subgroup& subgroup, std::uint32_t lane) -> std::optional<std::uint32_t> {
                                std::uint32_t sum = 0;
                                for (const Subgroup& other : seen.subgroups) {
                                  if (other.workgroup != subgroup.workgroup || other.id > subgroup.id) continue;
                                  for (const std::uint32_t k : lanes_of(other))
                                    if (other.id < subgroup.id || k <= lane) sum += 1 + other.lanes[k]->index % 100 % 3;
                                }
                                return sum;
                              });
}

}  // namespace

void add_subgroup_idiom_cases(Cases& cases) {
  const Group with_arithmetic = {
      cases, "subgroups.idioms", {&Capabilities::subgroup_basic, &Capabilities::subgroup_arithmetic}};
  add_workgroup_sums(with_arithmetic);
  with_arithmetic.add("workgroup_scan", "scans of subgroups, continued over the workgroup", check_workgroup_scan);
  Group{cases, "subgroups.idioms", {&Capabilities::subgroup_basic, &Capabilities::subgroup_ballot}}.add(
      "compaction", "invocations that pass a test write side by side, with one atomic of each subgroup",
      check_compaction);
}

}  // namespace tandem::conformance
