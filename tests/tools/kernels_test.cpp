// The compute kernels of `tandem bench --kernels`.

#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "devices/devices.hpp"
#include "tests/support/device_test.hpp"
#include "tests/support/process.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tools/kernels/kernel.hpp"
#include "tools/kernels/kernel_run.hpp"

namespace tandem::test {
namespace {

using kernels::Kernel;
using kernels::KernelRun;
using kernels::Problem;

void check_answers(const rhi::DeviceHandle& device) {
  for (const Kernel& kernel : kernels::kernels()) {
    CAPTURE(kernel.name);
    const Problem problem = kernel.problem(kernels::Size::small);
    KernelRun run(device, kernel, problem);
    CHECK(run.compile_milliseconds() > 0.0);
    for (int round = 0; round < 2; ++round) CHECK_NOTHROW(run.run());
  }
}

TANDEM_DEVICE_TEST("every kernel's answer is right") { check_answers(device_handle); }

TEST_CASE("every kernel's answer is right with one lane") { check_answers(create_device({.name = "cpu-scalar"})); }

TANDEM_DEVICE_TEST("an answer that is not the expected one is a sentence that names the word") {
  for (const Kernel& kernel : kernels::kernels()) {
    if (std::string(kernel.name) != "n-body" && std::string(kernel.name) != "prefix-sum") continue;
    Problem problem = kernel.problem(kernels::Size::small);
    problem.expected[7] += 1000.0;
    KernelRun run(device_handle, kernel, problem);
    try {
      run.run();
      FAIL("not noticed");
    } catch (const kernels::WrongAnswer& wrong) {
      const std::string sentence = wrong.what();
      CAPTURE(sentence);
      CHECK(sentence.starts_with("the kernel '" + std::string(kernel.name) + "' answers wrongly on " + device_name));
      CHECK(sentence.find(": word 7 is ") != std::string::npos);
      CHECK((sentence.find("which may differ by") != std::string::npos) == (problem.tolerance > 0.0));
    }
  }
}

TEST_CASE("tolerances are far below the answers, and what was never written is wrong") {
  for (const Kernel& kernel : kernels::kernels()) {
    CAPTURE(kernel.name);
    const Problem problem = kernel.problem(kernels::Size::small);
    double squares = 0.0;
    for (const double value : problem.expected) squares += value * value;
    CHECK(problem.tolerance < 1e-3 * std::sqrt(squares / static_cast<double>(problem.expected.size())));
    CHECK(kernels::mistake(problem, kernels::Words(problem.expected.size(), ~0U)) != "");
    CHECK(kernels::mistake(problem, kernels::Words(problem.expected.size(), 0U)) != "");
    CHECK(kernel.source().starts_with("#version 460\n"));
  }
}

TEST_CASE("kernels are chosen by name, in the order of the list") {
  CHECK(kernels::named_kernels("").size() == kernels::kernels().size());
  const std::vector<Kernel> chosen = kernels::named_kernels("n-body,fft");
  REQUIRE(chosen.size() == 2);
  CHECK(chosen[0].name == std::string("n-body"));
  CHECK(chosen[1].name == std::string("fft"));
  CHECK_THROWS_WITH_AS(kernels::named_kernels("fft,fft"), "the kernel 'fft' is named twice", Error);
  CHECK_THROWS_AS(kernels::named_kernels("fft,"), Error);
}

TEST_CASE("bench measures kernels on every device in every round") {
  const ScratchFolder folder;
  const Outcome outcome = run_tandem("bench --kernels fft,prefix-sum --device cpu cpu-scalar --repeat 3 --json k.json",
                                     {.folder = folder.path()});
  CHECK(outcome.errors == "");
  REQUIRE(outcome.exit_code == 0);
  CHECK(outcome.output.find("2 kernels: 3 rounds after one to warm up") == 0);
  const nlohmann::json json = nlohmann::json::parse(read_text(folder.path() / "k.json"));
  CHECK(json.at("format") == 1);
  CHECK(json.at("version") == TANDEM_VERSION);
  CHECK(json.at("settings").at("threads") == 0);
  REQUIRE(json.at("devices").size() == 2);
  CHECK(json.at("devices").at(1).at("name") == "cpu-scalar");
  REQUIRE(json.at("kernels").size() == 2);
  CHECK(json.at("kernels").at(0).at("name") == "fft");
  for (const nlohmann::json& kernel : json.at("kernels")) {
    CHECK(kernel.at("description").get<std::string>() != "");
    REQUIRE(kernel.at("devices").size() == 2);
    CHECK(kernel.at("devices").at(0).at("speed_ratio").at("median") == 1.0);
    for (const nlohmann::json& device : kernel.at("devices")) {
      CHECK(device.at("ms_rounds").size() == 3);
      CHECK(device.at("compile_ms").get<double>() > 0.0);
      CHECK(device.at("ms").at("min").get<double>() > 0.0);
      CHECK(device.at("ms").at("min") <= device.at("ms").at("median"));
      CHECK(device.at("ms").at("median") <= device.at("ms").at("max"));
    }
  }
}

}  // namespace
}  // namespace tandem::test
