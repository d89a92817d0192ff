#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <functional>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "pathtracer/scene/settings.hpp"

/// Options whose values are read strictly: the whole text must be a value in range, else the command line is refused
/// with a sentence that names the option, the text and what was expected. `value` must outlive the parsing.
namespace tandem::tools {

/// A whole number from `least` to `most`; the help shows the current value as the default.
CLI::Option* add_whole_number(CLI::App& command, const std::string& name, std::uint64_t& value, std::uint64_t least,
                              std::uint64_t most, const std::string& description);
CLI::Option* add_whole_number(CLI::App& command, const std::string& name, std::uint32_t& value, std::uint32_t least,
                              std::uint32_t most, const std::string& description);

/// A number from `least` to `most`, both included.
CLI::Option* add_number(CLI::App& command, const std::string& name, double& value, double least, double most,
                        const std::string& description);
CLI::Option* add_number(CLI::App& command, const std::string& name, std::optional<double>& value, double least,
                        double most, const std::string& description);
CLI::Option* add_whole_number(CLI::App& command, const std::string& name, std::optional<std::uint32_t>& value,
                              std::uint32_t least, std::uint32_t most, const std::string& description);
CLI::Option* add_number(CLI::App& command, const std::string& name, std::optional<float>& value, float least,
                        float most, const std::string& type, const std::string& description);

/// Pixels as WIDTHxHEIGHT.
CLI::Option* add_size(CLI::App& command, const std::string& name, std::optional<glm::uvec2>& value,
                      const std::string& description);

/// A pixel as X,Y.
CLI::Option* add_pixel(CLI::App& command, const std::string& name, glm::uvec2& value, const std::string& description);

/// One of `names`.
CLI::Option* add_choice(CLI::App& command, const std::string& name, std::span<const char* const> names,
                        const std::function<void(std::size_t)>& choose, const std::string& description);

/// One of the values of the table, by its name.
template <typename T>
CLI::Option* add_named(CLI::App& command, const std::string& name, std::optional<T>& value,
                       std::span<const Named<T>> table, const std::string& description) {
  std::vector<const char*> names;
  for (const Named<T>& named : table) names.push_back(named.name);
  return add_choice(
      command, name, names, [&value, table](std::size_t index) { value = table[index].value; }, description);
}

/// Three finite numbers, comma-separated, each at least `least`. `type` stands for the value in the help.
CLI::Option* add_vector(CLI::App& command, const std::string& name, std::optional<glm::vec3>& value, float least,
                        const std::string& type, const std::string& description);

/// A point: three finite numbers, comma-separated, each within the range of a float.
CLI::Option* add_point(CLI::App& command, const std::string& name, std::optional<glm::dvec3>& value,
                       const std::string& description);

}  // namespace tandem::tools
