#include "tools/report/probe_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <iterator>
#include <vector>

namespace tandem::tools {
namespace {

using compare::DifferenceClass;
using compare::ProbeDifference;
using compare::ProbeField;

/// Differences that the table and the JSON list.
constexpr std::size_t most_in_table = 10;
constexpr std::size_t most_in_json = 1000;

std::string value_text(const ProbeField& field, std::uint32_t bits) {
  if (field.kind == ProbeField::Kind::number) return fmt::format("{:.9g}", std::bit_cast<float>(bits));
  if (field.offset == offsetof(compare::ProbeAnswer, type)) {
    switch (static_cast<compare::AnswerType>(bits)) {
      case compare::AnswerType::miss:
        return "nothing";
      case compare::AnswerType::triangle:
        return "a triangle";
      case compare::AnswerType::sphere:
        return "a sphere";
      case compare::AnswerType::missing:
        return "no answer";
    }
  }
  if (field.offset == offsetof(compare::ProbeAnswer, hit_kind)) {
    if (bits == compare::hit_kind::front) return "front";
    if (bits == compare::hit_kind::back) return "back";
  }
  return fmt::format("{}", bits);
}

std::string sentence(const ProbeDifference& difference) {
  const std::string ulp = difference.field->kind == ProbeField::Kind::number
                              ? fmt::format(" ({} ULP apart)", difference.ulp)
                              : std::string();
  return fmt::format("pixel {},{} sample {} ray {}, {}: {} is {} on a, {} on b{}: {}, {}", difference.path.pixel.x,
                     difference.path.pixel.y, difference.path.sample, difference.ray_index, difference.trial,
                     difference.field->name, value_text(*difference.field, difference.a),
                     value_text(*difference.field, difference.b), ulp, compare::name(difference.kind),
                     compare::name(difference.ruling));
}

/// At most `count`, mismatches first.
std::vector<ProbeDifference> listed(const compare::Probing& probing, std::size_t count) {
  std::vector<ProbeDifference> differences = probing.differences;
  std::stable_partition(differences.begin(), differences.end(),
                        [](const ProbeDifference& difference) { return difference.kind == DifferenceClass::mismatch; });
  if (differences.size() > count) differences.resize(count);
  return differences;
}

nlohmann::ordered_json value_json(const ProbeField& field, std::uint32_t bits) {
  if (field.kind == ProbeField::Kind::number) return std::bit_cast<float>(bits);
  return bits;
}

nlohmann::ordered_json classes_json(const compare::ClassCounts& classes) {
  nlohmann::ordered_json json;
  for (std::size_t i = 0; i < classes.size(); ++i) json[compare::name(static_cast<DifferenceClass>(i))] = classes[i];
  return json;
}

}  // namespace

std::string table(const compare::Probing& probing) {
  std::string text;
  const auto line = [&](const char* name, const std::string& value) {
    fmt::format_to(std::back_inserter(text), "{:<18}{}\n", name, value);
  };
  std::uint64_t answers = 0, bit_equal = 0;
  for (const compare::ProbeTrial& trial : probing.trials) {
    answers += trial.rays;
    bit_equal += trial.bit_equal;
  }
  line("probes", fmt::format("{} trials of {} rays: {} of {} answers have the same bits", probing.trials.size(),
                             probing.rays, bit_equal, answers));
  const compare::ClassCounts classes = probing.classes();
  for (std::size_t i = 0; i < classes.size(); ++i)
    if (classes[i] > 0) line("", fmt::format("{} {}", classes[i], compare::name(static_cast<DifferenceClass>(i))));
  for (const std::string& reason : probing.left_out) line("left out", reason);
  // What rounding explains is for programs.
  const std::uint64_t mismatches = probing.count(DifferenceClass::mismatch);
  const std::size_t shown = std::min<std::uint64_t>(mismatches, most_in_table);
  for (const ProbeDifference& difference : listed(probing, shown)) line("", sentence(difference));
  if (shown < mismatches) line("", fmt::format("and {} more mismatches", mismatches - shown));
  return text;
}

nlohmann::ordered_json to_json(const compare::Probing& probing) {
  nlohmann::ordered_json json = {{"rays", probing.rays},
                                 {"classes", classes_json(probing.classes())},
                                 {"left_out", probing.left_out},
                                 {"trials", nlohmann::ordered_json::array()},
                                 {"difference_count", probing.differences.size()},
                                 {"differences", nlohmann::ordered_json::array()}};
  for (const compare::ProbeTrial& trial : probing.trials)
    json["trials"].push_back({{"name", trial.name},
                              {"rays", trial.rays},
                              {"bit_equal", trial.bit_equal},
                              {"classes", classes_json(trial.classes)}});
  for (const ProbeDifference& difference : listed(probing, most_in_json))
    json["differences"].push_back({{"pixel", {difference.path.pixel.x, difference.path.pixel.y}},
                                   {"sample", difference.path.sample},
                                   {"ray", difference.ray_index},
                                   {"trial", difference.trial},
                                   {"field", difference.field->name},
                                   {"a", value_json(*difference.field, difference.a)},
                                   {"b", value_json(*difference.field, difference.b)},
                                   {"ulp", difference.ulp},
                                   {"class", compare::name(difference.kind)},
                                   {"ruling", compare::name(difference.ruling)}});
  return json;
}

}  // namespace tandem::tools
