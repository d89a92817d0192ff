#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

#include <spirv_cross/spirv_glsl.hpp>

#include "rhi/shader_reflection.hpp"

namespace tandem::cpu {

/// Prints one shader as C++.
///
/// SPIRV-Cross parses the module, names things, turns the control flow graph into structured statements and hoists
/// temporaries; this class prints every declaration, instruction and constant itself. Nothing is forwarded: each result
/// is a temporary, so that no load moves across a store, and the C++ compiler puts it into a register.
///
/// Values have value types (GLM vectors and matrices, Array, plain structs). Buffers are bytes: a
/// pointer into one, or a buffer reference, is an address expression, and the Offset, ArrayStride, MatrixStride and
/// RowMajor decorations on the way to it go into the text of the load or store. Functions and Private variables are
/// members of a struct Invocation that lives on the stack for one invocation.
class Printer : public spirv_cross::CompilerGLSL {
 public:
  /// @param spirv a module from prepare()
  /// @param reflection of the same words
  Printer(const std::vector<std::uint32_t>& spirv, const std::string& label, const rhi::ShaderReflection& reflection,
          const std::string& entry_symbol);

  /// The translation unit. Throws rhi::Error(unsupported), or what SPIRV-Cross throws.
  std::string compile() override;

 protected:
  void emit_function_prototype(spirv_cross::SPIRFunction& function, const spirv_cross::Bitset& return_flags) override;
  void emit_entry_point_declarations() override {}
  void emit_block_hints(const spirv_cross::SPIRBlock&) override {}
  void emit_instruction(const spirv_cross::Instruction& instruction) override;
  std::string variable_decl(const spirv_cross::SPIRType& type, const std::string& name, std::uint32_t id) override;
  std::string variable_decl(const spirv_cross::SPIRVariable& variable) override;
  std::string builtin_to_glsl(spv::BuiltIn builtin, spv::StorageClass storage) override;

 private:
  using Type = spirv_cross::SPIRType;
  using BaseType = spirv_cross::SPIRType::BaseType;
  using Operands = const std::uint32_t*;

  /// Where a pointer into a buffer points, and how the memory there is laid out beyond what its type says.
  struct Address {
    std::string bytes;                   ///< C++ expression of type std::byte*
    std::string resource;                ///< C++ expression of the kernel::Resource, "" where it has none
    std::uint32_t offset = 0;            ///< constant part of the distance to `bytes`
    std::uint32_t matrix_stride = 0;     ///< of the matrices there
    std::uint32_t component_stride = 0;  ///< of the vector there, 0: tight
    bool row_major = false;
  };

  [[noreturn]] void fail(const std::string& what) const;

  // printer.cpp: the translation unit around the functions.
  void set_up_backend();
  void set_up_names();
  void set_up_variables();
  void measure_functions();
  void print_module();
  void print_members();
  void print_constants();
  void print_run();
  void print_info();
  std::string resource_kind(rhi::BindingKind kind) const;
  const rhi::ShaderBinding* binding_of(std::uint32_t variable) const;
  std::uint32_t first_resource_of(std::uint32_t variable) const;
  std::string stage_name() const;

  // printer_types.cpp: names of types, structs, constants.
  std::string type_name(std::uint32_t type_id) { return type_name(get<Type>(type_id)); }
  std::string type_name(const Type& type);
  std::string scalar_name(BaseType base) const;
  std::string vector_name(BaseType base, std::uint32_t length) const;
  std::string struct_name(const Type& type);
  std::vector<std::string> member_names(const Type& type) const;
  std::uint32_t array_length(const Type& type) const;
  /// An array or a pointer to one has the array's lengths; an array of pointers and a pointer are both marked as
  /// pointers, but only a pointer is one level deeper than what it is made of.
  bool is_pointer(const Type& type) const {
    return type.pointer && type.pointer_depth > get<Type>(type.parent_type).pointer_depth;
  }
  bool is_array(const Type& type) const { return !type.array.empty() && !is_pointer(type); }
  bool is_runtime_array(const Type& type) const { return is_array(type) && array_length(type) == 0; }
  bool is_opaque(const Type& type) const;
  std::string constant_text(const spirv_cross::SPIRConstant& constant);
  std::string scalar_text(const spirv_cross::SPIRConstant& constant, BaseType base, std::uint32_t column,
                          std::uint32_t row) const;
  std::string constant_initializer(const spirv_cross::SPIRConstant& constant);

