#include "compare/report/page.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string_view>

#include "compare/image/image_pair.hpp"
#include "compare/report/packed_images.hpp"
#include "compare/report/packing.hpp"
#include "compare/report/page_sources.hpp"

namespace tandem::compare {
namespace {

using nlohmann::ordered_json;

/// Text between tags.
std::string escaped_html(std::string_view text) {
  std::string result;
  for (const char character : text) {
    if (character == '<') {
      result += "&lt;";
    } else if (character == '&') {
      result += "&amp;";
    } else {
      result += character;
    }
  }
  return result;
}

/// JSON inside <script>, which ends at the first "</script" even within a string.
std::string escaped_json(std::string_view json) {
  std::string result;
  for (const char character : json) {
    if (character == '<') {
      result += "\\u003c";
    } else {
      result += character;
    }
  }
  return result;
}

std::string dump(const ordered_json& json) { return json.dump(-1, ' ', false, ordered_json::error_handler_t::replace); }

/// The template with each {{place}} filled; what fills one is not looked at again.
std::string filled(std::string_view text, const std::vector<std::pair<std::string_view, std::string_view>>& places) {
  std::string result;
  while (true) {
    const std::size_t begin = text.find("{{");
    if (begin == std::string_view::npos) return result += text;
    const std::size_t end = text.find("}}", begin);
    const std::string_view name = text.substr(begin + 2, end - begin - 2);
    result += text.substr(0, begin);
    for (const auto& place : places)
      if (place.first == name) result += place.second;
    text.remove_prefix(end + 2);
  }
}

ordered_json divergences_json(const Classification& classification, const Ranking& ranking) {
  std::vector<glm::uvec2> ranked;
  for (const RankedPixel& pixel : ranking.pixels) ranked.push_back(pixel.pixel);
  const auto before = [](const glm::uvec2& first, const glm::uvec2& second) {
    return first.y != second.y ? first.y < second.y : first.x < second.x;
  };
  std::ranges::sort(ranked, before);
  ordered_json json = ordered_json::array();
  for (const ClassifiedPath& path : classification.paths) {
    if (!std::ranges::binary_search(ranked, path.path.pixel, before)) continue;
    for (const Divergence& divergence : path.divergences) {
      json.push_back({{"x", path.path.pixel.x},
                      {"y", path.path.pixel.y},
                      {"sample", path.path.sample},
                      {"class", name(divergence.difference_class)},
                      {"segment", divergence.segment},
                      {"event", name(divergence.a.kind())},
                      {"field", divergence.field != nullptr ? ordered_json(divergence.field->name) : ordered_json()},
                      {"ulp", divergence.ulp_distance},
                      {"sentence", divergence.sentence}});
    }
  }
  return json;
}

ordered_json wrong_sums_json(const Classification& classification) {
  ordered_json json = ordered_json::array();
  for (const ClassifiedPixel& pixel : classification.pixels)
    if (pixel.wrong_sum != 0)
      json.push_back({{"x", pixel.pixel.x}, {"y", pixel.pixel.y}, {"device", std::string(1, pixel.wrong_sum)}});
  return json;
}

ordered_json classification_json(const Classification& classification, const Ranking& ranking) {
  ordered_json json = {{"differing_pixels", classification.differing_pixels},
                       {"classed_pixels", classification.classed_pixels},
                       {"surveyed_pixels", classification.surveyed_pixels},
                       {"traced_paths", classification.traced_paths},
                       {"differing_paths", classification.differing_paths},
                       {"pixels", ordered_json::object()},
                       {"divergences", ordered_json::object()}};
  for (std::size_t i = 0; i < difference_class_count; ++i) {
    const char* const class_name = name(static_cast<DifferenceClass>(i));
    json["pixels"][class_name] = classification.pixel_counts[i];
    json["divergences"][class_name] = classification.divergence_counts[i];
  }
  json["found"] = packed(dump(
      {{"divergences", divergences_json(classification, ranking)}, {"wrong_sums", wrong_sums_json(classification)}}));
  return json;
}

/// "event/field" of all fields that devices only report and no result depends on.
ordered_json observed_fields() {
  ordered_json json = ordered_json::array();
  for (std::uint32_t i = 1; i <= pathtracer::event_kind_count; ++i) {
    const auto kind = static_cast<pathtracer::EventKind>(i);
    for (const EventField& field : fields_of(kind))
      if (field.tier == FieldTier::observed) json.push_back(std::string(name(kind)) + "/" + field.name);
  }
  return json;
}

/// One byte a pixel: 255 times the error.
std::string packed_errors(const FlipErrors& flip) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(flip.errors.size());
  for (const float error : flip.errors)
    bytes.push_back(static_cast<std::uint8_t>(std::lround(255.0F * std::clamp(error, 0.0F, 1.0F))));
  return packed(bytes);
}

std::string packed_paths(const std::vector<RecordedPath>& paths) {
  ordered_json json = ordered_json::array();
  for (const RecordedPath& path : paths)
    json.push_back({{"x", path.path.pixel.x},
                    {"y", path.path.pixel.y},
                    {"sample", path.path.sample},
                    {"events", ordered_json::parse(path.events)}});
  return packed(dump(json));
}

ordered_json data_json(const ReportPage& contents) {
  const PackedImages images = pack_images(contents.a, contents.b);
  constexpr std::uint8_t unclassed = 255;
  std::vector<std::uint32_t> indices;
  std::vector<std::uint8_t> classes;
  for (const RankedPixel& ranked : contents.ranking.pixels) {
    indices.push_back(ranked.pixel.y * contents.a.width + ranked.pixel.x);
    classes.push_back(ranked.difference_class ? static_cast<std::uint8_t>(*ranked.difference_class) : unclassed);
  }
  ordered_json json = {
      {"width", contents.a.width},
      {"height", contents.a.height},
      {"bytes", images.bytes},
      {"a", images.a},
      {"exclusive_or", images.exclusive_or},
      {"differs", images.differs},
      {"differing_pixels", contents.ranking.differing_pixels},
      {"ranked", packed(indices)},
      {"ranked_classes", packed(classes)},
      {"ranked_values",
       images.bytes < 4 ? ordered_json(pack_exact_values(contents.a, contents.b, indices)) : ordered_json()},
      {"flip", contents.flip != nullptr ? ordered_json(packed_errors(*contents.flip)) : ordered_json()},
      {"classes", ordered_json::array()},
      {"paths", packed_paths(contents.paths)},
      {"path_count", contents.paths.size()},
      {"observed", observed_fields()}};
  for (std::size_t i = 0; i < difference_class_count; ++i)
    json["classes"].push_back(name(static_cast<DifferenceClass>(i)));
  json["classification"] = contents.classification != nullptr
                               ? classification_json(*contents.classification, contents.ranking)
                               : ordered_json();
  return json;
}

}  // namespace

std::string page(const ReportPage& contents) {
  check_pair(contents.a, contents.b);
  const std::string title = escaped_html(contents.title);
  const std::string numbers = escaped_json(contents.numbers);
  const std::string data = escaped_json(dump(data_json(contents)));
  return filled(
      page_template(),
      {{"title", title}, {"style", page_style()}, {"numbers", numbers}, {"data", data}, {"script", page_script()}});
}

}  // namespace tandem::compare
