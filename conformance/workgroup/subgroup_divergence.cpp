#include <algorithm>
#include <string>
#include <vector>

#include <spirv/unified1/spirv.hpp11>

#include "conformance/kit/cases.hpp"
#include "conformance/workgroup/subgroup_run.hpp"

/// subgroups.divergence: operations where not all invocations of a subgroup arrive.
///
/// A kernel has places, at each of which a ballot says who is there together and further operations are held to that
/// ballot. Who must be together depends on what the device guarantees:
/// - always: nobody but those whose own control flow leads there, and each agrees with those that it sees;
/// - with maximal reconvergence: all of them, but at places that several cases of a switch lead to;
/// - with subgroup-uniform control flow: all of them, at a place that all invocations of the subgroup reach outside of
///   divergent constructs.
namespace tandem::conformance {
namespace {

using Capabilities = rhi::Capabilities;

/// Words of a place: the ballot, and operations among those who are there.
constexpr std::uint32_t place_words = 9;

struct Place {
  bool is_uniform = false;                            ///< outside of constructs that diverge
  bool is_loose = false;                              ///< whatever the device guarantees, they may come apart
  std::function<bool(std::uint32_t index)> is_there;  ///< whether the invocation's control flow leads there
  /// Invocations with different keys are never there together.
  std::function<std::uint32_t(std::uint32_t index)> key = [](std::uint32_t) { return 0u; };
};

struct Divergence {
  std::string name;
  std::string behaviour;
  std::string declarations = {};
  std::string body;  ///< calls place(at + N * k) at place k, with place_words for N
  std::vector<Place> places;
};

const std::string place_function = R"(
uint own;
void place(uint to) {
  const uvec4 together = subgroupBallot(true);
  for (uint k = 0u; k < 4u; ++k) answers[to + k] = together[k];
  answers[to + 4] = subgroupAdd(own);
  answers[to + 5] = subgroupExclusiveAdd(own);
  answers[to + 6] = subgroupBroadcastFirst(own);
  answers[to + 7] = uint(subgroupElect());
  answers[to + 8] = uint(subgroupAll(own % 2u == 1u));
}
)";

/// From these headers on, compilers and validators know the mode.
template <typename Mode>
concept knows_maximal_reconvergence = requires {
  Mode::MaximallyReconvergesKHR;
};

bool has_bit(const Invocation& invocation, std::uint32_t first, std::uint32_t bit) {
  return (invocation.answers[first + bit / 32] >> bit % 32 & 1) != 0;
}

/// Those who are there must be a set that the device may choose; returns its lanes, ascending.
std::vector<std::uint32_t> checked_ballot(const Subgroup& subgroup, std::uint32_t lane, std::uint32_t k,
                                          const Place& place, bool all_together) {
  const Invocation& self = *subgroup.lanes[lane];
  const std::uint32_t first = k * place_words;
  const std::string where = fmt::format("place {}, subgroup {} of workgroup {}", k, subgroup.id, subgroup.workgroup);
  std::vector<std::uint32_t> together;
  for (std::uint32_t other = 0; other < 128; ++other) {
    const bool is_seen = has_bit(self, first, other);
    const bool may_be_seen = other < subgroup.size && subgroup.lanes[other] != nullptr &&
                             place.is_there(subgroup.lanes[other]->index) &&
                             place.key(subgroup.lanes[other]->index) == place.key(self.index);
    if (is_seen) together.push_back(other);
    check(!is_seen || may_be_seen,
          fmt::format("{}: lane {} sees lane {}, which never comes there", where, lane, other));
    check(is_seen || !may_be_seen || (!all_together && other != lane),
          fmt::format("{}: lane {} does not see lane {}", where, lane, other));
  }
  for (const std::uint32_t other : together)
    for (std::uint32_t word = 0; word < 4; ++word)
      check_equal(fmt::format("{}: the ballot of lane {} that lane {} sees", where, other, lane),
                  subgroup.lanes[other]->answers[first + word], self.answers[first + word]);
  return together;
}

std::uint32_t own_value(const Invocation& invocation) { return invocation.index * 2 + 1; }

void check_place(const Subgroup& subgroup, std::uint32_t lane, std::uint32_t k, const Place& place, bool all_together) {
  const Invocation& self = *subgroup.lanes[lane];
  const std::span<const std::uint32_t> seen = self.answers.subspan(std::size_t{k} * place_words, place_words);
  if (!place.is_there(self.index)) {
    for (const std::uint32_t word : seen)
      check_equal(fmt::format("place {}, where invocation {} never comes: a word", k, self.index), word, 0);
    return;
  }
  std::uint32_t sum = 0, before = 0;
  const std::vector<std::uint32_t> together = checked_ballot(subgroup, lane, k, place, all_together);
  for (const std::uint32_t other : together) {
    const std::uint32_t value = own_value(*subgroup.lanes[other]);
    sum += value;
    before += other < lane ? value : 0;
  }
  const std::string where = fmt::format(" at place {} in lane {} of subgroup {}", k, lane, subgroup.id);
  check_equal("subgroupAdd" + where, seen[4], sum);
  check_equal("subgroupExclusiveAdd" + where, seen[5], before);
  check_equal("subgroupBroadcastFirst" + where, seen[6], own_value(*subgroup.lanes[together.front()]));
  check_equal("subgroupElect" + where, seen[7], lane == together.front() ? 1 : 0);
  check_equal("subgroupAll" + where, seen[8], 1);
}

void check_divergence(Context& context, const Divergence& divergence) {
  const Capabilities& capabilities = context.device().info().capabilities;
  SubgroupKernel kernel = {
      .label = "divergence: " + divergence.name,
      .extensions = {"GL_KHR_shader_subgroup_ballot", "GL_KHR_shader_subgroup_arithmetic",
                     "GL_KHR_shader_subgroup_vote"},
      .declarations = place_function + with(divergence.declarations, "N", std::to_string(place_words) + "u"),
      .body = "  own = i * 2u + 1u;\n" + with(divergence.body, "N", std::to_string(place_words) + "u"),
      .columns = static_cast<std::uint32_t>(divergence.places.size()) * place_words};
  if (capabilities.subgroup_uniform_control_flow) {
    kernel.extensions.push_back("GL_EXT_subgroup_uniform_control_flow");
    kernel.main_attributes = "[[subgroup_uniform_control_flow]]";
  }
  if (capabilities.maximal_reconvergence && knows_maximal_reconvergence<spv::ExecutionMode>) {
    kernel.extensions.push_back("GL_EXT_spirv_intrinsics");
    kernel.declarations =
        "spirv_execution_mode(extensions = [\"SPV_KHR_maximal_reconvergence\"], 6023);\n" + kernel.declarations;
  }
  const SubgroupAnswers seen = run_subgroups(context, kernel);
  for (const Subgroup& subgroup : seen.subgroups)
    for (std::uint32_t k = 0; k < divergence.places.size(); ++k) {
      const Place& place = divergence.places[k];
      const bool all_together = (capabilities.maximal_reconvergence && !place.is_loose) ||
                                (place.is_uniform && capabilities.subgroup_uniform_control_flow);
      for (const std::uint32_t lane : lanes_of(subgroup)) check_place(subgroup, lane, k, place, all_together);
    }
}

/// After everything: all invocations.
Place all_of_them() {
  return {.is_uniform = true, .is_loose = false, .is_there = [](std::uint32_t) { return true; }};
}

template <typename IsThere>
Place loosely(const IsThere& is_there) {
  return {.is_uniform = false, .is_loose = true, .is_there = is_there};
}

template <typename IsThere>
Place those(const IsThere& is_there) {
  return {.is_uniform = false, .is_loose = false, .is_there = is_there};
}

std::vector<Divergence> branches() {
  return {
      {.name = "if_else",
       .behaviour = "both sides of a branch, and all after it",
       .body = "  if (i % 3u == 1u) place(at); else place(at + N); place(at + 2u * N);",
       .places = {those([](auto i) { return i % 3 == 1; }), those([](auto i) { return i % 3 != 1; }), all_of_them()}},
      {.name = "nested_branches",
       .behaviour = "branches within branches, and the outer branch after them",
       .body = R"(
  if (i % 2u == 0u) {
    if (i % 4u == 0u) place(at); else if (i % 8u == 2u) place(at + N);
    place(at + 2u * N);
  }
  place(at + 3u * N);
)",
       .places = {those([](auto i) { return i % 4 == 0; }), those([](auto i) { return i % 8 == 2; }),
                  those([](auto i) { return i % 2 == 0; }), all_of_them()}},
      {.name = "switch_with_fall_through",
       .behaviour = "the cases of a switch, one of which goes on into the next",
       .body = R"(
  switch (i % 5u) {
    case 0u: place(at);
    case 1u: place(at + N); break;
    case 3u: place(at + 2u * N); break;
    default: place(at + 3u * N);
  }
  place(at + 4u * N);
)",
       .places = {those([](auto i) { return i % 5 == 0; }), loosely([](auto i) { return i % 5 <= 1; }),
                  those([](auto i) { return i % 5 == 3; }), loosely([](auto i) { return i % 5 == 2 || i % 5 == 4; }),
                  all_of_them()}},
      {.name = "uniform_branch",
       .behaviour = "a branch that the invocations of each subgroup take together",
       .body = R"(
  if (gl_WorkGroupID.x == 1u) { if (i % 2u == 0u) place(at); place(at + N); } else place(at + 2u * N);
  place(at + 3u * N);
)",
       .places = {those([](auto i) { return i >= 100 && i % 2 == 0; }),
                  {.is_uniform = true, .is_loose = false, .is_there = [](auto i) { return i >= 100; }},
                  {.is_uniform = true, .is_loose = false, .is_there = [](auto i) { return i < 100; }},
                  all_of_them()}},
      {.name = "early_return",
       .behaviour = "who has returned takes no part any more",
       .body = R"(
  if (i % 4u == 2u) return;
  place(at);
  if (i % 2u == 1u) { if (i % 3u == 0u) { place(at + N); return; } }
  place(at + 2u * N);
)",
       .places = {those([](auto i) { return i % 4 != 2; }), those([](auto i) { return i % 2 == 1 && i % 3 == 0; }),
                  those([](auto i) { return i % 4 != 2 && !(i % 2 == 1 && i % 3 == 0); })}}};
}

