#include "conformance/kit/shader_run.hpp"

#include <bit>

#include "conformance/kit/check.hpp"
#include "rhi/transfer.hpp"

namespace tandem::conformance {

Words answers(Context& context, const ShaderRun& run, std::size_t count) {
  rhi::Device& device = context.device();
  const rhi::ComputePipelineHandle pipeline =
      context.compute_pipeline("#version 460\n" + run.glsl, run.label, run.options);
  const rhi::BufferHandle buffer = words_buffer(device, Words(count), "answers of " + run.label);
  std::vector<rhi::BindGroupEntry> entries = run.entries;
  entries.push_back({.binding = 0, .resource = rhi::BufferRange{buffer}});
  const rhi::BindGroupHandle group =
      device.create_bind_group({.pipeline = pipeline, .entries = entries, .label = run.label});
  const rhi::CommandListHandle list = device.create_command_list(run.label);
  list->dispatch({.pipeline = pipeline,
                  .bind_groups = {group},
                  .push_constants = std::as_bytes(std::span(run.push_constants)),
                  .workgroup_count = run.workgroup_count});
  device.submit(list)->wait();
  return rhi::read<std::uint32_t>(device, buffer, count);
}

std::string with(std::string text, const std::string& what, const std::string& replacement) {
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + replacement.size()))
    text.replace(at, what.size(), replacement);
  return text;
}

std::vector<float> floats_of(std::span<const std::uint32_t> words) {
  std::vector<float> floats;
  for (const std::uint32_t word : words) floats.push_back(std::bit_cast<float>(word));
  return floats;
}

rhi::BufferHandle words_buffer(rhi::Device& device, const Words& words, const std::string& label) {
  return rhi::create_filled(device, words, rhi::BufferUsage::storage, label);
}

void check_words(const Words& seen, const Words& expected) {
  check_equal("the number of words", seen.size(), expected.size());
  for (std::size_t i = 0; i < seen.size(); ++i) check_equal(fmt::format("word {}", i), seen[i], expected[i]);
}

}  // namespace tandem::conformance
