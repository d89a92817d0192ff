#include "tools/report/statistics_report.hpp"

#include <fmt/format.h>

#include <iterator>

#include "compare/statistics/bias_text.hpp"

namespace tandem::tools {
namespace {

using compare::BiasTest;
using compare::ComparedMean;

nlohmann::ordered_json to_json(const compare::Tile& tile) {
  return {{"x", tile.left}, {"y", tile.top}, {"width", tile.width}, {"height", tile.height}};
}

nlohmann::ordered_json to_json(const ComparedMean& mean) {
  nlohmann::ordered_json json = to_json(mean.tile);
  json["channel"] = compare::name(mean.channel);
  json["mean_a"] = mean.a.value;
  json["mean_b"] = mean.b.value;
  json["standard_error_a"] = mean.a.standard_error;
  json["standard_error_b"] = mean.b.standard_error;
  json["relative_difference"] = mean.relative_difference();
  json["p_value"] = mean.p_value;
  return json;
}

nlohmann::ordered_json to_json(const BiasTest& test) {
  return {{"p_value", test.p_value},
          {"tiles_p_value", test.tiles_p_value},
          {"picture_p_value", test.picture_p_value},
          {"tile_tests", test.tile_tests},
          {"worst_tile", to_json(test.worst_tile)},
          {"worst_mean", to_json(test.worst_mean)},
          {"rmse", test.rmse}};
}

}  // namespace

std::string table(const compare::Statistics& statistics) {
  const BiasTest& bias = statistics.bias;
  std::string text;
  const auto line = [&](const char* name, const std::string& value) {
    fmt::format_to(std::back_inserter(text), "{:<18}{}\n", name, value);
  };
  const auto percent = [](double fraction) { return fmt::format("{:.3g} %", 100 * fraction); };
  line("batches", fmt::format("{} of {} spp, under seeds from {} (a) and {} (b) on", statistics.batches,
                              statistics.batch_samples, statistics.seed_a, statistics.seed_b));
  line("p-value of a, b", fmt::format("{:.3g} (tiles {:.3g}, picture {:.3g}); below {:g} is a bias", bias.p_value,
                                      bias.tiles_p_value, bias.picture_p_value, statistics.level));
  line("worst tile", fmt::format("{}, {}: {}", compare::text_of(bias.worst_tile.tile),
                                 compare::name(bias.worst_tile.channel), compare::text_of(bias.worst_tile, "a", "b")));
  line("", fmt::format("p-value {:.3g}, one of {} tests", bias.worst_tile.p_value, bias.tile_tests));
  line("picture",
       fmt::format("{}: {}", compare::name(bias.worst_mean.channel), compare::text_of(bias.worst_mean, "a", "b")));
  line("noise floor", fmt::format("RMSE {:.4g} of a, b; {:.4g} of a, a; {:.4g} of b, b under other seeds", bias.rmse,
                                  statistics.control_a.rmse, statistics.control_b.rmse));
  line("", fmt::format("p-value {:.3g} of a, a; {:.3g} of b, b", statistics.control_a.p_value,
                       statistics.control_b.p_value));
  line("power",
       fmt::format("a bias of {} of the picture, or of {} of the median tile ({}),", percent(statistics.power.picture),
                   percent(statistics.power.median_tile), text_of(statistics.power.tile)));
  line("", fmt::format("would have been found with probability {:g}", statistics.power.probability));
  return text;
}

nlohmann::ordered_json to_json(const compare::Statistics& statistics) {
  nlohmann::ordered_json json = {{"level", statistics.level},
                                 {"batches", statistics.batches},
                                 {"batch_samples", statistics.batch_samples},
                                 {"tile", statistics.tile},
                                 {"seeds",
                                  {{"a", statistics.seed_a},
                                   {"control_a", statistics.control_seed_a},
                                   {"b", statistics.seed_b},
                                   {"control_b", statistics.control_seed_b}}}};
  json.update(to_json(statistics.bias));
  json["control_a"] = to_json(statistics.control_a);
  json["control_b"] = to_json(statistics.control_b);
  json["power"] = {{"probability", statistics.power.probability},
                   {"picture", statistics.power.picture},
                   {"median_tile", statistics.power.median_tile},
                   {"tile", to_json(statistics.power.tile)}};
  return json;
}

}  // namespace tandem::tools
