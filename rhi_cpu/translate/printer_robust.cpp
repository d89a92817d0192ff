// Accesses of kernels for devices with robust access, and loops of kernels for devices with a time limit.

#include <algorithm>

#include <fmt/format.h>

#include "rhi_cpu/translate/printer.hpp"

namespace tandem::cpu {

using spirv_cross::SPIRType;

namespace {

/// Whether a value's bytes in memory are those of C++: a scalar, or a vector without gaps.
bool lies_as_it_is(const SPIRType& type, const Address& address) {
  return type.array.empty() && !type.pointer && type.basetype != SPIRType::Struct && type.columns == 1 &&
         (type.vecsize == 1 || address.component_stride == 0);
}

}  // namespace

std::uint32_t Printer::memory_extent(std::uint32_t type_id, const Address& address) const {
  const Type& type = get<Type>(type_id);
  const std::uint32_t scalar = type.width / 8;
  if (is_array(type))
    return (array_length(type) - 1) * get_decoration(type_id, spv::DecorationArrayStride) +
           memory_extent(type.parent_type, address);
  if (is_pointer(type)) return sizeof(std::uint64_t);
  if (type.basetype == SPIRType::Struct) {
    std::uint32_t extent = 0;
    for (std::uint32_t i = 0; i < type.member_types.size(); ++i) {
      const Address member = {.bytes = "",
                              .resource = "",
                              .matrix_stride = matrix_stride(type.self, i),
                              .row_major = has_member_decoration(type.self, i, spv::DecorationRowMajor)};
      extent = std::max(extent, get_member_decoration(type.self, i, spv::DecorationOffset) +
                                    memory_extent(type.member_types[i], member));
    }
    return extent;
  }
  if (type.columns > 1) {
    const std::uint32_t lines = address.row_major ? type.vecsize : type.columns;
    const std::uint32_t length = address.row_major ? type.columns : type.vecsize;
    return (lines - 1) * address.matrix_stride + length * scalar;
  }
  const std::uint32_t stride = address.component_stride != 0 ? address.component_stride : scalar;
  return (type.vecsize - 1) * stride + scalar;
}

bool Printer::is_guarded(const Address& address) const { return options_.robust && !address.data.empty(); }

std::string Printer::guarded_load(std::uint32_t type_id, const Address& address) {
  if (!is_guarded(address)) return load_text(type_id, address);
  if (lies_as_it_is(get<Type>(type_id), address))
    return fmt::format("k::load_inside<{}>({}, {}, {})", type_name(get<Type>(type_id)), address.data, address.size,
                       printed(address));
  Address inside = address;
  inside.bytes = "inside";
  inside.offset = 0;
  return fmt::format("k::read_inside<{}>({}, {}, {}, [](const std::byte* inside) {{ return {}; }})",
                     memory_extent(type_id, address), address.data, address.size, printed(address),
                     load_text(type_id, inside));
}

std::string Printer::guarded_store(std::uint32_t type_id, const Address& address, const std::string& value) {
  if (!is_guarded(address)) return store_text(type_id, address, value);
  if (lies_as_it_is(get<Type>(type_id), address))
    return fmt::format("k::store_inside<{}>({}, {}, {}, {})", type_name(get<Type>(type_id)), address.data, address.size,
                       printed(address), value);
  Address inside = address;
  inside.bytes = "inside";
  inside.offset = 0;
  return fmt::format("k::write_inside<{}>({}, {}, {}, [&](std::byte* inside) {{ {}; }})",
                     memory_extent(type_id, address), address.data, address.size, printed(address),
                     store_text(type_id, inside, value));
}

std::string Printer::guarded_pointer(std::uint32_t type_id, const Address& address) {
  if (!is_guarded(address)) return printed(address);
  return fmt::format("k::pointer_inside<{}>({}, {}, {}, k::Nowhere{{}})", memory_extent(type_id, address), address.data,
                     address.size, printed(address));
}

std::string Printer::index_inside(const Type& type, const std::string& index) const {
  // A vector's own operator stays inside of it.
  const bool is_matrix = !is_array(type) && type.columns > 1;
  if (!options_.robust || (!is_array(type) && !is_matrix)) return index;
  return fmt::format("k::index_inside({}, std::size_t({}))", is_matrix ? type.columns : array_length(type), index);
}

std::string Printer::descriptor_count(std::uint32_t variable) const {
  if (get<spirv_cross::SPIRVariable>(variable).parameter != nullptr) {
    std::uint32_t count = 1;
    for (const Type* type = &get<Type>(pointee(get<spirv_cross::SPIRVariable>(variable).basetype)); is_array(*type);
         type = &get<Type>(type->parent_type))
      count *= array_length(*type);
    return std::to_string(count);
  }
  const rhi::ShaderBinding* binding = binding_of(variable);
  if (binding == nullptr) return "0";
  if (binding->count != 0) return std::to_string(binding->count);
  return fmt::format("resources[{}].size", first_resource_of(variable));
}

void Printer::print_look() {
  const std::string watch = is_traced() ? "shader_call.watch" : "watch";
  statement("if (--rounds == 0) rounds = k::look(", watch, ");");
}

}  // namespace tandem::cpu
