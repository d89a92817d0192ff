#include <bit>
#include <numeric>
#include <string>

#include "conformance/kit/cases.hpp"
#include "conformance/workgroup/shared_memory.hpp"

/// shared_memory.exchange: what the invocations of a workgroup hand each other. shared_memory.types: what may lie in
/// shared memory. shared_memory.layout: blocks that share their bytes, and memory that begins as zeros.
namespace tandem::conformance {

void require_workgroup_memory(Context& context, std::uint32_t bytes) {
  const std::uint32_t size = context.device().info().limits.workgroup_memory_size;
  if (size == 0) throw Unsupported("the device lacks workgroup memory");
  if (size < bytes) throw Unsupported(fmt::format("the device has {} bytes of workgroup memory, not {}", size, bytes));
}

void check_workgroups(Context& context, const WorkgroupKernel& kernel,
                      const std::function<std::uint32_t(std::uint32_t group, std::uint32_t index)>& expected) {
  require_workgroup_memory(context, kernel.bytes);
  const std::uint32_t invocations = kernel.local_size[0] * kernel.local_size[1] * kernel.local_size[2];
  const std::uint32_t per_group = kernel.answers == 0 ? invocations : kernel.answers;
  std::string glsl = kernel.extensions + fmt::format(R"(
layout(local_size_x = {}, local_size_y = {}, local_size_z = {}) in;
layout(binding = 0, std430) coherent buffer Answers {{ uint answers[]; }};
)",
                                                     kernel.local_size[0], kernel.local_size[1], kernel.local_size[2]);
  glsl += kernel.declarations + fmt::format(R"(
void main() {{
  const uint group = (gl_WorkGroupID.z * gl_NumWorkGroups.y + gl_WorkGroupID.y) * gl_NumWorkGroups.x + gl_WorkGroupID.x;
  const uint i = gl_LocalInvocationIndex, first = group * {}u;
{}
}}
)",
                                            per_group, kernel.body);
  const auto [x, y, z] = kernel.workgroup_count;
  const Words seen = answers(
      context,
      {.label = kernel.label, .glsl = glsl, .workgroup_count = kernel.workgroup_count, .options = kernel.options},
      std::size_t{x} * y * z * per_group);
  for (std::uint32_t k = 0; k < seen.size(); ++k)
    check_equal(fmt::format("answer {} of workgroup {}", k % per_group, k / per_group), seen[k],
                expected(k / per_group, k % per_group));
}

