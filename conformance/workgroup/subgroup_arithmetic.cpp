#include <functional>
#include <limits>
#include <string>
#include <type_traits>
#include <vector>

#include "conformance/kit/cases.hpp"
#include "conformance/workgroup/subgroup_run.hpp"

/// subgroups.arithmetic: reductions and scans of every operation and type. subgroups.clustered: reductions of clusters.
/// All values are such that the order of the operations makes no difference.
namespace tandem::conformance {
namespace {

using Capabilities = rhi::Capabilities;

enum class Operation { add, mul, min, max, bit_and, bit_or, bit_xor };

struct OperationName {
  Operation operation;
  const char* glsl;  ///< of subgroupAdd and subgroupInclusiveAdd
};

constexpr OperationName all_operations[] = {
    {Operation::add, "Add"},     {Operation::mul, "Mul"},   {Operation::min, "Min"},    {Operation::max, "Max"},
    {Operation::bit_and, "And"}, {Operation::bit_or, "Or"}, {Operation::bit_xor, "Xor"}};

template <typename T>
bool has_operation(Operation operation) {
  const bool is_bitwise = operation >= Operation::bit_and;
  return std::is_same_v<T, bool> ? is_bitwise : std::is_floating_point_v<T> ? !is_bitwise : true;
}

template <typename T>
T combined(Operation operation, T a, T b) {
  if constexpr (std::is_same_v<T, bool>) {
    return operation == Operation::bit_and ? a && b : operation == Operation::bit_or ? a || b : a != b;
  } else {
    if (operation == Operation::min) return std::min(a, b);
    if (operation == Operation::max) return std::max(a, b);
    if constexpr (std::is_floating_point_v<T>) {
      return operation == Operation::add ? a + b : a * b;
    } else {
      const auto x = static_cast<std::uint64_t>(a), y = static_cast<std::uint64_t>(b);
      switch (operation) {
        case Operation::add:
          return static_cast<T>(x + y);
        case Operation::mul:
          return static_cast<T>(x * y);
        case Operation::bit_and:
          return static_cast<T>(x & y);
        case Operation::bit_or:
          return static_cast<T>(x | y);
        default:
          return static_cast<T>(x ^ y);
      }
    }
  }
}

/// What an exclusive scan begins with.
template <typename T>
T identity(Operation operation) {
  constexpr bool is_float = std::is_floating_point_v<T>;
  using Limits = std::numeric_limits<T>;
  switch (operation) {
    case Operation::mul:
      return T(1);
    case Operation::min:
      return is_float ? Limits::infinity() : Limits::max();
    case Operation::max:
      return is_float ? -Limits::infinity() : Limits::lowest();
    case Operation::bit_and:
      return std::is_same_v<T, bool> ? T(true) : static_cast<T>(~std::uint64_t{0});
    default:
      return T(0);
  }
}

/// The value of invocation i, in GLSL and here. A product of floats has powers of two that nearly balance, since 16
/// bits hold no more; all sums of them are small integers.
template <typename T>
std::string value_glsl(const std::string& type) {
  if (std::is_same_v<T, bool>) return "bool x = i % 7u != 3u, factor = x;";
  const std::string declaration = with("TYPE x = ", "TYPE", type);
  if (std::is_floating_point_v<T>)
    return with(
        "TYPE x = TYPE(int(i * 37u % 9u) - 4);\n"
        "TYPE factor = TYPE(i % 16u == 1u ? 2.0 : i % 16u == 6u ? 0.5 : i % 3u == 0u ? -1.0 : 1.0);",
        "TYPE", type);
  const std::string wide = sizeof(T) == 8 ? " * TYPE(4294967297UL)" : "";
  return with("TYPE x = TYPE(i * 2654435761u + 97u)" + wide + ", factor = x | TYPE(1);", "TYPE", type);
}

template <typename T>
T value_of(std::uint32_t i, Operation operation) {
  const bool is_factor = operation == Operation::mul;
  if constexpr (std::is_same_v<T, bool>) {
    return i % 7 != 3;
  } else if constexpr (std::is_floating_point_v<T>) {
    if (is_factor) return i % 16 == 1 ? T(2) : i % 16 == 6 ? T(0.5) : i % 3 == 0 ? T(-1) : T(1);
    return static_cast<T>(static_cast<int>(i * 37 % 9) - 4);
  } else {
    const auto narrow = static_cast<T>(i * 2654435761u + 97u);
    const auto x = sizeof(T) == 8 ? static_cast<T>(static_cast<std::uint64_t>(narrow) * 4294967297ull) : narrow;
    return is_factor ? static_cast<T>(x | 1) : x;
  }
}

/// The values of the lanes that take part, combined.
template <typename T>
T folded(const Subgroup& subgroup, Operation operation, const std::function<bool(std::uint32_t)>& takes_part) {
  T result = identity<T>(operation);
  for (const std::uint32_t lane : lanes_of(subgroup))
    if (takes_part(lane)) result = combined<T>(operation, result, value_of<T>(subgroup.lanes[lane]->index, operation));
  return result;
}

std::vector<std::string> extensions_for(const std::string& class_of_operations) {
  return {"GL_KHR_shader_subgroup_" + class_of_operations, "GL_EXT_shader_explicit_arithmetic_types",
          "GL_EXT_shader_subgroup_extended_types_int8",    "GL_EXT_shader_subgroup_extended_types_int16",
          "GL_EXT_shader_subgroup_extended_types_int64",   "GL_EXT_shader_subgroup_extended_types_float16"};
}

template <typename T>
void check_arithmetic(Context& context, const std::string& type) {
  const std::uint32_t words = words_of(type);
  SubgroupKernel kernel = {.label = "subgroup arithmetic of " + type,
                           .extensions = extensions_for("arithmetic"),
                           .declarations = put_function(type),
                           .body = value_glsl<T>(type) + "\n",
                           .columns = 0};
  for (const auto& [operation, name] : all_operations) {
    if (!has_operation<T>(operation)) continue;
    const char* const value = operation == Operation::mul ? "factor" : "x";
    for (const char* const scan : {"", "Inclusive", "Exclusive"}) {
      kernel.body += fmt::format("  put(at + {}, subgroup{}{}({}));\n", kernel.columns, scan, name, value);
      kernel.columns += words;
    }
  }
  const SubgroupAnswers seen = run_subgroups(context, kernel);
  std::uint32_t column = 0;
  for (const OperationName& row : all_operations) {
    const Operation operation = row.operation;
    if (!has_operation<T>(operation)) continue;
    const auto check_scan = [&](const char* scan, const std::function<bool(std::uint32_t, std::uint32_t)>& takes_part) {
      check_values<T>(seen, column, fmt::format("subgroup{}{} of {}", scan, row.glsl, type),
                      [&](const Subgroup& subgroup, std::uint32_t lane) {
                        return folded<T>(subgroup, operation,
                                         [&](std::uint32_t other) { return takes_part(other, lane); });
                      });
      column += words;
    };
    check_scan("", [](std::uint32_t, std::uint32_t) { return true; });
    check_scan("Inclusive", [](std::uint32_t other, std::uint32_t lane) { return other <= lane; });
    check_scan("Exclusive", [](std::uint32_t other, std::uint32_t lane) { return other < lane; });
  }
}

/// Clusters of every size that the device's subgroups have: the size is a constant of the shader.
template <typename T>
void check_clusters(Context& context, const std::string& type) {
  const std::uint32_t words = words_of(type);
  SubgroupKernel kernel = {.label = "subgroup clusters of " + type,
                           .extensions = extensions_for("clustered"),
                           .declarations = put_function(type),
                           .body = value_glsl<T>(type) + "\n",
                           .columns = 0};
  const std::uint32_t largest = context.device().info().limits.subgroup_size;
  // Two operations with every size; the others with one, since each use takes the device time to compile.
  struct Use {
    OperationName row;
    std::uint32_t cluster;
  };
  std::vector<Use> uses;
  for (const OperationName& row : all_operations) {
    if (!has_operation<T>(row.operation)) continue;
    const bool every_size = row.operation == Operation::add || row.operation == Operation::bit_xor;
    for (std::uint32_t cluster = 1; cluster <= largest; cluster *= 2)
      if (every_size || cluster == std::max(largest / 2, 1u)) uses.push_back({row, cluster});
  }
  for (const Use& use : uses) {
    const char* const value = use.row.operation == Operation::mul ? "factor" : "x";
    kernel.body += fmt::format("  put(at + {}, subgroupClustered{}({}, {}u));\n", kernel.columns, use.row.glsl, value,
                               use.cluster);
    kernel.columns += words;
  }
  const SubgroupAnswers seen = run_subgroups(context, kernel);
  std::uint32_t column = 0;
  for (const Use& use : uses) {
    check_values<T>(seen, column, fmt::format("subgroupClustered{} of {} by {}", use.row.glsl, type, use.cluster),
                    [&](const Subgroup& subgroup, std::uint32_t lane) -> std::optional<T> {
                      return folded<T>(subgroup, use.row.operation,
                                       [&](std::uint32_t other) { return other / use.cluster == lane / use.cluster; });
                    });
    column += words;
  }
}

/// Each component of a vector for itself.
void check_vectors(Context& context) {
  const SubgroupAnswers seen = run_subgroups(context, {.label = "subgroup arithmetic of vectors",
                                                       .extensions = {"GL_KHR_shader_subgroup_arithmetic"},
                                                       .body = R"(
  const uvec4 v = uvec4(i, i * 3u, i ^ 21u, 1u);
  const uvec4 sum = subgroupAdd(v), scan = subgroupExclusiveAdd(v);
  const ivec2 least = subgroupMin(-ivec2(v.xy));
  const vec3 most = subgroupMax(vec3(v.xyz));
  const bvec2 all_odd = subgroupAnd(bvec2(v.x % 2u == 1u, v.w == 1u));
  for (uint k = 0u; k < 4u; ++k) { answers[at + k] = sum[k]; answers[at + 4u + k] = scan[k]; }
  for (uint k = 0u; k < 2u; ++k) { answers[at + 8u + k] = uint(-least[k]); answers[at + 13u + k] = uint(all_odd[k]); }
  for (uint k = 0u; k < 3u; ++k) answers[at + 10u + k] = uint(most[k]);
)",
                                                       .columns = 15});
  const auto component = [](const Subgroup& subgroup, std::uint32_t lane, std::uint32_t k) {
    const std::uint32_t i = subgroup.lanes[lane]->index;
    return k == 0 ? i : k == 1 ? i * 3 : k == 2 ? i ^ 21 : 1;
  };
  for (std::uint32_t column = 0; column < 15; ++column)
    check_values<std::uint32_t>(
        seen, column, fmt::format("word {} of vectors", column),
        [&](const Subgroup& subgroup, std::uint32_t lane) -> std::optional<std::uint32_t> {
          std::uint32_t sum = 0, before = 0, most = 0, all_odd = 1;
          const std::uint32_t k = column < 8 ? column % 4 : column < 10 ? column - 8 : column < 13 ? column - 10 : 0;
          for (const std::uint32_t other : lanes_of(subgroup)) {
            const std::uint32_t value = component(subgroup, other, k);
            sum += value;
            before += other < lane ? value : 0;
            most = std::max(most, value);
            all_odd &= column == 13 ? value % 2 : 1;
          }
          return column < 4 ? sum : column < 8 ? before : column < 13 ? most : all_odd;
        });
}

/// Calls add<T>(name, type, needs) for each type.
template <typename Add>
void for_each_type(const Add& add) {
  using Needs = std::vector<Capability>;
  constexpr Capability extended = &Capabilities::subgroup_extended_types;
  add.template operator()<std::int32_t>("int32", "int", Needs{});
  add.template operator()<std::uint32_t>("uint32", "uint", Needs{});
  add.template operator()<float>("float32", "float", Needs{});
  add.template operator()<bool>("bool", "bool", Needs{});
  add.template operator()<double>("float64", "double", Needs{&Capabilities::shader_float64});
  add.template operator()<std::int64_t>("int64", "int64_t", Needs{extended, &Capabilities::shader_int64});
  add.template operator()<std::uint64_t>("uint64", "uint64_t", Needs{extended, &Capabilities::shader_int64});
  add.template operator()<std::int16_t>("int16", "int16_t", Needs{extended, &Capabilities::shader_int16});
  add.template operator()<std::uint16_t>("uint16", "uint16_t", Needs{extended, &Capabilities::shader_int16});
  add.template operator()<std::int8_t>("int8", "int8_t", Needs{extended, &Capabilities::shader_int8});
  add.template operator()<std::uint8_t>("uint8", "uint8_t", Needs{extended, &Capabilities::shader_int8});
  add.template operator()<float>("float16", "float16_t", Needs{extended, &Capabilities::shader_float16});
}

}  // namespace

void add_subgroup_arithmetic_cases(Cases& cases) {
  for_each_type([&]<typename T>(const std::string& name, const std::string& type, std::vector<Capability> needs) {
    needs.insert(needs.begin(), {&Capabilities::subgroup_basic, &Capabilities::subgroup_arithmetic});
    Group{cases, "subgroups.arithmetic", std::move(needs)}.add(
        name, "reductions and scans combine the values of the subgroup's invocations",
        [type](Context& context) { check_arithmetic<T>(context, type); });
  });
  Group{cases, "subgroups.arithmetic", {&Capabilities::subgroup_basic, &Capabilities::subgroup_arithmetic}}.add(
      "vectors", "the components of a vector are combined each for itself", check_vectors);
  for_each_type([&]<typename T>(const std::string& name, const std::string& type, std::vector<Capability> needs) {
    if (sizeof(T) < 4 && name != "bool" && name != "int16") return;
    needs.insert(needs.begin(), {&Capabilities::subgroup_basic, &Capabilities::subgroup_clustered});
    Group{cases, "subgroups.clustered", std::move(needs)}.add(
        name, "reductions of clusters combine the values of the cluster's invocations",
        [type](Context& context) { check_clusters<T>(context, type); });
  });
}

}  // namespace tandem::conformance
