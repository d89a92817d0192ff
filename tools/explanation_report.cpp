#include "tools/explanation_report.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <limits>

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

}  // namespace tandem::tools
