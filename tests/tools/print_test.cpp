// What shaders print by debugPrintfEXT, on the command line.

#include <doctest/doctest.h>

#include <string>
#include <vector>

#include "tests/support/device_test.hpp"
#include "tests/support/process.hpp"
#include "tests/support/scratch_folder.hpp"

namespace tandem::test {
namespace {

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

constexpr const char* printing = R"(#version 460
#extension GL_EXT_debug_printf : enable
layout(local_size_x = 4) in;
layout(set = 0, binding = 0) buffer Values { float values[]; };
void main() {
  const uint i = gl_GlobalInvocationID.x;
  values[i] += 1;
  if (i % 3 == 0) debugPrintfEXT("%v2u: %.2f\n", uvec2(i, 7), values[i]);
}
)";

}  // namespace

TEST_CASE("what a shader prints is shown on every device, with the invocation, and its format is checked") {
  ScratchFolder folder;
  folder.write("printing.comp", printing);
  const std::string given = "run printing.comp --buffer Values=iota:8 --groups 2";
  for (const std::string& device : device_names()) {
    const Outcome all = run_tandem(given + " --device " + device, {.folder = folder.path()});
    CHECK(all.exit_code == 0);
    CHECK(all.output.starts_with(device + ": [0,0,0] 0, 7: 1.00\n" + device + ": [3,0,0] 3, 7: 4.00\n" + device +
                                 ": [6,0,0] 6, 7: 7.00\n" + device + ": ran in"));
    const Outcome one = run_tandem(given + " --print-lines 1 --device " + device, {.folder = folder.path()});
    CHECK(contains(one.output, device + ": ... and 2 more lines"));
    const Outcome none = run_tandem(given + " --print-lines 0 --device " + device, {.folder = folder.path()});
    CHECK(none.output.starts_with(device + ": ran in"));
  }
  const Outcome list = run_tandem("run printing.comp --list", {.folder = folder.path()});
  CHECK(contains(list.output, "prints at printing.comp: %v2u: %.2f\\n"));
  std::string wrong = printing;
  wrong.replace(wrong.find("%.2f"), 4, "%.2d");
  folder.write("wrong.comp", wrong);
  const Outcome check = run_tandem("run wrong.comp --check", {.folder = folder.path()});
  CHECK(check.exit_code == 2);
  CHECK(check.errors == "tandem: wrong.comp: debugPrintfEXT(\"%v2u: %.2d\\n\"): '%.2d' is given a float\n");
}

TEST_CASE("amber: what shaders print is shown, command by command") {
  ScratchFolder folder;
  folder.write("printing.amber", R"(#!amber
SHADER compute printing GLSL
#version 450
#extension GL_EXT_debug_printf : enable
layout(binding = 0) buffer Values { uint values[]; };
void main() {
  values[gl_GlobalInvocationID.x] *= 2;
  debugPrintfEXT("value %u", values[gl_GlobalInvocationID.x]);
}
END
BUFFER values DATA_TYPE uint32 DATA 3 4 END
PIPELINE compute doubling
  ATTACH printing
  BIND BUFFER values AS storage DESCRIPTOR_SET 0 BINDING 0
END
RUN doubling 2 1 1
RUN doubling 1 1 1
EXPECT values IDX 0 EQ 12 8
)");
  for (const std::string& device : device_names()) {
    const Outcome outcome = run_tandem("amber printing.amber --device " + device, {.folder = folder.path()});
    CHECK(outcome.exit_code == 0);
    std::vector<std::string> lines;
    for (std::size_t at = 0; (at = outcome.output.find("value ", at)) != std::string::npos; ++at)
      lines.push_back(outcome.output.substr(at, outcome.output.find('\n', at) - at));
    CHECK(lines == std::vector<std::string>{"value 6", "value 8", "value 12"});
    CHECK(outcome.output.find("printed  " + device) == 0);
  }
}

}  // namespace tandem::test
