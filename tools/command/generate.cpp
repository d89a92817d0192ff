#include <fmt/format.h>

#include <cstdint>
#include <filesystem>
#include <memory>

#include "base/progress.hpp"
#include "pathtracer/load/generate.hpp"
#include "tools/command.hpp"
#include "tools/options/option_values.hpp"
#include "tools/output/print.hpp"
#include "tools/output/progress_bar.hpp"

namespace tandem::tools {
namespace {

struct Options {
  std::uint64_t triangles = 1'000'000;
  std::filesystem::path output;
};

int generate(const Options& options) {
  const std::uint64_t triangles =
      pathtracer::generate_spheres(options.triangles, options.output, progress_bar("generate"));
  if (triangles == 0) throw Cancelled();
  print("{}: {} triangles\n", options.output.string(), triangles);
  return exit_code::success;
}

}  // namespace

void add_generate_command(CLI::App& app, Action& action) {
  CLI::App* const command =
      app.add_subcommand("generate", "Write a scene of any size: the Cornell box filled with displaced spheres");
  const auto options = std::make_shared<Options>();
  add_whole_number(*command, "--triangles", options->triangles, pathtracer::minimum_generated_triangles,
                   pathtracer::maximum_generated_triangles, "Approximate number of triangles");
  command->add_option("-o,--output", options->output, "Wavefront OBJ file; its MTL file is written beside it")
      ->required()
      ->type_name("FILE.obj");
  command->footer("Example:\n  tandem generate --triangles 1300000 -o million.obj");
  command->callback([&action, options] { action = [options] { return generate(*options); }; });
}

}  // namespace tandem::tools
