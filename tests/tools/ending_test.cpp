#include <doctest/doctest.h>

#include <chrono>
#include <filesystem>
#include <string>

#include "tests/support/device_test.hpp"
#include "tests/support/process.hpp"
#include "tests/support/scratch_folder.hpp"

// How the program ends when it cannot say so, or is told to end.

namespace tandem::test {
namespace {

const std::string scenes = std::string(TANDEM_SOURCE_DIRECTORY) + "/scenes/";

/// Runs `tandem LINE` in a shell, which redirects its output.
Outcome shell(const std::string& line, const ScratchFolder& folder) {
  return run_in_shell("tandem " + line, {.folder = folder.path()});
}

TEST_CASE("output that cannot be written is an error, and an error that cannot be written is one too") {
  const ScratchFolder folder;
  CHECK(shell("render absent.obj 2>/dev/full", folder).exit_code == 2);
  CHECK(shell("render absent.obj 2>&-", folder).exit_code == 2);
  CHECK(shell("nonsense 2>&- >&- <&-", folder).exit_code == 2);
  for (const char* line : {"--help >/dev/full", "--version >/dev/full", "devices >/dev/full", "devices >&-",
                           "generate --triangles 100 -o x.obj >/dev/full"}) {
    CAPTURE(line);
    const Outcome outcome = shell(line, folder);
    CHECK(outcome.exit_code == 2);
    CHECK(outcome.errors == "tandem: standard output cannot be written\n");
  }
  // What was asked for is there all the same.
  CHECK(std::filesystem::exists(folder.path() / "x.obj"));
  // No file of the program takes the number of standard error.
  const std::string render = "render " + scenes + "cornell_box.obj --device cpu --size 8x8 --spp 1 ";
  CHECK(shell(render + "-o closed.exr 2>&- >&-", folder).exit_code == 2);
  CHECK(shell(render + "-o open.exr", folder).exit_code == 0);
  CHECK(std::filesystem::file_size(folder.path() / "closed.exr") ==
        std::filesystem::file_size(folder.path() / "open.exr"));
}

TEST_CASE("a limit of the size of files is an error like a full disk, and leaves nothing") {
  const ScratchFolder folder;
  const Outcome outcome = run_in_shell(
      "ulimit -f 1; tandem render " + scenes + "cornell_box.obj --device cpu --size 64x64 --spp 1 -o x.exr",
      {.folder = folder.path()});
  CHECK(outcome.exit_code == 2);
  CHECK(outcome.errors.starts_with("tandem: cannot write 'x.exr': "));
  CHECK(folder.names().empty());
}

TANDEM_DEVICE_TEST("an interrupt ends the program in a driver's compiler, too, and leaves nothing") {
  const ScratchFolder folder;
  const auto started = std::chrono::steady_clock::now();
  // lavapipe compiles these shaders for minutes. What is faster finishes.
  const Outcome outcome = run_tandem(
      words("render {} --device {} --size 8x8 --spp 1 -o x.png", {scenes + "still_life.glb", device_name}),
      {.folder = folder.path(), .interrupt_after_ms = 5000, .environment = {"MESA_SHADER_CACHE_DISABLE=true"}});
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - started;
  if (outcome.exit_code == 0) return;
  CHECK(outcome.exit_code == 130);
  CHECK(outcome.errors.find("tandem: interrupted") != std::string::npos);
  // Two seconds, on a machine that does five other things at once.
  CHECK(seconds.count() < 5 + 10);
  CHECK(folder.names().empty());
}

}  // namespace
}  // namespace tandem::test
