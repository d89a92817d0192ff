#include <string>

#include "conformance/kit/cases.hpp"
#include "conformance/workgroup/shared_memory.hpp"

/// barriers.control_flow: where barriers may stand. barriers.values: what lives across them. barriers.memory: which
/// memory they order.
namespace tandem::conformance {
namespace {

/// A shared array through which invocation i hands x to its neighbour.
const std::string hand_on = R"(
shared uint s[64];
uint hand_on(uint i, uint x) {
  s[i] = x;
  barrier();
  const uint y = s[(i + 1u) % 64u];
  barrier();
  return y;
}
)";

std::uint32_t neighbour(std::uint32_t i, std::uint32_t steps) { return (i + steps) % 64; }

void add_control_flow_cases(const Group& group) {
  group.add("uniform_loop", "a scan that doubles its step in each round of a loop", [](Context& context) {
    check_workgroups(context, {.label = "scan", .declarations = "shared uint s[2][64];", .body = R"(
  s[0][i] = i + group;
  uint from = 0u;
  for (uint delta = 1u; delta < 64u; delta *= 2u) {
    barrier();
    s[1u - from][i] = s[from][i] + (i >= delta ? s[from][i - delta] : 0u);
    from = 1u - from;
  }
  answers[first + i] = s[from][i];
)"},
                     [](auto workgroup, auto i) { return i * (i + 1) / 2 + (i + 1) * workgroup; });
  });
  group.add("nested_loops", "loops within loops, with do, while, break and continue that all take",
            [](Context& context) {
              check_workgroups(context,
                               {.label = "barriers in nested loops",
                                .declarations = hand_on,
                                .body = R"(
  uint x = i;
  for (uint k = 0u; k < 4u; ++k) {
    if (k == 1u) continue;
    uint m = 0u;
    do {
      x = hand_on(i, x);
      if (k == 2u && m == 1u) break;
    } while (++m < 3u);
  }
  uint rounds = group + 2u;
  while (true) {
    if (rounds-- == 0u) break;
    x = hand_on(i, x);
  }
  answers[first + i] = x;
)",
                                .workgroup_count = {4, 1, 1}},
                               [](auto workgroup, auto i) { return neighbour(i, 3 + 2 + 3 + workgroup + 2); });
            });
  group.add("nested_functions", "functions with barriers that call each other from several places",
            [](Context& context) {
              check_workgroups(context,
                               {.label = "barriers in functions",
                                .declarations = hand_on + R"(
uint twice(uint i, uint x) { return hand_on(i, hand_on(i, x)); }
void times(uint i, uint count, inout uint x) {
  for (uint k = 0u; k < count; ++k) {
    if (k == 2u) { x = twice(i, x) + 64u; return; }
    x = hand_on(i, x);
  }
}
)",
                                .body = R"(
  uint x = i;
  times(i, group, x);
  times(i, 2u, x);
  answers[first + i] = twice(i, x) + twice(i, x) * 1000u;
)",
                                .workgroup_count = {5, 1, 1}},
                               [](auto workgroup, auto i) {
                                 const std::uint32_t steps = workgroup <= 2 ? workgroup : 4;
                                 const std::uint32_t x = neighbour(i, steps + 4) + (workgroup > 2 ? 64u : 0u);
                                 return x + x * 1000;
                               });
            });
  group.add("uniform_branches", "branches and switches that each workgroup takes as one", [](Context& context) {
    check_workgroups(context,
                     {.label = "barriers in branches",
                      .declarations = hand_on,
                      .body = R"(
  uint x = i;
  if (group % 2u == 0u) {
    x = hand_on(i, x);
    if (group == 4u) x = hand_on(i, x); else x += 100u;
  } else {
    x = hand_on(i, x + 200u);
  }
  switch (group) {
    case 1u: x = hand_on(i, x);
    case 2u: x = hand_on(i, x); break;
    case 3u: answers[first + i] = hand_on(i, x); return;
    default: break;
  }
  barrier();
  answers[first + i] = x + 1000u;
)",
                      .workgroup_count = {5, 1, 1}},
                     [](auto workgroup, auto i) {
                       switch (workgroup) {
                         case 0:
                           return neighbour(i, 1) + 1100;
                         case 1:
                           return neighbour(i, 3) + 1200;
                         case 2:
                           return neighbour(i, 2) + 1100;
                         case 3:
                           return neighbour(i, 2) + 200;
                         default:
                           return neighbour(i, 2) + 1000;
                       }
                     });
  });
  group.add("after_divergence", "all meet at a barrier after branches, loops and returns that differ",
            [](Context& context) {
              check_workgroups(context,
                               {.label = "barriers after divergence",
                                .declarations = hand_on + R"(
uint collatz(uint n) {
  for (uint k = 0u; ; ++k) {
    if (n <= 1u) return k;
    n = n % 2u == 0u ? n / 2u : 3u * n + 1u;
  }
}
)",
                                .body = R"(
  uint x = 0u;
  for (uint round = 0u; round < 3u; ++round) {
    if (i % 3u == round) x += collatz(i + 1u);
    else for (uint k = 0u; k < i; ++k) { if (k == 20u) break; if (k % 2u == 0u) continue; x += 1u; }
    x = hand_on(i, x);
  }
  answers[first + i] = x;
)"},
                               [](auto, auto i) {
                                 std::uint32_t x = 0;
                                 for (std::uint32_t round = 0; round < 3; ++round) {
                                   // The value that arrives at i comes from 3 steps above, going down.
                                   const std::uint32_t at = (i + 3 - round) % 64;
                                   if (at % 3 == round) {
                                     for (std::uint32_t n = at + 1; n > 1; ++x) n = n % 2 == 0 ? n / 2 : 3 * n + 1;
                                   } else {
                                     x += std::min(at, 20u) / 2;
                                   }
                                 }
                                 return x;
                               });
            });
  group.add("grid", "workgroups of three dimensions in a grid of three, each with barriers of its own",
            [](Context& context) {
              check_workgroups(context,
                               {.label = "barriers in a grid",
                                .declarations = "shared uvec3 ids[60];",
                                .body = R"(
  ids[i] = gl_GlobalInvocationID;
  barrier();
  const uvec3 id = ids[59u - i] - gl_WorkGroupID * gl_WorkGroupSize;
  barrier();
  answers[first + i] = (id.z * 4u + id.y) * 5u + id.x + 100u * group;
)",
                                .local_size = {5, 4, 3},
                                .workgroup_count = {2, 3, 2}},
                               [](auto workgroup, auto i) { return 59 - i + 100 * workgroup; });
            });
  group.add("odd_sizes", "workgroups that fill no whole subgroup", [](Context& context) {
    for (const std::uint32_t size : {1u, 7u, 37u})
      check_workgroups(context,
                       {.label = fmt::format("a barrier of {}", size),
                        .declarations = fmt::format("const uint size = {}u;\nshared uint s[size];", size),
                        .body = R"(
  uint x = i + group;
  for (uint k = 0u; k < 3u; ++k) {
    s[i] = x;
    barrier();
    x = s[(i + 1u) % size];
    barrier();
  }
  answers[first + i] = x;
)",
                        .local_size = {size, 1, 1},
                        .workgroup_count = {3, 1, 1}},
                       [size](auto workgroup, auto i) { return (i + 3) % size + workgroup; });
  });
}

