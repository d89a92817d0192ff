#include <algorithm>
#include <bit>
#include <string>
#include <vector>

#include "conformance/kit/cases.hpp"
#include "conformance/workgroup/subgroup_run.hpp"

/// subgroups.basic: the built-ins, elect and barriers. subgroups.vote and subgroups.ballot. subgroups.size_control:
/// pipelines that require a size, or full subgroups.
namespace tandem::conformance {
namespace {

using Capabilities = rhi::Capabilities;
using Size = std::array<std::uint32_t, 3>;
using Word = std::optional<std::uint32_t>;

/// Places, and who is elected.
SubgroupKernel places(const Size& local_size) {
  return {.label = "places in subgroups",
          .body = "  answers[at] = uint(subgroupElect());",
          .columns = 1,
          .local_size = local_size};
}

/// What places() answers.
SubgroupAnswers elected(Context& context, const SubgroupKernel& kernel) {
  SubgroupAnswers seen = run_subgroups(context, kernel);
  check_values<std::uint32_t>(seen, 0, "subgroupElect", [](const Subgroup& subgroup, std::uint32_t lane) -> Word {
    return lane == lanes_of(subgroup).front() ? 1 : 0;
  });
  return seen;
}

/// The subgroups of the device by default, whose size is known.
void check_places(Context& context, const Size& local_size) {
  const SubgroupAnswers seen = elected(context, places(local_size));
  const std::uint32_t size = context.device().info().limits.subgroup_size;
  for (const Subgroup& subgroup : seen.subgroups) check_equal("gl_SubgroupSize", subgroup.size, size);
}

void add_basic_cases(Cases& cases) {
  const Group group = {cases, "subgroups.basic", {&Capabilities::subgroup_basic}};
  const std::string behaviour =
      "each invocation has a place of its own, all agree about the sizes, and the first of a subgroup is elected";
  group.add("line", behaviour, [](Context& context) { check_places(context, {100, 1, 1}); });
  group.add("rectangle", behaviour, [](Context& context) { check_places(context, {9, 7, 1}); });
  group.add("box", behaviour, [](Context& context) { check_places(context, {3, 5, 7}); });
  group.add("one_invocation", behaviour, [](Context& context) { check_places(context, {1, 1, 1}); });
  group.add("workgroups", "subgroups do not reach over workgroups", [](Context& context) {
    SubgroupKernel kernel = places({5, 1, 1});
    kernel.workgroup_count = {3, 2, 4};
    const SubgroupAnswers seen = elected(context, kernel);
    std::vector<std::uint32_t> invocations(24);
    for (const Subgroup& subgroup : seen.subgroups)
      invocations[subgroup.workgroup] += static_cast<std::uint32_t>(lanes_of(subgroup).size());
    for (const std::uint32_t count : invocations) check_equal("the invocations of a workgroup", count, 5);
  });
  group.add("barriers", "subgroup barriers order accesses to shared memory", [](Context& context) {
    constexpr std::uint32_t places = 2048;
    if (context.device().info().limits.workgroup_memory_size < places * 4)
      throw Unsupported("the device lacks workgroup memory");
    const SubgroupAnswers seen = run_subgroups(context, {.label = "subgroup barriers",
                                                         .declarations = "shared uint here[2048];",
                                                         .body = R"(
  const uint first = gl_SubgroupID * gl_SubgroupSize, place = first + gl_SubgroupInvocationID;
  for (uint k = 0u; k < 4u; ++k) {
    if (place < 2048u) here[place] = i * 5u + k;
    subgroupMemoryBarrierShared();
    subgroupBarrier();
    answers[at + k] = here[min(first + (gl_SubgroupInvocationID ^ 1u), 2047u)];
    subgroupBarrier();
  }
)",
                                                         .columns = 4});
    for (std::uint32_t k = 0; k < 4; ++k)
      check_values<std::uint32_t>(seen, k, "the neighbour's value",
                                  [k](const Subgroup& subgroup, std::uint32_t lane) -> Word {
                                    const std::uint32_t other = lane ^ 1;
                                    const bool is_kept = subgroup.id * subgroup.size + other < places;
                                    if (!is_kept || other >= subgroup.size || subgroup.lanes[other] == nullptr)
                                      return {};
                                    return subgroup.lanes[other]->index * 5 + k;
                                  });
  });
}

void check_votes(Context& context) {
  constexpr std::uint32_t columns = 11;
  const SubgroupAnswers seen = run_subgroups(context, {.label = "subgroup votes",
                                                       .extensions = {"GL_KHR_shader_subgroup_vote"},
                                                       .body = R"(
  const bool not_50 = i != 50u;
  answers[at] = uint(subgroupAll(true));
  answers[at + 1] = uint(subgroupAll(not_50));
  answers[at + 2] = uint(subgroupAny(!not_50));
  answers[at + 3] = uint(subgroupAny(false));
  answers[at + 4] = uint(subgroupAllEqual(gl_SubgroupID + 7u));
  answers[at + 5] = uint(subgroupAllEqual(int(not_50)));
  answers[at + 6] = uint(subgroupAllEqual(not_50));
  answers[at + 7] = uint(subgroupAllEqual(not_50 ? 1.5 : -1.5));
  answers[at + 8] = uint(subgroupAllEqual(vec3(1.0, float(gl_SubgroupID), not_50 ? 3.0 : 4.0)));
  answers[at + 9] = uint(subgroupAllEqual(uvec2(gl_WorkGroupID.x, 5u)));
  answers[at + 10] = uint(subgroupAllEqual(i));
)",
                                                       .columns = columns});
  for (std::uint32_t column = 0; column < columns; ++column)
    check_values<std::uint32_t>(
        seen, column, fmt::format("vote {}", column), [column](const Subgroup& subgroup, std::uint32_t) -> Word {
          const std::vector<std::uint32_t> lanes = lanes_of(subgroup);
          const bool has_50 = std::any_of(lanes.begin(), lanes.end(),
                                          [&](std::uint32_t lane) { return subgroup.lanes[lane]->index == 50; });
          const bool alone = lanes.size() == 1;
          switch (column) {
            case 0:
            case 4:
            case 9:
              return 1;
            case 1:
              return has_50 ? 0 : 1;
            case 2:
              return has_50 ? 1 : 0;
            case 3:
              return 0;
            case 10:
              return alone ? 1 : 0;
            default:
              return alone || !has_50 ? 1 : 0;
          }
        });
}

