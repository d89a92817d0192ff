#include <algorithm>
#include <bit>
#include <string>
#include <vector>

#include "conformance/kit/cases.hpp"
#include "conformance/workgroup/subgroup_run.hpp"

/// subgroups.divergent_operations: every class of operations in a branch that part of a subgroup takes. A ballot in the
/// same branch says who takes part.
namespace tandem::conformance {
namespace {

using Capabilities = rhi::Capabilities;
using Word = std::optional<std::uint32_t>;

/// Those who are in the branch together with `self`, and its lane among them.
struct Party {
  std::vector<const Invocation*> members;  ///< by lane
  std::uint32_t lane = 0;

  const Invocation* member_at(std::uint32_t wanted) const {
    const auto found = std::find_if(members.begin(), members.end(),
                                    [wanted](const Invocation* member) { return member->lane == wanted; });
    return found == members.end() ? nullptr : *found;
  }
};

/// An expression of x = i, and what it is for an invocation of a party; nothing where it is undefined.
struct Row {
  std::string glsl;
  std::function<Word(const Party&)> expected;
};

constexpr std::uint32_t ballot_words = 4;

/// sum(f(i)) over those members for which `counts`.
template <typename Value, typename Counts>
std::uint32_t sum(const Party& party, const Value& value, const Counts& counts) {
  std::uint32_t result = 0;
  for (const Invocation* member : party.members)
    if (counts(member->lane)) result += static_cast<std::uint32_t>(value(member->index));
  return result;
}

Word index_at(const Party& party, std::uint32_t lane) {
  const Invocation* const member = party.member_at(lane);
  return member == nullptr ? Word() : member->index;
}

std::vector<Row> arithmetic_rows() {
  const auto everyone = [](std::uint32_t) { return true; };
  return {{"subgroupAdd(x)",
           [=](const Party& p) {
             return sum(
                 p, [](auto i) { return i; }, everyone);
           }},
          {"subgroupInclusiveAdd(x * 3u)",
           [](const Party& p) {
             return sum(
                 p, [](auto i) { return i * 3; }, [&](auto lane) { return lane <= p.lane; });
           }},
          {"subgroupExclusiveMul(x | 1u)",
           [](const Party& p) {
             std::uint32_t product = 1;
             for (const Invocation* member : p.members) product *= member->lane < p.lane ? member->index | 1 : 1;
             return product;
           }},
          {"floatBitsToUint(subgroupMin(float(x) + 0.5))",
           [](const Party& p) {
             float least = 1e9f;
             for (const Invocation* member : p.members)
               least = std::min(least, static_cast<float>(member->index) + 0.5f);
             return std::bit_cast<std::uint32_t>(least);
           }},
          {"uint(subgroupInclusiveMax(-int(x * 7u % 31u)))",
           [](const Party& p) {
             std::int32_t most = -1000;
             for (const Invocation* member : p.members)
               if (member->lane <= p.lane) most = std::max(most, -static_cast<std::int32_t>(member->index * 7 % 31));
             return static_cast<std::uint32_t>(most);
           }},
          {"subgroupXor(uvec2(x * 5u, 1u)).x * 2u + subgroupXor(uvec2(x, 1u)).y",
           [](const Party& p) {
             std::uint32_t bits = 0;
             for (const Invocation* member : p.members) bits ^= member->index * 5;
             return bits * 2 + static_cast<std::uint32_t>(p.members.size() % 2);
           }},
          {"uint(subgroupOr(x % 8u == 3u))", [](const Party& p) {
             return sum(
                        p, [](auto i) { return i % 8 == 3; }, [](auto) { return true; }) > 0
                        ? 1u
                        : 0u;
           }}};
}

std::vector<Row> vote_and_ballot_rows() {
  const auto count = [](const Party& p, auto is_counted) {
    return sum(p, is_counted, [](std::uint32_t) { return true; });
  };
  return {{"uint(subgroupAny(x % 8u == 3u))",
           [=](const Party& p) { return count(p, [](auto i) { return i % 8 == 3; }) > 0 ? 1u : 0u; }},
          {"uint(subgroupAll(x % 3u != 1u))", [](const Party& p) { return p.members[0]->index % 3 != 1 ? 1u : 0u; }},
          {"uint(subgroupAllEqual(x % 2u))",
           [=](const Party& p) {
             const std::uint32_t odd = count(p, [](auto i) { return i % 2; });
             return odd == 0 || odd == p.members.size() ? 1u : 0u;
           }},
          {"subgroupBallotBitCount(subgroupBallot(x % 2u == 0u))",
           [=](const Party& p) { return count(p, [](auto i) { return i % 2 == 0; }); }},
          {"subgroupBallotFindMSB(subgroupBallot(true))", [](const Party& p) { return p.members.back()->lane; }},
          {"subgroupBroadcastFirst(x)", [](const Party& p) { return p.members.front()->index; }},
          {"uint(subgroupElect())", [](const Party& p) { return p.members.front()->lane == p.lane ? 1u : 0u; }}};
}

std::vector<Row> exchange_rows() {
  return {{"subgroupShuffle(x, (gl_SubgroupInvocationID + 2u) % gl_SubgroupSize)",
           [](const Party& p) { return index_at(p, p.lane + 2); }},
          {"subgroupShuffleXor(x, 3u)", [](const Party& p) { return index_at(p, p.lane ^ 3); }},
          {"subgroupShuffleUp(x, 2u)", [](const Party& p) { return p.lane < 2 ? Word() : index_at(p, p.lane - 2); }},
          {"subgroupShuffleDown(x, 1u)", [](const Party& p) { return index_at(p, p.lane + 1); }}};
}

std::vector<Row> cluster_rows(std::uint32_t cluster) {
  return {{fmt::format("subgroupClusteredAdd(x, {}u)", cluster),
           [cluster](const Party& p) {
             return sum(
                 p, [](auto i) { return i; }, [&](std::uint32_t lane) { return lane / cluster == p.lane / cluster; });
           }},
          {fmt::format("subgroupClusteredMax(x, {}u)", cluster), [cluster](const Party& p) {
             std::uint32_t most = 0;
             for (const Invocation* member : p.members)
               if (member->lane / cluster == p.lane / cluster) most = std::max(most, member->index);
             return most;
           }}};
}

std::vector<Row> quad_rows() {
  return {{"subgroupQuadSwapHorizontal(x)", [](const Party& p) { return index_at(p, p.lane ^ 1); }},
          {"subgroupQuadSwapDiagonal(x)", [](const Party& p) { return index_at(p, p.lane ^ 3); }},
          {"subgroupQuadBroadcast(x, 2u)", [](const Party& p) { return index_at(p, (p.lane & ~3u) + 2); }}};
}

/// The party that the ballot in front of the rows names.
Party party_of(const Subgroup& subgroup, std::uint32_t lane) {
  Party party = {.members = {}, .lane = lane};
  for (std::uint32_t other = 0; other < 128; ++other) {
    if ((subgroup.lanes[lane]->answers[other / 32] >> other % 32 & 1) == 0) continue;
    const bool is_invocation = other < subgroup.size && subgroup.lanes[other] != nullptr;
    check(is_invocation && subgroup.lanes[other]->index % 3 % 2 == subgroup.lanes[lane]->index % 3 % 2,
          fmt::format("lane {} sees lane {}, which is on the other side of the branch", lane, other));
    party.members.push_back(subgroup.lanes[other]);
  }
  check(party.member_at(lane) != nullptr, fmt::format("lane {} does not see itself", lane));
  return party;
}

/// The rows on both sides of a branch: i % 3 is 1, or 0 or 2.
void check_rows(Context& context, const std::string& label, const std::vector<std::string>& extensions,
                const std::vector<Row>& rows) {
  SubgroupKernel kernel = {.label = label,
                           .extensions = {"GL_KHR_shader_subgroup_ballot"},
                           .declarations =
                               "void work(uint at, uint x) {\n  const uvec4 together = subgroupBallot(true);\n"
                               "  for (uint k = 0u; k < 4u; ++k) answers[at + k] = together[k];\n",
                           .body = "  if (i % 3u == 1u) work(at, i); else work(at, i);",
                           .columns = ballot_words};
  kernel.extensions.insert(kernel.extensions.end(), extensions.begin(), extensions.end());
  for (const Row& row : rows)
    kernel.declarations += fmt::format("  answers[at + {}] = {};\n", kernel.columns++, row.glsl);
  kernel.declarations += "}\n";
  const SubgroupAnswers seen = run_subgroups(context, kernel);
  for (std::uint32_t k = 0; k < rows.size(); ++k)
    check_values<std::uint32_t>(
        seen, ballot_words + k, rows[k].glsl + " in a branch",
        [&](const Subgroup& subgroup, std::uint32_t lane) { return rows[k].expected(party_of(subgroup, lane)); });
}

}  // namespace

void add_divergent_operation_cases(Cases& cases) {
  const std::string behaviour = "operations on each side of a branch see those who are there";
  const auto group = [&](std::vector<Capability> needs) {
    needs.insert(needs.begin(), {&Capabilities::subgroup_basic, &Capabilities::subgroup_ballot});
    return Group{cases, "subgroups.divergent_operations", std::move(needs)};
  };
  group({&Capabilities::subgroup_arithmetic}).add("arithmetic", behaviour, [](Context& context) {
    check_rows(context, "arithmetic in a branch", {"GL_KHR_shader_subgroup_arithmetic"}, arithmetic_rows());
  });
  group({&Capabilities::subgroup_vote}).add("votes_and_ballots", behaviour, [](Context& context) {
    check_rows(context, "votes in a branch", {"GL_KHR_shader_subgroup_vote"}, vote_and_ballot_rows());
  });
  group({&Capabilities::subgroup_shuffle, &Capabilities::subgroup_shuffle_relative})
      .add("shuffles", behaviour, [](Context& context) {
        check_rows(context, "shuffles in a branch",
                   {"GL_KHR_shader_subgroup_shuffle", "GL_KHR_shader_subgroup_shuffle_relative"}, exchange_rows());
      });
  group({&Capabilities::subgroup_clustered}).add("clusters", behaviour, [](Context& context) {
    const std::uint32_t cluster = std::min(context.device().info().limits.subgroup_size, 4u);
    check_rows(context, "clusters in a branch", {"GL_KHR_shader_subgroup_clustered"}, cluster_rows(cluster));
  });
  group({&Capabilities::subgroup_quad}).add("quads", behaviour, [](Context& context) {
    if (context.device().info().limits.subgroup_size < 4)
      throw Unsupported("the device has subgroups of fewer invocations than a quad");
    check_rows(context, "quads in a branch", {"GL_KHR_shader_subgroup_quad"}, quad_rows());
  });
}

}  // namespace tandem::conformance
