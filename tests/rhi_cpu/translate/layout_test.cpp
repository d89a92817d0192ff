// Loads and stores honour every layout. The expected offsets come from the rules of the OpenGL 4.6 core specification,
// section 7.6.2.2 (std140, std430), and of GL_EXT_scalar_block_layout, not from SPIR-V decorations.

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include <doctest/doctest.h>
#include <fmt/format.h>

#include "tests/rhi_cpu/translate/kernel_harness.hpp"

namespace {

using tandem::test::Kernel;
using tandem::test::resource;

enum class Layout { std140, std430, scalar };

/// A GLSL type of floats: a vector or scalar (columns 1), a matrix, a struct of members, or an array of one of them.
struct Type {
  std::uint32_t rows = 1;
  std::uint32_t columns = 1;
  bool row_major = false;
  std::uint32_t array_length = 0;  ///< 0: no array
  std::vector<Type> members;       ///< of a struct
};

Type vector(std::uint32_t rows) { return {.rows = rows, .members = {}}; }
Type matrix(std::uint32_t columns, std::uint32_t rows, bool row_major = false) {
  return {.rows = rows, .columns = columns, .row_major = row_major, .members = {}};
}
Type structure(std::vector<Type> members) { return {.members = std::move(members)}; }
Type array(Type element, std::uint32_t length) {
  element.array_length = length;
  return element;
}

std::uint32_t round_up(std::uint32_t x, std::uint32_t to) { return (x + to - 1) / to * to; }

std::uint32_t vector_alignment(std::uint32_t rows, Layout layout) {
  return layout == Layout::scalar || rows == 1 ? 4 : rows == 2 ? 8 : 16;
}

/// Distance of the columns (row-major: rows) of a matrix.
std::uint32_t matrix_stride(const Type& type, Layout layout) {
  const std::uint32_t length = type.row_major ? type.columns : type.rows;
  if (layout == Layout::scalar) return 4 * length;
  return layout == Layout::std140 ? 16 : vector_alignment(length, layout);
}

struct Extent {
  std::uint32_t size;
  std::uint32_t alignment;
};

Extent extent(const Type& type, Layout layout) {
  if (type.array_length != 0) {
    Type element = type;
    element.array_length = 0;
    Extent each = extent(element, layout);
    if (layout == Layout::std140) each.alignment = round_up(each.alignment, 16);
    return {round_up(each.size, each.alignment) * type.array_length, each.alignment};
  }
  if (!type.members.empty()) {
    Extent whole = {0, layout == Layout::std140 ? 16u : 4u};
    for (const Type& member : type.members) {
      const Extent each = extent(member, layout);
      whole.size = round_up(whole.size, each.alignment) + each.size;
      whole.alignment = std::max(whole.alignment, each.alignment);
    }
    // Scalar layout does not pad a struct's end either way that matters here: all components are floats.
    return {layout == Layout::scalar ? whole.size : round_up(whole.size, whole.alignment), whole.alignment};
  }
  if (type.columns > 1) {
    const std::uint32_t stride = matrix_stride(type, layout);
    const std::uint32_t count = type.row_major ? type.rows : type.columns;
    return {stride * count, layout == Layout::scalar ? 4 : stride};
  }
  return {4 * type.rows, vector_alignment(type.rows, layout)};
}

/// A component: how GLSL names it and where it lies.
struct Component {
  std::string expression;
  std::uint32_t offset;
};

void append_components(const Type& type, Layout layout, const std::string& name, std::uint32_t offset, bool dynamic,
                       std::vector<Component>& components) {
  const auto index = [&](std::uint32_t i) {
    return dynamic ? fmt::format("{}[{} + zero]", name, i) : fmt::format("{}[{}]", name, i);
  };
  if (type.array_length != 0) {
    Type element = type;
    element.array_length = 0;
    const std::uint32_t stride = extent(type, layout).size / type.array_length;
    for (std::uint32_t i = 0; i < type.array_length; ++i)
      append_components(element, layout, index(i), offset + i * stride, dynamic, components);
  } else if (!type.members.empty()) {
    std::uint32_t end = offset;
    for (std::uint32_t i = 0; i < type.members.size(); ++i) {
      const Extent each = extent(type.members[i], layout);
      const std::uint32_t begin = offset + round_up(end - offset, each.alignment);
      append_components(type.members[i], layout, fmt::format("{}.m{}", name, i), begin, dynamic, components);
      end = begin + each.size;
    }
  } else if (type.columns > 1) {
    const std::uint32_t stride = matrix_stride(type, layout);
    for (std::uint32_t c = 0; c < type.columns; ++c)
      for (std::uint32_t r = 0; r < type.rows; ++r)
        components.push_back(
            {fmt::format("{}[{}]", index(c), dynamic ? fmt::format("{} + zero", r) : fmt::to_string(r)),
             offset + (type.row_major ? r * stride + c * 4 : c * stride + r * 4)});
  } else if (type.rows == 1) {
    components.push_back({name, offset});
  } else {
    for (std::uint32_t r = 0; r < type.rows; ++r) components.push_back({index(r), offset + r * 4});
  }
}

/// GLSL declarations of the structs inside `type`, innermost first, and of its members.
std::string declare(const Type& type, const std::string& name, const std::string& prefix, std::string& structs) {
  std::string base;
  if (!type.members.empty()) {
    std::string members;
    for (std::size_t i = 0; i < type.members.size(); ++i)
      members += declare(type.members[i], fmt::format("m{}", i), fmt::format("{}_{}", prefix, i), structs);
    structs += fmt::format("struct {} {{ {}}};\n", prefix, members);
    base = prefix;
  } else if (type.columns > 1) {
    base = fmt::format("{}mat{}x{}", type.row_major ? "layout(row_major) " : "", type.columns, type.rows);
  } else {
    base = type.rows == 1 ? "float" : fmt::format("vec{}", type.rows);
  }
  return fmt::format("{} {}{}; ", base, name, type.array_length ? fmt::format("[{}]", type.array_length) : "");
}

const char* name_of(Layout layout) {
  return layout == Layout::std140 ? "std140" : layout == Layout::std430 ? "std430" : "scalar";
}

/// The members of the block under test: every shape whose layout differs between the rules.
Type block_type() {
  const Type inner = structure({vector(3), matrix(2, 2), array(vector(1), 2)});
  return structure({vector(1),
                    vector(3),
                    matrix(3, 3),
                    vector(1),
                    matrix(4, 3),
                    matrix(4, 3, true),
                    vector(2),
                    matrix(3, 3, true),
                    array(vector(3), 3),
                    array(vector(1), 3),
                    vector(1),
                    inner,
                    array(inner, 2),
                    array(matrix(2, 2), 2),
                    array(matrix(3, 2, true), 2),
                    array(matrix(2, 3), 2),
                    vector(4),
                    matrix(2, 4, true),
                    array(vector(2), 3),
                    vector(1)});
}

struct Block {
  std::string structs;
  std::string members;
  std::vector<Component> components;
  std::uint32_t size = 0;
};

Block block(Layout layout, const std::string& instance, bool dynamic) {
  const Type type = block_type();
  Block result;
  for (std::size_t i = 0; i < type.members.size(); ++i)
    result.members += declare(type.members[i], fmt::format("m{}", i), fmt::format("S{}", i), result.structs);
  append_components(type, layout, instance, 0, dynamic, result.components);
  result.size = extent(type, layout).size;
  return result;
}

const char* header(bool dynamic) {
  return dynamic ? "#extension GL_EXT_scalar_block_layout : require\nlayout(local_size_x = 1) in;\n"
                   "layout(push_constant) uniform Push { int zero; };\n"
                 : "#extension GL_EXT_scalar_block_layout : require\nlayout(local_size_x = 1) in;\n";
}

const std::int32_t zero = 0;

TEST_CASE("every component of a block is read where its layout puts it") {
  for (const Layout layout : {Layout::std140, Layout::std430, Layout::scalar}) {
    for (const bool uniform : {false, true}) {
      if (uniform && layout == Layout::std430) continue;  // GLSL has no std430 uniform blocks
      for (const bool dynamic : {false, true}) {
        const Block source = block(layout, "source", dynamic);
        std::string glsl = header(dynamic) + source.structs;
        glsl += fmt::format("layout({}, binding = 0) {} Source {{ {}}} source;\n", name_of(layout),
                            uniform ? "uniform" : "readonly buffer", source.members);
        glsl += "layout(std430, binding = 1) buffer Result { float result[]; };\nvoid main() {\n";
        std::vector<float> memory(source.size / 4 + 4, -1.0f), expected;
        for (std::size_t i = 0; i < source.components.size(); ++i) {
          glsl += fmt::format("  result[{}] = {};\n", i, source.components[i].expression);
          memory[source.components[i].offset / 4] = static_cast<float>(i + 1);
          expected.push_back(static_cast<float>(i + 1));
        }
        CAPTURE(name_of(layout));
        CAPTURE(uniform);
        CAPTURE(dynamic);
        std::vector<float> result(expected.size());
        Kernel(glsl + "}\n").run({resource(memory), resource(result)}, {1}, std::as_bytes(std::span(&zero, 1)));
        CHECK(result == expected);
      }
    }
  }
}

TEST_CASE("members stored whole or by component reach where their layout puts them, and nothing else") {
  for (const Layout layout : {Layout::std140, Layout::std430, Layout::scalar}) {
    for (const bool by_component : {false, true}) {
      // From another layout, so that a copy of bytes would be wrong.
      const Layout other = layout == Layout::scalar ? Layout::std140 : Layout::scalar;
      const Block source = block(other, "source", by_component);
      const Block target = block(layout, "target", by_component);
      std::string glsl = header(by_component) + source.structs;
      glsl += fmt::format("layout({}, binding = 0) readonly buffer Source {{ {}}} source;\n", name_of(other),
                          source.members);
      glsl += fmt::format("layout({}, binding = 1) buffer Target {{ {}}} target;\nvoid main() {{\n", name_of(layout),
                          target.members);
      const std::size_t members = block_type().members.size();
      if (by_component)
        for (std::size_t i = 0; i < source.components.size(); ++i)
          glsl += fmt::format("  {} = {};\n", target.components[i].expression, source.components[i].expression);
      else
        for (std::size_t i = 0; i < members; ++i) glsl += fmt::format("  target.m{0} = source.m{0};\n", i);
      std::vector<float> from(source.size / 4 + 4, -1.0f), to(target.size / 4 + 4, -1.0f), expected = to;
      for (std::size_t i = 0; i < source.components.size(); ++i) {
        from[source.components[i].offset / 4] = static_cast<float>(i + 1);
        expected[target.components[i].offset / 4] = static_cast<float>(i + 1);
      }
      CAPTURE(name_of(layout));
      CAPTURE(by_component);
      Kernel(glsl + "}\n").run({resource(from), resource(to)}, {1}, std::as_bytes(std::span(&zero, 1)));
      CHECK(to == expected);
    }
  }
}

}  // namespace
