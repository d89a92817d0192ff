#include <fmt/format.h>

#include <algorithm>

#include "program/amber/read/parser.hpp"

// BIND.
namespace tandem::program::amber {
namespace {

using Kind = DraftBinding::Kind;

struct BindingWord {
  std::string_view word;
  Kind kind;
  bool dynamic = false;
};
constexpr std::array<BindingWord, 9> binding_words = {{{"uniform", Kind::buffer},
                                                       {"storage", Kind::buffer},
                                                       {"uniform_dynamic", Kind::buffer, true},
                                                       {"storage_dynamic", Kind::buffer, true},
                                                       {"uniform_texel_buffer", Kind::texel_buffer},
                                                       {"storage_texel_buffer", Kind::texel_buffer},
                                                       {"storage_image", Kind::storage_image},
                                                       {"sampled_image", Kind::sampled_image},
                                                       {"combined_image_sampler", Kind::combined_image_sampler}}};

/// The names up to AS, KERNEL or DESCRIPTOR_SET: one, or several of an array.
std::vector<Token> read_names(Parser& parser, std::string_view what) {
  std::vector<Token> names = {parser.name(what)};
  while (!parser.at_line_end() && !parser.next_is("AS") && !parser.next_is("KERNEL") &&
         !parser.next_is("DESCRIPTOR_SET"))
    names.push_back(parser.name(what));
  return names;
}

void read_place(Parser& parser, DraftBinding& binding) {
  parser.expect("DESCRIPTOR_SET");
  binding.set = parser.whole_number32("the number of the descriptor set");
  parser.expect("BINDING");
  binding.binding = parser.whole_number32("the number of the binding");
}

std::vector<std::uint64_t> read_for_each(Parser& parser, std::size_t count, std::string_view what) {
  std::vector<std::uint64_t> values;
  for (std::size_t i = 0; i < count; ++i) values.push_back(parser.whole_number(what, ~std::uint32_t{0}));
  return values;
}

/// Replaces what was bound there, as a derived pipeline does with what it has of its parent.
void add(DraftPipeline& pipeline, std::vector<DraftBinding> bindings) {
  const DraftBinding& first = bindings.front();
  std::erase_if(pipeline.bindings,
                [&](const DraftBinding& each) { return each.set == first.set && each.binding == first.binding; });
  pipeline.bindings.insert(pipeline.bindings.end(), bindings.begin(), bindings.end());
}

void mark(Parser& parser, DraftData& data, const DraftBinding& binding, Position position) {
  const bool as_image = binding.kind == Kind::storage_image || binding.kind == Kind::sampled_image ||
                        binding.kind == Kind::combined_image_sampler;
  (as_image ? data.bound_as_image : data.bound_as_buffer) = true;
  const bool has_texels = as_image || binding.kind == Kind::texel_buffer;
  if (has_texels && !data.texel) parser.fail(position, fmt::format("the type of {} is none of texels", data.name));
  if (has_texels && !data.texel->format) parser.unsupported(position, fmt::format("the format {}", data.texel->name));
  if (as_image && !data.is_image)
    parser.fail(position, fmt::format("{} has no width and height: it is no IMAGE", data.name));
  if (as_image && data.samples > 1)
    parser.unsupported(data.position, fmt::format("an image with {} samples", data.samples));
  if (as_image && binding.base_level >= data.level_count)
    parser.fail(position, fmt::format("{} has {} levels, so BASE_MIP_LEVEL {} is none of them", data.name,
                                      data.level_count, binding.base_level));
}

void read_buffers(Parser& parser, DraftPipeline& pipeline) {
  const std::vector<Token> names = read_names(parser, "a buffer or image");
  std::vector<DraftBinding> bindings(names.size());
  for (std::size_t i = 0; i < names.size(); ++i) {
    bindings[i].index = parser.data(names[i].text, names[i].position);
    bindings[i].array_element = static_cast<std::uint32_t>(i);
  }
  if (parser.next_is("KERNEL")) parser.unsupported(names.front().position, "an argument of an OpenCL kernel");
  parser.expect("AS");
  const Token word = parser.name("what the buffer is bound as");
  if (parser.next_is("KERNEL")) parser.unsupported(names.front().position, "an argument of an OpenCL kernel");
  if (word.is("push_constant")) {
    pipeline.push_constants = bindings.front().index;
    parser.draft().data[bindings.front().index].bound_as_buffer = true;
    return;
  }
  if (word.is("color") || word.is("depth_stencil") || word.is("resolve"))
    parser.fail(word.position, fmt::format("{} is of graphics pipelines", word.text));
  const auto found =
      std::find_if(binding_words.begin(), binding_words.end(), [&](const auto& each) { return word.is(each.word); });
  if (found == binding_words.end())
    parser.fail(word.position, fmt::format("a buffer is not bound AS '{}'", word.text.substr(0, 60)));

  DraftBinding common;
  common.kind = found->kind;
  if (common.kind == Kind::combined_image_sampler) {
    parser.expect("SAMPLER");
    const Token sampler = parser.name("a sampler");
    common.sampler = parser.sampler(sampler.text, sampler.position);
  }
  read_place(parser, common);
  std::vector<std::uint64_t> offsets(names.size());
  std::vector<std::uint64_t> ranges(names.size(), rhi::whole_size);
  if (found->dynamic) {
    parser.expect("OFFSET");
    offsets = read_for_each(parser, names.size(), "an OFFSET for each buffer");
  }
  while (!parser.at_line_end()) {
    const Token option = parser.next();
    if (option.is("BASE_MIP_LEVEL") && common.kind != Kind::buffer && common.kind != Kind::texel_buffer) {
      common.base_level = parser.whole_number32("a level");
    } else if (option.is("DESCRIPTOR_OFFSET") && common.kind == Kind::buffer) {
      const auto more = read_for_each(parser, names.size(), "a DESCRIPTOR_OFFSET for each buffer");
      for (std::size_t i = 0; i < names.size(); ++i) offsets[i] += more[i];
    } else if (option.is("DESCRIPTOR_RANGE") && common.kind == Kind::buffer) {
      for (std::uint64_t& range : ranges) {
        // -1 is all of it.
        const Position position = parser.lexer().position();
        const Number number = parser.number("a DESCRIPTOR_RANGE for each buffer");
        if (number.floating || number.bits == 0) parser.fail(position, "a range is a number of bytes");
        range = number.negative ? rhi::whole_size : number.bits;
      }
    } else {
      parser.fail(option.position, fmt::format("'{}' is too much after BIND", option.text.substr(0, 60)));
    }
  }
  for (std::size_t i = 0; i < names.size(); ++i) {
    DraftBinding& binding = bindings[i];
    const std::size_t index = binding.index;
    binding = common;
    binding.index = index;
    binding.array_element = static_cast<std::uint32_t>(i);
    binding.offset = offsets[i];
    binding.size = ranges[i];
    mark(parser, parser.draft().data[index], binding, names[i].position);
  }
  add(pipeline, std::move(bindings));
}

void read_samplers(Parser& parser, DraftPipeline& pipeline) {
  const std::vector<Token> names = read_names(parser, "a sampler");
  std::vector<DraftBinding> bindings(names.size());
  if (parser.next_is("KERNEL")) parser.unsupported(names.front().position, "an argument of an OpenCL kernel");
  DraftBinding common;
  common.kind = Kind::sampler;
  read_place(parser, common);
  for (std::size_t i = 0; i < names.size(); ++i) {
    bindings[i] = common;
    bindings[i].index = parser.sampler(names[i].text, names[i].position);
    bindings[i].array_element = static_cast<std::uint32_t>(i);
  }
  add(pipeline, std::move(bindings));
}

void read_top_level_binding(Parser& parser, DraftPipeline& pipeline) {
  const Token name = parser.name("a top level");
  DraftBinding binding;
  binding.kind = Kind::acceleration_structure;
  binding.index = parser.top_level(name.text, name.position);
  read_place(parser, binding);
  add(pipeline, {binding});
}

}  // namespace

void read_binding(Parser& parser, DraftPipeline& pipeline) {
  const Token what = parser.name("BUFFER, SAMPLER or ACCELERATION_STRUCTURE");
  if (what.is("BUFFER") || what.is("BUFFER_ARRAY")) {
    read_buffers(parser, pipeline);
  } else if (what.is("SAMPLER") || what.is("SAMPLER_ARRAY")) {
    read_samplers(parser, pipeline);
  } else if (what.is("ACCELERATION_STRUCTURE")) {
    read_top_level_binding(parser, pipeline);
  } else {
    parser.fail(what.position, fmt::format("BUFFER, BUFFER_ARRAY, SAMPLER, SAMPLER_ARRAY or ACCELERATION_STRUCTURE is "
                                           "bound, not '{}'",
                                           what.text.substr(0, 60)));
  }
  parser.end_line("BIND");
}

}  // namespace tandem::program::amber
