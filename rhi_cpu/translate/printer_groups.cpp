// Workgroups whose invocations share memory and wait for each other (kernel/workgroups.hpp, kernel/lanes.hpp).

#include <algorithm>

#include <fmt/format.h>

#include "rhi/error.hpp"
#include "rhi_cpu/kernel/group_limits.hpp"
#include "rhi_cpu/translate/printer.hpp"

namespace tandem::cpu {

using spirv_cross::SPIRConstant;
using spirv_cross::SPIRFunction;
using spirv_cross::SPIRVariable;

namespace {

std::uint32_t aligned(std::uint32_t size) { return (size + 15) / 16 * 16; }

}  // namespace

bool Printer::is_in_memory(spv::StorageClass storage) const {
  return is_buffer(storage) || (storage == spv::StorageClassWorkgroup && has_workgroup_blocks_);
}

bool Printer::is_shared_pointer(const Type& type) const {
  return is_pointer(type) && type.storage == spv::StorageClassWorkgroup && !has_workgroup_blocks_;
}

std::string Printer::place_at(std::uint32_t pointer_id) {
  if (!is_shared_pointer(pointer_id)) return value(pointer_id);
  const bool is_variable = std::ranges::find(workgroup_variables_, pointer_id) != workgroup_variables_.end();
  return is_variable ? to_name(pointer_id) : fmt::format("(*{})", value(pointer_id));
}

std::uint32_t Printer::invocation_count() const { return workgroup_size_[0] * workgroup_size_[1] * workgroup_size_[2]; }

std::uint32_t Printer::fibre_count() const {
  return is_wide() ? (invocation_count() + options_.lanes - 1) / options_.lanes : invocation_count();
}

bool Printer::needs_fibres() const {
  if (is_wide()) return invocation_count() > 1 && has_barriers_;
  return invocation_count() > 1 && (has_barriers_ || (needs_lanes() && options_.subgroup_size > 1));
}

bool Printer::needs_group() const { return needs_fibres() || needs_lanes() || !workgroup_variables_.empty(); }

void Printer::set_up_groups() {
  if (is_traced()) return;
  std::vector<std::uint32_t> parameters;
  ir.for_each_typed_id<SPIRFunction>([&](std::uint32_t, SPIRFunction& function) {
    for (const auto& parameter : function.arguments) parameters.push_back(parameter.id);
    for (const std::uint32_t block : live_blocks(function.self))
      for (const auto& instruction : get<spirv_cross::SPIRBlock>(block).ops)
        has_barriers_ |= instruction.op == spv::OpControlBarrier && !is_of_subgroup(view(instruction));
  });
  std::uint32_t size = 0;
  ir.for_each_typed_id<SPIRVariable>([&](std::uint32_t id, SPIRVariable& variable) {
    const bool is_parameter = std::find(parameters.begin(), parameters.end(), id) != parameters.end();
    if (variable.storage != spv::StorageClassWorkgroup || variable.phi_variable || is_parameter) return;
    workgroup_variables_.push_back(id);
    const std::uint32_t type_id = pointee(variable.basetype);
    const Type& type = get<Type>(type_id);
    // Either all of them are blocks, which begin at the same place, or none is.
    if (type.basetype == Type::Struct && has_decoration(type.self, spv::DecorationBlock)) {
      has_workgroup_blocks_ = true;
      size = std::max(size, memory_extent(type_id, {.bytes = "", .resource = ""}));
      // A pointer, not the array: what selects or stores it asks for its type.
      ir.meta[id].decoration.alias = "(&own_group->memory[0])";
    } else {
      size = aligned(size) + value_layout(*this, type).size;
      ir.meta[id].decoration.alias = fmt::format("own_group->shared_{}", id);
    }
  });
  workgroup_memory_ = aligned(size);
  if (size > kernel::max_workgroup_memory)
    throw rhi::Error(rhi::ErrorCode::unsupported, label_,
                     fmt::format("its shared variables have {} bytes, where a workgroup on the CPU device has {}", size,
                                 kernel::max_workgroup_memory));
}

bool Printer::is_of_subgroup(const Instruction& barrier) const {
  const auto* scope = maybe_get<SPIRConstant>(barrier.operand(0));
  return scope == nullptr || scope->scalar() == spv::ScopeSubgroup || scope->scalar() == spv::ScopeInvocation;
}

void Printer::print_control_barrier(const Instruction& i) {
  const auto* scope = maybe_get<SPIRConstant>(i.operand(0));
  if (scope == nullptr) fail("OpControlBarrier whose scope is no constant");
  if (invocation_count() == 1 || scope->scalar() == spv::ScopeInvocation) return statement("k::memory_barrier();");
  if (is_wide() && is_of_subgroup(i)) return statement("k::memory_barrier();");
  if (is_of_subgroup(i)) return statement(lane(), ".meet();");
  // The place of the instruction in the module names it.
  const std::ptrdiff_t place = i.words().data() - ir.spirv.data();
  if (is_wide())
    statement(
        fmt::format("own_group->turns.barrier_of_lanes(k::bits_of({}) == k::bits_of(built_in_entered), "
                    "k::lane(built_in_LocalInvocationIndex, 0) / k::lane_count, {}u);",
                    mask_, place));
  else
    statement(fmt::format("own_group->turns.barrier(built_in_LocalInvocationIndex, {}u);", place));
}

std::string Printer::lane_types() const {
  return fmt::format("<{}, {}, {}>", options_.subgroup_size, invocation_count(), std::max(marks_.depth, 1u));
}

void Printer::print_group() {
  statement("struct Workgroup {");
  statement("const k::Dispatch& dispatch;");
  statement("k::uvec3 count, id;");
  if (needs_lanes() && !is_wide())
    statement("k::Subgroups", lane_types(), " turns = {};");
  else if (needs_fibres())
    statement("k::Turns turns{", fibre_count(), "};");
  if (has_workgroup_blocks_) statement("alignas(16) std::byte memory[", workgroup_memory_, "] = {};");
  for (const std::uint32_t id : workgroup_variables_)
    if (!has_workgroup_blocks_)
      statement("alignas(16) ", type_name(pointee(get<SPIRVariable>(id).basetype)), " shared_", id, " = {};");
  statement("static constexpr k::uint fibre_count = ", fibre_count(), ";");
  statement("void invoke(k::uint index);");
  statement("};");
  statement("");
}

void Printer::print_invoke() {
  const char* watch = options_.watched ? ", dispatch.watch" : "";
  const char* lane = needs_lanes() ? ", {turns, index}" : "";
  if (is_wide())
    statement(fmt::format(
        R"(inline void Workgroup::invoke(k::uint fibre) {{
  const k::uint begin = fibre * k::lane_count;
  const k::Lanes<k::uint> index = k::Lanes<k::uint>(begin) + k::lane_indices();
  const k::wide_t<k::uvec3> local = k::local_invocations<{0}u, {1}u>(begin);
  Invocation{{dispatch.resources, dispatch.push_constants, count, id, local, k::spread(id * k::uvec3({0}u, {1}u, {2}u)) + local, index, {4}{3}, this}}
      .entry_point({4});
}}
)",
        workgroup_size_[0], workgroup_size_[1], workgroup_size_[2], watch, entry_mask()));
  else
    statement(fmt::format(
        R"(inline void Workgroup::invoke(k::uint index) {{
  const k::uvec3 local(index % {0}u, index / {0}u % {1}u, index / ({0}u * {1}u));
  Invocation{{dispatch.resources, dispatch.push_constants, count, id, local, id * k::uvec3({0}u, {1}u, {2}u) + local, index{3}, this{4}}}
      .entry_point();
}}
)",
        workgroup_size_[0], workgroup_size_[1], workgroup_size_[2], watch, lane));
}

