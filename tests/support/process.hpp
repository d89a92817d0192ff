#pragma once

#include <concepts>
#include <cstddef>
#include <filesystem>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

/// Programs as subprocesses, without a terminal.
namespace tandem::test {

struct Outcome {
  int exit_code = 0;  ///< -N: ended by signal N
  std::string output;
  std::string errors;
};

struct ProcessOptions {
  std::filesystem::path folder = {};          ///< current folder of the program; empty: that of the test
  unsigned interrupt_after_ms = 0;            ///< not 0: SIGINT after so long
  std::size_t file_size_limit = 0;            ///< not 0: bytes beyond which every write to a file fails
  std::vector<std::string> environment = {};  ///< NAME=value, beside the variables that the test has
};

/// The words of a line, between its spaces. Each word {} stands for the next value, which may have spaces:
/// words("render {} -o x.png", {scene}). As many values as {}.
std::vector<std::string> words(std::string_view line, std::initializer_list<std::string_view> values = {});

/// Runs a program; its arguments may have spaces.
Outcome run_program(const std::filesystem::path& program, const std::vector<std::string>& arguments,
                    const ProcessOptions& options = {});

/// Runs `tandem ARGUMENTS...`. Lines of its errors that say what it waits for ("tandem: compiling shaders for vulkan:
/// 30 s so far") are left out: how many there are depends on the machine.
Outcome run_tandem(const std::vector<std::string>& arguments, const ProcessOptions& options = {});

/// Runs `tandem LINE`. Arguments that may have spaces, as paths may, are given by words().
Outcome run_tandem(const std::convertible_to<std::string_view> auto& line, const ProcessOptions& options = {}) {
  return run_tandem(words(line), options);
}

/// Runs a line of a shell, in which `tandem` is the program under test.
Outcome run_in_shell(const std::string& line, ProcessOptions options = {});

}  // namespace tandem::test
