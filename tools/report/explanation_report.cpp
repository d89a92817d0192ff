#include "tools/report/explanation_report.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <limits>
#include <string_view>

#include "tools/report/device_json.hpp"
#include "tools/report/job_report.hpp"
#include "tools/report/probe_report.hpp"

namespace tandem::tools {
namespace {

using compare::EventField;
using compare::EventPair;
using compare::FieldType;
using pathtracer::PathEvent;

constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

/// By the shortest decimal number that gives the float back; as a double it would be printed with seventeen digits.
nlohmann::ordered_json number_json(float value) {
  if (std::isnan(value)) return "nan";
  if (std::isinf(value)) return value > 0 ? "inf" : "-inf";
  return std::strtod(fmt::format("{}", value).c_str(), nullptr);
}

/// What the value names in the scene; empty where it names nothing.
std::string name_of(const EventField& field, const PathEvent& event, const compare::SceneNames& names) {
  if (field.type != FieldType::index || event.words[field.word] == none) return {};
  std::string text = names.text(field, event);
  return text == compare::field_text(field, event) ? std::string() : text;
}

nlohmann::ordered_json field_json(const EventField& field, const EventPair& pair, const compare::SceneNames& names) {
  nlohmann::ordered_json json;
  const bool equal = !compare::differs(pair, field);
  const auto add = [&](const PathEvent& event, const char* value, const char* name) {
    json[value] = value_json(field, event);
    if (const std::string text = name_of(field, event, names); !text.empty()) json[name] = text;
  };
  if (pair.a) add(*pair.a, "a", "name_a");
  if (pair.b && !equal) add(*pair.b, "b", "name_b");
  if (pair.a && pair.b && !equal) {
    if (const std::uint32_t ulp = compare::ulp_distance(field, *pair.a, *pair.b); ulp != none) json["ulp"] = ulp;
  }
  return json;
}

nlohmann::ordered_json divergence_json(const compare::Divergence& divergence) {
  nlohmann::ordered_json json = {{"segment", divergence.segment}, {"event", compare::name(divergence.a.kind())}};
  if (divergence.field != nullptr) {
    json["field"] = divergence.field->name;
    json["a"] = value_json(*divergence.field, divergence.a);
    json["b"] = value_json(*divergence.field, divergence.b);
    if (divergence.ulp_distance != none) json["ulp"] = divergence.ulp_distance;
    if (std::isfinite(divergence.relative_difference)) json["relative"] = divergence.relative_difference;
  } else {
    json["event_b"] = compare::name(divergence.b.kind());
  }
  json["class"] = compare::name(divergence.difference_class);
  json["sentence"] = divergence.sentence;
  if (divergence.exact_answer) {
    const std::uint32_t answer = *divergence.exact_answer;
    json["exact_answer"] = answer == none ? nlohmann::ordered_json(nullptr) : nlohmann::ordered_json(answer);
  }
  return json;
}

nlohmann::ordered_json sample_json(const compare::ExplainedSample& sample) {
  nlohmann::ordered_json json = {{"sample", sample.sample}, {"differs", sample.differs}};
  if (!sample.classified) return json;
  const std::optional<compare::DifferenceClass> worst = sample.classified->worst();
  json["class"] = worst ? nlohmann::ordered_json(compare::name(*worst)) : nlohmann::ordered_json(nullptr);
  json["divergences"] = nlohmann::ordered_json::array();
  for (const compare::Divergence& divergence : sample.classified->divergences)
    json["divergences"].push_back(divergence_json(divergence));
  return json;
}

nlohmann::ordered_json first_json(const compare::Explanation& explanation) {
  if (!explanation.first) return nullptr;
  const compare::FirstDifference& first = *explanation.first;
  const EventPair& pair = explanation.events[first.pair];
  nlohmann::ordered_json json = {
      {"index", first.pair}, {"segment", pair.segment()}, {"event", compare::name(pair.kind())}};
  if (first.field == nullptr) {
    json["only"] = pair.a ? "a" : "b";
  } else {
    json["field"] = first.field->name;
    json.update(field_json(*first.field, pair, explanation.names));
    if (std::isfinite(first.relative_difference)) json["relative"] = first.relative_difference;
  }
  return json;
}

}  // namespace

nlohmann::ordered_json value_json(const EventField& field, const PathEvent& event) {
  const std::uint32_t word = event.words[field.word];
  switch (field.type) {
    case FieldType::index:
      return word == none ? nlohmann::ordered_json(nullptr) : nlohmann::ordered_json(word);
    case FieldType::count:
      return word;
    case FieldType::bits:
      return fmt::format("{:#010x}", word);
    case FieldType::flag:
      return word != 0;
    case FieldType::choice:
      return compare::field_text(field, event);
    case FieldType::number:
      return number_json(event.number(field.word));
    default:
      break;
  }
  nlohmann::ordered_json vector = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < compare::word_count(field.type); ++i)
    vector.push_back(number_json(event.number(field.word + i)));
  return vector;
}

nlohmann::ordered_json events_json(std::span<const EventPair> pairs, const compare::SceneNames& names) {
  nlohmann::ordered_json events = nlohmann::ordered_json::array();
  for (const EventPair& pair : pairs) {
    nlohmann::ordered_json event = {{"segment", pair.segment()}, {"event", compare::name(pair.kind())}};
    if (!pair.a || !pair.b) event["only"] = pair.a ? "a" : "b";
    event["fields"] = nlohmann::ordered_json::object();
    for (const EventField& field : compare::fields_of(pair.kind()))
      event["fields"][field.name] = field_json(field, pair, names);
    events.push_back(std::move(event));
  }
  return events;
}

nlohmann::ordered_json to_json(const compare::Explanation& explanation) {
  nlohmann::ordered_json json = {{"device_a", to_json(explanation.a)},
                                 {"device_b", to_json(explanation.b)},
                                 {"arbiter", to_json(explanation.arbiter)},
                                 {"trace_a", pathtracer::name(explanation.trace_a)},
                                 {"trace_b", pathtracer::name(explanation.trace_b)},
                                 {"settings", to_json(explanation.job)},
                                 {"pixel", {explanation.pixel.x, explanation.pixel.y}},
                                 {"mismatches", explanation.mismatches()},
                                 {"samples", nlohmann::ordered_json::array()},
                                 {"sample", explanation.shown_sample().sample},
                                 {"first_difference", first_json(explanation)}};
  for (const compare::ExplainedSample& sample : explanation.samples) json["samples"].push_back(sample_json(sample));
  json["observed"] = {{"fields", explanation.observed.fields},
                      {"differing", explanation.observed.differing},
                      {"relative", explanation.observed.relative_difference}};
  json["events"] = events_json(explanation.events, explanation.names);
  if (explanation.probing) json["probes"] = to_json(*explanation.probing);
  json["format"] = json_format;
  json["version"] = TANDEM_VERSION;
  return json;
}

}  // namespace tandem::tools
