#include "tests/family/shader_tree.hpp"

#include <array>
#include <cctype>

#include <fmt/format.h>

namespace tandem::family {
namespace {

constexpr std::array scalar_names = {"bool",     "int",     "uint",     "float",  "int64_t",
                                     "uint64_t", "int16_t", "uint16_t", "int8_t", "uint8_t"};
constexpr std::array vector_names = {"bvec",   "ivec",   "uvec",   "vec",   "i64vec",
                                     "u64vec", "i16vec", "u16vec", "i8vec", "u8vec"};

using Fill = std::function<void(char mark, std::size_t number)>;

/// The text with what stands behind its marks, which `fill` appends.
void print_filled(const std::string& text, std::string& result, const Fill& fill) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool is_mark = (text[i] == '$' || text[i] == '@') && i + 1 < text.size() &&
                         std::isdigit(static_cast<unsigned char>(text[i + 1])) != 0;
    if (!is_mark) {
      result += text[i];
      continue;
    }
    const char mark = text[i];
    std::size_t number = 0;
    while (i + 1 < text.size() && std::isdigit(static_cast<unsigned char>(text[i + 1])) != 0)
      number = number * 10 + static_cast<std::size_t>(text[++i] - '0');
    fill(mark, number);
  }
}

void print(const Expression& expression, std::string& result) {
  print_filled(expression.text, result, [&](char, std::size_t number) { print(expression.parts.at(number), result); });
}

void print(const std::vector<Statement>& list, int depth, std::string& result) {
  const std::string indent(static_cast<std::size_t>(depth) * 2, ' ');
  for (const Statement& statement : list) {
    result += indent;
    print_filled(statement.text, result, [&](char mark, std::size_t number) {
      if (mark == '$') return print(statement.expressions.at(number), result);
      result += "{\n";
      print(statement.blocks.at(number), depth + 1, result);
      result += indent + "}";
    });
    result += "\n";
  }
}

void visit_lists(std::vector<Statement>& list, const std::function<void(std::vector<Statement>&)>& visit) {
  visit(list);
  for (Statement& statement : list)
    for (auto& block : statement.blocks) visit_lists(block, visit);
}

void visit_expression(Expression& expression, const std::function<void(Expression&)>& visit) {
  visit(expression);
  for (Expression& part : expression.parts) visit_expression(part, visit);
}

}  // namespace

bool is_integer(Scalar scalar) { return scalar != Scalar::boolean && scalar != Scalar::f32; }

bool is_float(const Type& type) { return type.scalar == Scalar::f32 && type.structure < 0 && !type.is_array(); }

std::string name_of(const Type& type) {
  if (type.is_array()) return fmt::format("{}[{}]", name_of(type.element()), type.length);
  if (type.structure >= 0) return fmt::format("S{}", type.structure);
  if (type.columns > 1)
    return type.columns == type.rows ? fmt::format("mat{}", type.rows)
                                     : fmt::format("mat{}x{}", type.columns, type.rows);
  const auto scalar = static_cast<std::size_t>(type.scalar);
  return type.rows > 1 ? fmt::format("{}{}", vector_names.at(scalar), type.rows) : scalar_names.at(scalar);
}

std::string declaration(const Type& type, const std::string& name) {
  if (type.is_array()) return fmt::format("{} {}[{}]", name_of(type.element()), name, type.length);
  return name_of(type) + " " + name;
}

std::string printed(const Expression& expression) {
  std::string result;
  print(expression, result);
  return result;
}

std::string printed(const ShaderTree& shader) {
  std::string result = shader.preamble;
  for (const FunctionTree& function : shader.functions) {
    result += function.head + " {\n";
    print(function.body, 1, result);
    result += "}\n";
  }
  return result;
}

void for_each_list(ShaderTree& shader, const std::function<void(std::vector<Statement>&)>& visit) {
  for (FunctionTree& function : shader.functions) visit_lists(function.body, visit);
}

void for_each_expression(ShaderTree& shader, const std::function<void(Expression&)>& visit) {
  for_each_list(shader, [&](std::vector<Statement>& list) {
    for (Statement& statement : list)
      for (Expression& expression : statement.expressions) visit_expression(expression, visit);
  });
}

std::size_t statement_count(const ShaderTree& shader) {
  ShaderTree copy = shader;
  std::size_t count = 0;
  for_each_list(copy, [&](std::vector<Statement>& list) { count += list.size(); });
  return count;
}

}  // namespace tandem::family