void add_value_cases(const Group& group) {
  group.add("locals", "arrays, structures and loop counters keep their values across barriers", [](Context& context) {
    check_workgroups(context,
                     {.label = "locals across barriers",
                      .declarations = hand_on + R"(
struct State { uvec3 v; bool odd; float f; };
uint global_x;
void add_global(uint i) { global_x += hand_on(i, global_x); }
)",
                      .body = R"(
  uint history[4];
  State state = State(uvec3(i), i % 2u == 1u, float(i));
  global_x = i;
  uint x = i;
  for (uint k = 0u; k < 4u; ++k) {
    const uint before = x * 2u;
    x = hand_on(i, x);
    history[(k + i) % 4u] = before / 2u;
    state.v[k % 3u] += x;
    state.odd = !state.odd;
    state.f += 0.5;
    barrier();
  }
  add_global(i);
  uint ok = uint(state.odd == (i % 2u == 1u)) + 2u * uint(state.f == float(i) + 2.0);
  ok += 4u * uint(state.v == uvec3(i + (i + 1u) % 64u + x, i + (i + 2u) % 64u, i + (i + 3u) % 64u));
  for (uint k = 0u; k < 4u; ++k) ok += (8u << k) * uint(history[(k + i) % 4u] == (i + k) % 64u);
  answers[first + i] = ok + 1000u * global_x;
)"},
                     [](auto, auto i) { return 127 + 1000 * (i + neighbour(i, 1)); });
  });
}

/// A barrier with a memory barrier in front of it, between the accesses to shared memory and to a buffer.
void check_memory_barrier(Context& context, const std::string& extensions, const std::string& barrier) {
  check_workgroups(context,
                   {.label = barrier,
                    .extensions = extensions,
                    .declarations = "shared uint s[64];",
                    .body = with(R"(
  uint x = group * 64u + i;
  for (uint k = 0u; k < 3u; ++k) {
    s[i] = x;
    answers[first + i] = x * 3u;
    BARRIER;
    x = s[(i + 1u) % 64u] + answers[first + (i + 1u) % 64u] - 3u * s[(i + 1u) % 64u];
    BARRIER;
  }
  answers[first + i] = x;
)",
                                 "BARRIER", barrier)},
                   [](auto workgroup, auto i) { return workgroup * 64 + neighbour(i, 3); });
}

void add_memory_cases(const Group& group) {
  const std::string behaviour = "accesses to shared memory and buffers before it come before those after it";
  const auto add = [&](const std::string& name, const std::string& extensions, const std::string& barrier) {
    group.add(name, behaviour, [=](Context& context) { check_memory_barrier(context, extensions, barrier); });
  };
  add("shared_and_buffer", "", "memoryBarrierShared(); memoryBarrierBuffer(); barrier()");
  add("all", "", "memoryBarrier(); barrier()");
  add("group", "", "groupMemoryBarrier(); barrier()");
  add("control_barrier", "#extension GL_KHR_memory_scope_semantics : require\n",
      "controlBarrier(gl_ScopeWorkgroup, gl_ScopeWorkgroup, gl_StorageSemanticsShared | gl_StorageSemanticsBuffer, "
      "gl_SemanticsAcquireRelease)");
}

}  // namespace

void add_barrier_cases(Cases& cases) {
  add_control_flow_cases({cases, "barriers.control_flow", {}});
  add_value_cases({cases, "barriers.values", {}});
  add_memory_cases({cases, "barriers.memory", {}});
}

}  // namespace tandem::conformance
