#include "program/explain/text.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "program/explain/slice.hpp"
#include "program/explain/source.hpp"
#include "program/explain/value_text.hpp"

namespace tandem::program {
namespace {

constexpr std::size_t most_sites = 12, most_slice = 12;

std::string place_text(const RecordedShader& shader, std::size_t instruction) {
  const SourcePlace place = source_of(shader.module, instruction);
  if (place.line == 0) return fmt::format("{}, instruction {}", shader.name, instruction);
  return fmt::format("{}:{}", place.file.empty() ? shader.name : place.file, place.line);
}

std::string id_text(const std::array<std::uint32_t, 3>& id) { return fmt::format("{},{},{}", id[0], id[1], id[2]); }

std::string wrong_text(const Judgement& judgement, const ExplanationNames& names) {
  switch (judgement.wrong) {
    case WrongDevice::a:
      return names.a + " is wrong";
    case WrongDevice::b:
      return names.b + " is wrong";
    case WrongDevice::both:
      return "both are wrong";
    case WrongDevice::unknown:
      return judgement.cause == Cause::mismatch ? "one of them is wrong" : "";
    case WrongDevice::none:
      break;
  }
  return "";
}

std::string judgement_text(const Judgement& judgement, const ExplanationNames& names) {
  std::string text(name_of(judgement.cause));
  if (const std::string wrong = wrong_text(judgement, names); !wrong.empty()) text += ": " + wrong;
  if (!judgement.reason.empty()) text += (text.find(':') == std::string::npos ? ": " : "; ") + judgement.reason;
  return text;
}

std::string value_line(const std::string& name, const RecordedWords& value, std::size_t component,
                       const std::optional<double>& error) {
  std::string line = fmt::format("    {:<8} {}   {}", name, value_text(value), bits_text(value, component));
  if (error) line += fmt::format("   {:.3g} ulp from the exact result", *error);
  return line + "\n";
}

std::string difference_text(const Divergence& difference, const ExplanationNames& names) {
  const RecordedShader& shader = *difference.shader;
  const SourcePlace place = source_of(shader.module, difference.instruction);
  const Instruction& instruction = shader.module.instructions[difference.instruction];
  std::string text = fmt::format("  {}\n", place_text(shader, difference.instruction));
  if (!place.text.empty()) text += fmt::format("    {}\n", place.text);
  const std::string operation = describe_instruction(shader.module, difference.instruction);
  text += instruction.result == 0 ? fmt::format("    {}\n", operation)
                                  : fmt::format("    {} = {}\n", name_of(shader.module, instruction.result), operation);
  for (std::size_t i = 0; i < difference.operands.size(); ++i)
    if (difference.operands[i])
      text += fmt::format("      {} = {}\n", name_of(shader.module, instruction.words[instruction.used_ids[i]]),
                          value_text(*difference.operands[i]));
  if (difference.a.components.empty()) return text;
  const std::size_t component = first_other_component(difference.a, difference.b);
  text += value_line(names.a, difference.a, component, difference.judgement.error_a);
  text += value_line(names.b, difference.b, component, difference.judgement.error_b);
  if (difference.judgement.expected)
    text += value_line("exact", *difference.judgement.expected, component, std::nullopt);
  if (const std::optional<std::uint64_t> distance = ulp_distance(difference.a, difference.b, component))
    text += fmt::format("    {} ulp apart\n", *distance);
  return text;
}

std::string slice_text(const Explanation& explanation, const Divergence& difference) {
  std::string text;
  const Module& module = difference.shader->module;
  for (const SliceEntry& entry : slice_of(*explanation.launch, explanation.a, difference, most_slice)) {
    const SourcePlace place = source_of(module, entry.instruction);
    text += fmt::format("    {:>6}  {} = {}  ({})\n", place.line != 0 ? fmt::format("{}", place.line) : "",
                        name_of(module, module.instructions[entry.instruction].result), value_text(entry.value),
                        describe_instruction(module, entry.instruction));
  }
  return text.empty() ? "" : "  Its operands come from (line, value):\n" + text;
}

std::string sites_text(const Explanation& explanation, const ExplanationNames& names) {
  std::string text;
  const std::vector<Site>& sites = explanation.lockstep.sites;
  for (std::size_t i = 0; i < std::min(sites.size(), most_sites); ++i) {
    const Site& site = sites[i];
    text += fmt::format("  {:>9} of {:>9}  {}  {}\n", site.differences, site.executions,
                        place_text(*site.shader, site.instruction),
                        describe_instruction(site.shader->module, site.instruction));
    text += fmt::format("                          {}\n", judgement_text(site.example.judgement, names));
  }
  if (sites.size() > most_sites) text += fmt::format("  and {} more instructions\n", sites.size() - most_sites);
  return text;
}

std::string output_text(const OutputState& output, bool all_recorded, const Job& job, const ExplanationNames& names) {
  const std::string name = output.is_image ? job.images[output.index].desc.label : job.buffers[output.index].name;
  std::string text = fmt::format("  {} {}: {}", output.is_image ? "image" : "buffer", name,
                                 output.plain_equal ? "equal bits" : "other bits");
  if (!output.plain_equal && output.forced_equal && all_recorded)
    text += fmt::format(", equal once {} goes on with the values of {}", names.b, names.a);
  if (!output.forced_equal)
    text += fmt::format(", and other bits even though {} goes on with the values of {}", names.b, names.a);
  if (output.order_changed) text += "; depends on the order of invocations";
  for (const auto& [changed, device] :
       {std::pair(output.record_changed_a, names.a), {output.record_changed_b, names.b}})
    if (changed) text += fmt::format("; {} computes other bits while it records (it rearranges arithmetic)", device);
  return text + "\n";
}

}  // namespace

std::string explanation_text(const Explanation& explanation, const Job& job, const ExplanationNames& names) {
  if (explanation.launch == nullptr) return fmt::format("{}: no command runs shaders\n", names.input);
  const auto& size = explanation.launch->size;
  std::string text =
      fmt::format("{}, command {} of {}: {} x {} x {} invocations; a {}, b {}\n", names.input, explanation.command + 1,
                  job.commands.size(), size[0], size[1], size[2], names.a, names.b);
  if (explanation.other_bits)
    text += fmt::format("{} of {} invocations compute other bits\n", *explanation.other_bits, explanation.launched);
  if (!explanation.slot) return text + "no invocation computes other bits\n";
  for (const OutputState& output : explanation.outputs)
    text += output_text(output, explanation.all_recorded, job, names);

  const LockstepComparison& lockstep = explanation.lockstep;
  text +=
      fmt::format("\nIn lockstep ({} with the operands of {}): {} values of {} invocations, {} instructions differ\n",
                  names.b, names.a, lockstep.values, explanation.a.request.invocations.size(), lockstep.sites.size());
  text += sites_text(explanation, names);
  if (lockstep.parted != 0) text += fmt::format("  {} invocations ran other shaders for a ray\n", lockstep.parted);
  if (lockstep.incomplete != 0)
    text += fmt::format("  the records of {} invocations were cut off\n", lockstep.incomplete);

  const std::size_t slot = *explanation.slot;
  text +=
      fmt::format("\nInvocation {}\n", id_text(id_of(explanation.a.request, explanation.a.request.invocations[slot])));
  const FirstDivergence& first = explanation.first[slot];
  if (first.value) {
    text += fmt::format("First other bits, behind {} equal values:\n", first.value->order);
    text += difference_text(*first.value, names);
    text += fmt::format("    {}\n", judgement_text(first.value->judgement, names));
    text += slice_text(explanation, *first.value);
  } else {
    text += "computes the same bits on both devices\n";
  }
  if (first.decision) {
    text += "First other decision:\n" + difference_text(*first.decision, names);
    text += slice_text(explanation, *first.decision);
  }
  if (!lockstep.sites.empty()) {
    const Divergence& gravest = lockstep.sites.front().example;
    const bool shown = first.value && first.value->instruction == gravest.instruction && gravest.slot == slot;
    if (!shown) {
      text += "Gravest difference with equal operands:\n" + difference_text(gravest, names);
      text += fmt::format("    {}\n", judgement_text(gravest.judgement, names));
    }
  }
  return text;
}

}  // namespace tandem::program
