#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "tools/options/render_options.hpp"

namespace tandem::tools {

/// An option and the values that it takes in turn: "spp=1,4,16".
struct Variation {
  std::string option;  ///< with its dashes
  std::vector<std::string> values;
};

/// Throws Error unless the text has the form NAME=VALUE,VALUE,... Values that have commas in them are in brackets:
/// "background=[0,0,0],[1,1,1]".
Variation parse_variation(const std::string& text);

/// How a scene is rendered.
struct Configuration {
  std::vector<std::pair<std::string, std::string>> varied;  ///< options and values, in the order of the command line
  RenderOptions options;
  std::vector<std::string> words;  ///< the same as a command line: the scene and all options that are given
};

/// Gives an option of a command line a value, in place of the one that it has.
void set_option(std::vector<std::string>& words, const std::string& option, const std::string& value);

/// Every scene with every combination of values; of one scene they follow each other, the last variation fastest.
/// Throws Error for an option that is not one of rendering, for a value that it does not take, and for one that varies
/// twice.
/// @param words the options of `base` as a command line
std::vector<Configuration> configurations(const RenderOptions& base, std::span<const std::string> words,
                                          std::span<const std::filesystem::path> scenes,
                                          std::span<const Variation> variations);

}  // namespace tandem::tools
