#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <new>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/progress.hpp"
#include "base/threads.hpp"
#include "tools/command.hpp"
#include "tools/options/option_words.hpp"
#include "tools/output/interruption.hpp"
#include "tools/output/print.hpp"
#include "tools/program/explained_job.hpp"

namespace {

using namespace tandem::tools;

/// One line on standard error, whatever line breaks the sentence came with.
int fail(std::string sentence, int code = exit_code::error) {
  std::replace(sentence.begin(), sentence.end(), '\n', ' ');
  print_error_line(sentence);
  return code;
}

/// Whether a word of the command line is a shader, a script, or a job of several.
bool names_program(std::span<char* const> words) {
  return std::ranges::any_of(words, [](std::string_view word) {
    return word == "--job" || word.starts_with("--job=") || program_run::is_program_file(word);
  });
}

int run(int argc, char** argv) {
  CLI::App app("Renders one ray-tracing shader on Vulkan and on the CPU, and compares the images bit by bit.",
               "tandem");
  app.set_version_flag("--version", "tandem " TANDEM_VERSION);
  app.require_subcommand(1);
  app.footer(
      "Exit code: 0 success, or the results agree; 1 they differ (diff, matrix, gallery, suite, run) or a device is\n"
      "wrong (explain, conformance, bench, amber); 2 any error, with one sentence on standard error; 3 the images\n"
      "differ for reasons that the scene owns (diff, gallery, suite); 130 interrupted.\n"
      "Environment variables:\n"
      "  TANDEM_CACHE_DIR     Folder of shaders compiled for the CPU devices [$XDG_CACHE_HOME/tandem, "
      "~/.cache/tandem]\n"
      "  TANDEM_CACHE_MAX_MB  Maximum size of that folder in MiB [256]\n"
      "  TANDEM_CXX           C++ compiler for shaders that are not built in [c++, g++ or clang++ on PATH]\n"
      "  TANDEM_IMAGE_CODEC   File of the library that reads and writes images [that of the installation]\n"
      "'tandem COMMAND --help' describes a command and its options.");
  Action action;
  add_devices_command(app, action);
  add_render_command(app, action);
  add_view_command(app, action);
  add_run_command(app, action);
  // Scenes and shaders have other options, and the same questions.
  if (names_program(std::span(argv, static_cast<std::size_t>(argc)))) {
    add_program_diff_command(app, action);
    add_program_explain_command(app, action);
  } else {
    add_diff_command(app, action);
    add_explain_command(app, action);
  }
  add_generate_command(app, action);
  add_gallery_command(app, action);
  add_bench_command(app, action);
  add_conformance_command(app, action);
  add_study_command(app, action);
  add_matrix_command(app, action);
  add_suite_command(app, action);
  add_amber_command(app, action);
  const char* const hint = "'tandem --help' lists the commands";
  if (argc < 2) return fail(fmt::format("a command is required; {}", hint));
  if (argv[1][0] != '-' &&
      app.get_subcommands([&](const CLI::App* command) { return command->check_name(argv[1]); }).empty()) {
    return fail(fmt::format("'{}' is not a command; {}", argv[1], hint));
  }
  try {
    std::vector<std::string> words = option_words(std::span(argv, static_cast<std::size_t>(argc)).subspan(1));
    std::ranges::reverse(words);  // as CLI11 takes them
    app.parse(std::move(words));
  } catch (const CLI::Success& request) {
    return app.exit(request);  // --help and --version
  } catch (const CLI::ParseError& error) {
    return fail(error.what());
  }
  note_interrupts();
  tandem::require_threads();
  return action();
}

}  // namespace

int main(int argc, char** argv) {
  reserve_standard_files();
  try {
    const int code = run(argc, argv);
    return finish_output() ? code : fail("standard output cannot be written");
  } catch (const tandem::Cancelled& interruption) {
    return fail(interruption.what(), exit_code::interrupted);
  } catch (const std::bad_alloc&) {
    return fail("not enough memory for this scene and image size");
  } catch (const std::exception& error) {
    return fail(error.what());
  }
}
