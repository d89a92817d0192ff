#pragma once

#include <functional>
#include <string>
#include <vector>

/// A GLSL compute shader as a tree that can be cut down piece by piece and printed again.
namespace tandem::family {

enum class Scalar { boolean, i32, u32, f32, i64, u64, i16, u16, i8, u8 };

/// A GLSL type: a scalar, a vector, a matrix, a struct of the shader, or an array of one of these.
struct Type {
  Scalar scalar = Scalar::i32;
  int rows = 1;        ///< components of a vector or of a column
  int columns = 1;     ///< of a matrix, else 1
  int length = 0;      ///< of an array, else 0
  int structure = -1;  ///< index into ShaderTree::structs, else -1

  bool operator==(const Type&) const = default;
  bool is_array() const { return length != 0; }
  bool is_struct() const { return structure >= 0 && !is_array(); }
  bool is_matrix() const { return columns > 1 && !is_array(); }
  bool is_vector() const { return rows > 1 && columns == 1 && structure < 0 && !is_array(); }
  bool is_scalar() const { return rows == 1 && columns == 1 && structure < 0 && !is_array(); }
  /// Of an array.
  Type element() const {
    Type type = *this;
    type.length = 0;
    return type;
  }
  /// Of a vector or a matrix.
  Type component() const {
    Type type = *this;
    (columns > 1 ? type.columns : type.rows) = 1;
    return type;
  }
};

bool is_integer(Scalar scalar);
/// Whether a type is a float or made of floats; structs and arrays are none.
bool is_float(const Type& type);
/// "int", "vec3", "mat2x3", "S0"; of an array that of its elements with "[4]".
std::string name_of(const Type& type);
/// A declaration without its end: "vec3 p[4]".
std::string declaration(const Type& type, const std::string& name);

/// GLSL in which $0, $1... stand for the parts.
struct Expression {
  Type type;
  std::string text;
  std::vector<Expression> parts = {};
};

/// GLSL in which $0, $1... stand for the expressions and @0, @1... for blocks of statements.
struct Statement {
  std::string text;
  std::vector<Expression> expressions = {};
  std::vector<std::vector<Statement>> blocks = {};
};

struct FunctionTree {
  std::string head;  ///< "float f0(int a, inout vec3 b)"
  std::vector<Statement> body;
};

struct StructType {
  std::vector<Type> members;  ///< m0, m1...
};

struct ShaderTree {
  std::string preamble;                 ///< everything in front of the functions
  std::vector<StructType> structs;      ///< the preamble has them
  std::vector<FunctionTree> functions;  ///< callees before callers, main last
};

std::string printed(const Expression& expression);
std::string printed(const ShaderTree& shader);

/// Calls `visit` with every list of statements, outer ones first.
void for_each_list(ShaderTree& shader, const std::function<void(std::vector<Statement>&)>& visit);
/// Calls `visit` with every expression, the whole before its parts.
void for_each_expression(ShaderTree& shader, const std::function<void(Expression&)>& visit);
std::size_t statement_count(const ShaderTree& shader);

}  // namespace tandem::family
