// Subgroup operations on the CPU device, with small and large subgroups and a last one that is not full.

#include <doctest/doctest.h>

#include <bit>
#include <cmath>
#include <functional>
#include <string>

#include "tests/rhi_cpu/groups/device.hpp"

namespace tandem::cpu::test {
namespace {

constexpr std::uint32_t sizes[] = {1, 8, 32};
constexpr std::uint32_t invocations = 42;
constexpr const char* head = R"(
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_vote : require
#extension GL_KHR_shader_subgroup_ballot : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#extension GL_KHR_shader_subgroup_shuffle : require
#extension GL_KHR_shader_subgroup_shuffle_relative : require
#extension GL_KHR_shader_subgroup_clustered : require
#extension GL_KHR_shader_subgroup_quad : require
#extension GL_EXT_shader_subgroup_extended_types_int8 : require
#extension GL_EXT_shader_subgroup_extended_types_int16 : require
#extension GL_EXT_shader_subgroup_extended_types_int64 : require
#extension GL_EXT_shader_subgroup_extended_types_float16 : require
#extension GL_EXT_shader_explicit_arithmetic_types : require
layout(local_size_x = 42) in;
layout(binding = 0) buffer B { uint b[]; };
uint row = 0;
void put(uint x) { b[row++ * 42 + gl_LocalInvocationIndex] = x; }
void put(float x) { put(floatBitsToUint(x)); }
)";

/// What lane `i` is to put; `taking_part(lane)` are the others of its subgroup, [first, last) the subgroup.
struct Lane {
  std::uint32_t i, size, first, last;
  std::uint32_t id() const { return i - first; }
};

/// Runs the shader with each size; row r, invocation i, must be rows[r](lane).
void check_rows(const std::string& body, const std::vector<std::function<std::uint32_t(const Lane&)>>& rows) {
  for (const std::uint32_t size : sizes) {
    CAPTURE(size);
    const rhi::DeviceHandle device = device_with(size);
    const Words words = run(*device, head + body, Words(rows.size() * invocations));
    for (std::uint32_t r = 0; r < rows.size(); ++r) {
      CAPTURE(r);
      for (std::uint32_t i = 0; i < invocations; ++i) {
        CAPTURE(i);
        const std::uint32_t first = i / size * size;
        const Lane lane = {.i = i, .size = size, .first = first, .last = std::min(first + size, invocations)};
        CHECK(words[r * invocations + i] == rows[r](lane));
      }
    }
  }
}

/// The combination of value(j) over j in [first, last) that take part.
template <typename T, typename Value, typename Combine>
T combined(std::uint32_t first, std::uint32_t last, T identity, const Value& value, const Combine& combine) {
  T result = identity;
  for (std::uint32_t j = first; j < last; ++j)
    if (j % 3 != 1) result = combine(result, value(j));
  return result;
}

TEST_CASE("built-ins, votes, ballots and shuffles") {
  const auto mask = [](std::uint32_t first, std::uint32_t last, std::uint32_t base, const auto& takes) {
    std::uint32_t result = 0;
    for (std::uint32_t j = first; j < last; ++j)
      if (takes(j)) result |= 1u << (j - base);
    return result;
  };
  const auto divergent = [](std::uint32_t j) { return j % 3 != 1; };
  const auto first_of = [&](const Lane& l) {
    for (std::uint32_t j = l.first; j < l.last; ++j)
      if (divergent(j)) return j;
    return 0u;
  };
  const auto only = [&](const auto& f) {
    return [=](const Lane& l) { return divergent(l.i) ? std::uint32_t(f(l)) : 0u; };
  };
  const auto below = [](std::uint32_t n) { return n >= 32 ? ~0u : (1u << n) - 1; };
  const auto of = [&](const Lane& l, std::uint32_t j) {
    return j >= l.first && j < l.last && divergent(j) ? 100 + j : 0u;
  };
  check_rows(R"(
void main() {
  uint i = gl_LocalInvocationIndex;
  put(gl_SubgroupSize | gl_NumSubgroups << 8 | gl_SubgroupID << 16 | gl_SubgroupInvocationID << 24);
  put(gl_SubgroupEqMask.x); put(gl_SubgroupGeMask.x); put(gl_SubgroupGtMask.x);
  put(gl_SubgroupLeMask.x); put(gl_SubgroupLtMask.x + gl_SubgroupLtMask.y + gl_SubgroupEqMask.z);
  put(subgroupBallot(true).x);
  if (i % 3 == 1) return;
  put(uint(subgroupElect()));
  put(uint(subgroupAll(i < 20)) | uint(subgroupAny(i < 20)) << 1 | uint(subgroupAllEqual(i / 7)) << 2 |
      uint(subgroupAllEqual(vec3(1, i / 16, 2))) << 3 | uint(subgroupAllEqual(i < 9)) << 4);
  uvec4 ballot = subgroupBallot(i % 2 == 0);
  put(ballot.x);
  put(uint(subgroupInverseBallot(ballot)) | uint(subgroupBallotBitExtract(ballot, 2)) << 1);
  put(subgroupBallotBitCount(ballot) | subgroupBallotInclusiveBitCount(ballot) << 8 |
      subgroupBallotExclusiveBitCount(ballot) << 16);
  put(subgroupBallotFindLSB(ballot) ^ subgroupBallotFindMSB(ballot) << 8);
  put(subgroupBroadcastFirst(uvec2(i, i + 100)).y);
  put(subgroupBroadcast(i + 100, 0));
  put(subgroupShuffle(i + 100, gl_SubgroupInvocationID ^ 5));
  put(uint(subgroupShuffleXor(u64vec2(1, uint64_t(i + 100) << 40), 2).y >> 40));
  put(uint(subgroupShuffleUp(float16_t(i + 100), 3)));
  put(uint(subgroupShuffleDown(double(i + 100), 1)));
  put(subgroupQuadBroadcast(i + 100, 2));
  put(subgroupQuadSwapHorizontal(i + 100) << 16 | subgroupQuadSwapVertical(i + 100) << 8 |
      subgroupQuadSwapDiagonal(i + 100));
}
)",
             {[](const Lane& l) {
                return l.size | (invocations + l.size - 1) / l.size << 8 | l.i / l.size << 16 | l.id() << 24;
              },
              [](const Lane& l) { return 1u << l.id(); },
              [&](const Lane& l) { return below(l.size) & ~below(l.id()); },
              [&](const Lane& l) { return below(l.size) & ~below(l.id() + 1); },
              [&](const Lane& l) { return below(l.id() + 1); },
              [&](const Lane& l) { return below(l.id()); },
              [&](const Lane& l) { return mask(l.first, l.last, l.first, [](std::uint32_t) { return true; }); },
              only([&](const Lane& l) { return first_of(l) == l.i; }),
              only([&](const Lane& l) {
                bool all = true, any = false, sevens = true, sixteens = true, nines = true;
                const std::uint32_t f = first_of(l);
                for (std::uint32_t j = l.first; j < l.last; ++j) {
                  if (!divergent(j)) continue;
                  all &= j < 20;
                  any |= j < 20;
                  sevens &= j / 7 == f / 7;
                  sixteens &= j / 16 == f / 16;
                  nines &= (j < 9) == (f < 9);
                }
                return unsigned(all) | unsigned(any) << 1 | unsigned(sevens) << 2 | unsigned(sixteens) << 3 |
                       unsigned(nines) << 4;
              }),
              only([&](const Lane& l) {
                return mask(l.first, l.last, l.first, [&](std::uint32_t j) { return divergent(j) && j % 2 == 0; });
              }),
              only([&](const Lane& l) {
                const std::uint32_t m =
                    mask(l.first, l.last, l.first, [&](std::uint32_t j) { return divergent(j) && j % 2 == 0; });
                return (m >> l.id() & 1) | (m >> 2 & 1) << 1;
              }),
              only([&](const Lane& l) {
                const std::uint32_t m =
                    mask(l.first, l.last, l.first, [&](std::uint32_t j) { return divergent(j) && j % 2 == 0; });
                return std::uint32_t(std::popcount(m)) | std::uint32_t(std::popcount(m & below(l.id() + 1))) << 8 |
                       std::uint32_t(std::popcount(m & below(l.id()))) << 16;
              }),
              only([&](const Lane& l) {
                const std::uint32_t m =
                    mask(l.first, l.last, l.first, [&](std::uint32_t j) { return divergent(j) && j % 2 == 0; });
                const std::uint32_t low = m == 0 ? ~0u : std::uint32_t(std::countr_zero(m));
                return low ^ (std::uint32_t(std::bit_width(m)) - 1) << 8;
              }),
              only([&](const Lane& l) { return 100 + first_of(l); }),
              only([&](const Lane& l) { return of(l, l.first); }),
              only([&](const Lane& l) { return of(l, l.first + (l.id() ^ 5)); }),
              only([&](const Lane& l) { return of(l, l.first + (l.id() ^ 2)); }),
              only([&](const Lane& l) { return of(l, l.i - 3); }),
              only([&](const Lane& l) { return of(l, l.i + 1); }),
              only([&](const Lane& l) { return of(l, l.first + (l.id() & ~3u) + 2); }),
              only([&](const Lane& l) {
                return of(l, l.first + (l.id() ^ 1)) << 16 | of(l, l.first + (l.id() ^ 2)) << 8 |
                       of(l, l.first + (l.id() ^ 3));
              })});
}

