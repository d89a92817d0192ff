#include <doctest/doctest.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/device_test.hpp"
#include "tests/support/process.hpp"
#include "tests/support/run_summary.hpp"
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

TEST_CASE("without threads to be had there is a sentence") {
  // The limit counts the threads of a user, and none of root's.
  if (geteuid() != 0) TANDEM_SKIP("only root can become a user without other processes");
  const ScratchFolder folder;
  // A place that every user can read.
  REQUIRE(run_in_shell("cp $(command -v tandem) " + scenes + "cornell_box.* . && chmod -R a+rX . ",
                       {.folder = folder.path()})
              .exit_code == 0);
  for (const char* most : {"1", "4"}) {
    CAPTURE(most);
    // A number that is nobody's.
    const Outcome outcome =
        run_in_shell(std::string("setpriv --reuid=54321 --regid=54321 --clear-groups prlimit --nproc=") + most +
                         " ./tandem render cornell_box.obj --size 8x8 --spp 1 -o x.png",
                     {.folder = folder.path()});
    CHECK(outcome.exit_code == 2);
    CHECK(outcome.errors.starts_with("tandem: only "));
    CHECK(outcome.errors.find("threads can be started: ") != std::string::npos);
  }
}

/// Starts `tandem LINE`, sends it SIGTERM after some seconds, once or twice, and returns its exit code and how many
/// seconds it lived after the first.
std::pair<int, double> terminated(const std::string& line, const char* seconds, bool twice,
                                  const ScratchFolder& folder) {
  const std::string again = twice ? "sleep 0.1; kill -TERM $child 2>/dev/null; " : "";
  const Outcome outcome = run_in_shell("tandem " + line + " >/dev/null 2>errors & child=$!; sleep " + seconds +
                                           "; before=$(date +%s.%N); kill -TERM $child; " + again +
                                           "wait $child; code=$?; after=$(date +%s.%N); echo $code $before $after",
                                       {.folder = folder.path()});
  std::istringstream numbers(outcome.output);
  int code = -1;
  double before = 0, after = 0;
  numbers >> code >> before >> after;
  return {code, after - before};
}

TEST_CASE("SIGTERM ends the program while it renders, loads, classifies or probes, and leaves nothing") {
  const ScratchFolder folder;
  const std::string box = scenes + "cornell_box.obj";
  REQUIRE(shell("generate --triangles 1000000 -o large.obj", folder).exit_code == 0);
  const std::vector<std::string> lines = {
      "render " + box + " --device cpu --spp 16777216 -o x.png", "render large.obj --device cpu --spp 100000 -o x.png",
      "diff " + box + " --device cpu cpu-exact --size 512x512 --spp 64 --classify --survey 1000000 --out new",
      "diff " + box + " --device cpu cpu-exact --size 128x128 --probe --probe-rays 500000 --spp 1 --out new"};
  for (const std::string& line : lines)
    for (const bool twice : {false, true}) {
      CAPTURE(line);
      CAPTURE(twice);
      const auto [code, seconds] = terminated(line, "0.7", twice, folder);
      CHECK(code == 130);
      // Two seconds, or at once; on a machine that does five other things.
      CHECK(seconds < 10);
      CHECK(read_text(folder.path() / "errors").find("tandem: interrupted") != std::string::npos);
      CHECK(folder.names() == std::vector<std::string>{"errors", "large.mtl", "large.obj"});
    }
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
