#include <doctest/doctest.h>

#include <algorithm>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/process.hpp"
#include "tests/support/scratch_folder.hpp"

namespace tandem::test {
namespace {

const std::string box = TANDEM_SOURCE_DIRECTORY "/scenes/cornell_box.obj";

/// The commands that a help text lists, one to a line, between "Subcommands:" and an empty line.
std::vector<std::string> listed_commands(const std::string& help) {
  std::vector<std::string> commands;
  std::istringstream lines(help.substr(help.find("Subcommands:\n")));
  std::string line;
  std::getline(lines, line);
  while (std::getline(lines, line) && !line.empty()) commands.push_back(words(line).at(0));
  return commands;
}

TEST_CASE("every command explains itself and all its options") {
  const std::string image =
      " --size --spp --depth --seed --camera --camera-position --camera-target --fov --view-height --lens-radius "
      "--focus-distance --background --integrator --sampler --nee --mis --bsdf-sampling --roulette --max-diffuse-depth "
      "--max-glossy-depth --max-specular-depth --clamp-direct --clamp-indirect --occlusion-length --terminator-offset "
      "--threads --trace "
      "--validation --allow-missing-mtl --thin-panes";
  const std::string thresholds = " --tier --min-within-1e3 --min-bit-equal --max-mean-difference --max-non-finite";
  const std::map<std::string, std::string> options = {
      {"devices", "--json"},
      {"render",
       "SCENE --output --device --denoise --denoise-levels --denoise-strength --denoise-fireflies Examples" + image},
      {"view", "SCENE --a --b --device --arbiter --output --spp-per-frame --exposure Exit Examples" + image},
      {"diff",
       "SCENE --a --b --json --junit --out --report --baseline --metrics --classify --classify-pixels --survey "
       "--arbiter "
       "--probe --probe-rays --trace-a --trace-b --min-p-value Exit Examples" +
           image + thresholds},
      {"explain",
       "SCENE --pixel --sample --a --b --arbiter --trace-a --trace-b --all-events --probe --json Exit Examples" +
           image},
      {"generate", "--triangles --output Example"},
      {"run",
       "SHADER --job -D -I --buffer --image --sampler --scene --non-opaque --spec --push --record --hit --entry "
       "--recursion --groups --size --device --compare --ulp --tolerance --save --print --lines --print-lines --list "
       "--check --time "
       "--threads --validation Exit Examples"},
      {"amber", "FILE --device --junit --time-limit --validation Exit Examples"},
      {"gallery", "LIST --out --device --only --size --spp --threads Exit Examples"},
      {"bench",
       "SCENE --kernels --device --repeat --vary --first-picture --quick --json --csv --html --baseline Exit "
       "Examples" +
           image},
      {"conformance", "--device --require-devices --filter --list --full --json --markdown Exit"},
      {"study", "sampling markov metropolis denoising Exit"},
      {"matrix", "SCENE --device --json Exit Example" + image + thresholds},
      {"suite", "FILE --out --fresh --json --junit --threads --validation Exit Examples"}};
  const Outcome overview = run_tandem("--help");
  CHECK(overview.exit_code == 0);
  const std::vector<std::string> commands = listed_commands(overview.output);
  CHECK(commands.size() == options.size());
  for (const std::string& command : commands) {
    CAPTURE(command);
    REQUIRE(options.contains(command));
    const Outcome help = run_tandem(command + " --help");
    CHECK(help.exit_code == 0);
    CHECK(help.errors.empty());
    for (const std::string& word : words(options.at(command))) {
      CAPTURE(word);
      CHECK(help.output.find(word) != std::string::npos);
    }
  }
  const Outcome of_shaders = run_tandem("explain x.comp --help");
  CHECK(of_shaders.exit_code == 0);
  for (const std::string& word :
       words("SHADER --buffer --invocation --command --invocations --memory --no-order --a --b "
             "--arbiter --threads --validation Exit Examples")) {
    CAPTURE(word);
    CHECK(of_shaders.output.find(word) != std::string::npos);
  }
  const Outcome diff_of_shaders = run_tandem("diff x.comp --help");
  for (const std::string& word :
       words("SHADER --buffer --a --b --arbiter --ulp --tolerance --json --junit --out --report "
             "--threads --validation Exit Examples")) {
    CAPTURE(word);
    CHECK(diff_of_shaders.output.find(word) != std::string::npos);
  }
  CHECK(run_tandem("--version").output == "tandem " TANDEM_VERSION "\n");
}

struct BadCommandLine {
  std::vector<std::string> arguments;
  std::string sentence;  ///< what the one line of standard error must contain
};

TEST_CASE("a bad command line is one sentence, exit code 2, and leaves no file") {
  const std::vector<BadCommandLine> bad = {
      {{}, "a command is required"},
      {{"paint"}, "'paint' is not a command"},
      {{"render"}, "SCENE is required"},
      {{"render", box}, "--output is required"},
      {{"render", box, "-o", "x.png", "--size", "0"}, "--size: '0' is not a size"},
      {{"render", box, "-o", "x.png", "--size", "0x0"}, "--size: '0x0' is not a size"},
      {{"render", box, "-o", "x.png", "--size", "16x"}, "--size: '16x' is not a size"},
      {{"render", box, "-o", "x.png", "--size", "16x16x16"}, "--size: '16x16x16' is not a size"},
      {{"render", box, "-o", "x.png", "--size", "-16x16"}, "--size: '-16x16' is not a size"},
      {{"render", box, "-o", "x.png", "--size", "65536x65536"}, "at most 268435456 pixels"},
      {{"render", box, "-o", "x.png", "--size", "4294967297x4294967297"}, "is not a size"},
      {{"render", box, "-o", "x.png", "--spp", "0"}, "--spp: '0' is not a whole number from 1"},
      {{"render", box, "-o", "x.png", "--spp", "-4"}, "--spp: '-4' is not a whole number"},
      {{"render", box, "-o", "x.png", "--spp", "4.5"}, "--spp: '4.5' is not a whole number"},
      {{"render", box, "-o", "x.png", "--spp", "many"}, "--spp: 'many' is not a whole number"},
      {{"render", box, "-o", "x.png", "--spp", ""}, "--spp: '' is not a whole number"},
      {{"render", box, "-o", "x.png", "--spp"}, "--spp"},
      {{"render", box, "-o", "x.png", "--depth", "0"}, "--depth: '0' is not a whole number from 1"},
      {{"render", box, "-o", "x.png", "--seed", "4294967296"}, "--seed: '4294967296' is not a whole number"},
      {{"render", box, "-o", "x.png", "--threads", "-1"}, "--threads: '-1' is not a whole number"},
      {{"render", box, "-o", "x.png", "--trace", "rays"}, "--trace: 'rays' is neither 'query' nor 'pipeline'"},
      {{"render", box, "-o", "x.png", "--fov", "180"}, "--fov: '180' is not a number from 1 to 175"},
      {{"render", box, "-o", "x.png", "--fov", "nan"}, "--fov: 'nan' is not a number"},
      {{"render", box, "-o", "x.png", "--camera-position", "1,2"}, "--camera-position: '1,2' is not three numbers"},
      {{"render", box, "-o", "x.png", "--camera-target", "1,2,inf"}, "--camera-target: '1,2,inf' is not three numbers"},
      {{"render", box, "-o", "x.png", "--background", "-1,0,0"}, "that are at least 0"},
      {{"render", box, "-o", "x.png", "--camera-position", "1,1,1", "--camera-target", "1,1,1"}, "camera"},
      {{"render", box, "-o", "x.png", "--integrator", "metropolis", "--sampler", "sobol"}, "sampler sobol"},
      {{"explain", box, "--pixel", "1,1", "--a", "cpu", "--b", "cpu", "--integrator", "metropolis"}, "no paths"},
      {{"diff", box, "--a", "cpu", "--b", "cpu", "--classify", "--integrator", "metropolis"}, "no paths"},
      {{"study", "metropolis", box, "--integrator", "direct"}, "path and metropolis"},
      {{"render", box, "-o", "x.png", "--colour", "red"}, "--colour"},
      {{"render", box, box, "-o", "x.png"}, "not expected"},
      {{"render", box, "-o", "x.jpg"}, "x.jpg"},
      {{"render", box, "-o", "x"}, "'x'"},
      {{"render", box, "-o", "missing/x.png"}, "missing"},
      {{"render", box, "-o", "."}, "'.'"},
      {{"render", "missing.obj", "-o", "x.png"}, "missing.obj"},
      {{"render", ".", "-o", "x.png"}, "'.'"},
      {{"render", box, "-o", "x.png", "--device", "teapot"}, "teapot"},
      {{"render", box, "-o", "x.png", "--device", "vulkan:99"}, "vulkan:99"},
      {{"diff", box, "--a", "cpu", "--b", "teapot", "--out", "new"}, "teapot"},
      {{"diff", "missing.obj", "--out", "new"}, "missing.obj"},
      {{"diff", box, "--a", "cpu", "--b", "cpu", "--json", "missing/diff.json", "--out", "new"}, "missing"},
      {{"diff", box, "--a", "cpu", "--b", "cpu", "--out", box}, "cornell_box.obj"},
      {{"diff", box, "--a", "cpu", "--b", "cpu", "--out", "new", "--json", "./new/../new/a.png"}, "two results"},
      {{"diff", box, "--a", "cpu", "--b", "cpu", "--out", "new/deep", "--json", "missing/x"}, "missing"},
      {{"diff", box, "--a", "cpu", "--b", "cpu", "--min-bit-equal", "1.5"},
       "--min-bit-equal: '1.5' is not a number from 0 to 1"},
      {{"bench", box}, "--device is required"},
      {{"render", box, "-o", "x.png", "--device", "cpu,vulkan"}, "--device: one device is taken, not 2; 'tandem diff'"},
      {{"render", box, "-o", "x.png", "--device", "cpu", "vulkan"}, "--device: one device is taken, not 2"},
      {{"render", box, "-o", "x.png", "--device", ","}, "--device: ',' is not a device or a list of devices"},
      {{"render", box, "-o", "x.png", "--device="}, "--device: '' is not a device"},
      {{"render", box, "-o", "x.png", "--device", "cpu,"}, "--device: 'cpu,' is not a device"},
      {{"render", box, "-o", "x.png", "--device", "cpu,,cpu"}, "--device: 'cpu,,cpu' is not a device"},
      {{"diff", box, "--device", "cpu"}, "--device: two devices are compared, not 1"},
      {{"diff", box, "--device", "cpu", "cpu", "vulkan"}, "not 3; 'tandem matrix' compares more"},
      {{"diff", box, "--device", "cpu,cpu", "--b", "cpu"}, "--b excludes --device"},
      {{"bench", box, "--device", "cpu", "--repeat", "0"}, "--repeat: '0' is not a whole number from 1"},
      {{"bench", box, "--device", "cpu", "--json", "/dev/null"}, "/dev/null"},
      {{"bench", "--device", "cpu"}, "SCENE is required"},
      {{"bench", "--kernels"}, "--device is required"},
      {{"bench", "--kernels", "teapot", "--device", "cpu"},
       "'teapot' is not a kernel; the kernels are matrix-product, "},
      {{"bench", "--kernels", "fft,", "--device", "cpu"}, "'' is not a kernel"},
      {{"bench", "--kernels", "fft,fft", "--device", "cpu"}, "the kernel 'fft' is named twice"},
      {{"bench", "--kernels", "fft", box, "--device", "cpu"}, "--kernels: SCENE is about a scene"},
      {{"bench", "--kernels", "--device", "cpu", "--spp", "4"}, "--kernels: --spp is about a scene"},
      {{"bench", "--kernels", "--device", "cpu", "--json", "/dev/null"}, "/dev/null"},
      {{"conformance", "--filter", "teapot.*"}, "no case matches 'teapot.*'"},
      {{"conformance", "--device", "teapot"}, "teapot"},
      {{"conformance", "--json", "missing/x.json"}, "missing"},
      {{"generate", "--triangles", "3", "-o", "x.obj"}, "--triangles: '3' is not a whole number"},
      {{"generate", "--triangles", "100", "-o", "missing/x.obj"}, "missing"},
  };
  const ScratchFolder folder;
  for (const BadCommandLine& line : bad) {
    std::string words;
    for (const std::string& word : line.arguments) words += word + " ";
    CAPTURE(words);
    const Outcome outcome = run_tandem(line.arguments, {.folder = folder.path()});
    CAPTURE(outcome.errors);
    CHECK(outcome.exit_code == 2);
    CHECK(outcome.output.empty());
    CHECK(outcome.errors.starts_with("tandem: "));
    CHECK(std::count(outcome.errors.begin(), outcome.errors.end(), '\n') == 1);
    CHECK(outcome.errors.find(line.sentence) != std::string::npos);
    CHECK(folder.names().empty());
  }
}

TEST_CASE("without a Vulkan driver the error is one sentence, and the CPU device works") {
  const ScratchFolder folder;
  const ProcessOptions options = {.folder = folder.path(),
                                  .environment = {"VK_DRIVER_FILES=/nonexistent", "VK_ICD_FILENAMES=/nonexistent"}};
  const Outcome vulkan = run_tandem(words("render {} -o x.png --device vulkan", {box}), options);
  const Outcome cpu = run_tandem(words("render {} -o x.png --size 8x8 --spp 1", {box}), options);
  CHECK(vulkan.exit_code == 2);
  CHECK(vulkan.errors == "tandem: no Vulkan driver is installed\n");
  CHECK(cpu.exit_code == 0);
  CHECK(cpu.errors == "");
}

TEST_CASE("devices are named in one way by all commands, and settings by one name or its old one") {
  const ScratchFolder folder;
  const auto code = [&](const std::string& line) {
    CAPTURE(line);
    const Outcome outcome = run_tandem(words(line, {box}), {.folder = folder.path()});
    CHECK(outcome.errors == "");
    return outcome.exit_code;
  };
  const std::string small = " --size 8x8 --spp 1";
  // The scene may follow the devices.
  CHECK(code("diff --device cpu cpu-exact {}" + small) == 0);
  CHECK(code("diff --device cpu,cpu-exact {}" + small) == 0);
  CHECK(code("diff --device=cpu cpu-exact {}" + small) == 0);
  CHECK(code("diff --device cpu {} --device cpu-exact" + small) == 0);
  CHECK(code("matrix --device cpu cpu-exact cpu {}" + small) == 0);
  CHECK(code("bench --repeat 1 --device cpu cpu {}" + small) == 0);
  CHECK(code("explain --pixel 1,1 --device cpu cpu-exact {}" + small) == 0);

  CHECK(code("diff {} --device cpu cpu --size 8x8 --samples 3 --max-depth=2 --light-sampling off --json x.json") == 0);
  const std::string json = read_text(folder.path() / "x.json");
  for (const char* setting : {"\"spp\": 3,", "\"depth\": 2,", "\"nee\": false,"})
    CHECK(json.find(setting) != std::string::npos);
}

TEST_CASE("a scene that cannot be used is one sentence and exit code 2") {
  const ScratchFolder folder;
  const std::vector<std::pair<std::string, std::string>> scenes = {
      {"empty.obj", ""},
      {"no_triangles.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n"},
      {"nan.obj", "v 0 0 nan\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"},
      {"index.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n"},
      {"no_material.obj", "mtllib absent.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"}};
  for (const auto& scene : scenes) {
    const auto& [name, text] = scene;
    CAPTURE(scene.first);
    write_text(folder.path() / name, text);
    const Outcome outcome = run_tandem(words("render {} -o x.png", {name}), {.folder = folder.path()});
    CAPTURE(outcome.errors);
    CHECK(outcome.exit_code == 2);
    CHECK(outcome.errors.find(name) != std::string::npos);
    CHECK(std::count(outcome.errors.begin(), outcome.errors.end(), '\n') == 1);
    std::filesystem::remove(folder.path() / name);
    CHECK(folder.names().empty());
  }
}

}  // namespace
}  // namespace tandem::test
