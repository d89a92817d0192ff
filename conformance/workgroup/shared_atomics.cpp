#include <string>

#include "conformance/kit/cases.hpp"
#include "conformance/workgroup/shared_memory.hpp"

/// shared_memory.atomics: every operation, on words of shared memory that all invocations of a workgroup use at once.
namespace tandem::conformance {
namespace {

using Capabilities = rhi::Capabilities;

/// What all invocations have done to a word, and whether what they were told came before fits to it.
void add_word_cases(const Group& group) {
  group.add("uint", "results of every operation on uint", [](Context& context) {
    check_workgroups(context,
                     {.label = "shared atomics of uint",
                      .declarations = "shared uint s[8];",
                      .body = R"(
  if (i < 8u) s[i] = i == 1u ? 1000u : i == 3u ? ~0u : i == 6u ? 777u : 0u;
  barrier();
  atomicAdd(s[0], i + group);
  atomicMin(s[1], 70u - i);
  atomicMax(s[2], (i * 37u) % 64u);
  atomicAnd(s[3], ~(1u << (i % 24u)));
  atomicOr(s[4], 1u << (i / 4u));
  atomicXor(s[5], i * 3u);
  atomicExchange(s[6], 5u);
  for (uint seen = 0u, wanted = 0u; ; wanted = seen) {
    seen = atomicCompSwap(s[7], wanted, wanted * 2u + 1u);
    if (seen == wanted || wanted == ~0u) break;
  }
  barrier();
  if (i < 8u) answers[first + i] = s[i];
)",
                      .answers = 8},
                     [](auto workgroup, auto k) {
                       std::uint32_t parity = 0;
                       for (std::uint32_t i = 0; i < 64; ++i) parity ^= i * 3;
                       const std::array<std::uint32_t, 8> expected = {
                           63 * 64 / 2 + 64 * workgroup, 7, 63, 0xff000000u, 0xffffu, parity, 5, ~0u};
                       return expected[k];
                     });
  });
  group.add("int", "minimum and maximum are those of signed numbers", [](Context& context) {
    check_workgroups(context,
                     {.label = "shared atomics of int",
                      .declarations = "shared int s[4];",
                      .body = R"(
  if (i < 4u) s[i] = 0;
  barrier();
  atomicMin(s[0], 20 - int(i));
  atomicMax(s[1], int(i) - 70 + 80 * int(group));
  atomicAdd(s[2], i % 2u == 0u ? -3 : 1);
  atomicExchange(s[3], -9);
  barrier();
  if (i < 4u) answers[first + i] = uint(s[i]);
)",
                      .answers = 4},
                     [](auto workgroup, auto k) {
                       const std::array<std::int32_t, 4> expected = {-43, workgroup == 0 ? 0 : 73, -64, -9};
                       return static_cast<std::uint32_t>(expected[k]);
                     });
  });
  group.add("previous_values", "no two invocations are told the same value of a counter", [](Context& context) {
    check_workgroups(
        context,
        {.label = "previous values", .declarations = "shared uint counter, chain, told[64], links[65];", .body = R"(
  told[i] = 0u;
  links[i] = 0u;
  if (i == 0u) { counter = 0u; chain = 64u; links[64] = 0u; }
  barrier();
  told[atomicAdd(counter, 1u)] = i + 1u;
  links[atomicExchange(chain, i)] += 1u;
  barrier();
  if (i == 0u) links[chain] += 1u;
  barrier();
  answers[first + i] = uint(told[i] != 0u) + links[i] * 10u + (i == 0u ? links[64] * 100u : 0u);
)"},
        [](auto, auto i) { return 11 + (i == 0 ? 100u : 0u); });
  });
  group.add("spread", "invocations count in a histogram, member by member of a structure", [](Context& context) {
    check_workgroups(context,
                     {.label = "histogram",
                      .declarations = R"(
struct Bin { uint count; uint last; };
shared Bin bins[8];
uint bump(uint bin, uint i) { atomicMax(bins[bin].last, i); return atomicAdd(bins[bin].count, 1u); }
)",
                      .body = R"(
  if (i < 8u) bins[i] = Bin(0u, 0u);
  barrier();
  if (i % 3u != 0u) { if (bump(i % 8u, i) > 64u) bins[0].count = 1000u; }
  barrier();
  if (i < 8u) answers[first + i] = bins[i].count * 100u + bins[i].last;
)",
                      .answers = 8},
                     [](auto, auto bin) {
                       std::uint32_t count = 0, last = 0;
                       for (std::uint32_t i = 0; i < 64; ++i)
                         if (i % 3 != 0 && i % 8 == bin) ++count, last = i;
                       return count * 100 + last;
                     });
  });
}

