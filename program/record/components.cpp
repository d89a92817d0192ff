#include "program/record/components.hpp"

#include <bit>
#include <glm/gtc/packing.hpp>

namespace tandem::program {
namespace {

bool collect(const Module& module, std::uint32_t type, Component at, std::vector<Component>& out);

bool collect_elements(const Module& module, std::uint32_t type, std::uint32_t count, const Component& at,
                      std::vector<Component>& out) {
  if (count > most_words) return false;
  for (std::uint32_t i = 0; i < count; ++i) {
    Component inner = at;
    inner.path.push_back(i);
    if (!collect(module, type, std::move(inner), out)) return false;
  }
  return true;
}

bool collect(const Module& module, std::uint32_t type, Component at, std::vector<Component>& out) {
  const Instruction& definition = program::definition(module, type);
  const std::vector<std::uint32_t>& words = definition.words;
  switch (definition.op) {
    case spv::OpTypeBool:
      at.kind = ComponentKind::boolean;
      break;
    case spv::OpTypeInt:
      at.kind = words[3] != 0 ? ComponentKind::signed_integer : ComponentKind::unsigned_integer;
      at.width = words[2];
      break;
    case spv::OpTypeFloat:
      at.kind = ComponentKind::floating;
      at.width = words[2];
      break;
    case spv::OpTypeVector:
    case spv::OpTypeMatrix:
      return collect_elements(module, words[2], words[3], at, out);
    case spv::OpTypeArray: {
      const Instruction& length = program::definition(module, words[3]);
      return length.op == spv::OpConstant && collect_elements(module, words[2], length.words[3], at, out);
    }
    case spv::OpTypeStruct:
      for (std::uint32_t i = 0; i + 2 < words.size(); ++i) {
        Component inner = at;
        inner.path.push_back(i);
        if (!collect(module, words[i + 2], std::move(inner), out)) return false;
      }
      return true;
    default:
      return false;
  }
  at.word = word_count(out);
  out.push_back(std::move(at));
  return word_count(out) <= most_words;
}

}  // namespace

std::uint32_t word_count(const std::vector<Component>& components) {
  return components.empty() ? 0 : components.back().word + components.back().word_count();
}

std::uint32_t recorded_word(const Component& component, std::uint32_t bits) {
  if (component.kind == ComponentKind::floating)
    return std::bit_cast<std::uint32_t>(glm::unpackHalf1x16(static_cast<std::uint16_t>(bits)));
  return bits & ((1u << component.width) - 1);
}

std::optional<std::vector<Component>> components_of(const Module& module, std::uint32_t type) {
  std::vector<Component> components;
  if (type == 0 || !collect(module, type, {}, components) || components.empty()) return std::nullopt;
  return components;
}

}  // namespace tandem::program
