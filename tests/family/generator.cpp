#include "tests/family/generator.hpp"

#include <fmt/format.h>

namespace tandem::family {

Generator::Generator(std::uint32_t seed, const Features& features) : choices_(seed), features_(features) {}

Type Generator::any_value_type() {
  switch (choices_.below(has_small_ ? 12 : 10)) {
    case 0:
      return {Scalar::boolean};
    case 1:
      return {Scalar::boolean, choices_.between(2, 4)};
    case 2:
    case 3:
      return {Scalar::i32};
    case 4:
      return {Scalar::u32};
    case 5:
      return {choices_.of({Scalar::i32, Scalar::u32}), choices_.between(2, 4)};
    case 6:
    case 7:
      return {Scalar::f32};
    case 8:
      return {Scalar::f32, choices_.between(2, 4)};
    case 9:
      return {Scalar::f32, choices_.between(2, 4), choices_.between(2, 4)};
    case 10:
      return {choices_.of({Scalar::i64, Scalar::u64, Scalar::i16, Scalar::u16, Scalar::i8, Scalar::u8})};
    default:
      return {choices_.of({Scalar::i64, Scalar::i16, Scalar::u16, Scalar::u8}), choices_.between(2, 4)};
  }
}

Type Generator::any_type() {
  const int kind = choices_.below(10);
  if (kind == 0 && !structs_.empty()) {
    Type type;
    type.structure = choices_.below(static_cast<int>(structs_.size()));
    if (choices_.chance(30)) type.length = choices_.between(2, 3);
    return type;
  }
  Type type = any_value_type();
  if (kind <= 3) type.length = choices_.between(2, 5);
  return type;
}

void Generator::choose_structs() {
  const int count = choices_.below(3);
  for (int i = 0; i < count; ++i) {
    StructType type;
    const int members = choices_.between(2, 4);
    for (int k = 0; k < members; ++k) type.members.push_back(any_type());
    structs_.push_back(std::move(type));
  }
}

std::string Generator::preamble() {
  std::string text = "#version 460\n#extension GL_EXT_scalar_block_layout : require\n";
  if (has_small_) text += "#extension GL_EXT_shader_explicit_arithmetic_types : require\n";
  if (features_.subgroups)
    text +=
        "#extension GL_KHR_shader_subgroup_basic : require\n#extension GL_KHR_shader_subgroup_quad : require\n"
        "#extension GL_KHR_shader_subgroup_shuffle : require\n#extension GL_KHR_shader_subgroup_clustered : require\n";
  text += fmt::format("layout(local_size_x = {}, local_size_y = {}, local_size_z = {}) in;\n", size_[0], size_[1],
                      size_[2]);
  text += fmt::format(R"(layout(std430, binding = 0) readonly buffer Words {{ uint words[{0}]; }};
layout(std430, binding = 1) readonly buffer Reals {{ float reals[{0}]; }};
layout(std430, binding = 2) buffer Own {{ uint own[]; }};
struct Item {{ vec3 p; int i; mat3 m; float a[5]; uint b[4]; ivec2 q; {1} s; }};
layout(scalar, binding = 3) buffer Items {{ Item items[]; }};
layout(binding = 4) uniform Uniforms {{ uvec4 u[4]; vec4 f[4]; mat4 m; ivec2 i; uint n; }} uni;
layout(push_constant) uniform Constants {{ uint n; int i; float f; uint m; vec4 v; }} pc;
)",
                      input_words, has_small_ ? "u16vec4" : "uvec2");
  if (features_.barriers) text += fmt::format("shared uint exchanged[{}];\n", size_[0] * size_[1] * size_[2]);
  for (std::size_t i = 0; i < structs_.size(); ++i) {
    text += fmt::format("struct S{} {{ ", i);
    for (std::size_t k = 0; k < structs_[i].members.size(); ++k)
      text += declaration(structs_[i].members[k], fmt::format("m{}", k)) + "; ";
    text += "};\n";
  }
  text += fmt::format(R"(uint id = 0u;
uint h = 17u;
float fix(float x) {{ float y = floor(clamp(x, -1000.0, 1000.0) * 64.0) * 0.015625; return y == 0.0 ? 0.0 : y; }}
vec2 fix(vec2 x) {{ return vec2(fix(x.x), fix(x.y)); }}
vec3 fix(vec3 x) {{ return vec3(fix(x.x), fix(x.y), fix(x.z)); }}
vec4 fix(vec4 x) {{ return vec4(fix(x.xy), fix(x.zw)); }}
)");
  for (const auto& [columns, rows] : fixed_matrices_) {
    const std::string name = name_of(Type{Scalar::f32, rows, columns});
    text += fmt::format("{0} fix({0} x) {{ return {0}(fix(x[0]), fix(x[1])", name);
    for (int i = 2; i < columns; ++i) text += fmt::format(", fix(x[{}])", i);
    text += "); }\n";
  }
  return text;
}

