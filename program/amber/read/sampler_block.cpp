#include <fmt/format.h>

#include <array>
#include <span>
#include <utility>

#include "program/amber/read/parser.hpp"

// SAMPLER.
namespace tandem::program::amber {
namespace {

template <typename T>
using Word = std::pair<std::string_view, T>;

constexpr std::array<Word<rhi::Filter>, 2> filters = {
    {{"nearest", rhi::Filter::nearest}, {"linear", rhi::Filter::linear}}};
constexpr std::array<Word<rhi::AddressMode>, 5> address_modes = {
    {{"repeat", rhi::AddressMode::repeat},
     {"mirrored_repeat", rhi::AddressMode::mirrored_repeat},
     {"clamp_to_edge", rhi::AddressMode::clamp_to_edge},
     {"clamp_to_border", rhi::AddressMode::clamp_to_border},
     {"mirrored_clamp_to_edge", rhi::AddressMode::mirror_clamp_to_edge}}};
constexpr std::array<Word<rhi::BorderColor>, 6> border_colors = {
    {{"float_transparent_black", rhi::BorderColor::float_transparent_black},
     {"int_transparent_black", rhi::BorderColor::int_transparent_black},
     {"float_opaque_black", rhi::BorderColor::float_opaque_black},
     {"int_opaque_black", rhi::BorderColor::int_opaque_black},
     {"float_opaque_white", rhi::BorderColor::float_opaque_white},
     {"int_opaque_white", rhi::BorderColor::int_opaque_white}}};
constexpr std::array<Word<rhi::CompareOp>, 8> compare_ops = {{{"never", rhi::CompareOp::never},
                                                              {"less", rhi::CompareOp::less},
                                                              {"equal", rhi::CompareOp::equal},
                                                              {"less_or_equal", rhi::CompareOp::less_or_equal},
                                                              {"greater", rhi::CompareOp::greater},
                                                              {"not_equal", rhi::CompareOp::not_equal},
                                                              {"greater_or_equal", rhi::CompareOp::greater_or_equal},
                                                              {"always", rhi::CompareOp::always}}};

template <typename T, std::size_t n>
T one_of(Parser& parser, const std::array<Word<T>, n>& words, const Token& option) {
  const Token token = parser.name(fmt::format("a value of {}", option.text));
  for (const auto& [word, value] : words)
    if (token.is(word)) return value;
  parser.fail(token.position, fmt::format("'{}' is no value of {}", token.text.substr(0, 60), option.text));
}

}  // namespace

void read_sampler(Parser& parser) {
  rhi::SamplerDesc desc;
  const Position position = parser.lexer().position();
  desc.label = parser.new_name("sampler");
  desc.max_lod = 1.0f;
  bool compare = false;
  rhi::CompareOp compare_op = rhi::CompareOp::never;
  for (Token option = parser.next(); !option.ends_line(); option = parser.next()) {
    if (option.is("MAG_FILTER")) {
      desc.magnification = one_of(parser, filters, option);
    } else if (option.is("MIN_FILTER")) {
      desc.minification = one_of(parser, filters, option);
    } else if (option.is("ADDRESS_MODE_U")) {
      desc.address[0] = one_of(parser, address_modes, option);
    } else if (option.is("ADDRESS_MODE_V")) {
      desc.address[1] = one_of(parser, address_modes, option);
    } else if (option.is("ADDRESS_MODE_W")) {
      desc.address[2] = one_of(parser, address_modes, option);
    } else if (option.is("BORDER_COLOR")) {
      desc.border = one_of(parser, border_colors, option);
    } else if (option.is("MIN_LOD")) {
      desc.min_lod = static_cast<float>(parser.number("MIN_LOD").value);
    } else if (option.is("MAX_LOD")) {
      desc.max_lod = static_cast<float>(parser.number("MAX_LOD").value);
    } else if (option.is("NORMALIZED_COORDS")) {
      desc.unnormalized_coordinates = false;
    } else if (option.is("UNNORMALIZED_COORDS")) {
      desc.unnormalized_coordinates = true;
    } else if (option.is("COMPARE")) {
      compare = parser.on_or_off("COMPARE");
    } else if (option.is("COMPARE_OP")) {
      compare_op = one_of(parser, compare_ops, option);
    } else {
      parser.fail(option.position, fmt::format("'{}' is no option of SAMPLER", option.text.substr(0, 60)));
    }
  }
  if (desc.unnormalized_coordinates) desc.min_lod = desc.max_lod = 0.0f;
  if (compare) desc.compare = compare_op;
  if (!(desc.min_lod <= desc.max_lod))
    parser.fail(position, fmt::format("MIN_LOD of the sampler {} is larger than MAX_LOD", desc.label));
  parser.draft().samplers.push_back(std::move(desc));
}

}  // namespace tandem::program::amber