void add_wide_and_float_cases(Cases& cases) {
  const auto group = [&](std::vector<Capability> needs) {
    return Group{cases, "shared_memory.atomics", std::move(needs)};
  };
  group({&Capabilities::shader_int64, &Capabilities::shared_int64_atomics})
      .add("uint64", "results of every operation on uint64_t", [](Context& context) {
        check_workgroups(context,
                         {.label = "shared atomics of uint64",
                          .extensions = "#extension GL_EXT_shader_explicit_arithmetic_types : require\n"
                                        "#extension GL_EXT_shader_atomic_int64 : require\n",
                          .declarations = "shared uint64_t s[8];",
                          .body = R"(
  if (i < 8u) s[i] = i == 1u || i == 3u ? ~0ul : 0ul;
  barrier();
  const uint64_t wide = uint64_t(i) << 32 | 1ul;
  atomicAdd(s[0], wide);
  atomicMin(s[1], wide + 4294967296ul);
  atomicMax(s[2], wide);
  atomicAnd(s[3], ~(1ul << i));
  atomicOr(s[4], 1ul << i);
  atomicXor(s[5], wide << 1);
  atomicExchange(s[6], 81985529216486895ul);
  for (uint64_t seen = 0ul, wanted = 0ul; ; wanted = seen) {
    seen = atomicCompSwap(s[7], wanted, wanted + 4294967297ul);
    if (seen == wanted) break;
  }
  barrier();
  if (i < 8u) { answers[first + 2u * i] = uint(s[i]); answers[first + 2u * i + 1u] = uint(s[i] >> 32); }
)",
                          .answers = 16},
                         [](auto, auto k) {
                           const std::array<std::uint64_t, 8> expected = {
                               (63ull * 64 / 2) << 32 | 64, 1ull << 32 | 1,    63ull << 32 | 1, 0, ~0ull, 0,
                               81985529216486895ull,        64 * 4294967297ull};
                           return static_cast<std::uint32_t>(expected[k / 2] >> 32 * (k % 2));
                         });
      });
  const std::string float_extension = "#extension GL_EXT_shader_atomic_float : require\n";
  group({&Capabilities::shared_float32_atomics})
      .add("float32", "exchange, load and store of floats", [=](Context& context) {
        check_workgroups(context,
                         {.label = "shared float exchange",
                          .extensions = float_extension + "#extension GL_KHR_memory_scope_semantics : require\n",
                          .declarations = "shared float chain, copy; shared uint links[65];",
                          .body = R"(
  links[i] = 0u;
  if (i == 0u) { chain = 64.0; links[64] = 0u; }
  barrier();
  links[uint(atomicExchange(chain, float(i)))] += 1u;
  barrier();
  if (i == 0u) {
    atomicStore(copy, chain, gl_ScopeWorkgroup, 0, 0);
    links[uint(atomicLoad(copy, gl_ScopeWorkgroup, 0, 0))] += 1u;
  }
  barrier();
  answers[first + i] = links[i] + (i == 0u ? links[64] * 10u : 0u);
)"},
                         [](auto, auto i) { return 1 + (i == 0 ? 10u : 0u); });
      });
  group({&Capabilities::shared_float32_atomic_add})
      .add("float32_add", "sums of floats that any order leaves exact", [=](Context& context) {
        check_workgroups(context,
                         {.label = "shared float add",
                          .extensions = float_extension,
                          .declarations = "shared float sum; shared uint told[64];",
                          .body = R"(
  told[i] = 0u;
  if (i == 0u) sum = 0.0;
  barrier();
  told[uint(atomicAdd(sum, 0.5) * 2.0)] = 1u;
  barrier();
  answers[first + i] = uint(sum) + told[i];
)"},
                         [](auto, auto) { return 33u; });
      });
  group({&Capabilities::shader_float64, &Capabilities::shared_float64_atomic_add})
      .add("float64_add", "sums of doubles", [=](Context& context) {
        check_workgroups(context,
                         {.label = "shared double add",
                          .extensions = float_extension,
                          .declarations = "shared double sum;",
                          .body = R"(
  if (i == 0u) sum = 0.0lf;
  barrier();
  atomicAdd(sum, double(i) + 4294967296.0lf);
  barrier();
  answers[first + i] = uint(sum - 64.0lf * 4294967296.0lf);
)"},
                         [](auto, auto) { return 63u * 64 / 2; });
      });
  group({&Capabilities::shared_float32_atomic_min_max})
      .add("float32_min_max", "minimum and maximum of floats", [=](Context& context) {
        check_workgroups(context,
                         {.label = "shared float minimum",
                          .extensions = float_extension + "#extension GL_EXT_shader_atomic_float2 : require\n",
                          .declarations = "shared float least, most;",
                          .body = R"(
  if (i == 0u) { least = 1000.0; most = -1000.0; }
  barrier();
  atomicMin(least, float(i) - 10.5);
  atomicMax(most, float(i) - 100.5);
  barrier();
  answers[first + i] = uint(least * -2.0) * 1000u + uint(most * -2.0);
)"},
                         [](auto, auto) { return 21u * 1000 + 75; });
      });
}

}  // namespace

void add_shared_atomic_cases(Cases& cases) {
  add_word_cases({cases, "shared_memory.atomics", {}});
  add_wide_and_float_cases(cases);
}

}  // namespace tandem::conformance
