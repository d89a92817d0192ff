#include "program/record/word_code.hpp"

namespace tandem::program {

std::uint32_t scalar_type(Globals& globals, const Component& component) {
  switch (component.kind) {
    case ComponentKind::boolean:
      return globals.bool_type();
    case ComponentKind::floating:
      return globals.scalar_type(spv::OpTypeFloat, component.width, false);
    default:
      return globals.scalar_type(spv::OpTypeInt, component.width, component.kind == ComponentKind::signed_integer);
  }
}

void append_words(Code& code, const Component& component, std::uint32_t scalar, std::uint32_t* words) {
  Globals& globals = code.globals();
  const std::uint32_t uint = globals.uint_type();
  if (component.kind == ComponentKind::boolean) {
    words[0] = code.value(spv::OpSelect, uint, {scalar, globals.constant(1), globals.constant(0)});
  } else if (component.width == 64) {
    const std::uint32_t halves = code.value(spv::OpBitcast, globals.uint_vector(2), {scalar});
    words[0] = code.value(spv::OpCompositeExtract, uint, {halves, 0});
    words[1] = code.value(spv::OpCompositeExtract, uint, {halves, 1});
  } else if (component.width < 32 && component.kind == ComponentKind::floating) {
    words[0] = code.value(spv::OpBitcast, uint, {code.value(spv::OpFConvert, globals.float_type(), {scalar})});
  } else if (component.width < 32) {
    words[0] = code.value(spv::OpUConvert, uint, {scalar});
  } else {
    words[0] = component.kind == ComponentKind::unsigned_integer ? scalar : code.value(spv::OpBitcast, uint, {scalar});
  }
}

}  // namespace tandem::program