namespace {

using Capabilities = rhi::Capabilities;

void add_exchange_cases(const Group& group) {
  group.add("reversal", "an invocation reads what another has written before the barrier", [](Context& context) {
    check_workgroups(context,
                     {.label = "reversal",
                      .declarations = "shared uint s[64];",
                      .body = "  s[i] = group * 100u + i;\n  barrier();\n  answers[first + i] = s[63u - i];",
                      .workgroup_count = {3, 2, 2}},
                     [](auto workgroup, auto i) { return workgroup * 100 + 63 - i; });
  });
  group.add("reduction", "a tree of sums, halved by barriers", [](Context& context) {
    check_workgroups(context,
                     {.label = "reduction",
                      .declarations = "shared uint s[128];",
                      .body = R"(
  s[i] = (group + 1u) * (i + 1u);
  for (uint half_count = 64u; half_count > 0u; half_count /= 2u) {
    barrier();
    if (i < half_count) s[i] += s[i + half_count];
  }
  if (i == 0u) answers[first] = s[0];
)",
                      .local_size = {128, 1, 1},
                      .workgroup_count = {5, 1, 1},
                      .answers = 1},
                     [](auto workgroup, auto) { return (workgroup + 1) * (128 * 129 / 2); });
  });
  group.add("transpose", "a tile of 8 x 8, whose rows are padded, is turned over", [](Context& context) {
    check_workgroups(context,
                     {.label = "transpose",
                      .declarations = "shared uint tile[8][9];",
                      .body = R"(
  tile[gl_LocalInvocationID.y][gl_LocalInvocationID.x] = group * 64u + i;
  barrier();
  answers[first + i] = tile[gl_LocalInvocationID.x][gl_LocalInvocationID.y];
)",
                      .local_size = {8, 8, 1},
                      .workgroup_count = {2, 2, 1}},
                     [](auto workgroup, auto i) { return workgroup * 64 + i % 8 * 8 + i / 8; });
  });
  group.add("matrix_product", "a product of 24 x 24 matrices, in tiles of 8 x 8", [](Context& context) {
    // a[r][c] = r + 2 c, b[r][c] = (r * c) % 7: all sums are integers that floats hold.
    check_workgroups(context,
                     {.label = "matrix product",
                      .declarations = "shared float tile_a[8][8], tile_b[8][8];",
                      .body = R"(
  const uvec2 at = gl_LocalInvocationID.xy, whole = gl_WorkGroupID.xy * 8u + at;
  float sum = 0.0;
  for (uint k = 0u; k < 24u; k += 8u) {
    tile_a[at.y][at.x] = float(whole.y + 2u * (k + at.x));
    tile_b[at.y][at.x] = float((k + at.y) * whole.x % 7u);
    barrier();
    for (uint m = 0u; m < 8u; ++m) sum += tile_a[at.y][m] * tile_b[m][at.x];
    barrier();
  }
  answers[first + i] = uint(sum);
)",
                      .local_size = {8, 8, 1},
                      .workgroup_count = {3, 3, 1}},
                     [](auto workgroup, auto i) {
                       const std::uint32_t column = workgroup % 3 * 8 + i % 8, row = workgroup / 3 * 8 + i / 8;
                       std::uint32_t sum = 0;
                       for (std::uint32_t k = 0; k < 24; ++k) sum += (row + 2 * k) * (k * column % 7);
                       return sum;
                     });
  });
  group.add("functions", "functions read and write shared memory, and take it as an argument", [](Context& context) {
    check_workgroups(context,
                     {.label = "shared memory in functions",
                      .declarations = R"(
struct Pair { uint a; uint b; };
shared Pair pairs[64];
shared uint total[64];
void swap(inout uint a, inout uint b) { uint c = a; a = b; b = c; }
Pair swapped(Pair pair) { swap(pair.a, pair.b); return pair; }
uint sum_of(uint values[64]) { uint sum = 0u; for (uint k = 0u; k < 64u; ++k) sum += values[k]; return sum; }
void fill(uint i) { pairs[i] = Pair(i, i + 1000u); total[i] = i; }
)",
                      .body = R"(
  fill(i);
  swap(pairs[i].a, pairs[i].b);
  barrier();
  const Pair other = swapped(pairs[63u - i]);
  answers[first + i] = other.a * 65536u + other.b + sum_of(total);
)"},
                     [](auto, auto i) { return (63 - i) * 65536 + (63 - i) + 1000 + 63 * 64 / 2; });
  });
  group.add("size_by_constant", "workgroup and shared array have the size of a specialisation constant",
            [](Context& context) {
              check_workgroups(context,
                               {.label = "size by constant",
                                .declarations = R"(
layout(local_size_x_id = 7) in;
shared uint s[gl_WorkGroupSize.x * 2u];
)",
                                .body = R"(
  s[i] = i;
  s[gl_WorkGroupSize.x + i] = gl_WorkGroupSize.x;
  barrier();
  const uint last = 2u * gl_WorkGroupSize.x - 1u;
  answers[first + i] = s[gl_WorkGroupSize.x - 1u - i] + s[last - i] * 1000u;
)",
                                .answers = 48,
                                .options = {.specialization = {{.id = 7, .value = 48}}}},
                               [](auto, auto i) { return 47 - i + 48000; });
            });
  group.add("all_bytes", "a shader may have as much shared memory as the device says", [](Context& context) {
    require_workgroup_memory(context, 4);
    const std::uint32_t words = context.device().info().limits.workgroup_memory_size / 4;
    check_workgroups(context,
                     {.label = "all bytes",
                      .declarations = fmt::format("const uint words = {}u;\nshared uint s[words];", words),
                      .body = R"(
  for (uint k = i; k < words; k += 64u) s[k] = k * (group + 3u);
  barrier();
  uint wrong = 0u;
  for (uint k = 63u - i; k < words; k += 64u) wrong += uint(s[k] != k * (group + 3u));
  answers[first + i] = wrong;
)",
                      .workgroup_count = {4, 1, 1}},
                     [](auto, auto) { return 0u; });
  });
}

/// One array of a type in shared memory: TYPE(VALUE) goes in, uint() of it comes out.
void check_type(Context& context, const std::string& type, const std::string& to_type, const std::string& to_uint,
                const std::function<std::uint32_t(std::uint32_t)>& expected) {
  check_workgroups(context,
                   {.label = "shared " + type,
                    .extensions = "#extension GL_EXT_shader_explicit_arithmetic_types : require\n",
                    .declarations = with("shared TYPE s[65];", "TYPE", type),
                    .body = with("  s[i + 1u] = " + to_type + ";\n  if (i == 0u) s[0] = s[1];\n  barrier();\n" +
                                     "  TYPE x = s[64u - i];\n  answers[first + i] = " + to_uint + ";",
                                 "TYPE", type)},
                   [&](auto, auto i) { return expected(63 - i); });
}