/// Four words of a mask of lanes.
using Mask = std::array<std::uint32_t, 4>;

Mask mask_of(const Subgroup& subgroup, const std::function<bool(std::uint32_t lane)>& is_set, bool only_present) {
  Mask mask = {};
  for (std::uint32_t lane = 0; lane < subgroup.size; ++lane)
    if ((!only_present || subgroup.lanes[lane] != nullptr) && is_set(lane)) mask[lane / 32] |= 1u << lane % 32;
  return mask;
}

void check_ballots(Context& context) {
  const SubgroupAnswers seen = run_subgroups(context, {.label = "subgroup ballots",
                                                       .extensions = {"GL_KHR_shader_subgroup_ballot"},
                                                       .body = R"(
  const bool third = i % 3u == 1u;
  const uvec4 everyone = subgroupBallot(true), some = subgroupBallot(third);
  const uvec4 pattern = uvec4(0x5a0ff05au, 0x12345678u, 0xffff0000u, 1u);
  for (uint k = 0u; k < 4u; ++k) { answers[at + k] = everyone[k]; answers[at + 4u + k] = some[k]; }
  answers[at + 8] = uint(subgroupInverseBallot(some));
  answers[at + 9] = uint(subgroupBallotBitExtract(pattern, gl_SubgroupInvocationID));
  answers[at + 10] = subgroupBallotBitCount(some);
  answers[at + 11] = subgroupBallotInclusiveBitCount(some);
  answers[at + 12] = subgroupBallotExclusiveBitCount(some);
  answers[at + 13] = subgroupBallotFindLSB(everyone);
  answers[at + 14] = subgroupBallotFindMSB(everyone);
  answers[at + 15] = subgroupBroadcastFirst(i);
  answers[at + 16] = subgroupBroadcast(i * 3u, 0u);
)",
                                                       .columns = 17});
  const auto third = [](const Subgroup& subgroup, std::uint32_t lane) { return subgroup.lanes[lane]->index % 3 == 1; };
  for (std::uint32_t column = 0; column < 17; ++column)
    check_values<std::uint32_t>(
        seen, column, fmt::format("ballot word {}", column),
        [column, third](const Subgroup& subgroup, std::uint32_t lane) -> Word {
          const std::vector<std::uint32_t> lanes = lanes_of(subgroup);
          constexpr Mask pattern = {0x5a0ff05au, 0x12345678u, 0xffff0000u, 1u};
          const auto count_below = [&](std::uint32_t end) {
            return static_cast<std::uint32_t>(std::count_if(lanes.begin(), lanes.end(), [&](std::uint32_t other) {
              return other < end && third(subgroup, other);
            }));
          };
          if (column < 4)
            return mask_of(
                subgroup, [](std::uint32_t) { return true; }, true)[column];
          if (column < 8)
            return mask_of(
                subgroup, [&](std::uint32_t other) { return third(subgroup, other); }, true)[column - 4];
          switch (column) {
            case 8:
              return third(subgroup, lane) ? 1 : 0;
            case 9:
              return pattern[lane / 32] >> lane % 32 & 1;
            case 10:
              return count_below(subgroup.size);
            case 11:
              return count_below(lane + 1);
            case 12:
              return count_below(lane);
            case 13:
              return lanes.front();
            case 14:
              return lanes.back();
            case 15:
              return subgroup.lanes[lanes.front()]->index;
            default:
              if (subgroup.lanes[0] == nullptr) return {};
              return subgroup.lanes[0]->index * 3;
          }
        });
}

