// What stands behind the functions of a kernel: the loop over workgroups, and what the kernel says of itself.

#include <algorithm>

#include <fmt/format.h>

#include "rhi_cpu/translate/names/kernel_names.hpp"
#include "rhi_cpu/translate/printer.hpp"

namespace tandem::cpu {

using spirv_cross::SPIRVariable;

void Printer::print_members() {
  statement("struct Invocation {");
  if (is_traced()) {
    print_traced_members();
  } else {
    statement("const k::Resource* resources;");
    statement("const std::byte* push_constants;");
    const bool wide = is_wide();
    for (const char* built_in : {"NumWorkgroups", "WorkgroupId"}) statement("k::uvec3 built_in_", built_in, ";");
    for (const char* built_in : {"LocalInvocationId", "GlobalInvocationId"})
      statement(wide ? "k::wide_t<k::uvec3>" : "k::uvec3", " built_in_", built_in, ";");
    statement(wide ? "k::Lanes<k::uint>" : "k::uint", " built_in_LocalInvocationIndex;");
    if (wide) statement("k::Mask built_in_entered;");
    if (options_.watched) statement("const k::Watch* watch;");
    if (needs_group()) statement("Workgroup* own_group;");
    if (needs_lanes()) statement("k::Lane", lane_types(), " own_lane;");
  }
  if (options_.watched) statement("k::uint rounds = k::rounds_between_looks;");
  ir.for_each_typed_id<SPIRVariable>([&](std::uint32_t id, SPIRVariable& variable) {
    if (variable.storage == spv::StorageClassPrivate) {
      const std::uint32_t type = pointee(variable.basetype);
      std::string initial = is_opaque(get<Type>(type)) ? "" : "{}";
      mode_ = is_wide() ? Mode::wide : Mode::common;
      if (variable.initializer) initial = " = " + value(variable.initializer);
      statement(type_name(type), " ", to_name(id), initial, ";");
      mode_ = Mode::common;
      return;
    }
    if (!has_decoration(id, spv::DecorationBinding) || binding_of(id) == nullptr) return;
    const Type& type = get<Type>(pointee(variable.basetype));
    const std::string first = fmt::format("resources[{}]", first_resource_of(id));
    if (is_array(type) && binding_of(id)->count == 0)
      statement("const k::Resource* ", to_name(id), " = reinterpret_cast<const k::Resource*>(", first, ".data);");
    else if (is_array(type))
      statement("const k::Resource* ", to_name(id), " = &", first, ";");
    else if (variable.storage == spv::StorageClassUniformConstant)
      statement("const ", descriptor_target(type), "* ", to_name(id), " = ", descriptor_member(type, first), ";");
    else
      statement("std::byte* ", to_name(id), " = ", first, ".data;");
    if (options_.robust && is_buffer(variable.storage) && !is_array(type))
      statement("std::size_t ", to_name(id), "_size = ", first, ".size;");
  });
  statement("");
}

void Printer::print_wide_run() {
  const std::uint32_t count = workgroup_size_[0] * workgroup_size_[1] * workgroup_size_[2];
  statement(fmt::format(
      R"(void run(const k::Dispatch& dispatch, std::uint64_t first, std::uint64_t end) {{
  const k::uvec3 count(dispatch.workgroup_count[0], dispatch.workgroup_count[1], dispatch.workgroup_count[2]);
  const k::uvec3 base(dispatch.base_workgroup[0], dispatch.base_workgroup[1], dispatch.base_workgroup[2]);
  for (std::uint64_t workgroup = first; workgroup < end; ++workgroup) {{
    const k::uvec3 id = base + k::uvec3(workgroup % count.x, workgroup / count.x % count.y, workgroup / count.x / count.y);
    for (k::uint begin = 0; begin < {3}u; begin += k::lane_count) {{
      const k::Lanes<k::uint> index = k::Lanes<k::uint>(begin) + k::lane_indices();
      const k::wide_t<k::uvec3> local = k::local_invocations<{0}u, {1}u>(begin);
      Invocation{{dispatch.resources, dispatch.push_constants, count, id, local, k::spread(id * k::uvec3({0}u, {1}u, {2}u)) + local, index, {5}{4}}}
          .entry_point({5});
    }}
  }}
}}
)",
      workgroup_size_[0], workgroup_size_[1], workgroup_size_[2], count, options_.watched ? ", dispatch.watch" : "",
      entry_mask()));
}

std::string Printer::entry_mask() const {
  const std::uint32_t count = invocation_count();
  return count % options_.lanes == 0 ? "k::Mask(true)" : fmt::format("index < k::Lanes<k::uint>({}u)", count);
}

void Printer::print_run() {
  if (is_wide()) return print_wide_run();
  statement(fmt::format(
      R"(void run(const k::Dispatch& dispatch, std::uint64_t first, std::uint64_t end) {{
  const k::uvec3 count(dispatch.workgroup_count[0], dispatch.workgroup_count[1], dispatch.workgroup_count[2]);
  const k::uvec3 base(dispatch.base_workgroup[0], dispatch.base_workgroup[1], dispatch.base_workgroup[2]);
  for (std::uint64_t workgroup = first; workgroup < end; ++workgroup) {{
    const k::uvec3 id = base + k::uvec3(workgroup % count.x, workgroup / count.x % count.y, workgroup / count.x / count.y);
    k::uint index = 0;
    for (k::uint z = 0; z < {2}u; ++z)
      for (k::uint y = 0; y < {1}u; ++y)
        for (k::uint x = 0; x < {0}u; ++x) {{
          const k::uvec3 local(x, y, z);
          Invocation{{dispatch.resources, dispatch.push_constants, count, id, local, id * k::uvec3({0}u, {1}u, {2}u) + local, index++{3}}}
              .entry_point();
        }}
  }}
}}
)",
      workgroup_size_[0], workgroup_size_[1], workgroup_size_[2], options_.watched ? ", dispatch.watch" : ""));
}

void Printer::print_info() {
  std::uint32_t resources = 0;
  std::string slots;
  for (const rhi::ShaderBinding& binding : reflection_.bindings) {
    const char* kind = resource_kind_name(binding.kind);
    if (kind == nullptr) fail("a sampled image or sampler binding");
    slots += fmt::format("    {{{}, {}, {}, {}, k::ResourceKind::{}}},\n", binding.set, binding.binding, binding.count,
                         resources, kind);
    resources += std::max(binding.count, 1u);
  }
  const bool any = !reflection_.bindings.empty();
  if (any) statement("constexpr k::BindingSlot binding_slots[] = {\n", slots, "};");
  const std::string payload_size = incoming_payload_type_.empty() ? "0" : "sizeof(" + incoming_payload_type_ + ")";
  statement(fmt::format(
      "constexpr k::KernelInfo kernel_info = {{k::abi_version, {{{}, {}, {}}}, {}, {}, {}, {}, {}, k::Stage::{}, {}, "
      "{}, {}}};\n",
      workgroup_size_[0], workgroup_size_[1], workgroup_size_[2], reflection_.push_constant_size, resources,
      reflection_.bindings.size(), any ? "binding_slots" : "nullptr", is_traced() ? "nullptr" : "run",
      stage_name(reflection_.stage), is_traced() ? "call" : "nullptr", reflection_.shader_record_size, payload_size));
  statement("}  // namespace");
  statement("");
  statement("extern \"C\" __attribute__((visibility(\"default\"))) const tandem::kernel::KernelInfo* ",
            options_.entry_symbol, "() { return &kernel_info; }");
}

}  // namespace tandem::cpu
