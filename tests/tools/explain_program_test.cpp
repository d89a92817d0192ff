// `tandem explain` of shaders that are not the path tracer's.

#include <doctest/doctest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "tests/support/device_test.hpp"
#include "tests/support/process.hpp"
#include "tests/support/scratch_folder.hpp"

namespace tandem::test {
namespace {

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

constexpr const char* waves = R"(#version 460
layout(local_size_x = 4) in;
layout(set = 0, binding = 0) buffer Values { float values[]; };
layout(push_constant) uniform Push { float speed; };
float wave(float x) {
  return sin(x * speed);
}
void main() {
  uint i = gl_GlobalInvocationID.x;
  values[i] = wave(values[i]);
}
)";

/// Every invocation draws a ticket: another one on every device, and in every order.
constexpr const char* tickets = R"(#!amber
SHADER compute draw GLSL
#version 450
layout(local_size_x = 8) in;
layout(binding = 0) buffer Tickets { uint next; uint drawn[]; };
void main() { drawn[gl_GlobalInvocationID.x] = atomicAdd(next, 1u); }
END
BUFFER tickets DATA_TYPE uint32 SIZE 33 FILL 0
PIPELINE compute drawing
  ATTACH draw
  BIND BUFFER tickets AS storage DESCRIPTOR_SET 0 BINDING 0
END
RUN drawing 4 1 1
EXPECT tickets IDX 0 EQ 32
)";

const std::string bound = " --buffer values=iota:64 --push 0.75 --groups 16";

}  // namespace

TEST_CASE("a shader that computes the same bits says so") {
  ScratchFolder folder;
  folder.write("waves.comp", waves);
  const Outcome outcome =
      run_tandem("explain waves.comp" + bound + " --a cpu --b cpu-exact", {.folder = folder.path()});
  CHECK(outcome.exit_code == 0);
  CHECK(contains(outcome.output, "waves.comp, command 1 of 1: 64 x 1 x 1 invocations; a cpu-scalar, b cpu-exact"));
  CHECK(contains(outcome.output, "values of 64 invocations, 0 instructions differ"));
}

TEST_CASE("the first instruction that differs is named, with its line, its operands and a judgement") {
  for (const std::string& device : device_names()) {
    if (device == "cpu") continue;  // the reference
    ScratchFolder folder;
    folder.write("waves.comp", waves);
    const Outcome outcome =
        run_tandem("explain waves.comp" + bound + " --a cpu --b " + device, {.folder = folder.path()});
    CHECK(outcome.exit_code == 0);
    CAPTURE(outcome.output);
    CHECK(contains(outcome.output, "waves.comp:6  Sin"));
    CHECK(contains(outcome.output, "within precision: "));
    CHECK(contains(outcome.output, "    return sin(x * speed);"));
    const Outcome one =
        run_tandem("explain waves.comp" + bound + " --invocation 0 --b " + device, {.folder = folder.path()});
    CHECK(one.exit_code == 0);
    CHECK(contains(one.output, "of 1 invocations"));
  }
}

TEST_CASE("what depends on the order of invocations is told from what is wrong") {
  ScratchFolder folder;
  folder.write("tickets.amber", tickets);
  for (const std::string& device : device_names()) {
    // Eight lanes draw in another order than one.
    const std::string b = device == "cpu" ? "cpu-wide" : device;
    const Outcome outcome = run_tandem("explain tickets.amber --a cpu --b " + b, {.folder = folder.path()});
    CAPTURE(outcome.output);
    CHECK(outcome.exit_code == 0);
    CHECK_FALSE(contains(outcome.output, "mismatch"));
  }
}

TEST_CASE("two devices are compared with a verdict, as text, JSON and JUnit XML") {
  for (const std::string& device : device_names()) {
    const bool is_reference = device == "cpu";
    ScratchFolder folder;
    folder.write("waves.comp", waves);
    const std::string b = is_reference ? "cpu-exact" : device;
    const Outcome outcome = run_tandem("diff waves.comp" + bound + " --a cpu --b " + b + " --json d.json --junit d.xml",
                                       {.folder = folder.path()});
    CAPTURE(outcome.output);
    CHECK(outcome.exit_code == (is_reference ? 0 : 3));
    CHECK(contains(outcome.output, is_reference ? "verdict: equal bits" : "verdict: explained: within precision"));
    const nlohmann::json json = nlohmann::json::parse(read_text(folder.path() / "d.json"));
    CHECK(json["exit_code"] == outcome.exit_code);
    CHECK(json["resources"][0]["name"] == "values");
    CHECK(json["resources"][0]["values"] == 64);
    CHECK(json.contains("explanation") != is_reference);
    if (!is_reference) CHECK(json["explanation"]["instructions"][0]["line"] == 6);
    CHECK(contains(read_text(folder.path() / "d.xml"), "<testcase classname=\"waves.comp\" name=\"values\""));
    const Outcome within =
        run_tandem("diff waves.comp" + bound + " --a cpu --tolerance 0.001 --b " + b, {.folder = folder.path()});
    CHECK(within.exit_code == 0);
  }
}

TEST_CASE("an explanation is written as JSON") {
  ScratchFolder folder;
  folder.write("tickets.amber", tickets);
  const Outcome outcome =
      run_tandem("explain tickets.amber --a cpu --b cpu-wide --json e.json", {.folder = folder.path()});
  CHECK(outcome.exit_code == 0);
  const nlohmann::json json = nlohmann::json::parse(read_text(folder.path() / "e.json"));
  CHECK(json["recorded"] == 32);
  CHECK(json["outputs"][0]["name"] == "tickets");
}

TEST_CASE("what cannot be explained is refused in one sentence") {
  struct Bad {
    std::string arguments, error;
  };
  ScratchFolder folder;
  folder.write("waves.comp", waves);
  folder.write("tickets.amber", tickets);
  folder.write("broken.amber", "#!amber\nSHADER compute nothing\n");
  for (const Bad& bad : {
           Bad{"waves.comp", "tandem: the shaders need more than is given: "},
           Bad{"waves.comp" + bound + " --invocation 64",
               "tandem: there is no invocation 64,0,0; the launch has 64 x 1 x 1"},
           Bad{"waves.comp" + bound + " --invocation 1,x", "tandem: --invocation: '1,x' is not of the form X[,Y[,Z]]"},
           Bad{"waves.comp" + bound + " --command 2", "tandem: --command 2: there are commands 1 to 1"},
           Bad{"tickets.amber waves.comp", "tandem: waves.comp: one script is explained at a time"},
           Bad{"missing.amber", "missing.amber"},
           Bad{"broken.amber", "broken.amber:2"},
       }) {
    CAPTURE(bad.arguments);
    const Outcome outcome =
        run_tandem("explain " + bad.arguments + " --a cpu --b cpu-exact", {.folder = folder.path()});
    CHECK(outcome.exit_code == 2);
    CAPTURE(outcome.errors);
    CHECK(contains(outcome.errors, bad.error));
    CHECK(outcome.output.empty());
  }
}

}  // namespace tandem::test
