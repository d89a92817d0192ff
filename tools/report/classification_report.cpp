#include "tools/report/classification_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <vector>

#include "tools/report/device_json.hpp"

namespace tandem::tools {
namespace {

using compare::ClassifiedPath;
using compare::DifferenceClass;
using compare::Divergence;

/// Divergences that the table and the JSON list, and pixels that the JSON does.
constexpr std::size_t most_in_table = 10;
constexpr std::size_t most_in_json = 1000;
constexpr std::size_t most_pixels_in_json = 100000;

struct Listed {
  const ClassifiedPath* path;
  const Divergence* divergence;
};

/// At most `count` divergences that are no mere rounding, the worst first.
std::vector<Listed> listed(const compare::Classification& classification, std::size_t count, bool rounding) {
  std::vector<Listed> all;
  for (const ClassifiedPath& path : classification.paths)
    for (const Divergence& divergence : path.divergences)
      if (rounding || divergence.difference_class != DifferenceClass::rounding) all.push_back({&path, &divergence});
  std::stable_sort(all.begin(), all.end(), [](const Listed& first, const Listed& second) {
    return first.divergence->difference_class > second.divergence->difference_class;
  });
  if (all.size() > count) all.resize(count);
  return all;
}

nlohmann::ordered_json counts_json(const compare::ClassCounts& counts) {
  nlohmann::ordered_json json;
  for (std::size_t i = 0; i < counts.size(); ++i) json[compare::name(static_cast<DifferenceClass>(i))] = counts[i];
  return json;
}

}  // namespace

std::string table(const compare::Classification& classification) {
  std::string text;
  const auto line = [&](const std::string& name, const std::string& value) {
    fmt::format_to(std::back_inserter(text), "{:<18}{}\n", name, value);
  };
  line("classified", fmt::format("{} of {} differing pixels, and a survey of {}", classification.classed_pixels,
                                 classification.differing_pixels, classification.surveyed_pixels));
  line("paths", fmt::format("{} traced again, {} differ", classification.traced_paths, classification.differing_paths));
  for (std::size_t i = 0; i < compare::difference_class_count; ++i) {
    const auto difference_class = static_cast<DifferenceClass>(i);
    const bool zero = classification.pixel_counts[i] == 0 && classification.divergence_counts[i] == 0;
    if (zero && difference_class != DifferenceClass::mismatch) continue;
    line("", fmt::format("{}: {} pixels, {} times.{}{}", compare::name(difference_class),
                         classification.pixel_counts[i], classification.divergence_counts[i], zero ? "" : " ",
                         zero ? "" : compare::meaning(difference_class)));
  }
  std::size_t wrong_sums = 0;
  for (const compare::ClassifiedPixel& pixel : classification.pixels) {
    if (pixel.wrong_sum == 0 || ++wrong_sums > most_in_table) continue;
    line("", fmt::format("pixel {},{}: the image of {} is not the sum of its paths", pixel.pixel.x, pixel.pixel.y,
                         pixel.wrong_sum));
  }
  if (wrong_sums > most_in_table) line("", fmt::format("and {} more such pixels", wrong_sums - most_in_table));
  for (const Listed& each : listed(classification, most_in_table, false)) {
    const pathtracer::PathId& path = each.path->path;
    line("", fmt::format("pixel {},{} sample {}, {}: {}", path.pixel.x, path.pixel.y, path.sample,
                         compare::name(each.divergence->difference_class), each.divergence->sentence));
  }
  return text;
}

nlohmann::ordered_json to_json(const Divergence& divergence) {
  nlohmann::ordered_json json = {{"class", compare::name(divergence.difference_class)},
                                 {"segment", divergence.segment},
                                 {"event", compare::name(divergence.a.kind())}};
  if (divergence.field) {
    json["field"] = divergence.field->name;
    json["a"] = compare::field_text(*divergence.field, divergence.a);
    json["b"] = compare::field_text(*divergence.field, divergence.b);
    json["ulp"] = number_or_null(divergence.ulp_distance);
  } else {
    json["event_b"] = compare::name(divergence.b.kind());
  }
  if (divergence.exact_answer) json["exact"] = number_or_null(*divergence.exact_answer);
  json["sentence"] = divergence.sentence;
  return json;
}

nlohmann::ordered_json to_json(const compare::Classification& classification) {
  nlohmann::ordered_json json = {{"differing_pixels", classification.differing_pixels},
                                 {"classed_pixels", classification.classed_pixels},
                                 {"surveyed_pixels", classification.surveyed_pixels},
                                 {"traced_paths", classification.traced_paths},
                                 {"differing_paths", classification.differing_paths},
                                 {"mismatches", classification.mismatches()},
                                 {"pixel_classes", counts_json(classification.pixel_counts)},
                                 {"divergence_classes", counts_json(classification.divergence_counts)},
                                 {"pixels", nlohmann::ordered_json::array()},
                                 {"divergences", nlohmann::ordered_json::array()}};
  for (std::size_t i = 0; i < std::min(classification.pixels.size(), most_pixels_in_json); ++i) {
    const compare::ClassifiedPixel& pixel = classification.pixels[i];
    nlohmann::ordered_json each = {{"pixel", {pixel.pixel.x, pixel.pixel.y}},
                                   {"class", compare::name(pixel.difference_class)}};
    if (pixel.wrong_sum != 0) each["wrong_sum"] = std::string(1, pixel.wrong_sum);
    json["pixels"].push_back(std::move(each));
  }
  for (const Listed& each : listed(classification, most_in_json, true)) {
    const pathtracer::PathId& path = each.path->path;
    nlohmann::ordered_json divergence = {{"pixel", {path.pixel.x, path.pixel.y}}, {"sample", path.sample}};
    divergence.update(to_json(*each.divergence));
    json["divergences"].push_back(std::move(divergence));
  }
  return json;
}

}  // namespace tandem::tools