void add_type_cases(Cases& cases) {
  const std::string behaviour = "an element that one invocation writes, another reads";
  const auto add = [&](const std::string& name, const std::vector<Capability>& needs, const std::string& type,
                       const std::string& to_type, const std::string& to_uint,
                       const std::function<std::uint32_t(std::uint32_t)>& expected) {
    Group{cases, "shared_memory.types", needs}.add(
        name, behaviour, [=](Context& context) { check_type(context, type, to_type, to_uint, expected); });
  };
  add("int8", {&Capabilities::shader_int8}, "int8_t", "int8_t(int(i) * 5 - 100)", "uint(int(x) + 1000)",
      [](std::uint32_t i) { return static_cast<std::uint32_t>(static_cast<std::int8_t>(i * 5 - 100) + 1000); });
  add("uint16", {&Capabilities::shader_int16}, "uint16_t", "uint16_t(i * 2000u)", "uint(x)",
      [](std::uint32_t i) { return i * 2000 & 0xffff; });
  add("int64", {&Capabilities::shader_int64}, "int64_t", "int64_t(i) * 6000000007l", "uint(x >> 16)",
      [](std::uint32_t i) { return static_cast<std::uint32_t>(i * 6000000007ull >> 16); });
  add("float16", {&Capabilities::shader_float16}, "float16_t", "float16_t(float(i) * 0.25)", "uint(float(x) * 4.0)",
      [](std::uint32_t i) { return i; });
  add("float64", {&Capabilities::shader_float64}, "double", "double(i) * 4294967296.0lf + 1.0lf",
      "uint((x - 1.0lf) / 65536.0lf)", [](std::uint32_t i) { return i << 16; });
  const Group group = {cases, "shared_memory.types", {}};
  group.add("bool_and_vectors", "bool, bvec3, vec3, uvec4 and matrices keep their components", [](Context& context) {
    check_workgroups(context,
                     {.label = "bool and vectors",
                      .declarations = R"(
shared bool flags[64];
shared bvec3 masks[64];
shared vec3 points[64];
shared uvec4 quads[64];
shared mat2x3 matrices[4];
)",
                      .body = R"(
  flags[i] = i % 3u == 0u;
  masks[i] = bvec3(i % 2u == 0u, true, i % 5u == 0u);
  points[i] = vec3(i, 1.0, 2.0);
  points[i].z = float(i) + 0.5;
  quads[i] = uvec4(0u);
  quads[i][i % 4u] = i;
  if (i < 24u) matrices[i / 6u][i / 3u % 2u][i % 3u] = float(i);
  barrier();
  const uint j = 63u - i;
  const vec3 p = points[j];
  const uvec4 q = quads[j];
  uint bits = uint(flags[j]) + 2u * uint(masks[j].x) + 4u * uint(masks[j].y) + 8u * uint(masks[j].z);
  bits += 16u * uint(p == vec3(j, 1.0, float(j) + 0.5)) + 32u * uint(q.x + q.y + q.z + q.w == j && q[j % 4u] == j);
  const vec3 row = matrices[j % 4u] * vec2(1.0, 2.0);
  answers[first + i] = bits + 64u * uint(row.x + row.y + row.z);
)"},
                     [](auto, auto i) {
                       const std::uint32_t j = 63 - i, m = j % 4 * 6;
                       const std::uint32_t sum = 3 * m + 3 + 2 * (3 * m + 12);
                       return (j % 3 == 0 ? 1u : 0u) + (j % 2 == 0 ? 2u : 0u) + 4 + (j % 5 == 0 ? 8u : 0u) + 16 + 32 +
                              64 * sum;
                     });
  });
  group.add("structs", "arrays of structures with arrays in them, as a whole and member by member",
            [](Context& context) {
              check_workgroups(context,
                               {.label = "shared structs",
                                .declarations = R"(
struct Inner { vec3 v; bool b; };
struct Outer { uint n; Inner inner[2]; float f[3]; };
shared Outer s[32];
)",
                                .body = R"(
  Outer o;
  o.n = i;
  for (uint k = 0u; k < 2u; ++k) o.inner[k] = Inner(vec3(i, k, 3.0), (i + k) % 2u == 0u);
  for (uint k = 0u; k < 3u; ++k) o.f[k] = float(i * 10u + k);
  s[i] = o;
  barrier();
  s[31u - i].inner[i % 2u].v.y = 7.0;
  s[31u - i].f[2] += 1.0;
  barrier();
  const Outer p = s[(i + 1u) % 32u];
  const Inner q = p.inner[p.n % 2u], r = p.inner[(p.n + 1u) % 2u];
  answers[first + i] = p.n + 100u * uint(q.v.y + r.v.y) + 10000u * (uint(q.b) + 2u * uint(r.b)) + 100000u * uint(p.f[2]);
)",
                                .local_size = {32, 1, 1}},
                               [](auto, auto i) {
                                 const std::uint32_t n = (i + 1) % 32, writer = 31 - n, replaced = writer % 2;
                                 const std::uint32_t kept = 1 - replaced;
                                 // (n + k) % 2 == 0 holds for k = n % 2, which is q, and not for r.
                                 return n + 100 * (7 + kept) + 10000 + 100000 * (n * 10 + 3);
                               });
            });
}

