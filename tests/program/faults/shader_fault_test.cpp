// Wrong instructions are put into a device, and explain() has to name each: the line, the instruction, a mismatch, and
// nothing else. Shaders without a fault have no mismatch.

#include <doctest/doctest.h>

#include <algorithm>
#include <string>

#include "program/explain/explanation.hpp"
#include "program/explain/source.hpp"
#include "program/explain/text.hpp"
#include "tests/faults/faulty_device.hpp"
#include "tests/program/faults/explained_shader.hpp"
#include "tests/program/faults/shader_fault.hpp"
#include "tests/support/device_test.hpp"

using namespace tandem;
using namespace tandem::test;

namespace {

std::string text_of(const program::Explanation& explanation, const program::Job& job) {
  return program::explanation_text(explanation, job, {.a = "a", .b = "b", .input = "shader"});
}

/// With one lane on the CPU: g++ takes long over wide kernels that record.
rhi::DeviceHandle narrow(const std::string& device_name) {
  return test::device(device_name == "cpu" ? "cpu-scalar" : device_name);
}

program::Explanation explained(const ExplainedShader& shader, rhi::Device& b) {
  program::ExplainOptions options;
  options.exact = test::device("cpu-exact").get();
  return program::explain(*test::device("cpu-scalar"), b, shader.job, options);
}

}  // namespace

TANDEM_DEVICE_TEST("shaders without a fault have no mismatch") {
  for (const ExplainedShader& shader : explained_shaders()) {
    CAPTURE(shader.name);
    const program::Explanation explanation = explained(shader, *narrow(device_name));
    CHECK(explanation.lockstep.values > 1000);
    CHECK(explanation.lockstep.incomplete == 0);
    if (program::gravest(explanation) == program::Cause::mismatch) FAIL_CHECK(text_of(explanation, shader.job));
  }
}

// Every fault is compiled anew. The CPU device, whose compiler is slow, has every sixth.
TANDEM_DEVICE_TEST("every wrong instruction is found at its line, as a mismatch of the device that has it") {
  const std::vector<ExplainedShader> shaders = explained_shaders();
  const std::vector<ShaderFault> faults = shader_faults();
  CHECK(faults.size() >= 25);
  for (std::size_t i = 0; i < faults.size(); i += device_name == "cpu" ? 6 : 1) {
    const ShaderFault& fault = faults[i];
    CAPTURE(fault.name);
    const auto shader = std::ranges::find(shaders, fault.shader, &ExplainedShader::name);
    REQUIRE(shader != shaders.end());
    const program::Module module = program::parse_module(
        program::with_fixed_constants(shader->job.shaders[0].spirv, {}, fault.shader), fault.shader);
    const rhi::DeviceHandle faulty = faulty_device(narrow(device_name), edits_of(fault, module));
    const program::Explanation explanation = explained(*shader, *faulty);
    const std::size_t expected = place_of(fault, module);
    std::size_t mismatches = 0;
    for (const program::Site& site : explanation.lockstep.sites) {
      const program::Judgement& judgement = site.example.judgement;
      if (judgement.cause != program::Cause::mismatch) continue;
      ++mismatches;
      CHECK(site.instruction == expected);
      CHECK(program::source_of(module, site.instruction).line == fault.line);
      CHECK((judgement.wrong == program::WrongDevice::b || judgement.wrong == program::WrongDevice::unknown));
    }
    CHECK(mismatches == 1);
    if (mismatches != 1) MESSAGE(text_of(explanation, shader->job));
  }
}
