#include "program/cause/rearrangement.hpp"

#include <array>

#include "program/cause/environment.hpp"

namespace tandem::program {
namespace {

/// A scalar of an id.
struct Source {
  std::uint32_t id = 0;
  std::size_t component = 0;
  bool negated = false;
};

std::size_t scalar_count(const Module& module, std::uint32_t type) {
  const std::optional<std::vector<Component>> components = components_of(module, type);
  return components ? components->size() : 0;
}

/// One step back through an instruction that moves scalars of vectors.
std::optional<Source> moved_from(const Module& module, const Source& source) {
  const Instruction& made = definition(module, source.id);
  const std::vector<std::uint32_t>& words = made.words;
  const auto vector_size = [&](std::uint32_t id) { return scalar_count(module, definition(module, id).type); };
  switch (made.op) {
    case spv::OpCopyObject:
      return Source{words[3], source.component, source.negated};
    case spv::OpFNegate:
      return Source{words[3], source.component, !source.negated};
    case spv::OpCompositeExtract:
      if (words.size() != 5 || definition(module, definition(module, words[3]).type).op != spv::OpTypeVector)
        return std::nullopt;
      return Source{words[3], words[4], source.negated};
    case spv::OpVectorShuffle: {
      const std::size_t index = words[5 + source.component], first_size = vector_size(words[3]);
      if (index >= first_size + vector_size(words[4])) return std::nullopt;
      return index < first_size ? Source{words[3], index, source.negated}
                                : Source{words[4], index - first_size, source.negated};
    }
    case spv::OpCompositeConstruct: {
      std::size_t component = source.component;
      for (std::size_t i = 3; i < words.size(); ++i) {
        const std::size_t size = vector_size(words[i]);
        if (component < size) return Source{words[i], component, source.negated};
        component -= size;
      }
      return std::nullopt;
    }
    default:
      return std::nullopt;
  }
}

bool rounds(spv::Op op) {
  return op == spv::OpFAdd || op == spv::OpFSub || op == spv::OpFMul || op == spv::OpFDiv ||
         op == spv::OpVectorTimesScalar;
}

std::optional<Real> value_of(const Call& call, std::uint32_t id, std::size_t component) {
  if (!call.lookup) return std::nullopt;
  const std::optional<RecordedWords> recorded = call.lookup(id);
  if (!recorded || recorded->components.empty()) return std::nullopt;
  const Scalars scalars = scalars_of(*recorded);
  const Scalar& scalar = scalars[scalars.size() == 1 ? 0 : component];
  if (scalar.kind != ComponentKind::floating || !is_finite(real_of(scalar))) return std::nullopt;
  return real_of(scalar);
}

Range in_real_numbers(spv::Op op, Real x, Real y) {
  switch (op) {
    case spv::OpFAdd:
      return exactly(x + y);
    case spv::OpFSub:
      return exactly(x - y);
    case spv::OpFDiv:
      return exactly(x / y);
    default:
      return exactly(x * y);
  }
}

}  // namespace

bool may_combine(const Module& module, const Instruction& instruction) {
  return !is_decorated(module, instruction.result, spv::DecorationNoContraction);
}

std::optional<Range> unrounded(const Call& call, std::uint32_t id, std::size_t component, const Scalar& recorded) {
  Source source{id, component};
  for (int steps = 0; steps < 16; ++steps) {
    const std::optional<Source> before = moved_from(call.module, source);
    if (!before) break;
    source = *before;
  }
  const Instruction& made = definition(call.module, source.id);
  if (!rounds(made.op) || !may_combine(call.module, made)) return std::nullopt;
  const std::optional<Real> x = value_of(call, made.words[3], source.component);
  const std::optional<Real> y = value_of(call, made.words[4], source.component);
  if (x && y) {
    const Range value = in_real_numbers(made.op, *x, *y);
    if (!is_finite(value.exact)) return std::nullopt;
    return source.negated ? negate(value) : value;
  }
  if (call.lookup || (made.op != spv::OpFMul && made.op != spv::OpVectorTimesScalar)) return std::nullopt;
  const Real rounded = real_of(recorded), unit = ulp(rounded, format_of(recorded.width));
  if (!is_finite(rounded)) return std::nullopt;
  return Range{.exact = rounded, .low = rounded - unit, .high = rounded + unit};
}

}  // namespace tandem::program
