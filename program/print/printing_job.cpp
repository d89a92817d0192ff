#include "program/print/printing_job.hpp"

#include <algorithm>
#include <cstring>
#include <tuple>

#include "rhi/entry_point.hpp"

namespace tandem::program {
namespace {

std::vector<std::uint32_t> one_entry_point(const Shader& shader) {
  return rhi::with_one_entry_point(shader.spirv, shader.entry_point, shader.name);
}

/// Behind all bindings of set 0 that a shader uses or a pipeline binds.
std::uint32_t free_binding(const Job& job) {
  std::uint32_t binding = 0;
  for (const Shader& shader : job.shaders)
    for (const rhi::ShaderBinding& used : rhi::reflect(one_entry_point(shader), shader.name).bindings)
      if (used.set == 0) binding = std::max(binding, used.binding + 1);
  for (const Pipeline& pipeline : job.pipelines)
    for (const Binding& bound : pipeline.bindings)
      if (bound.set == 0) binding = std::max(binding, bound.binding + 1);
  return binding;
}

std::vector<std::byte> empty_buffer(std::uint32_t most_lines, const std::vector<PrintCall>& calls) {
  std::uint32_t slot_words = 1;
  for (const PrintCall& call : calls) slot_words = std::max(slot_words, call.slot_words);
  std::vector<std::uint32_t> words(print_header_words + (std::size_t{most_lines} + 1) * slot_words);
  words[print_header_capacity] = most_lines;
  words[print_header_slot_words] = slot_words;
  const auto bytes = std::as_bytes(std::span(words));
  return {bytes.begin(), bytes.end()};
}

}  // namespace

std::optional<PrintingJob> printing_job(const Job& job, std::uint32_t most_lines) {
  if (std::ranges::none_of(job.shaders, [](const Shader& shader) { return prints(shader.spirv); })) return std::nullopt;
  PrintingJob printing{.job = job, .buffer = job.buffers.size(), .calls = {}};
  const std::uint32_t binding = free_binding(job);
  for (Shader& shader : printing.job.shaders) {
    if (!prints(shader.spirv)) continue;
    PrintingShader rewritten = with_print_buffer(
        one_entry_point(shader), shader.name,
        {.set = 0, .binding = binding, .first_call = static_cast<std::uint32_t>(printing.calls.size())});
    shader.spirv = std::move(rewritten.spirv);
    shader.entry_point.clear();
    std::ranges::move(rewritten.calls, std::back_inserter(printing.calls));
  }
  printing.job.buffers.push_back(
      {.name = "lines of debugPrintfEXT", .initial = empty_buffer(most_lines, printing.calls)});
  for (Pipeline& pipeline : printing.job.pipelines)
    pipeline.bindings.push_back({.set = 0, .binding = binding, .resource = BufferUse{printing.buffer}});
  return printing;
}

std::vector<PrintCall> print_calls(const Job& job) {
  std::vector<PrintCall> calls;
  for (const Shader& shader : job.shaders)
    if (prints(shader.spirv))
      std::ranges::move(with_print_buffer(one_entry_point(shader), shader.name, {}).calls, std::back_inserter(calls));
  return calls;
}

PrintedLines printed_lines(const PrintingJob& printing, std::span<const std::byte> contents) {
  std::vector<std::uint32_t> words(contents.size() / sizeof(std::uint32_t));
  std::memcpy(words.data(), contents.data(), words.size() * sizeof(std::uint32_t));
  const std::uint32_t count = words[print_header_count], slot_words = words[print_header_slot_words];
  const std::uint32_t kept = std::min(count, words[print_header_capacity]);
  PrintedLines result{.lines = {}, .left_out = count - kept};
  for (std::uint32_t i = 0; i < kept; ++i) {
    const auto slot = std::span(words).subspan(print_header_words + std::size_t{i} * slot_words, slot_words);
    if (slot[0] == 0 || slot[0] > printing.calls.size()) continue;  // the device was stopped before it wrote the line
    const PrintCall& call = printing.calls[slot[0] - 1];
    PrintedLine line{.invocation = {slot[1], slot[2], slot[3]},
                     .text = print_text(call.format, call.arguments, slot.subspan(4))};
    if (line.text.ends_with('\n')) line.text.pop_back();
    result.lines.push_back(std::move(line));
  }
  std::ranges::stable_sort(result.lines, {}, [](const PrintedLine& line) {
    return std::tuple(line.invocation[2], line.invocation[1], line.invocation[0]);
  });
  return result;
}

}  // namespace tandem::program