TEST_CASE("reductions and scans of every operation and every type, also where only some take part") {
  const auto plus = [](auto a, auto b) { return decltype(a)(a + b); };
  const auto times = [](auto a, auto b) { return decltype(a)(a * b); };
  const auto least = [](auto a, auto b) { return b < a ? b : a; };
  const auto greatest = [](auto a, auto b) { return a < b ? b : a; };
  const auto only = [&](const auto& f) {
    return [=](const Lane& l) { return l.i % 3 != 1 ? std::uint32_t(f(l)) : 0u; };
  };
  const auto bits = [](float x) { return std::bit_cast<std::uint32_t>(x); };
  // Its sums depend on their order.
  const auto uneven = [](std::uint32_t j) { return 1.0f / float(j + 3); };
  const auto sum_of_floats = [&](std::uint32_t first, std::uint32_t last) {
    return combined(first, last, 0.0f, uneven, plus);
  };
  const auto cluster = [](const Lane& l, std::uint32_t n) {
    const std::uint32_t width = std::min(n, l.size);
    const std::uint32_t first = l.first + l.id() / width * width;
    return std::pair(first, std::min(first + width, l.last));
  };
  check_rows(R"(
void main() {
  uint i = gl_LocalInvocationIndex;
  if (i % 3 == 1) return;
  float x = 1.0 / float(i + 3);
  put(subgroupAdd(i));
  put(subgroupInclusiveAdd(uvec3(i, 1, 2)).x);
  put(subgroupExclusiveAdd(i));
  put(subgroupAdd(x));
  put(subgroupInclusiveAdd(x));
  put(subgroupExclusiveAdd(x));
  put(subgroupMul(i + 1) ^ subgroupInclusiveMul(2 * i + 1) ^ subgroupExclusiveMul(i | 1));
  put(uint(subgroupMin(int(i) - 20)) ^ uint(subgroupExclusiveMin(int(i) - 20)) ^ subgroupMin(i - 20));
  put(uint(subgroupMax(int(i) - 20)) ^ uint(subgroupExclusiveMax(int(i) - 20)) ^ subgroupMax(i - 20));
  put(subgroupExclusiveMin(x));
  put(subgroupExclusiveMax(x));
  put(subgroupAnd(~(1u << i % 32)) ^ subgroupInclusiveAnd(~i) ^ subgroupExclusiveAnd(~i));
  put(subgroupOr(1u << i % 32) ^ subgroupExclusiveOr(i));
  put(subgroupXor(i) ^ subgroupExclusiveXor(i));
  put(uint(subgroupAnd(i < 20)) | uint(subgroupOr(i < 20)) << 1 | uint(subgroupXor(i < 20)) << 2 |
      uint(subgroupExclusiveAnd(bvec2(i < 10, true)).x) << 3);
  put(uint(subgroupInclusiveAdd(uint8_t(i * 5))) | uint(subgroupAdd(uint16_t(i * 3000))) << 8);
  put(uint(subgroupMax(int8_t(i * 5))) ^ uint(subgroupMin(int16_t(i * 3000))));
  put(uint(subgroupInclusiveAdd(uint64_t(i) << 30) >> 30));
  put(uint(subgroupMax(double(i) * 0.5) * 2.0LF) + uint(subgroupAdd(float16_t(i)).x) * 1000);
  put(subgroupClusteredAdd(i, 4));
  put(subgroupClusteredMax(i, 8) ^ subgroupClusteredMin(i, 1) ^ subgroupClusteredXor(i, 2));
}
)",
             {only([&](const Lane& l) {
                return combined(
                    l.first, l.last, 0u, [](auto j) { return j; }, plus);
              }),
              only([&](const Lane& l) {
                return combined(
                    l.first, l.i + 1, 0u, [](auto j) { return j; }, plus);
              }),
              only([&](const Lane& l) {
                return combined(
                    l.first, l.i, 0u, [](auto j) { return j; }, plus);
              }),
              only([&](const Lane& l) { return bits(sum_of_floats(l.first, l.last)); }),
              only([&](const Lane& l) { return bits(sum_of_floats(l.first, l.i + 1)); }),
              only([&](const Lane& l) { return bits(sum_of_floats(l.first, l.i)); }),
              only([&](const Lane& l) {
                return combined(
                           l.first, l.last, 1u, [](auto j) { return j + 1; }, times) ^
                       combined(
                           l.first, l.i + 1, 1u, [](auto j) { return 2 * j + 1; }, times) ^
                       combined(
                           l.first, l.i, 1u, [](auto j) { return j | 1; }, times);
              }),
              only([&](const Lane& l) {
                const auto value = [](auto j) { return std::int32_t(j) - 20; };
                return std::uint32_t(combined(l.first, l.last, INT32_MAX, value, least)) ^
                       std::uint32_t(combined(l.first, l.i, INT32_MAX, value, least)) ^
                       combined(
                           l.first, l.last, ~0u, [](auto j) { return j - 20; }, least);
              }),
              only([&](const Lane& l) {
                const auto value = [](auto j) { return std::int32_t(j) - 20; };
                return std::uint32_t(combined(l.first, l.last, INT32_MIN, value, greatest)) ^
                       std::uint32_t(combined(l.first, l.i, INT32_MIN, value, greatest)) ^
                       combined(
                           l.first, l.last, 0u, [](auto j) { return j - 20; }, greatest);
              }),
              only([&](const Lane& l) { return bits(combined(l.first, l.i, INFINITY, uneven, least)); }),
              only([&](const Lane& l) { return bits(combined(l.first, l.i, -INFINITY, uneven, greatest)); }),
              only([&](const Lane& l) {
                const auto both = [](auto a, auto b) { return a & b; };
                return combined(
                           l.first, l.last, ~0u, [](auto j) { return ~(1u << j % 32); }, both) ^
                       combined(
                           l.first, l.i + 1, ~0u, [](auto j) { return ~j; }, both) ^
                       combined(
                           l.first, l.i, ~0u, [](auto j) { return ~j; }, both);
              }),
              only([&](const Lane& l) {
                const auto either = [](auto a, auto b) { return a | b; };
                return combined(
                           l.first, l.last, 0u, [](auto j) { return 1u << j % 32; }, either) ^
                       combined(
                           l.first, l.i, 0u, [](auto j) { return j; }, either);
              }),
              only([&](const Lane& l) {
                const auto one = [](auto a, auto b) { return a ^ b; };
                return combined(
                           l.first, l.last, 0u, [](auto j) { return j; }, one) ^
                       combined(
                           l.first, l.i, 0u, [](auto j) { return j; }, one);
              }),
              only([&](const Lane& l) {
                const auto small = [](auto j) { return j < 20; };
                return unsigned(combined(l.first, l.last, true, small, [](bool a, bool b) { return a && b; })) |
                       unsigned(combined(l.first, l.last, false, small, [](bool a, bool b) { return a || b; })) << 1 |
                       unsigned(combined(l.first, l.last, false, small, [](bool a, bool b) { return a != b; })) << 2 |
                       unsigned(combined(
                           l.first, l.i, true, [](auto j) { return j < 10; }, [](bool a, bool b) { return a && b; }))
                           << 3;
              }),
              only([&](const Lane& l) {
                return combined(
                           l.first, l.i + 1, std::uint8_t(0), [](auto j) { return std::uint8_t(j * 5); }, plus) |
                       combined(
                           l.first, l.last, std::uint16_t(0), [](auto j) { return std::uint16_t(j * 3000); }, plus)
                           << 8;
              }),
              only([&](const Lane& l) {
                const auto bytes = [](auto j) { return std::int8_t(j * 5); };
                const auto shorts = [](auto j) { return std::int16_t(j * 3000); };
                return std::uint32_t(combined(l.first, l.last, std::int8_t(-128), bytes, greatest)) ^
                       std::uint32_t(combined(l.first, l.last, std::int16_t(32767), shorts, least));
              }),
              only([&](const Lane& l) {
                return combined(
                    l.first, l.i + 1, 0u, [](auto j) { return j; }, plus);
              }),
              only([&](const Lane& l) {
                return combined(
                           l.first, l.last, 0u, [](auto j) { return j; }, greatest) +
                       combined(
                           l.first, l.last, 0u, [](auto j) { return j; }, plus) *
                           1000;
              }),
              only([&](const Lane& l) {
                const auto [first, last] = cluster(l, 4);
                return combined(
                    first, last, 0u, [](auto j) { return j; }, plus);
              }),
              only([&](const Lane& l) {
                const auto [first, last] = cluster(l, 8);
                const auto [two, two_end] = cluster(l, 2);
                return combined(
                           first, last, 0u, [](auto j) { return j; }, greatest) ^
                       l.i ^
                       combined(
                           two, two_end, 0u, [](auto j) { return j; }, [](auto a, auto b) { return a ^ b; });
              })});
}

}  // namespace
}  // namespace tandem::cpu::test
