#include <bit>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <type_traits>
#include <vector>

#include "conformance/kit/cases.hpp"
#include "conformance/kit/check.hpp"
#include "conformance/kit/shader_run.hpp"
#include "rhi/precision.hpp"
#include "rhi/transfer.hpp"

/// arithmetic.*: integers of every width exactly, floats within the precision of the Vulkan specification.
namespace tandem::conformance {
namespace {

using Capabilities = rhi::Capabilities;
using rhi::FloatOperation;

constexpr int integer_operations = 12;

/// integer_operations results of each pair, in T. Divisors are never zero, nor -1 below the least number.
const std::string integer_shader = R"(
#extension GL_EXT_shader_explicit_arithmetic_types : require
#extension GL_EXT_shader_16bit_storage : require
#extension GL_EXT_shader_8bit_storage : require
layout(local_size_x = 1) in;
layout(binding = 0, std430) buffer Answers { WORD answers[]; };
layout(binding = 1, std430) readonly buffer Pairs { TYPE pairs[]; };
void main() {
  uint i = gl_WorkGroupID.x;
  TYPE a = pairs[2 * i], b = pairs[2 * i + 1];
  TYPE shift = TYPE(uint(b) & 7u);
  TYPE results[12] = TYPE[](a + b, a - b, a * b, a / b, a & b, a | b, a ^ b, ~a, a << shift, a >> shift, min(a, b), max(a, b));
  for (int k = 0; k < 12; ++k) answers[12 * i + k] = WORD(results[k]);
}
)";

template <typename T>
std::vector<T> integer_results(T a, T b) {
  using Wide = std::conditional_t<std::is_signed_v<T>, std::int64_t, std::uint64_t>;
  const auto wrapped = [](std::uint64_t value) { return static_cast<T>(value); };
  const auto x = static_cast<std::uint64_t>(static_cast<Wide>(a)), y = static_cast<std::uint64_t>(static_cast<Wide>(b));
  const unsigned shift = static_cast<unsigned>(y & 7);
  return {wrapped(x + y),      wrapped(x - y),
          wrapped(x * y),      static_cast<T>(static_cast<Wide>(a) / static_cast<Wide>(b)),
          wrapped(x & y),      wrapped(x | y),
          wrapped(x ^ y),      wrapped(~x),
          wrapped(x << shift), static_cast<T>(static_cast<Wide>(a) >> shift),
          std::min(a, b),      std::max(a, b)};
}

template <typename T>
void check_integers(Context& context, const std::string& type) {
  using Word = std::conditional_t<sizeof(T) == 8, std::uint64_t, std::uint32_t>;
  rhi::Device& device = context.device();
  constexpr T least = std::numeric_limits<T>::min(), most = std::numeric_limits<T>::max();
  const std::vector<T> pairs = {least, most,        most,  most, T(100), T(7),  T(least + 1), T(3),
                                T(5),  T(most - 2), T(-3), T(2), T(77),  T(-5), T(0),         T(1)};
  const std::string glsl = with(with(integer_shader, "TYPE", type), "WORD", sizeof(T) == 8 ? "uint64_t" : "uint");
  const auto count = static_cast<std::uint32_t>(pairs.size() / 2);
  ShaderRun run = {.label = "arithmetic of " + type, .glsl = glsl, .workgroup_count = {count, 1, 1}};
  run.entries = {
      {.binding = 1,
       .resource = rhi::BufferRange{rhi::create_filled(device, pairs, rhi::BufferUsage::storage, "pairs of " + type)}}};
  const Words words = answers(context, run, std::size_t{count} * integer_operations * (sizeof(Word) / 4));
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::vector<T> expected = integer_results(pairs[2 * i], pairs[2 * i + 1]);
    for (std::size_t k = 0; k < integer_operations; ++k) {
      Word seen = 0;
      std::memcpy(&seen, words.data() + (i * integer_operations + k) * (sizeof(Word) / 4), sizeof(Word));
      check_equal(fmt::format("operation {} of {} and {} as {}", k, std::int64_t(pairs[2 * i]),
                              std::int64_t(pairs[2 * i + 1]), type),
                  static_cast<T>(seen), expected[k]);
    }
  }
}

void add_integer_cases(Cases& cases) {
  const std::string behaviour = "integer arithmetic is exact and wraps";
  const auto group = [&](std::vector<Capability> needs) {
    return Group{cases, "arithmetic.integers", std::move(needs)};
  };
  const Group of_32 = group({}), of_8 = group({&Capabilities::shader_int8}),
              of_16 = group({&Capabilities::shader_int16}), of_64 = group({&Capabilities::shader_int64});
  of_8.add("int8", behaviour, [](Context& context) { check_integers<std::int8_t>(context, "int8_t"); });
  of_8.add("uint8", behaviour, [](Context& context) { check_integers<std::uint8_t>(context, "uint8_t"); });
  of_16.add("int16", behaviour, [](Context& context) { check_integers<std::int16_t>(context, "int16_t"); });
  of_16.add("uint16", behaviour, [](Context& context) { check_integers<std::uint16_t>(context, "uint16_t"); });
  of_32.add("int32", behaviour, [](Context& context) { check_integers<std::int32_t>(context, "int"); });
  of_32.add("uint32", behaviour, [](Context& context) { check_integers<std::uint32_t>(context, "uint"); });
  of_64.add("int64", behaviour, [](Context& context) { check_integers<std::int64_t>(context, "int64_t"); });
  of_64.add("uint64", behaviour, [](Context& context) { check_integers<std::uint64_t>(context, "uint64_t"); });
}

