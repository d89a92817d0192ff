#pragma once

#include <CLI/CLI.hpp>
#include <functional>

#include "compare/verdict/verdict.hpp"

/// The commands of the command line. Each add_*_command declares a subcommand of `app` with its options; when the
/// command line names it, `action` becomes what it asks for. An action prints its results to standard output, returns
/// the exit code, and throws std::exception with one clear sentence when it cannot do what was asked.
namespace tandem::tools {

using Action = std::function<int()>;

namespace exit_code {
inline constexpr int success = 0;
inline constexpr int differ =
    1;  ///< the images or results differ (diff, matrix, gallery, suite, run); a mismatch (explain)
/// `conformance`, `amber`, `bench --kernels`: a device is wrong; `run --check`: one cannot run the shader.
inline constexpr int failed = 1;
inline constexpr int error = 2;
inline constexpr int explained = 3;  ///< the images differ, but for reasons that the scene owns (diff, gallery, suite)
inline constexpr int interrupted = 130;  ///< as shells report a program ended by Ctrl-C
}  // namespace exit_code

/// The exit code of a command whose result is the outcome.
constexpr int exit_code_of(compare::Outcome outcome) {
  return outcome == compare::Outcome::agree       ? exit_code::success
         : outcome == compare::Outcome::explained ? exit_code::explained
                                                  : exit_code::differ;
}

void add_amber_command(CLI::App& app, Action& action);
void add_devices_command(CLI::App& app, Action& action);
void add_render_command(CLI::App& app, Action& action);
void add_diff_command(CLI::App& app, Action& action);
void add_explain_command(CLI::App& app, Action& action);
/// `explain` and `diff` of shaders that are not the path tracer's, in the place of the commands for scenes.
void add_program_explain_command(CLI::App& app, Action& action);
void add_program_diff_command(CLI::App& app, Action& action);
void add_generate_command(CLI::App& app, Action& action);
void add_gallery_command(CLI::App& app, Action& action);
void add_bench_command(CLI::App& app, Action& action);
void add_conformance_command(CLI::App& app, Action& action);
void add_study_command(CLI::App& app, Action& action);
/// `study markov`, a subcommand of `study`.
void add_study_markov_command(CLI::App& group, Action& action);
/// `study metropolis`, likewise.
void add_study_metropolis_command(CLI::App& group, Action& action);
/// A subcommand of `study`.
void add_study_denoising_command(CLI::App& group, Action& action);
void add_matrix_command(CLI::App& app, Action& action);
void add_suite_command(CLI::App& app, Action& action);
void add_run_command(CLI::App& app, Action& action);
void add_view_command(CLI::App& app, Action& action);

}  // namespace tandem::tools
