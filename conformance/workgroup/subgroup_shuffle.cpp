#include <algorithm>
#include <string>
#include <type_traits>
#include <vector>

#include "conformance/kit/cases.hpp"
#include "conformance/workgroup/subgroup_run.hpp"

/// subgroups.shuffle, .shuffle_relative, .quad and .rotate: values of other invocations. What a lane without an
/// invocation would hold is undefined, so nothing is expected of those who ask for it.
namespace tandem::conformance {
namespace {

using Capabilities = rhi::Capabilities;

/// What an operation takes its value from: a lane of the subgroup, which may not have an invocation, or be none.
using Source = std::function<std::uint32_t(std::uint32_t lane, std::uint32_t size)>;

struct Exchange {
  std::string glsl;  ///< an expression of x, the invocation's value
  Source source;
};

constexpr std::uint32_t nowhere = ~0u;

Exchange shuffle_xor(std::uint32_t mask) {
  return {fmt::format("subgroupShuffleXor(x, {}u)", mask),
          [mask](std::uint32_t lane, std::uint32_t) { return lane ^ mask; }};
}

Exchange shuffle_up(std::uint32_t delta) {
  return {fmt::format("subgroupShuffleUp(x, {}u)", delta),
          [delta](std::uint32_t lane, std::uint32_t) { return lane < delta ? nowhere : lane - delta; }};
}

Exchange shuffle_down(std::uint32_t delta) {
  return {fmt::format("subgroupShuffleDown(x, {}u)", delta),
          [delta](std::uint32_t lane, std::uint32_t) { return lane + delta; }};
}

std::vector<Exchange> shuffles(std::uint32_t) {
  return {
      {"subgroupShuffle(x, (gl_SubgroupInvocationID * 5u + 3u) % gl_SubgroupSize)",
       [](std::uint32_t lane, std::uint32_t size) { return (lane * 5 + 3) % size; }},
      {"subgroupShuffle(x, 0u)", [](std::uint32_t, std::uint32_t) { return 0u; }},
      {"subgroupShuffle(x, gl_SubgroupInvocationID / 2u)", [](std::uint32_t lane, std::uint32_t) { return lane / 2; }},
      {"subgroupShuffleXor(x, gl_SubgroupSize - 1u)",
       [](std::uint32_t lane, std::uint32_t size) { return lane ^ (size - 1); }},
      shuffle_xor(1),
      shuffle_xor(6)};
}

std::vector<Exchange> relative_shuffles(std::uint32_t) {
  return {shuffle_up(1),
          shuffle_up(3),
          shuffle_down(1),
          shuffle_down(5),
          {"subgroupShuffleUp(x, gl_SubgroupSize / 2u)",
           [](std::uint32_t lane, std::uint32_t size) { return lane < size / 2 ? nowhere : lane - size / 2; }},
          {"subgroupShuffleDown(x, 0u)", [](std::uint32_t lane, std::uint32_t) { return lane; }}};
}

std::vector<Exchange> quads(std::uint32_t subgroup_size) {
  if (subgroup_size < 4) throw Unsupported("the device has subgroups of fewer invocations than a quad");

  std::vector<Exchange> all = {
      {"subgroupQuadSwapHorizontal(x)", [](std::uint32_t lane, std::uint32_t) { return lane ^ 1; }},
      {"subgroupQuadSwapVertical(x)", [](std::uint32_t lane, std::uint32_t) { return lane ^ 2; }},
      {"subgroupQuadSwapDiagonal(x)", [](std::uint32_t lane, std::uint32_t) { return lane ^ 3; }}};
  for (std::uint32_t k = 0; k < 4; ++k)
    all.push_back({fmt::format("subgroupQuadBroadcast(x, {}u)", k),
                   [k](std::uint32_t lane, std::uint32_t) { return (lane & ~3u) + k; }});
  return all;
}

/// By a number that is the same in all invocations and less than the size.
std::vector<Exchange> rotations(std::uint32_t) {
  std::vector<Exchange> all;
  for (const std::uint32_t delta : {0u, 1u, 5u})
    all.push_back({fmt::format("subgroup_rotate(3u, x, {}u % gl_SubgroupSize)", delta),
                   [delta](std::uint32_t lane, std::uint32_t size) { return (lane + delta) % size; }});
  all.push_back({"subgroup_rotate(3u, x, gl_SubgroupSize / gl_NumWorkGroups.x)",
                 [](std::uint32_t lane, std::uint32_t size) { return (lane + size / 2) % size; }});
  return all;
}

std::vector<Exchange> clustered_rotations(std::uint32_t subgroup_size) {
  std::vector<Exchange> all;
  for (std::uint32_t cluster = 1; cluster <= subgroup_size; cluster *= 2) {
    const std::uint32_t delta = 3 % cluster;
    all.push_back(
        {fmt::format("subgroup_rotate(3u, x, {}u, {}u)", delta, cluster),
         [=](std::uint32_t lane, std::uint32_t) { return lane / cluster * cluster + (lane + delta) % cluster; }});
  }
  return all;
}

/// The instruction of GL_KHR_shader_subgroup_rotate, which older compilers do not know.
std::string rotate_function(const std::string& type) {
  const std::string head = R"(
spirv_instruction(extensions = ["SPV_KHR_subgroup_rotate"], capabilities = [6026], id = 4431)
TYPE subgroup_rotate(uint scope, TYPE value, uint delta)";
  return with(head + ");" + head + ", uint cluster);\n", "TYPE", type);
}

/// The value of invocation i, which every type holds.
double number_of(std::uint32_t i) { return static_cast<double>(i * 7 % 101); }

template <typename T>
void check_exchange(Context& context, const std::string& type, SubgroupKernel kernel,
                    const std::vector<Exchange>& exchanges) {
  const bool is_bool = std::is_same_v<T, bool>;
  const std::uint32_t words = words_of(type);
  kernel.label += " of " + type;
  kernel.extensions.insert(
      kernel.extensions.end(),
      {"GL_EXT_shader_explicit_arithmetic_types", "GL_EXT_shader_subgroup_extended_types_int8",
       "GL_EXT_shader_subgroup_extended_types_int16", "GL_EXT_shader_subgroup_extended_types_int64",
       "GL_EXT_shader_subgroup_extended_types_float16"});
  kernel.declarations += put_function(type);
  kernel.body = with(is_bool ? "  bool x = i * 7u % 101u > 50u;\n" : "  TYPE x = TYPE(i * 7u % 101u);\n", "TYPE", type);
  kernel.columns = 0;
  for (const Exchange& exchange : exchanges) {
    kernel.body += fmt::format("  put(at + {}, {});\n", kernel.columns, exchange.glsl);
    kernel.columns += words;
  }
  const SubgroupAnswers seen = run_subgroups(context, kernel);
  for (std::uint32_t k = 0; k < exchanges.size(); ++k)
    check_values<T>(seen, k * words, exchanges[k].glsl + " of " + type,
                    [&](const Subgroup& subgroup, std::uint32_t lane) -> std::optional<T> {
                      const std::uint32_t source = exchanges[k].source(lane, subgroup.size);
                      if (source >= subgroup.size || subgroup.lanes[source] == nullptr) return {};
                      const double number = number_of(subgroup.lanes[source]->index);
                      return is_bool ? static_cast<T>(number > 50) : static_cast<T>(number);
                    });
}

/// Calls add<T>(name, type, needs) for types of each size.
template <typename Add>
void for_types(const Add& add) {
  using Needs = std::vector<Capability>;
  constexpr Capability extended = &Capabilities::subgroup_extended_types;
  add.template operator()<std::uint32_t>("uint32", "uint", Needs{});
  add.template operator()<float>("float32", "float", Needs{});
  add.template operator()<bool>("bool", "bool", Needs{});
  add.template operator()<double>("float64", "double", Needs{&Capabilities::shader_float64});
  add.template operator()<std::int64_t>("int64", "int64_t", Needs{extended, &Capabilities::shader_int64});
  add.template operator()<std::uint16_t>("uint16", "uint16_t", Needs{extended, &Capabilities::shader_int16});
  add.template operator()<std::int8_t>("int8", "int8_t", Needs{extended, &Capabilities::shader_int8});
  add.template operator()<float>("float16", "float16_t", Needs{extended, &Capabilities::shader_float16});
}

/// Operations of one capability: a case per type.
struct Family {
  std::string name;  ///< of the group, after "subgroups."
  std::string behaviour;
  Capability needs;
  std::vector<std::string> extensions;
  std::vector<Exchange> (*exchanges)(std::uint32_t subgroup_size);
  std::vector<std::string> types;
  bool rotates = false;
};

void add_family(Cases& cases, const Family& family) {
  for_types([&]<typename T>(const std::string& name, const std::string& type, std::vector<Capability> needs) {
    if (std::find(family.types.begin(), family.types.end(), type) == family.types.end()) return;
    needs.insert(needs.begin(), {&Capabilities::subgroup_basic, family.needs});
    Group{cases, "subgroups." + family.name, std::move(needs)}.add(name, family.behaviour, [=](Context& context) {
      const SubgroupKernel kernel = {.label = "subgroup " + family.name,
                                     .extensions = family.extensions,
                                     .declarations = family.rotates ? rotate_function(type) : "",
                                     .body = ""};
      check_exchange<T>(context, type, kernel, family.exchanges(context.device().info().limits.subgroup_size));
    });
  });
}

/// Vectors go as a whole, and an array's element by an index that differs between lanes.
void check_shuffled_vectors(Context& context) {
  const SubgroupAnswers seen = run_subgroups(context, {.label = "shuffled vectors",
                                                       .extensions = {"GL_KHR_shader_subgroup_shuffle"},
                                                       .body = R"(
  const uint other = gl_SubgroupInvocationID ^ 1u;
  const vec4 v = subgroupShuffle(vec4(i, i + 1u, i * 2u, 7.0), other);
  const ivec3 w = subgroupShuffleXor(ivec3(-int(i), int(i), 5), 1u);
  const bvec2 b = subgroupShuffle(bvec2(i % 2u == 0u, i % 3u == 0u), other);
  for (uint k = 0u; k < 4u; ++k) answers[at + k] = uint(v[k]);
  answers[at + 4] = uint(-w.x);
  answers[at + 5] = uint(w.y + w.z);
  answers[at + 6] = uint(b.x) + 2u * uint(b.y);
)",
                                                       .columns = 7});
  for (std::uint32_t column = 0; column < 7; ++column)
    check_values<std::uint32_t>(seen, column, fmt::format("word {} of vectors", column),
                                [column](const Subgroup& subgroup, std::uint32_t lane) -> std::optional<std::uint32_t> {
                                  const std::uint32_t other = lane ^ 1;
                                  if (other >= subgroup.size || subgroup.lanes[other] == nullptr) return {};
                                  const std::uint32_t i = subgroup.lanes[other]->index;
                                  const std::array<std::uint32_t, 7> expected = {
                                      i, i + 1, i * 2, 7, i, i + 5, (i % 2 == 0 ? 1u : 0u) + (i % 3 == 0 ? 2u : 0u)};
                                  return expected[column];
                                });
}

const std::vector<std::string> every_type = {"uint",    "float",    "bool",   "double",
                                             "int64_t", "uint16_t", "int8_t", "float16_t"};

}  // namespace

