#include "tools/bench/plan.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.hpp"
#include "tools/options/option_words.hpp"

namespace tandem::tools {
namespace {

/// The options that are given in the words, over those of `base`.
RenderOptions with_options(const RenderOptions& base, const std::string& option, const std::string& value) {
  RenderOptions options = base;
  CLI::App parser;
  add_render_options(parser, options);
  try {
    // CLI11 takes words from the back.
    parser.parse(std::vector<std::string>{value, option, base.scene.string()});
  } catch (const CLI::ParseError& error) {
    throw Error(fmt::format("--vary: {}", error.what()));
  }
  options.scene = base.scene;
  return options;
}

void refuse_unknown(const Variation& variation) {
  CLI::App parser;
  RenderOptions unused;
  add_render_options(parser, unused);
  const CLI::Option* const found = parser.get_option_no_throw(variation.option);
  const bool takes_value = found != nullptr && found->get_items_expected_max() > 0;
  if (!takes_value || variation.option == "--validation" || variation.option == "--help")
    throw Error(fmt::format("--vary: '{}' is not an option of rendering that takes a value", variation.option));
}

}  // namespace

Variation parse_variation(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0)
    throw Error(fmt::format("--vary: '{}' is not of the form NAME=VALUE,VALUE,...", text));
  Variation variation{.option = text.substr(0, equals), .values = {}};
  if (!variation.option.starts_with("--")) variation.option.insert(0, "--");
  variation.option = std::string(current_name(variation.option));
  int depth = 0;
  std::string value;
  const auto end_value = [&] {
    if (value.empty()) throw Error(fmt::format("--vary: '{}' has an empty value", text));
    if (std::ranges::find(variation.values, value) != variation.values.end())
      throw Error(fmt::format("--vary: '{}' has the value '{}' twice", text, value));
    variation.values.push_back(std::exchange(value, {}));
  };
  for (const char each : text.substr(equals + 1)) {
    if (each == '[' && depth++ == 0) continue;
    if (each == ']' && --depth == 0) continue;
    if (each == ',' && depth == 0)
      end_value();
    else
      value += each;
  }
  if (depth != 0) throw Error(fmt::format("--vary: '{}' has a bracket without its other", text));
  end_value();
  return variation;
}

void set_option(std::vector<std::string>& words, const std::string& option, const std::string& value) {
  if (const auto found = std::ranges::find(words, option); found != words.end()) words.erase(found, found + 2);
  words.insert(words.end(), {option, value});
}

std::vector<Configuration> configurations(const RenderOptions& base, std::span<const std::string> words,
                                          std::span<const std::filesystem::path> scenes,
                                          std::span<const Variation> variations) {
  for (std::size_t i = 0; i < variations.size(); ++i) {
    refuse_unknown(variations[i]);
    if (std::ranges::find(variations.first(i), variations[i].option, &Variation::option) != variations.first(i).end())
      throw Error(fmt::format("--vary: {} varies twice", variations[i].option));
  }
  std::vector<Configuration> result;
  for (const std::filesystem::path& scene : scenes) {
    std::vector<Configuration> of_scene(1);
    of_scene[0].options = base;
    of_scene[0].options.scene = scene;
    of_scene[0].words = {scene.string()};
    of_scene[0].words.insert(of_scene[0].words.end(), words.begin(), words.end());
    for (const Variation& variation : variations) {
      std::vector<Configuration> more;
      for (const Configuration& each : of_scene)
        for (const std::string& value : variation.values) {
          Configuration next = each;
          next.options = with_options(each.options, variation.option, value);
          next.varied.emplace_back(variation.option.substr(2), value);
          set_option(next.words, variation.option, value);
          more.push_back(std::move(next));
        }
      of_scene = std::move(more);
    }
    result.insert(result.end(), std::make_move_iterator(of_scene.begin()), std::make_move_iterator(of_scene.end()));
  }
  return result;
}

}  // namespace tandem::tools
