#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "tests/family/choices.hpp"
#include "tests/family/shader_tree.hpp"

namespace tandem::family {

/// What a generated shader may use beyond control flow, arithmetic and buffers.
struct Features {
  bool small_integers = true;  ///< of 8, 16 and 64 bits, in one of three shaders
  bool approximate = false;    ///< what Vulkan lets a device round as it likes: dot, normalize, inversesqrt, mix...
  bool barriers = false;       ///< shared memory, with barriers that the whole workgroup reaches
  bool subgroups = false;      ///< operations among four neighbours, which every subgroup of at least four agrees on
};

struct GeneratedShader {
  ShaderTree tree;
  std::uint32_t workgroup_size[3] = {1, 1, 1};
};

/// The words of the output buffer and the bytes of the item that belong to each invocation.
inline constexpr std::uint32_t own_words = 16;
inline constexpr std::uint32_t item_bytes = 192;
/// Words of the input buffers.
inline constexpr std::uint32_t input_words = 256;

/// A shader with bindings
///   0  readonly uints[input_words]     1  readonly floats[input_words], multiples of 1/64 below 1000
///   2  uints of every invocation       3  items of every invocation       4  a uniform buffer
/// and push constants. The same for the same seed and features. Every loop has a bound, every invocation writes only
/// its own words, no value is NaN, infinite or denormal, and no conversion overflows: all devices give the same bits.
GeneratedShader generate(std::uint32_t seed, const Features& features = {});

struct Variable {
  std::string name;
  Type type;
  bool is_writable = true;
};

struct Parameter {
  Type type;
  bool is_in = true;
  bool is_out = false;
};

struct Signature {
  std::string name;
  bool returns = true;
  Type result;
  std::vector<Parameter> parameters;
  bool has_out = false;
};

/// Makes one shader.
class Generator {
 public:
  Generator(std::uint32_t seed, const Features& features);
  GeneratedShader shader();

 private:
  /// Where a statement stands.
  struct Place {
    int depth = 0;  ///< of nesting
    int loops = 0;  ///< around it, in this function
    bool may_break = false;
    bool may_return = true;
  };

  // generator.cpp: the shader and its functions.
  std::string preamble();
  void choose_structs();
  FunctionTree function(int number);
  FunctionTree main_function();
  void declare_locals(std::vector<Statement>& body, int count);
  Type any_type();
  Type any_value_type();

  // statements.cpp
  std::vector<Statement> block(Place place, int count);
  Statement statement(const Place& place);
  Statement assignment();
  Statement call();
  Statement choice(Place place);
  Statement loop(Place place);
  Statement selection(Place place);
  Statement jump(const Place& place);
  Statement store();
  Statement hashed();
  Statement exchange();
  Statement result_of_function();
  Expression trip_count();

  // expressions.cpp
  Expression expression(const Type& type, int depth);
  Expression stored(const Type& type, int depth);
  Expression leaf(const Type& type);
  Expression literal(const Type& type);
  Expression read(const Type& type);
  Expression uniform(const Type& type);
  bool holds(const Type& whole, const Type& part) const;
  Expression descend(Expression from, const Type& to);
  Expression member(Expression from);
  Expression some_scalar(Expression from);
  Expression lvalue();
  Expression index(int length);
  Expression constructed(const Type& type, int depth);
  Expression called(const Signature& callee, int depth);

  // operations.cpp
  Expression boolean(const Type& type, int depth);
  Expression integer(const Type& type, int depth);
  Expression real(const Type& type, int depth);
  Expression matrix(const Type& type, int depth);
  Expression make(const Type& type, const std::string& text, const std::vector<Type>& parts, int depth);

  Choices choices_;
  Features features_;
  bool has_small_ = false;
  int uniform_percent_ = 0;  ///< of what is read
  std::uint32_t size_[3] = {1, 1, 1};
  std::vector<StructType> structs_;
  std::vector<Signature> functions_;
  std::vector<Variable> variables_;  ///< of the function that is generated
  const Signature* current_ = nullptr;
  std::set<std::pair<int, int>> fixed_matrices_;  ///< columns and rows of those that fix() is called with
  int budget_ = 0;                                ///< statements that the function may still have
  int names_ = 0;
  int calls_ = 0;  ///< in the function that is generated
};

}  // namespace tandem::family
