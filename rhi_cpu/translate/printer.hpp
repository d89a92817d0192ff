#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

#include <spirv_cross/spirv_glsl.hpp>

#include "rhi/shader_reflection.hpp"
#include "rhi_cpu/translate/address.hpp"
#include "rhi_cpu/translate/groups/places.hpp"
#include "rhi_cpu/translate/instructions/extended_instructions.hpp"
#include "rhi_cpu/translate/instructions/image_operands.hpp"
#include "rhi_cpu/translate/instructions/instruction.hpp"
#include "rhi_cpu/translate/instructions/operations.hpp"
#include "rhi_cpu/translate/instructions/scalar_types.hpp"
#include "rhi_cpu/translate/storage_classes.hpp"
#include "rhi_cpu/translate/translate_options.hpp"
#include "rhi_cpu/translate/value_layout.hpp"
#include "rhi_cpu/translate/wide/mode.hpp"
#include "rhi_cpu/translate/wide/uniformity.hpp"

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
  /// @param module from prepare(), with places where it has subgroup operations
  /// @param reflection of the same words
  Printer(const MarkedModule& module, const std::string& label, const rhi::ShaderReflection& reflection,
          const TranslateOptions& options);

  /// The translation unit. Throws rhi::Error(unsupported), or what SPIRV-Cross throws.
  std::string compile() override;

  /// Whether there is C++ for an instruction in a function's blocks: it is an operation of operations.hpp, or one that
  /// is printed by hand.
  static bool prints(spv::Op op);

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
  using PrintFunction = void (Printer::*)(const Instruction&);

  [[noreturn]] void fail(const std::string& what) const;

  // printer.cpp: the translation unit around the functions.
  void set_up_backend();
  void set_up_names();
  void set_up_variables();
  /// Blocks of a function that can be reached, whatever is not constant.
  std::vector<std::uint32_t> live_blocks(std::uint32_t function) const;
  void measure_functions();
  void print_module();
  void print_constants();
  void print_members();
  void print_run();
  void print_wide_run();
  std::string entry_mask() const;
  void print_info();
  const rhi::ShaderBinding* binding_of(std::uint32_t variable) const;
  std::uint32_t first_resource_of(std::uint32_t variable) const;

  // printer_types.cpp: names of types, structs, constants.
  std::string type_name(std::uint32_t type_id) { return type_name(get<Type>(type_id)); }
  std::string type_name(const Type& type);
  std::string narrow_name(const Type& type);
  std::string numbers_name(BaseType base, std::uint32_t length) const;
  std::string struct_name(const Type& type);
  std::string wide_struct(const std::string& name, const std::string& members, const Type& type);
  std::vector<std::string> member_names(const Type& type) const;
  std::uint32_t array_length(const Type& type) const;
  bool is_pointer(const Type& type) const { return cpu::is_pointer(*this, type); }
  bool is_array(const Type& type) const { return cpu::is_array(*this, type); }
  bool is_runtime_array(const Type& type) const { return is_array(type) && array_length(type) == 0; }
  bool is_opaque(const Type& type) const;
  bool has_halves() const;
  std::string constant_text(const spirv_cross::SPIRConstant& constant);
  std::string scalar_text(const spirv_cross::SPIRConstant& constant, BaseType base, std::uint32_t column,
                          std::uint32_t row) const;
  std::string constant_initializer(const spirv_cross::SPIRConstant& constant);

  // printer_memory.cpp: pointers, loads, stores.
  bool is_buffer_pointer(std::uint32_t id);
  std::uint32_t pointee(std::uint32_t pointer_type_id) const;
  std::uint32_t matrix_stride(std::uint32_t struct_type_id, std::uint32_t member) const;
  Address address_of(std::uint32_t pointer_id);
  /// The memory that a pointer as a value leads to.
  Address address_in(std::uint32_t pointer_id);
  std::string printed(const Address& address) const;
  void print_access_chain(const Instruction& i);
  void chain_in_buffer(const Instruction& i, Address address, std::size_t first_index);
  void chain_in_variable(const Instruction& i);
  /// The kernel::Resource that the operands from `k` on name in an array of descriptors; moves both arguments behind
  /// it.
  std::string descriptor_element(const Instruction& i, std::size_t& k, std::uint32_t& type_id);
  void index_address(Address& address, std::uint32_t index_id, std::uint32_t stride);
  std::string load_text(std::uint32_t type_id, const Address& address);
  std::string store_text(std::uint32_t type_id, const Address& address, const std::string& value);
  void print_load(const Instruction& i);
  void print_store(const Instruction& i);
  void print_copy_memory(const Instruction& i);
  void print_store_to(std::uint32_t pointer_id, const std::string& text);
  void print_array_length(const Instruction& i);
  void print_struct_memory(std::uint32_t struct_type_id);
  void print_struct_memory_functions();

  // printer_pointers.cpp: pointers into buffers as values.
  bool is_pointer_value(std::uint32_t id);
  void set_up_pointers();
  /// Refuses a pointer to what would need more than an address to be loaded.
  void check_pointer_value(std::uint32_t pointer_id, const Address& address) const;
  std::string pointer_value(std::uint32_t pointer_id);
  void print_pointer_copy(const Instruction& i);
  void print_pointer_access_chain(const Instruction& i);
  void print_pointer_relation(const Instruction& i);

  // printer_robust.cpp: what stays inside of what is bound, and loops that can be ended.
  /// Bytes from the first to the last that a value of the type has there.
  std::uint32_t memory_extent(std::uint32_t type_id, const Address& address) const;
  bool is_guarded(const Address& address) const;
  std::string guarded_load(std::uint32_t type_id, const Address& address);
  std::string guarded_store(std::uint32_t type_id, const Address& address, const std::string& value);
  std::string guarded_pointer(std::uint32_t type_id, const Address& address);
  std::string index_inside(const Type& type, const std::string& index) const;
  std::string descriptor_count(std::uint32_t variable) const;
  void print_look();

  // printer_atomics.cpp
  std::string atomic_call(const Instruction& i, const char* function, BaseType base, const std::string& arguments);
  BaseType atomic_component(const Instruction& i);
  void print_atomic(const Instruction& i, const Operation& operation);
  void print_atomic_load(const Instruction& i);
  void print_atomic_store(const Instruction& i);
  void print_compare_exchange(const Instruction& i);

  // printer_groups.cpp: workgroup memory and barriers.
  void set_up_groups();
  /// Storage classes whose pointers are addresses.
  bool is_in_memory(spv::StorageClass storage) const;
  std::uint32_t invocation_count() const;
  bool needs_lanes() const { return marks_.depth > 0; }
  /// Invocations of a workgroup, or in the wide form its subgroups.
  std::uint32_t fibre_count() const;
  bool needs_fibres() const;
  /// Whether there is a struct Workgroup.
  bool needs_group() const;
  bool is_of_subgroup(const Instruction& barrier) const;
  /// The template arguments of k::Subgroups and k::Lane.
  std::string lane_types() const;
  std::uint32_t stack_size() const;
  void print_group();
  void print_group_run();
  void print_invoke();
  void print_control_barrier(const Instruction& i);
  bool is_shared_pointer(const Type& type) const;
  /// A pointer into a shared variable that is no block of bytes: its value is a C++ pointer.
  bool is_shared_pointer(std::uint32_t id) { return is_shared_pointer(type_of(id)); }
  /// What a pointer that is no address points at.
  std::string place_at(std::uint32_t pointer_id);

  // printer_subgroups.cpp
  static bool is_subgroup_operation(spv::Op op);
  /// Whether it asks a ballot, and no other lane.
  static bool is_ballot_query(spv::Op op);
  /// What the place that was last marked adds to an invocation's position.
  std::string place_words() const;
  /// The k::Lane of the invocation, at that place.
  std::string lane() const;
  std::string lane_number() const;  ///< gl_SubgroupInvocationID
  void print_mark(const Instruction& i);
  void print_subgroup_operation(const Instruction& i);
  void print_subgroup_arithmetic(const Instruction& i, const char* function, Sign sign);
  void print_ballot_count(const Instruction& i);
  std::string subgroup_built_in(spv::BuiltIn built_in);  ///< "" for what is none of a subgroup

  // printer_composites.cpp: calls, and values made of values.
  void print_call(const Instruction& i);
  /// The element that the operands from `first` on lead to.
  std::string part(const std::string& composite, const Type& type, const Instruction& i, std::size_t first);
  void print_construct(const Instruction& i);
  void print_extract(const Instruction& i);
  void print_insert(const Instruction& i);
  void print_extract_dynamic(const Instruction& i);
  void print_insert_dynamic(const Instruction& i);
  void print_shuffle(const Instruction& i);
  void print_copy(const Instruction& i);
  void print_copy_logical(const Instruction& i);

  // printer_instructions.cpp: which function prints which instruction.
  Instruction view(const spirv_cross::Instruction& instruction) const;
  /// The function for an instruction that operations.hpp does not have; null when there is none.
  static PrintFunction by_hand(spv::Op op);
  void print_instruction(const Instruction& i);
  void print_nothing(const Instruction&) {}
  void print_line(const Instruction& i);
  void print_memory_barrier(const Instruction& i);
  void print_clock(const Instruction& i);

  // printer_operations.cpp: everything that computes.
  void print_operation(const Instruction& i, const Operation& operation);
  /// The mask as the first argument of a function, in lanes.
  std::string lanes_argument() const;
  void print_infix(const Instruction& i, const Operation& operation);
  void print_prefix(const Instruction& i, const Operation& operation);
  void print_function(const Instruction& i, const Operation& operation);
  void print_relation(const Instruction& i, const Operation& operation);
  void print_conversion(const Instruction& i, const Operation& operation);
  void print_double_width(const Instruction& i, const Operation& operation);
  void print_shift(const Instruction& i, const Operation& operation);
  void print_bit_field(const Instruction& i, const Operation& operation);
  void print_ray_query_getter(const Instruction& i, const Operation& operation);
  void print_integer_dot(const Instruction& i);
  void print_bit_count(const Instruction& i);
  void print_bitcast(const Instruction& i);
  void check_bit_width(const Instruction& i);

  // printer_ray_tracing.cpp: the stages of a ray tracing pipeline.
  bool is_traced() const;
  void set_up_endings();
  /// The statement that ends the function being printed, and with it the shader.
  std::string ending();
  void print_call_ending(std::uint32_t function_id);
  void print_traced_members();
  void print_shader_call();
  void print_trace_ray(const Instruction& i);
  void print_execute_callable(const Instruction& i);
  void print_report_intersection(const Instruction& i);
  void print_structure_at(const Instruction& i);
  void print_ignore_intersection(const Instruction& i);
  void print_terminate_ray(const Instruction& i);
  std::string traced_built_in(spv::BuiltIn built_in) const;

  // printer_uniformity.cpp: which values the wide form keeps per lane.
  bool is_wide() const { return options_.lanes != 0; }
  std::vector<std::uint32_t> successors_of(std::uint32_t block_id) const;
  WideFunction& wide_function(std::uint32_t function_id);
  std::uint32_t root_variable(std::uint32_t pointer_id) const;
  void find_definitions(std::uint32_t function_id);
  void analyze_uniformity();
  bool update_uniformity(std::uint32_t function_id);

  // printer_wide.cpp: instructions in the wide form.
  bool varies(std::uint32_t id) const;
  bool has_varying_contents(std::uint32_t pointer_id) const;
  /// The value `text` of an operand as the mode wants it.
  std::string in_mode(std::uint32_t id, std::string text);
  void define_wide(std::uint32_t type_id, std::uint32_t id, const std::string& text);
  /// Whether there is C++ for all lanes at once.
  bool is_wide_operation(const Instruction& i);
  void print_wide_instruction(const Instruction& i);
  void print_by_lane(const Instruction& i, const std::function<void()>& print);
  void print_wide_chain(const Instruction& i);
  void keep_addresses(std::uint32_t id, Address& address);
  void print_wide_load(const Instruction& i);
  void print_wide_store(const Instruction& i);
  bool has_register(const Type& type) const;
  std::string bounds(const Address& address) const;
  void print_store_in_rows(const Instruction& i);
  void print_wide_call(const Instruction& i);
  void keep_shared_offsets(const Instruction& i);

  // printer_wide_flow.cpp: control flow in the wide form.
  struct WidePrinting;
  void print_wide_functions(std::uint32_t function_id);
  void print_wide_prototype(std::uint32_t function_id);
  void print_wide_function(std::uint32_t function_id);
  void print_escaping(std::uint32_t id, int block_number);
  void place_blocks(WidePrinting& printing);
  void print_declarations(const WidePrinting& printing, const std::vector<int>& blocks);
  void print_node(WidePrinting& printing, int block);
  void print_child(WidePrinting& printing, int block);
  void print_edge(WidePrinting& printing, int from, int to, const std::string& mask, const std::string& condition);
  void print_terminator(WidePrinting& printing, int block);
  std::string case_text(const spirv_cross::SPIRBlock& block, std::uint64_t number);

  // printer_images.cpp: storage images, and descriptors as values.
  std::string texel_format(const Type& type) const;
  /// The kernel::Shape of an image type.
  const char* image_shape(const Type& type) const;
  /// Types whose variables hold a pointer to what the host has bound.
  bool is_descriptor(const Type& type) const;
  const char* descriptor_target(const Type& type) const;
  std::string descriptor_member(const Type& type, const std::string& resource) const;
  /// The type of a parameter that is a pointer to `type`.
  std::string descriptor_parameter(const Type& type);
  /// What the UniformConstant pointer `pointer_id` points at; of an array, its elements.
  std::string descriptor_value(std::uint32_t pointer_id);
  /// Refuses image operands, whose mask is operand `mask`, that name a sample.
  void refuse_sample(const Instruction& i, std::size_t mask) const;
  void print_image_read(const Instruction& i);
  void print_image_write(const Instruction& i);
  void print_image_size(const Instruction& i);
  void print_texel_pointer(const Instruction& i);

  // printer_sampling.cpp: sampled images and samplers.
  /// Those behind the mask, which is operand `mask`; refuses what has no meaning here.
  ImageOperands image_operands(const Instruction& i, std::size_t mask) const;
  /// The kernel::Lookup of an instruction that samples.
  std::string lookup(const Instruction& i, std::size_t mask);
  /// What a shader reads of a texel's components.
  std::string texel_component(const Type& image) const;
  bool is_combined(const Type& type) const;
  void print_sampled_image(const Instruction& i);
  void print_image_of(const Instruction& i);
  void print_sample(const Instruction& i);
  void print_sample_compare(const Instruction& i);
  void print_gather(const Instruction& i);
  void print_fetch(const Instruction& i);
  void print_level_count(const Instruction& i);
  bool is_wide_image_operation(const Instruction& i);
  std::string common_value(std::uint32_t id);

  // printer_extended.cpp: GLSL.std.450.
  void print_extended(const Instruction& i);
  void print_extended_call(const Instruction& i, const ExtendedInstruction& extended, BaseType base);
  void print_split_into_pointer(const Instruction& i, const char* function);
  void print_split_into_struct(const Instruction& i, const char* function);

  // Operands.
  std::string value(std::uint32_t id);
  const Type& type_of(std::uint32_t id) { return get<Type>(expression_type_id(id)); }
  /// The operand as components of `base`, or of the signedness `sign`, converted when it has others.
  std::string value_as(std::uint32_t id, BaseType base);
  std::string value_with_sign(std::uint32_t id, Sign sign);
  /// Operands `first` and following, with commas between them.
  std::string values_with_sign(const Instruction& i, std::size_t first, Sign sign);
  /// Element `index` of the composite value or variable `composite`.
  std::string element(const std::string& composite, const Type& type, std::uint32_t index) const;
  const Type& element_type(const Type& type, std::uint32_t index) const;
  /// The result of `i` is `text`.
  void define(const Instruction& i, const std::string& text);
  /// The same of a text that has components of `base`.
  void define_as(const Instruction& i, const std::string& text, BaseType base);

  std::string label_;
  rhi::ShaderReflection reflection_;
  TranslateOptions options_;
  MarkedModule marks_;  ///< without its words
  std::array<std::uint32_t, 3> workgroup_size_ = {1, 1, 1};
  std::unordered_map<std::uint32_t, std::string> names_;           ///< of Function and Private variables' declarations
  std::unordered_map<std::uint32_t, std::uint32_t> initializers_;  ///< constant that a Function variable starts as
  std::unordered_map<std::uint32_t, Address> addresses_;           ///< pointers into buffers
  std::unordered_set<std::uint32_t> pointer_values_;               ///< what an OpPhi or an OpReturnValue takes
  std::map<std::string, std::string> structs_;                     ///< by layout: value structs are structural types
  std::unordered_map<std::uint32_t, std::string> struct_names_;
  std::string struct_declarations_;
  std::unordered_set<std::uint32_t> composite_constants_;
  std::unordered_map<std::uint32_t, std::uint64_t> inlined_size_;  ///< instructions of a function with all its callees
  bool has_line_numbers_ = false;
  bool samples_ = false;                ///< needs sampling.hpp
  bool uses_subgroups_ = false;         ///< needs rhi_cpu/kernel/subgroups.hpp
  bool has_barriers_ = false;           ///< of the workgroup
  bool has_workgroup_blocks_ = false;   ///< shared variables are blocks, of bytes
  std::uint32_t workgroup_memory_ = 0;  ///< bytes of such blocks
  std::vector<std::uint32_t> workgroup_variables_;
  std::uint32_t place_ = 0;                                          ///< the last mark's
  bool is_marked_ = false;                                           ///< the instruction being printed has that place
  std::unordered_map<std::uint32_t, std::uint32_t> built_in_types_;  ///< of the variable of a built-in
  std::unordered_set<std::uint32_t> ending_functions_;               ///< a call to one may end the shader
  std::vector<std::pair<std::string, std::string>> payloads_;        ///< type and name of what is passed on
  std::string incoming_payload_type_;                                ///< "" without one

  // The wide form.
  std::map<std::uint32_t, WideFunction> wide_functions_;
  Uniformity uniformity_;
  std::map<std::uint32_t, Definition> definitions_;  ///< of values
  std::unordered_set<std::uint32_t> escapes_;        ///< values that are used outside of the loop that defines them
  std::unordered_map<std::uint32_t, std::uint32_t> roots_;         ///< variable of a pointer
  std::unordered_map<std::uint32_t, std::string> shared_offsets_;  ///< of pointers to shared elements
  std::unordered_set<std::uint32_t> printed_functions_, declared_phis_;
  Mode mode_ = Mode::common;
  std::string mask_;               ///< of the block that is printed
  std::uint32_t lane_result_ = 0;  ///< the result whose lane is being printed
};

}  // namespace tandem::cpu