void add_subgroup_shuffle_cases(Cases& cases) {
  add_family(cases, {"shuffle",
                     "a shuffle brings the value of the lane that each invocation names",
                     &Capabilities::subgroup_shuffle,
                     {"GL_KHR_shader_subgroup_shuffle"},
                     shuffles,
                     every_type});
  Group{cases, "subgroups.shuffle", {&Capabilities::subgroup_basic, &Capabilities::subgroup_shuffle}}.add(
      "vectors", "vectors are shuffled as a whole", check_shuffled_vectors);
  add_family(cases, {"shuffle_relative",
                     "a relative shuffle brings the value of the lane so many below or above",
                     &Capabilities::subgroup_shuffle_relative,
                     {"GL_KHR_shader_subgroup_shuffle_relative"},
                     relative_shuffles,
                     {"uint", "float", "int64_t"}});
  add_family(cases, {"quad",
                     "quads exchange the values of their four invocations",
                     &Capabilities::subgroup_quad,
                     {"GL_KHR_shader_subgroup_quad"},
                     quads,
                     {"uint", "float", "bool", "double"}});
  add_family(cases, {"rotate",
                     "a rotation brings the value of the lane so many above, which begin again at the first",
                     &Capabilities::subgroup_rotate,
                     {"GL_EXT_spirv_intrinsics"},
                     rotations,
                     {"uint", "float", "int64_t"},
                     true});
  add_family(cases, {"clustered_rotate",
                     "a clustered rotation stays within the cluster",
                     &Capabilities::subgroup_clustered_rotate,
                     {"GL_EXT_spirv_intrinsics"},
                     clustered_rotations,
                     {"uint", "bool"},
                     true});
}

}  // namespace tandem::conformance
