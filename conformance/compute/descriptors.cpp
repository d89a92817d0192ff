#include "conformance/kit/cases.hpp"
#include "conformance/kit/check.hpp"
#include "conformance/kit/shader_run.hpp"
#include "rhi/transfer.hpp"

/// descriptors.*: what a bind group may hold besides one resource at each binding.
namespace tandem::conformance {
namespace {

using Capabilities = rhi::Capabilities;

rhi::BindGroupEntry buffer_at(rhi::Device& device, std::uint32_t binding, std::uint32_t element, const Words& words) {
  return {.binding = binding,
          .resource = rhi::BufferRange{words_buffer(device, words, "element " + std::to_string(element))},
          .array_element = element};
}

const std::string unsized_buffers = R"(
#extension GL_EXT_nonuniform_qualifier : require
layout(local_size_x = 4) in;
layout(binding = 0) buffer Answers { uint answers[]; };
layout(binding = 1) readonly buffer Source { uint length; uint words[]; } sources[];
layout(push_constant) uniform Elements { uvec4 elements; };
void main() {
  uint i = gl_LocalInvocationIndex;
  uint element = elements[i];
  answers[i] = sources[nonuniformEXT(element)].words[i];
  answers[4 + i] = sources[elements[3]].words.length();
}
)";

void add_array_cases(Cases& cases) {
  const Group unsized_arrays = {
      cases, "descriptors.arrays", {&Capabilities::unsized_arrays, &Capabilities::non_uniform_indexing}};
  unsized_arrays.add("unsized", "an array without a length has the elements that are bound", [](Context& context) {
    rhi::Device& device = context.device();
    if (!device.info().capabilities.partially_bound)
      throw Unsupported("the device wants every element of an array bound");
    ShaderRun run = {.label = "unsized buffers", .glsl = unsized_buffers, .push_constants = {0, 3, 700, 3}};
    run.entries = {buffer_at(device, 1, 0, {9, 10, 11}), buffer_at(device, 1, 3, {9, 20, 21, 22, 23, 24}),
                   buffer_at(device, 1, 700, {9, 30, 31, 32, 33})};
    check_words(answers(context, run, 8), Words{10, 21, 32, 23, 5, 5, 5, 5});
  });
  const Group sized = {cases, "descriptors.arrays", {&Capabilities::partially_bound}};
  sized.add("partially_bound", "elements that no invocation uses may be left out", [](Context& context) {
    rhi::Device& device = context.device();
    ShaderRun run = {.label = "partially bound",
                     .glsl = R"(
layout(local_size_x = 1) in;
layout(binding = 0) buffer Answers { uint answers[]; };
layout(binding = 1) readonly buffer Source { uint word; } sources[5];
layout(push_constant) uniform Element { uint element; };
void main() { answers[0] = sources[element].word; }
)",
                     .push_constants = {3}};
    run.entries = {buffer_at(device, 1, 3, {42})};
    check_words(answers(context, run, 1), Words{42});
  });
}

void add_alias_cases(const Group& group) {
  group.add("blocks", "several blocks may view one binding", [](Context& context) {
    ShaderRun run = {.label = "aliased blocks", .glsl = R"(
layout(local_size_x = 1) in;
layout(binding = 0) buffer Answers { uint answers[]; };
layout(binding = 1) buffer Words { uint words[4]; };
layout(binding = 1) readonly buffer Vectors { uvec4 vectors[]; };
layout(binding = 1) readonly buffer Floats { float floats[]; };
void main() {
  answers[0] = words[1];
  answers[1] = vectors[0].z;
  answers[2] = uint(floats[3] * 2);
}
)"};
    run.entries = {buffer_at(context.device(), 1, 0, {1, 2, 3, 0x40a00000})};
    check_words(answers(context, run, 3), Words{2, 3, 10});
  });
}

}  // namespace

void add_descriptor_cases(Cases& cases) {
  add_array_cases(cases);
  add_alias_cases({cases, "descriptors.aliases", {}});
}

}  // namespace tandem::conformance