void check_masks(Context& context) {
  const SubgroupAnswers seen = run_subgroups(context, {.label = "subgroup masks",
                                                       .extensions = {"GL_KHR_shader_subgroup_ballot"},
                                                       .body = R"(
  for (uint k = 0u; k < 4u; ++k) {
    answers[at + k] = gl_SubgroupEqMask[k];
    answers[at + 4u + k] = gl_SubgroupGeMask[k];
    answers[at + 8u + k] = gl_SubgroupGtMask[k];
    answers[at + 12u + k] = gl_SubgroupLeMask[k];
    answers[at + 16u + k] = gl_SubgroupLtMask[k];
  }
)",
                                                       .columns = 20});
  for (std::uint32_t column = 0; column < 20; ++column)
    check_values<std::uint32_t>(
        seen, column, fmt::format("word {} of the masks", column),
        [column](const Subgroup& subgroup, std::uint32_t lane) -> Word {
          const auto is_set = [&](std::uint32_t bit) {
            const std::array relations = {bit == lane, bit >= lane, bit > lane, bit <= lane, bit < lane};
            return relations[column / 4];
          };
          return mask_of(subgroup, is_set, false)[column % 4];
        });
}

void add_vote_and_ballot_cases(Cases& cases) {
  Group{cases, "subgroups.vote", {&Capabilities::subgroup_basic, &Capabilities::subgroup_vote}}.add(
      "all_any_equal", "votes count the subgroup's invocations and no others", check_votes);
  const Group ballot = {cases, "subgroups.ballot", {&Capabilities::subgroup_basic, &Capabilities::subgroup_ballot}};
  ballot.add("ballots", "a ballot has the bits of the subgroup's invocations, and its bits are counted and found",
             check_ballots);
  ballot.add("masks", "the masks of the lanes from, up to and at an invocation's own", check_masks);
}

/// Every size that the device lets a pipeline require.
void check_required_sizes(Context& context, bool full) {
  const rhi::Limits& limits = context.device().info().limits;
  for (std::uint32_t size = limits.min_subgroup_size; size <= limits.max_subgroup_size; size *= 2) {
    SubgroupKernel kernel = places({full ? std::max(size, 32u) : 29, 2, 1});
    kernel.options = {.required_subgroup_size = size, .full_subgroups = full};
    const SubgroupAnswers seen = elected(context, kernel);
    for (const Subgroup& subgroup : seen.subgroups) {
      check_equal("gl_SubgroupSize", subgroup.size, size);
      if (full) check_equal("the invocations of a full subgroup", lanes_of(subgroup).size(), size);
    }
  }
}

void add_size_control_cases(Cases& cases) {
  Group{cases, "subgroups.size_control", {&Capabilities::subgroup_basic, &Capabilities::required_subgroup_size}}.add(
      "required", "subgroups have the size that a pipeline requires",
      [](Context& context) { check_required_sizes(context, false); });
  Group{cases,
        "subgroups.size_control",
        {&Capabilities::subgroup_basic, &Capabilities::required_subgroup_size, &Capabilities::full_subgroups}}
      .add("required_and_full", "full subgroups of a required size have that many invocations",
           [](Context& context) { check_required_sizes(context, true); });
  Group{cases, "subgroups.size_control", {&Capabilities::subgroup_basic, &Capabilities::full_subgroups}}.add(
      "full", "every lane of a full subgroup has an invocation", [](Context& context) {
        const std::uint32_t size = context.device().info().limits.subgroup_size;
        SubgroupKernel kernel = places({std::max(size, 32u), 3, 1});
        kernel.options.full_subgroups = true;
        const SubgroupAnswers seen = elected(context, kernel);
        for (const Subgroup& subgroup : seen.subgroups)
          check_equal("the invocations of a full subgroup", lanes_of(subgroup).size(), size);
      });
  Group{cases, "subgroups.size_control", {&Capabilities::required_subgroup_size}}.add(
      "impossible", "a size that is no power of two, or out of range, is refused", [](Context& context) {
        for (const std::uint32_t size : {3u, 6u, context.device().info().limits.max_subgroup_size * 2}) {
          SubgroupKernel kernel = places({8, 1, 1});
          kernel.options.required_subgroup_size = size;
          bool refused = false;
          try {
            run_subgroups(context, kernel);
          } catch (const rhi::Error& error) {
            refused = error.code() == rhi::ErrorCode::invalid_argument;
          }
          check(refused, fmt::format("a pipeline with subgroups of {} was made", size));
        }
      });
}

}  // namespace

void add_subgroup_basic_cases(Cases& cases) {
  add_basic_cases(cases);
  add_vote_and_ballot_cases(cases);
  add_size_control_cases(cases);
}

}  // namespace tandem::conformance
