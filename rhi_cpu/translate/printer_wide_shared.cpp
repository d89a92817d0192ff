// Elements of shared arrays in the wide form: numbers that lanes load and store at once.

#include <utility>

#include <fmt/format.h>

#include "rhi_cpu/translate/printer.hpp"

namespace tandem::cpu {

using spirv_cross::SPIRConstant;

void Printer::keep_shared_offsets(const Instruction& i) {
  const std::uint32_t base = i.operand(0);
  const bool is_element = is_shared_pointer(base) && i.op() != spv::OpPtrAccessChain && !varies(base) &&
                          !escapes_.contains(i.result()) && !pointer_values_.contains(i.result());
  if (!is_element) return;
  const Type* type = &get<Type>(pointee(expression_type_id(base)));
  std::string offsets = "k::Words(0u)";
  for (std::size_t k = 1; k < i.operand_count(); ++k) {
    const std::uint32_t index = i.operand(k);
    const bool is_component = !is_array(*type) && type->columns == 1 && type->vecsize > 1;
    const bool is_known = is_array(*type) || (is_component && maybe_get<SPIRConstant>(index) != nullptr);
    if (!is_known || type_of(index).width != 32) return;
    std::string text;
    if (varies(index)) {
      const Mode before = std::exchange(mode_, Mode::wide);
      text = fmt::format("k::Words({})", value(index));
      mode_ = before;
      if (options_.robust) text = fmt::format("k::index_inside({}u, {})", array_length(*type), text);
    } else {
      text = index_inside(*type, fmt::format("std::uint32_t({})", value(index)));
      text = fmt::format("k::Words(std::uint32_t({}))", text);
    }
    type = &element_type(*type, 0);
    offsets += fmt::format(" + {} * k::Words(sizeof({}))", text, narrow_name(*type));
  }
  if (!has_register(*type)) return;
  statement("const k::Words o_", i.result(), " = ", offsets, ";");
  const std::string place = place_at(base);
  shared_offsets_[i.result()] = fmt::format("reinterpret_cast<std::byte*>(&{}), o_{}", place, i.result());
}

}  // namespace tandem::cpu
