// tandem_shader_family: random compute shaders, each run in several ways that must give the same bits.

#include <chrono>
#include <cstdio>
#include <exception>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "devices/devices.hpp"
#include "tests/family/forms.hpp"
#include "tests/family/reduction.hpp"
#include "tests/support/scratch_folder.hpp"

namespace {

using namespace tandem;
using namespace tandem::family;

/// One way to run a shader.
struct Way {
  std::string pass = {};          ///< of spirv-opt, first
  std::optional<Form> form = {};  ///< a kernel of our own
  rhi::DeviceHandle device = {};  ///< or a device

  std::string name() const {
    const std::string place = form ? name_of(*form) : device->info().name;
    return pass.empty() ? place : place + " after " + pass;
  }
};

std::string bits_that_differ(const Results& a, const Results& b) {
  std::size_t count = 0, first = 0;
  for (std::size_t i = 0; i + 4 <= a.size(); i += 4) {
    if (std::equal(a.begin() + static_cast<std::ptrdiff_t>(i), a.begin() + static_cast<std::ptrdiff_t>(i + 4),
                   b.begin() + static_cast<std::ptrdiff_t>(i)))
      continue;
    if (count++ == 0) first = i / 4;
  }
  return count == 0 ? "" : fmt::format("{} words differ, the first is {}", count, first);
}

class Comparison {
 public:
  Comparison(KernelRunner& runner, Way reference, std::uint32_t seed)
      : runner_(runner), reference_(std::move(reference)), seed_(seed) {}

  Results results(const std::vector<std::uint32_t>& spirv, const Way& way, const ShaderData& data) {
    const std::vector<std::uint32_t> words = optimized(spirv, way.pass);
    return way.form ? runner_.run(words, *way.form, data) : run_on_device(*way.device, words, data);
  }

  /// What is wrong with the shader run in a way, "" when nothing is.
  std::string fault(const GeneratedShader& shader, const std::vector<std::uint32_t>& spirv, const Results& expected,
                    const Way& way) {
    try {
      return bits_that_differ(expected, results(spirv, way, data_for(shader, seed_)));
    } catch (const std::exception& error) {
      return error.what();
    }
  }

  /// The smaller shader that fails alike.
  ShaderTree shrunk(const GeneratedShader& shader, const Way& way, const std::string& fault_text, std::size_t limit) {
    const std::string kind = fault_text.substr(0, fault_text.find(' ') == 0 ? 0 : 20);
    const bool differs = fault_text.find("words differ") != std::string::npos;
    return reduced(
        shader.tree,
        [&](const ShaderTree& tree) {
          const GeneratedShader candidate{
              tree, {shader.workgroup_size[0], shader.workgroup_size[1], shader.workgroup_size[2]}};
          try {
            const std::vector<std::uint32_t> spirv = compiled(tree);
            const Results expected = results(spirv, reference_, data_for(candidate, seed_));
            const std::string text = fault(candidate, spirv, expected, way);
            return differs ? text.find("words differ") != std::string::npos : text.substr(0, 20) == kind;
          } catch (const std::exception&) {
            return false;
          }
        },
        limit);
  }

 private:
  KernelRunner& runner_;
  Way reference_;  ///< what the others are compared with
  std::uint32_t seed_;
};

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Runs random compute shaders in several ways and compares what they write");
  std::uint32_t seed = 1, count = 10;
  std::vector<std::string> forms = {"4", "8", "16"}, passes = {"none"}, devices;
  std::string optimization = "-O1", folder;
  std::size_t limit = 1500;
  bool shrinks = false, prints = false, is_robust = false, is_quiet = false;
  Features features;
  app.add_option("--seed", seed, "of the first shader; the others have the following ones")->capture_default_str();
  app.add_option("--count", count, "shaders")->capture_default_str();
  app.add_option("--forms", forms, "of kernels, beside the scalar one: lanes, \"scalar\" to compare it with devices")
      ->delimiter(',')
      ->capture_default_str();
  app.add_option("--devices", devices, "to run on as well")->delimiter(',');
  app.add_option("--passes", passes, "of spirv-opt, each tried alone: none,-O,-Os,--loop-unroll")->delimiter(',');
  app.add_option("--optimization", optimization, "of the C++ compiler")->capture_default_str();
  app.add_option("--folder", folder, "for kernels, which stay there; without it they are in a scratch folder");
  app.add_option("--limit", limit, "of attempts to make a shader smaller")->capture_default_str();
  app.add_flag("--shrink", shrinks, "print a small shader that fails, instead of the whole");
  app.add_flag("--print", prints, "print every shader and run none");
  app.add_flag("--quiet", is_quiet, "print no shader that fails");
  app.add_flag("--robust", is_robust, "kernels that stay inside of buffers and arrays");
  app.add_flag("--approximate", features.approximate, "functions that devices round differently too");
  app.add_flag("--barriers", features.barriers, "shared memory and barriers, on devices only");
  app.add_flag("--subgroups", features.subgroups, "operations among four neighbours, on devices only");
  CLI11_PARSE(app, argc, argv);

  const test::ScratchFolder scratch;
  KernelRunner runner(folder.empty() ? scratch.path() : std::filesystem::path(folder), optimization);
  // Kernels of our own have no fibres, which shaders need that wait for each other.
  const bool waits = features.barriers || features.subgroups;
  if (waits) forms.clear();
  const Way reference = waits ? Way{.device = create_device({.name = "cpu-scalar"})} : Way{.form = Form{}};
  std::vector<Way> ways;
  for (const std::string& pass : passes) {
    const std::string name = pass == "none" ? "" : pass;
    for (const std::string& form : forms)
      if (form != "scalar" || !name.empty() || is_robust)
        ways.push_back({.pass = name,
                        .form = Form{form == "scalar" ? 0 : static_cast<std::uint32_t>(std::stoul(form)), is_robust}});
    for (const std::string& device : devices)
      ways.push_back({.pass = name, .device = create_device({.name = device, .robust_access = false})});
  }

  std::uint32_t failures = 0, runs = 0, left_out = 0;
  const auto start = std::chrono::steady_clock::now();
  for (std::uint32_t number = seed; number < seed + count; ++number) {
    const GeneratedShader shader = generate(number, features);
    if (prints) {
      fmt::print("// seed {}\n{}\n", number, printed(shader.tree));
      continue;
    }
    Comparison comparison(runner, reference, number);
    std::vector<std::uint32_t> spirv;
    Results expected;
    try {
      spirv = compiled(shader.tree);
      if (spirv.empty()) {
        ++left_out;
        continue;
      }
      expected = comparison.results(spirv, reference, data_for(shader, number));
    } catch (const std::exception& error) {
      ++failures;
      fmt::print("seed {}: {}\n", number, error.what());
      continue;
    }
    for (const Way& way : ways) {
      ++runs;
      const std::string fault = comparison.fault(shader, spirv, expected, way);
      if (fault.empty()) continue;
      ++failures;
      fmt::print("seed {}, {}: {}\n", number, way.name(), fault);
      if (is_quiet) continue;
      fmt::print("{}\n", printed(shrinks ? comparison.shrunk(shader, way, fault, limit) : shader.tree));
    }
    std::fflush(stdout);
  }
  if (prints) return 0;
  fmt::print("{} shaders, {} comparisons, {} failures, {:.1f} s; glslang crashes on {}\n", count, runs, failures,
             std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(), left_out);
  return failures == 0 ? 0 : 1;
}