  // printer_memory.cpp: pointers, loads, stores, atomics.
  bool is_buffer(spv::StorageClass storage) const;
  bool is_buffer_pointer(std::uint32_t id);
  std::uint32_t pointee(std::uint32_t pointer_type_id) const;
  std::uint32_t matrix_stride(std::uint32_t struct_type_id, std::uint32_t member) const;
  Address address_of(std::uint32_t pointer_id);
  std::string printed(const Address& address) const;
  void print_access_chain(Operands ops, std::uint32_t length);
  void chain_in_buffer(Operands ops, std::uint32_t length);
  void chain_in_variable(Operands ops, std::uint32_t length);
  void index_address(Address& address, std::uint32_t index_id, std::uint32_t stride);
  std::string load_text(std::uint32_t type_id, const Address& address);
  std::string store_text(std::uint32_t type_id, const Address& address, const std::string& value);
  void print_load(Operands ops);
  void print_store(std::uint32_t pointer_id, const std::string& text);
  void print_array_length(Operands ops);
  void print_atomic(spv::Op op, Operands ops);
  void print_struct_memory(std::uint32_t struct_type_id);
  void print_struct_memory_functions();

  // printer_composites.cpp: calls, and values made of values.
  void print_call(Operands ops, std::uint32_t length);
  void print_composite(spv::Op op, Operands ops, std::uint32_t length);

  // printer_operations.cpp: everything that computes.
  bool print_arithmetic(spv::Op op, Operands ops);
  bool print_relation(spv::Op op, Operands ops);
  bool print_conversion(spv::Op op, Operands ops);
  bool print_bits(spv::Op op, Operands ops);
  bool print_matrix(spv::Op op, Operands ops);
  void print_extended_result(Operands ops, const std::string& low, const std::string& high);

  // printer_ray_query.cpp
  void print_ray_query(spv::Op op, Operands ops);

  // printer_ray_tracing.cpp: the stages of a ray tracing pipeline.
  bool is_traced() const;
  bool is_payload(spv::StorageClass storage) const;
  bool is_incoming_payload(spv::StorageClass storage) const;
  void set_up_endings();
  /// The statement that ends the function being printed, and with it the shader.
  std::string ending();
  void print_call_ending(std::uint32_t function_id);
  std::uint32_t value_alignment(const Type& type) const;
  std::uint32_t value_size(const Type& type) const;
  void print_traced_members();
  void print_shader_call();
  void print_ray_tracing(spv::Op op, Operands ops);
  std::string traced_built_in(spv::BuiltIn built_in) const;

  // printer_images.cpp: storage images, and descriptors as values.
  std::string texel_format(const Type& type) const;
  /// Types whose variables hold a pointer to what the host has bound.
  bool is_descriptor(const Type& type) const;
  const char* descriptor_target(const Type& type) const;
  std::string descriptor_member(const Type& type, const std::string& resource) const;
  /// What the UniformConstant pointer `pointer_id` points at.
  std::string descriptor_value(std::uint32_t pointer_id);
  bool print_image(spv::Op op, Operands ops, std::uint32_t length);

  // printer_extended.cpp: GLSL.std.450.
  void print_extended(Operands ops, std::uint32_t length);
  void print_split(Operands ops, const char* function, bool through_pointer);

  // Operands.
  std::string value(std::uint32_t id) { return to_expression(id); }
  const Type& type_of(std::uint32_t id) { return get<Type>(expression_type_id(id)); }
  /// The operand as components of `base`, converted when it has another signedness.
  std::string value_as(std::uint32_t id, BaseType base);
  std::string value_signed(std::uint32_t id);
  std::string value_unsigned(std::uint32_t id);
  /// Element `index` of the composite value or variable `composite`.
  std::string element(const std::string& composite, const Type& type, std::uint32_t index) const;
  const Type& element_type(const Type& type, std::uint32_t index) const;
  /// Result `id` of type `type_id` is `text`, which has components of `base`.
  void define(std::uint32_t type_id, std::uint32_t id, const std::string& text);
  void define_as(std::uint32_t type_id, std::uint32_t id, const std::string& text, BaseType base);
  static bool is_integer(BaseType base);
  static BaseType to_signed(BaseType base);
  static BaseType to_unsigned(BaseType base);

  std::string label_;
  rhi::ShaderReflection reflection_;
  std::string entry_symbol_;
  std::array<std::uint32_t, 3> workgroup_size_ = {1, 1, 1};
  std::unordered_map<std::uint32_t, std::string> names_;           ///< of Function and Private variables' declarations
  std::unordered_map<std::uint32_t, std::uint32_t> initializers_;  ///< constant that a Function variable starts as
  std::unordered_map<std::uint32_t, Address> addresses_;           ///< pointers into buffers
  std::map<std::string, std::string> structs_;                     ///< by layout: value structs are structural types
  std::unordered_map<std::uint32_t, std::string> struct_names_;
  std::string struct_declarations_;
  std::unordered_set<std::uint32_t> composite_constants_;
  std::unordered_map<std::uint32_t, std::uint64_t> inlined_size_;  ///< instructions of a function with all its callees
  bool has_line_numbers_ = false;
  std::unordered_map<std::uint32_t, std::uint32_t> built_in_types_;  ///< of the variable of a built-in
  std::unordered_set<std::uint32_t> ending_functions_;               ///< a call to one may end the shader
  std::vector<std::pair<std::string, std::string>> payloads_;        ///< type and name of what is passed on
  std::string incoming_payload_type_;                                ///< "" without one
};

}  // namespace tandem::cpu