void Generator::declare_locals(std::vector<Statement>& body, int count) {
  for (int i = 0; i < count; ++i) {
    Variable variable{fmt::format("v{}", names_++), any_type()};
    const std::string precise = is_float(variable.type) ? "precise " : "";
    body.push_back({precise + declaration(variable.type, variable.name) + " = $0;", {stored(variable.type, 1)}});
    variables_.push_back(std::move(variable));
  }
}

FunctionTree Generator::function(int number) {
  Signature signature;
  signature.name = fmt::format("f{}", number);
  signature.returns = choices_.chance(80);
  signature.result = any_type();
  variables_.clear();
  calls_ = 0;
  std::string parameters;
  std::vector<Statement> body;
  const int count = choices_.below(4);
  for (int i = 0; i < count; ++i) {
    Parameter parameter{any_type()};
    const int kind = choices_.below(4);
    parameter.is_in = kind != 2;
    parameter.is_out = kind >= 2;
    signature.has_out |= parameter.is_out;
    const std::string name = fmt::format("p{}", i);
    parameters += (i == 0 ? "" : ", ") +
                  std::string(!parameter.is_out ? ""
                              : parameter.is_in ? "inout "
                                                : "out ") +
                  declaration(parameter.type, name);
    if (!parameter.is_in) body.push_back({name + " = $0;", {stored(parameter.type, 1)}});
    variables_.push_back({name, parameter.type});
    signature.parameters.push_back(parameter);
  }
  current_ = &signature;
  declare_locals(body, choices_.between(1, 3));
  budget_ = choices_.between(4, 12);
  for (Statement& each : block({.depth = 0}, choices_.between(2, 5))) body.push_back(std::move(each));
  if (signature.returns) body.push_back(result_of_function());
  current_ = nullptr;
  const std::string head =
      fmt::format("{} {}({})", signature.returns ? name_of(signature.result) : "void", signature.name, parameters);
  functions_.push_back(std::move(signature));
  return {head, std::move(body)};
}

FunctionTree Generator::main_function() {
  variables_.clear();
  calls_ = 0;
  std::vector<Statement> body;
  body.push_back(
      {"id = ((gl_WorkGroupID.z * gl_NumWorkGroups.y + gl_WorkGroupID.y) * gl_NumWorkGroups.x + gl_WorkGroupID.x) * "
       "gl_WorkGroupSize.x * gl_WorkGroupSize.y * gl_WorkGroupSize.z + gl_LocalInvocationIndex;"});
  declare_locals(body, choices_.between(3, 7));
  budget_ = choices_.between(10, 35);
  const bool exchanges = features_.barriers || features_.subgroups;
  const int rounds = exchanges ? 3 : 1;
  for (int i = 0; i < rounds; ++i) {
    for (Statement& each : block({.depth = 0, .may_return = !exchanges}, choices_.between(3, 8)))
      body.push_back(std::move(each));
    if (exchanges) body.push_back(exchange());
  }
  for (const Variable& variable : variables_) {
    Expression scalar = some_scalar({variable.type, variable.name});
    const char* text =
        scalar.type.scalar == Scalar::f32 ? "h = h * 33u + floatBitsToUint($0);" : "h = h * 33u + uint($0);";
    body.push_back({text, {std::move(scalar)}});
  }
  body.push_back({fmt::format("own[id * {0}u] += h;", own_words)});
  return {"void main()", std::move(body)};
}

GeneratedShader Generator::shader() {
  has_small_ = features_.small_integers && choices_.chance(33);
  uniform_percent_ = choices_.of({0, 50, 85, 97});
  struct Size {
    std::uint32_t sides[3];
  };
  constexpr Size sizes[] = {{{16, 1, 1}}, {{8, 4, 1}}, {{4, 2, 2}}, {{5, 3, 1}},
                            {{64, 1, 1}}, {{1, 1, 1}}, {{21, 1, 1}}};
  const Size size = sizes[features_.subgroups ? 4 * choices_.below(2) : choices_.below(7)];
  for (int i = 0; i < 3; ++i) size_[i] = size.sides[i];
  choose_structs();
  ShaderTree tree;
  tree.structs = structs_;
  const int functions = choices_.below(4);
  for (int i = 0; i < functions; ++i) tree.functions.push_back(function(i));
  tree.functions.push_back(main_function());
  tree.preamble = preamble();
  return {std::move(tree), {size_[0], size_[1], size_[2]}};
}

GeneratedShader generate(std::uint32_t seed, const Features& features) { return Generator(seed, features).shader(); }

}  // namespace tandem::family