void add_layout_cases(Cases& cases) {
  Group{cases, "shared_memory.layout", {&Capabilities::workgroup_memory_layout}}.add(
      "aliasing_blocks", "two blocks have the same bytes", [](Context& context) {
        check_workgroups(context,
                         {.label = "aliasing blocks",
                          .extensions = "#extension GL_EXT_shared_memory_block : require\n",
                          .declarations = R"(
shared First { layout(offset = 16) uint words[64]; } as_words;
shared Second { vec4 header; vec4 vectors[16]; } as_vectors;
)",
                          .body = R"(
  as_words.words[i] = floatBitsToUint(float(i) + 0.5);
  barrier();
  const uint j = 63u - i;
  answers[first + i] = uint(as_vectors.vectors[j / 4u][j % 4u] * 2.0);
)"},
                         [](auto, auto i) { return (63 - i) * 2 + 1; });
      });
  Group{cases,
        "shared_memory.layout",
        {&Capabilities::workgroup_memory_layout, &Capabilities::workgroup_memory_layout_8bit,
         &Capabilities::workgroup_memory_layout_16bit, &Capabilities::shader_int8, &Capabilities::shader_int16}}
      .add("bytes_of_words", "bytes and halves of the words of another block", [](Context& context) {
        check_workgroups(context,
                         {.label = "bytes of words",
                          .extensions = "#extension GL_EXT_shared_memory_block : require\n"
                                        "#extension GL_EXT_shader_explicit_arithmetic_types : require\n",
                          .declarations = R"(
shared Words { uint words[64]; } w;
shared Halves { uint16_t halves[128]; } h;
shared Bytes { uint8_t bytes[256]; } b;
)",
                          .body = R"(
  w.words[i] = i * 0x01020304u;
  barrier();
  h.halves[2u * i] = uint16_t(i + 500u);
  barrier();
  b.bytes[4u * i + 3u] = uint8_t(i);
  barrier();
  const uint j = 63u - i;
  answers[first + i] = w.words[j] ^ uint(b.bytes[4u * j + 2u]);
)"},
                         [](auto, auto i) {
                           const std::uint32_t j = 63 - i, byte = j * 0x01020304u >> 16 & 0xff;
                           return (j << 24 | byte << 16 | (j + 500)) ^ byte;
                         });
      });
  Group{cases, "shared_memory.layout", {&Capabilities::zeroed_workgroup_memory}}.add(
      "zeros", "variables with a null initialiser are zeros in every workgroup", [](Context& context) {
        // The first kernel leaves other bytes in the memory; so does each workgroup of the second.
        check_workgroups(context,
                         {.label = "leave bytes",
                          .declarations = "shared uint s[1024];",
                          .body = R"(
  for (uint k = i; k < 1024u; k += 64u) s[k] = ~k;
  barrier();
  answers[first + i] = s[1023u - i];
)",
                          .workgroup_count = {32, 1, 1}},
                         [](auto, auto i) { return ~(1023 - i); });
        check_workgroups(context,
                         {.label = "zeros",
                          .extensions = "#extension GL_EXT_null_initializer : require\n",
                          .declarations = R"(
struct Inner { vec3 v; bool b; };
shared uint s[700] = {};
shared Inner t[10] = {};
)",
                          .body = R"(
  uint wrong = 0u;
  for (uint k = i; k < 700u; k += 64u) wrong += uint(s[k] != 0u);
  for (uint k = 0u; k < 10u; ++k) wrong += uint(t[k].b) + uint(t[k].v != vec3(0.0));
  barrier();
  for (uint k = i; k < 700u; k += 64u) s[k] = i + 1u;
  if (i < 10u) t[i] = Inner(vec3(1.0), true);
  barrier();
  answers[first + i] = wrong * 1000u + s[63u - i];
)",
                          .workgroup_count = {32, 1, 1}},
                         [](auto, auto i) { return 64 - i; });
      });
}

}  // namespace

void add_shared_memory_cases(Cases& cases) {
  add_exchange_cases({cases, "shared_memory.exchange", {}});
  add_type_cases(cases);
  add_layout_cases(cases);
}

}  // namespace tandem::conformance