struct FloatRow {
  FloatOperation operation;
  const char* expression;  ///< of x and y
  std::function<double(double, double)> exact;
};

const std::vector<FloatRow>& float_rows() {
  static const std::vector<FloatRow> rows = {
      {FloatOperation::add, "x + y", [](double x, double y) { return x + y; }},
      {FloatOperation::subtract, "x - y", [](double x, double y) { return x - y; }},
      {FloatOperation::multiply, "x * y", [](double x, double y) { return x * y; }},
      {FloatOperation::divide, "x / y", [](double x, double y) { return x / y; }},
      {FloatOperation::sqrt, "sqrt(x)", [](double x, double) { return std::sqrt(x); }},
      {FloatOperation::inverse_sqrt, "inversesqrt(x)", [](double x, double) { return 1 / std::sqrt(x); }},
      {FloatOperation::exp, "exp(x)", [](double x, double) { return std::exp(x); }},
      {FloatOperation::exp2, "exp2(x)", [](double x, double) { return std::exp2(x); }},
      {FloatOperation::log, "log(x)", [](double x, double) { return std::log(x); }},
      {FloatOperation::log2, "log2(x)", [](double x, double) { return std::log2(x); }},
      {FloatOperation::pow, "pow(x, y)", [](double x, double y) { return std::pow(x, y); }},
      {FloatOperation::sin, "sin(x)", [](double x, double) { return std::sin(x); }},
      {FloatOperation::cos, "cos(x)", [](double x, double) { return std::cos(x); }},
      {FloatOperation::tan, "tan(x)", [](double x, double) { return std::tan(x); }},
      {FloatOperation::asin, "asin(min(x, TYPE(1)))", [](double x, double) { return std::asin(std::min(x, 1.0)); }},
      {FloatOperation::acos, "acos(min(x, TYPE(1)))", [](double x, double) { return std::acos(std::min(x, 1.0)); }},
      {FloatOperation::atan, "atan(x)", [](double x, double) { return std::atan(x); }},
      {FloatOperation::atan2, "atan(x, y)", [](double x, double y) { return std::atan2(x, y); }}};
  return rows;
}

/// Pairs that 16 bits hold exactly, with x > 0.
const std::vector<std::array<double, 2>> float_pairs = {{0.25, 3}, {1, 0.5}, {1.5, -2},      {3, 0.75}, {0.0625, 1.25},
                                                        {2.5, 2},  {7, 1.5}, {0.875, -0.25}, {5.5, 3},  {0.5, 0.5}};

void check_floats(Context& context, int bits) {
  rhi::Device& device = context.device();
  const std::string type = bits == 16 ? "float16_t" : "float";
  const std::vector<FloatRow>& rows = float_rows();
  std::string glsl = R"(
#extension GL_EXT_shader_explicit_arithmetic_types : require
layout(local_size_x = 1) in;
layout(binding = 0, std430) buffer Answers { float answers[]; };
layout(binding = 1, std430) readonly buffer Pairs { vec2 pairs[]; };
void main() {
  uint i = gl_WorkGroupID.x, at = i * )" +
                     std::to_string(rows.size()) + R"(;
  TYPE x = TYPE(pairs[i].x), y = TYPE(pairs[i].y);
)";
  for (std::size_t k = 0; k < rows.size(); ++k)
    glsl += fmt::format("  answers[at + {}] = float({});\n", k, rows[k].expression);
  glsl += "}\n";
  glsl = with(glsl, "TYPE", type);
  std::vector<float> pairs;
  for (const auto& [x, y] : float_pairs) pairs.insert(pairs.end(), {static_cast<float>(x), static_cast<float>(y)});
  const auto count = static_cast<std::uint32_t>(float_pairs.size());
  ShaderRun run = {.label = "arithmetic of " + type, .glsl = glsl, .workgroup_count = {count, 1, 1}};
  run.entries = {{.binding = 1,
                  .resource = rhi::BufferRange{rhi::create_filled(device, pairs, rhi::BufferUsage::storage, "pairs")}}};
  const std::vector<float> seen = floats_of(answers(context, run, count * rows.size()));
  for (std::uint32_t i = 0; i < count; ++i)
    for (std::size_t k = 0; k < rows.size(); ++k) {
      const auto [x, y] = float_pairs[i];
      const double exact = rows[k].exact(x, y);
      const double error = std::abs(seen[i * rows.size() + k] - exact);
      const double allowed = rhi::allowed_error(rows[k].operation, bits, x, y, exact);
      check(error <= allowed,
            fmt::format("{} of {} and {} in {} bits is {:.9g}, expected {:.9g} within {:.3g}",
                        rhi::name_of(rows[k].operation), x, y, bits, seen[i * rows.size() + k], exact, allowed));
    }
}

}  // namespace

void add_arithmetic_cases(Cases& cases) {
  add_integer_cases(cases);
  const std::string behaviour = "every operation is within the precision of the Vulkan specification";
  Group{cases, "arithmetic.floats", {}}.add("float32", behaviour, [](Context& context) { check_floats(context, 32); });
  Group{cases, "arithmetic.floats", {&Capabilities::shader_float16}}.add(
      "float16", behaviour, [](Context& context) { check_floats(context, 16); });
}

}  // namespace tandem::conformance
