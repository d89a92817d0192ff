#include "tools/program/explanation_json.hpp"

#include <string>

#include "program/explain/source.hpp"
#include "program/explain/value_text.hpp"
#include "tools/report/device_json.hpp"

namespace tandem::tools::program_run {
namespace {

using nlohmann::ordered_json;
using namespace program;

std::string wrong_text(WrongDevice wrong) {
  switch (wrong) {
    case WrongDevice::a:
      return "a";
    case WrongDevice::b:
      return "b";
    case WrongDevice::both:
      return "both";
    case WrongDevice::unknown:
      return "unknown";
    case WrongDevice::none:
      break;
  }
  return "none";
}

ordered_json value_json(const RecordedWords& value) {
  ordered_json bits = ordered_json::array();
  for (std::size_t i = 0; i < value.components.size(); ++i) bits.push_back(bits_text(value, i));
  return {{"text", value_text(value)}, {"bits", bits}};
}

ordered_json divergence_json(const Divergence& divergence) {
  const Module& module = divergence.shader->module;
  const SourcePlace place = source_of(module, divergence.instruction);
  ordered_json json = {{"shader", divergence.shader->name},
                       {"file", place.file},
                       {"line", place.line},
                       {"source", place.text},
                       {"instruction", divergence.instruction},
                       {"operation", describe_instruction(module, divergence.instruction)},
                       {"class", std::string(name_of(divergence.judgement.cause))},
                       {"wrong", wrong_text(divergence.judgement.wrong)},
                       {"reason", divergence.judgement.reason}};
  if (!divergence.a.components.empty()) {
    json["a"] = value_json(divergence.a);
    json["b"] = value_json(divergence.b);
    if (const auto distance =
            program::ulp_distance(divergence.a, divergence.b, first_other_component(divergence.a, divergence.b)))
      json["ulp"] = *distance;
  }
  if (divergence.judgement.expected) json["exact"] = value_json(*divergence.judgement.expected);
  return json;
}

}  // namespace

ordered_json to_json(const Explanation& explanation, const Job& job, const ExplanationNames& names) {
  ordered_json json = {{"format", json_format},
                       {"input", names.input},
                       {"a", names.a},
                       {"b", names.b},
                       {"command", explanation.command + 1},
                       {"class", std::string(name_of(gravest(explanation)))},
                       {"invocations", explanation.launched},
                       {"recorded", explanation.a.request.invocations.size()},
                       {"values", explanation.lockstep.values}};
  if (explanation.other_bits) json["invocations_with_other_bits"] = *explanation.other_bits;
  json["outputs"] = ordered_json::array();
  for (const OutputState& output : explanation.outputs)
    json["outputs"].push_back(
        {{"name", output.is_image ? job.images[output.index].desc.label : job.buffers[output.index].name},
         {"equal", output.plain_equal},
         {"equal_in_lockstep", output.forced_equal},
         {"depends_on_order", output.order_changed},
         {"changed_by_recording_a", output.record_changed_a},
         {"changed_by_recording_b", output.record_changed_b}});
  json["instructions"] = ordered_json::array();
  for (const Site& site : explanation.lockstep.sites) {
    ordered_json one = {{"executions", site.executions}, {"differences", site.differences}};
    one.update(divergence_json(site.example));
    json["instructions"].push_back(std::move(one));
  }
  json["first_differences"] = ordered_json::array();
  for (std::size_t slot = 0; slot < explanation.first.size(); ++slot) {
    const FirstDivergence& first = explanation.first[slot];
    if (!first.value) continue;
    const auto id = id_of(explanation.a.request, explanation.a.request.invocations[slot]);
    ordered_json one = {{"invocation", id}, {"value", divergence_json(*first.value)}};
    if (first.decision) one["decision"] = divergence_json(*first.decision);
    json["first_differences"].push_back(std::move(one));
  }
  return json;
}

}  // namespace tandem::tools::program_run
