// tandem-translate: the build's side of the translator (cmake/TandemShaders.cmake), and a way to read what it writes.

#include <cstdint>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "rhi_cpu/translate/translate.hpp"

namespace {

std::vector<std::uint32_t> read_words(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw std::runtime_error(path + ": cannot be read");
  const std::string bytes{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  if (bytes.size() % 4 != 0) throw std::runtime_error(path + ": is not a whole number of SPIR-V words");
  std::vector<std::uint32_t> words(bytes.size() / 4);
  std::copy(bytes.begin(), bytes.end(), reinterpret_cast<char*>(words.data()));
  return words;
}

void write(const std::string& path, const std::string& text) {
  if (path == "-") {
    std::fwrite(text.data(), 1, text.size(), stdout);
    return;
  }
  std::ofstream file(path, std::ios::binary);
  file << text;
  file.close();
  if (!file) throw std::runtime_error(path + ": cannot be written");
}

std::string embedded_words(const std::vector<std::uint32_t>& words, const std::string& name_space,
                           const std::string& name) {
  std::string text = fmt::format(
      "#include <cstdint>\n#include <span>\n\nnamespace {} {{\n\nstatic constexpr std::uint32_t words[] = {{",
      name_space);
  for (std::size_t i = 0; i < words.size(); ++i)
    text += fmt::format("{}{:#x},", i % 12 == 0 ? "\n    " : " ", words[i]);
  return text + fmt::format("\n}};\n\nstd::span<const std::uint32_t> {}() {{ return words; }}\n\n}}  // namespace {}\n",
                            name, name_space);
}

std::vector<tandem::rhi::SpecializationValue> specialization(const std::vector<std::string>& assignments) {
  std::vector<tandem::rhi::SpecializationValue> values;
  for (const std::string& assignment : assignments) {
    std::istringstream text(assignment);
    tandem::rhi::SpecializationValue value;
    char separator = 0;
    if (!(text >> value.id >> separator >> value.value) || separator != '=' || text.peek() != EOF)
      throw std::runtime_error("--specialize takes ID=VALUE, not '" + assignment + "'");
    values.push_back(value);
  }
  return values;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Translates a SPIR-V shader to the C++ that Tandem's CPU device runs");
  std::string input, kernel, embed, name_space = "tandem::shaders", name = "shader";
  std::string entry_symbol = tandem::cpu::TranslateOptions().entry_symbol;
  app.add_option("spirv", input, "SPIR-V binary")->required();
  app.add_option("--kernel", kernel, "write the kernel's C++ here (- for standard output)");
  std::vector<std::string> assignments;
  app.add_option("--specialize", assignments, "ID=VALUE of a specialisation constant; the others keep their defaults");
  app.add_option("--entry-symbol", entry_symbol, "name of the function that the kernel exports")->capture_default_str();
  bool robust = false, watched = false;
  app.add_flag("--robust", robust, "keep accesses inside of what is bound, as devices with robust access do");
  std::uint32_t subgroup_size = tandem::cpu::TranslateOptions().subgroup_size;
  app.add_option("--subgroup-size", subgroup_size, "invocations of a subgroup, a power of two up to 32")
      ->check(CLI::IsMember(std::vector<std::uint32_t>{1, 2, 4, 8, 16, 32}))
      ->capture_default_str();
  app.add_flag("--watched", watched, "let loops look at a watch, as devices with a time limit do");
  std::uint32_t lanes = 0;
  app.add_option("--lanes", lanes, "invocations that the kernel runs at once (4, 8, 16 or 32); 0: one after the other")
      ->check(CLI::IsMember({0, 4, 8, 16, 32}));
  app.add_option("--embed", embed, "write C++ that holds the SPIR-V words here");
  app.add_option("--namespace", name_space, "namespace of the embedded words")->capture_default_str();
  app.add_option("--name", name, "name of the function that returns the embedded words")->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  try {
    const std::vector<std::uint32_t> words = read_words(input);
    if (!embed.empty()) write(embed, embedded_words(words, name_space, name));
    const std::vector<tandem::rhi::SpecializationValue> values = specialization(assignments);
    if (!kernel.empty())
      write(kernel, tandem::cpu::translate(words, std::filesystem::path(input).filename().string(),
                                           {.specialization = values,
                                            .entry_symbol = entry_symbol,
                                            .robust = robust,
                                            .watched = watched,
                                            .subgroup_size = subgroup_size,
                                            .lanes = lanes})
                        .source);
  } catch (const std::exception& error) {
    fmt::print(stderr, "tandem-translate: {}\n", error.what());
    return 2;
  }
  return 0;
}