void Printer::print_group_run() {
  print_invoke();
  statement(fmt::format(
      R"(void run(const k::Dispatch& dispatch, std::uint64_t first, std::uint64_t end) {{
  const k::uvec3 count(dispatch.workgroup_count[0], dispatch.workgroup_count[1], dispatch.workgroup_count[2]);
  const k::uvec3 base(dispatch.base_workgroup[0], dispatch.base_workgroup[1], dispatch.base_workgroup[2]);
  for (std::uint64_t workgroup = first; workgroup < end; ++workgroup) {{
    const k::uvec3 id = base + k::uvec3(workgroup % count.x, workgroup / count.x % count.y, workgroup / count.x / count.y);
    Workgroup group{{dispatch, count, id}};
    {};
  }}
}}
)",
      needs_fibres() ? fmt::format("k::run_fibres(dispatch, group, {})", stack_size()) : "k::run_loop(group)"));
}

std::uint32_t Printer::stack_size() const {
  // What the shader's variables need, once more for copies, and as much again as a shader needs that has none.
  constexpr std::uint32_t least = 256u << 10, most = 64u << 20;
  std::uint64_t size = least;
  ir.for_each_typed_id<SPIRVariable>([&](std::uint32_t, const SPIRVariable& variable) {
    if (variable.storage != spv::StorageClassPrivate && variable.storage != spv::StorageClassFunction) return;
    const Type& type = get<Type>(variable.basetype);
    if (is_pointer(type) && !is_pointer(get<Type>(type.parent_type)) && !is_opaque(get<Type>(type.parent_type)))
      size += 4ull * value_layout(*this, get<Type>(type.parent_type)).size;
    else
      size += 4096;  // a ray query
  });
  return static_cast<std::uint32_t>(std::min<std::uint64_t>(size, most));
}

}  // namespace tandem::cpu