std::vector<Divergence> loops() {
  const auto trips = [](std::uint32_t count) { return those([count](auto i) { return i % 4 >= count; }); };
  return {
      {.name = "trip_counts",
       .behaviour = "each round of a loop has those who are still in it",
       .body = "  for (uint k = 0u; k < i % 4u; ++k) place(at + k * N);\n  place(at + 3u * N);",
       .places = {trips(1), trips(2), trips(3), all_of_them()}},
      {.name = "break",
       .behaviour = "who has left a loop takes no part in its further rounds",
       .body = R"(
  for (uint k = 0u; k < 3u; ++k) {
    if (k == i % 4u) { place(at + k * N); break; }
    place(at + (3u + k) * N);
  }
  place(at + 6u * N);
)",
       .places = {those([](auto i) { return i % 4 == 0; }), those([](auto i) { return i % 4 == 1; }),
                  those([](auto i) { return i % 4 == 2; }), trips(1), trips(2), trips(3), all_of_them()}},
      {.name = "continue",
       .behaviour = "who continues a loop misses the rest of its round and comes back for the next",
       .body = R"(
  for (uint k = 0u; k < 3u; ++k) {
    if ((i + k) % 3u == 0u) continue;
    place(at + k * N);
  }
  place(at + 3u * N);
)",
       .places = {those([](auto i) { return i % 3 != 0; }), those([](auto i) { return (i + 1) % 3 != 0; }),
                  those([](auto i) { return (i + 2) % 3 != 0; }), all_of_them()}},
      {.name = "nested_loops",
       .behaviour = "inner loops of different lengths, after which the rounds of the outer loop go on together",
       .body = R"(
  for (uint k = 0u; k < 2u; ++k) {
    for (uint m = 0u; m < (i + k) % 3u; ++m) place(at + (3u * k + m) * N);
    place(at + (3u * k + 2u) * N);
  }
)",
       .places = {those([](auto i) { return i % 3 > 0; }), those([](auto i) { return i % 3 > 1; }), all_of_them(),
                  those([](auto i) { return (i + 1) % 3 > 0; }), those([](auto i) { return (i + 1) % 3 > 1; }),
                  all_of_them()}},
      {.name = "do_while",
       .behaviour = "a loop that ends for each invocation at its own time",
       .body = R"(
  uint k = 0u;
  do { place(at + k * N); ++k; } while (k < 3u && (i >> k) % 2u == 1u);
  place(at + 3u * N);
)",
       .places = {all_of_them(), those([](auto i) { return (i >> 1) % 2 == 1; }),
                  those([](auto i) { return (i >> 1) % 2 == 1 && (i >> 2) % 2 == 1; }), all_of_them()}},
      {.name = "one_key_at_a_time",
       .behaviour = "a loop whose rounds serve those who have the first one's key",
       .body = R"(
  const uint key = i * 5u % 7u % 4u;
  while (true) {
    if (key == subgroupBroadcastFirst(key)) { place(at); break; }
  }
  place(at + N);
)",
       .places = {{.is_there = [](auto) { return true; }, .key = [](auto i) { return i * 5 % 7 % 4; }}, all_of_them()}},
      {.name = "functions",
       .behaviour = "operations in functions that are called from branches and return early",
       .declarations = R"(
uint inner(uint i, uint to) {
  if (i % 3u == 0u) { place(to); return 1u; }
  place(to + N);
  return 2u;
}
uint outer(uint i, uint to) {
  for (uint k = 0u; k < 2u; ++k)
    if (inner(i + k, to + 2u * k * N) == 1u) return k;
  place(to + 4u * N);
  return 7u;
}
)",
       .body = "  if (i % 2u == 0u) { if (outer(i, at) == 7u) place(at + 5u * N); }\n  place(at + 6u * N);",
       .places = {those([](auto i) { return i % 2 == 0 && i % 3 == 0; }),
                  those([](auto i) { return i % 2 == 0 && i % 3 != 0; }),
                  those([](auto i) { return i % 2 == 0 && i % 3 == 2; }),
                  those([](auto i) { return i % 2 == 0 && i % 3 == 1; }),
                  those([](auto i) { return i % 2 == 0 && i % 3 == 1; }),
                  those([](auto i) { return i % 2 == 0 && i % 3 == 1; }), all_of_them()}}};
}

}  // namespace

void add_subgroup_divergence_cases(Cases& cases) {
  const Group group = {cases,
                       "subgroups.divergence",
                       {&Capabilities::subgroup_basic, &Capabilities::subgroup_vote, &Capabilities::subgroup_ballot,
                        &Capabilities::subgroup_arithmetic}};
  for (const std::vector<Divergence>& table : {branches(), loops()})
    for (const Divergence& divergence : table)
      group.add(divergence.name, divergence.behaviour,
                [divergence](Context& context) { check_divergence(context, divergence); });
}

}  // namespace tandem::conformance
