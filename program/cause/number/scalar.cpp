#include "program/cause/number/scalar.hpp"

#include "program/record/components.hpp"

namespace tandem::program {

Real real_of(const Scalar& scalar) { return decoded(scalar.bits, format_of(scalar.width)); }

Scalar float_scalar(Real value, std::uint32_t width) {
  return {ComponentKind::floating, width, encoded(value, format_of(width))};
}

Scalars scalars_of(const RecordedWords& value) {
  Scalars scalars;
  for (const Component& component : value.components) {
    std::uint64_t bits = value.words.at(component.word);
    if (component.width == 64) bits |= std::uint64_t{value.words.at(component.word + 1)} << 32;
    if (component.kind == ComponentKind::boolean)
      bits = bits != 0 ? 1 : 0;
    else if (component.kind == ComponentKind::floating && component.width == 16)
      bits = encoded(rounded_to_nearest(decoded(bits, format_of(32)), format_of(16)), format_of(16));
    else
      bits &= mask_of(component.width);
    scalars.push_back({component.kind, component.width, bits});
  }
  return scalars;
}

RecordedWords words_of(const std::vector<Component>& components, std::span<const Scalar> scalars) {
  RecordedWords value{components, std::vector<std::uint32_t>(word_count(components))};
  for (std::size_t i = 0; i < components.size(); ++i) {
    std::uint64_t bits = scalars[i].bits;
    if (components[i].kind == ComponentKind::floating && components[i].width == 16)
      bits = encoded(real_of(scalars[i]), format_of(32));
    value.words[components[i].word] = static_cast<std::uint32_t>(bits);
    if (components[i].width == 64) value.words[components[i].word + 1] = static_cast<std::uint32_t>(bits >> 32);
  }
  return value;
}

}  // namespace tandem::program
