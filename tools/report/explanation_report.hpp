#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <string>

#include "compare/path/alignment.hpp"
#include "compare/path/scene_names.hpp"
#include "compare/session/explanation.hpp"

/// Paths on two devices, for people and for programs.
namespace tandem::tools {

/// One object for each pair: {"segment": 2, "event": "ray", "fields": {NAME: {"a": VALUE, "b": VALUE, "ulp": N}}}.
///
/// "b" and "ulp" are absent where b has the same bits, "ulp" also where there is no such distance (what is no float,
/// and NaNs). Of an event that only one device has, which "only" ("a" or "b") says, there is only its own value. Values
/// are numbers, arrays of numbers, booleans, names of choices, "0x..." for random bits, null for an index that names
/// nothing, and "nan", "inf" and "-inf"; a number read as a float has the device's bits. "name_a" and "name_b" say what
/// a number names in the scene.
nlohmann::ordered_json events_json(std::span<const compare::EventPair> pairs, const compare::SceneNames& names);

/// The value of a field as events_json has it.
nlohmann::ordered_json value_json(const compare::EventField& field, const pathtracer::PathEvent& event);

struct ExplanationTableOptions {
  bool all_events = false;  ///< every event with every field; else those where the paths part, and of later ones a line
  bool colors = false;      ///< for terminals
};

/// What differs first and why, then the events side by side.
std::string table(const compare::Explanation& explanation, const ExplanationTableOptions& options = {});

/// The same for programs, with all events; docs/guide/explain.md lists the keys.
nlohmann::ordered_json to_json(const compare::Explanation& explanation);

}  // namespace tandem::tools
