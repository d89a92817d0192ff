// `tandem run`: shaders of a user's own.

#include <doctest/doctest.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/pathtracer/load/description/json_schema.hpp"
#include "tests/support/device_test.hpp"
#include "tests/support/process.hpp"
#include "tests/support/scratch_folder.hpp"

namespace tandem::test {
namespace {

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

constexpr const char* scaling = R"(#version 460
#ifndef TYPE
#define TYPE float
#endif
layout(local_size_x = 4) in;
layout(constant_id = 3) const int added = 0;
layout(set = 0, binding = 0) readonly buffer In { TYPE values[]; };
layout(set = 0, binding = 1) buffer Out { uint count; TYPE results[]; } result;
layout(push_constant) uniform Push { float factor; uint last; };
void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i == 0) result.count = last + 1;
  if (i <= last) result.results[i] = values[i] * TYPE(factor) + TYPE(added);
}
)";

const std::string given = " --buffer In=iota:6 --buffer result=zeros:6 --push factor=2 --push last=5 --size 6";

std::vector<float> floats_of(const std::filesystem::path& path) {
  const std::string bytes = read_text(path);
  std::vector<float> values(bytes.size() / sizeof(float));
  std::memcpy(values.data(), bytes.data(), values.size() * sizeof(float));
  return values;
}

/// A folder with the shader scaling.comp.
struct Scaling {
  Scaling() { folder.write("scaling.comp", scaling); }
  Outcome run(const std::string& options) const {
    return run_tandem("run scaling.comp" + options, {.folder = folder.path()});
  }
  ScratchFolder folder;
};

TEST_CASE("a shader runs from the command line on every device, and its results are saved and printed") {
  const Scaling scaling;
  for (const std::string& device : device_names()) {
    CAPTURE(device);
    const Outcome outcome =
        scaling.run(given + " --spec added=1 --save result=out.csv --save In=in.bin --print --device " + device);
    CHECK(outcome.errors == "");
    REQUIRE(outcome.exit_code == 0);
    CHECK(read_text(scaling.folder.path() / "out.csv") ==
          "name,value\ncount,6\nresults[0],1\nresults[1],3\nresults[2],5\nresults[3],7\nresults[4],9\nresults[5],11\n");
    CHECK(floats_of(scaling.folder.path() / "in.bin") == std::vector<float>{0, 1, 2, 3, 4, 5});
    CHECK(contains(outcome.output, "result: Out, 28 bytes\n"));
    CHECK(contains(outcome.output, "  results[5]     11\n"));
    CHECK_FALSE(contains(outcome.output, "In: "));
  }
}

TEST_CASE("buffers come from lists and files of every kind, and macros change their types") {
  const Scaling scaling;
  const std::string rest = " --buffer 0:1=zeros:3 --push 10,2 --groups 1 --save 0:1=out.csv";
  const std::string expected = "name,value\ncount,3\nresults[0],50\nresults[1],60\nresults[2],70\n";
  const auto check = [&](const std::string& options) {
    CAPTURE(options);
    const Outcome outcome = scaling.run(options + rest);
    CHECK(outcome.errors == "");
    CHECK(outcome.exit_code == 0);
    CHECK(read_text(scaling.folder.path() / "out.csv") == expected);
  };
  check(" --buffer values=5,6,7");
  check(" --buffer values=5,6,7:8");
  scaling.folder.write("in.txt", "5 6\n7\n");
  check(" --buffer values=in.txt");
  scaling.folder.write("in.csv", "value\n5\n6\n7\n");
  check(" --buffer values=in.csv");
  scaling.folder.write("3.csv", "5,6,7\n");
  check(" --buffer values=3.csv:3");
  check(" -DTYPE=uint --buffer values=in.csv");
  const float floats[] = {5, 6, 7};
  scaling.folder.write("in.bin", std::string_view(reinterpret_cast<const char*>(floats), sizeof(floats)));
  check(" --buffer values=in.bin");
  // What one run saves as .npy another one reads.
  REQUIRE(scaling.run(" --buffer In=5,6,7 --buffer 0:1=zeros:3 --push 1,2 --size 3 --save In=in.npy").exit_code == 0);
  check(" --buffer values=in.npy");
}

TEST_CASE("random numbers are those of their seed, in their range") {
  const Scaling scaling;
  const auto saved = [&](const std::string& contents) {
    REQUIRE(scaling.run(" --buffer In=" + contents + " --buffer Out=zeros:8 --push 1,7 --groups 1 --save In=in.bin")
                .exit_code == 0);
    return floats_of(scaling.folder.path() / "in.bin");
  };
  const std::vector<float> first = saved("random:7:64B:10..20");
  CHECK(first.size() == 16);
  for (const float value : first) CHECK((value >= 10 && value < 20));
  CHECK(first == saved("random:7:16:10..20"));
  CHECK(first != saved("random:8:16:10..20"));
}

/// Each invocation reads what its neighbour writes: with lanes all read first, one after the other the last one reads
/// what the first has written.
constexpr const char* racing = R"(#version 460
layout(local_size_x = 4) in;
struct Pair { uint id; float value; };
layout(binding = 0) buffer Out { uint size; Pair pairs[4]; } result;
void main() {
  const uint i = gl_LocalInvocationIndex;
  result.pairs[i].value = result.pairs[(i + 1) % 4].value;
}
)";

TEST_CASE("two devices are compared value by value; what differs has a name, and a tolerance accepts it") {
  const ScratchFolder folder;
  folder.write("race.comp", racing);
  const std::string line = "run race.comp --buffer result=0,0,1,0,2,0,3,0,4 --groups 1 --compare";
  const auto run = [&](const std::string& options) { return run_tandem(line + options, {.folder = folder.path()}); };
  const Outcome same = run(" --device cpu,cpu,cpu");
  CHECK(same.exit_code == 0);
  CHECK(same.errors == "");
  CHECK(contains(same.output, "cpu against cpu: agree\n  result            9 of 9 values bit-equal\n"));
  const Outcome other = run(" --device cpu,cpu-scalar");
  CHECK(other.exit_code == 1);
  CHECK(contains(other.output,
                 "cpu against cpu-scalar: differ\n  result            8 of 9 values bit-equal, largest "
                 "difference 8388608 ulp, 0.5 relative, 1 absolute\n"
                 "    first   result.pairs[3].value: 1 against 2 (8388608 ulp, 0.5 relative)\n"));
  const Outcome tolerant = run(" --device cpu,cpu-scalar --tolerance 0.5");
  CHECK(tolerant.exit_code == 0);
  CHECK(contains(tolerant.output, "8 of 9 values bit-equal, 9 within the tolerance"));
  CHECK(run(" --device cpu,cpu-scalar --ulp 8388607").exit_code == 1);
  CHECK(run(" --device cpu,cpu-scalar --ulp 8388608").exit_code == 0);
}

TEST_CASE("an image is written, saved as a picture and as numbers, and read as a texture") {
  const ScratchFolder folder;
  folder.write("paint.comp", R"(#version 460
layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0, rgba8) uniform writeonly image2D picture;
void main() {
  const ivec2 p = ivec2(gl_GlobalInvocationID.xy);
  if (p.x < 4 && p.y < 2) imageStore(picture, p, vec4(p.x / 3.0, p.y, 0.2, 1));
}
)");
  folder.write("read.comp", R"(#version 460
layout(binding = 0) uniform sampler2D picture;
layout(binding = 1) uniform Size { vec2 at; };
layout(binding = 2) buffer Out { vec4 color; };
void main() { color = textureLod(picture, at, 0); }
)");
  const auto run = [&](const std::string& options) { return run_tandem("run " + options, {.folder = folder.path()}); };
  const Outcome painted =
      run("paint.comp --image picture=4x2 --size 4,2 --save picture=a.png --device " + device_names().back());
  CHECK(painted.errors == "");
  REQUIRE(painted.exit_code == 0);
  const Outcome read =
      run("read.comp --image picture=a.png --sampler linear,clamp --buffer Size=1,1 --buffer color=zeros --groups 1 "
          "--save color=c.txt");
  CHECK(read.errors == "");
  REQUIRE(read.exit_code == 0);
  CHECK(read_text(folder.path() / "c.txt") == "1\n1\n0.2\n1\n");
  REQUIRE(run("paint.comp --image picture=4x2 --size 4,2 --save picture=a.npy").exit_code == 0);
  CHECK(contains(read_text(folder.path() / "a.npy"), "'shape': (2, 4, 4)"));
  CHECK(run("paint.comp --image picture=4x2 --size 4,2 --save picture=a.exr").exit_code == 0);
  const Outcome wrong = run("paint.comp --image picture=r32f:4x2 --size 4,2");
  CHECK(wrong.exit_code == 2);
  CHECK(contains(wrong.errors, "another format"));
}

void write_rays(const ScratchFolder& folder) {
  folder.write("a.rgen", R"(#version 460
#extension GL_EXT_ray_tracing : require
layout(binding = 0) uniform accelerationStructureEXT scene;
layout(binding = 1) writeonly buffer Out { float results[]; };
layout(location = 0) rayPayloadEXT float value;
void main() {
  traceRayEXT(scene, 0, 0xff, 0, 0, 0, vec3(gl_LaunchIDEXT.x - 1.5, 0.25, 1), 0.0, vec3(0, 0, -1), 9.0, 0);
  results[gl_LaunchIDEXT.x] = value;
}
)");
  folder.write("a.rmiss", R"(#version 460
#extension GL_EXT_ray_tracing : require
layout(location = 0) rayPayloadInEXT float value;
void main() { value = -1; }
)");
  folder.write("a.rchit", R"(#version 460
#extension GL_EXT_ray_tracing : require
layout(location = 0) rayPayloadInEXT float value;
layout(shaderRecordEXT) buffer Record { float factor; };
void main() { value = factor * (1 + gl_PrimitiveID); }
)");
  folder.write("a.rahit", R"(#version 460
#extension GL_EXT_ray_tracing : require
void main() { if (gl_PrimitiveID == 0) ignoreIntersectionEXT; }
)");
  folder.write("a.obj", "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nf 1 2 3\nf 1 3 4\n");
}

TEST_CASE("a ray tracing pipeline runs from the command line on every device") {
  const ScratchFolder folder;
  write_rays(folder);
  for (const std::string& device : device_names()) {
    CAPTURE(device);
    const auto results = [&](const std::string& options) {
      const Outcome outcome =
          run_tandem("run " + options +
                         " --scene a.obj --buffer results=zeros:4 --size 4 --save results=out.bin --device " + device,
                     {.folder = folder.path()});
      CHECK(outcome.errors == "");
      REQUIRE(outcome.exit_code == 0);
      return floats_of(folder.path() / "out.bin");
    };
    CHECK(results("a.rgen a.rmiss a.rchit --record hit:0=10") == std::vector<float>{-1, 20, 10, -1});
    CHECK(results("a.rgen a.rmiss a.rchit a.rahit --record hit:0=10") == std::vector<float>{-1, 20, -1, -1});
    CHECK(results("a.rgen a.rmiss --hit a.rchit,a.rahit --record hit:0=5") == std::vector<float>{-1, 10, -1, -1});
  }
}

TEST_CASE("a job file runs several launches over the same buffers, and the command line goes before it") {
  const Scaling scaling;
  scaling.folder.write("sum.comp", R"(#version 460
layout(set = 1, binding = 7) buffer Words { uint count; float values[]; };
layout(binding = 1) buffer Out { float sum; };
void main() { sum = 0; for (uint i = 0; i < count; ++i) sum += values[i]; }
)");
  scaling.folder.write("job.json", R"({
  "buffers": {"In": [1, 2, 3, 4], "scaled": "zeros:4", "sum": "zeros"},
  "launches": [
    {"shader": "scaling.comp", "bind": {"0:1": "scaled"}, "constants": {"added": 1},
     "push": {"factor": 2, "last": 3}, "size": 4},
    {"shader": "sum.comp", "bind": {"1:7": "scaled"}, "groups": [1, 1, 1]}
  ],
  "save": {"sum": "sum.bin"}
})");
  const auto run = [&](const std::string& options) {
    return run_tandem(words("run --job {}" + options, {(scaling.folder.path() / "job.json").string()}));
  };
  for (const std::string& device : device_names()) {
    CAPTURE(device);
    const Outcome outcome = run(" --device " + device);
    CHECK(outcome.errors == "");
    REQUIRE(outcome.exit_code == 0);
    CHECK(floats_of(scaling.folder.path() / "sum.bin") == std::vector<float>{24});
  }
  REQUIRE(run(" --buffer In=1,1,1,1").exit_code == 0);
  CHECK(floats_of(scaling.folder.path() / "sum.bin") == std::vector<float>{12});
}

TEST_CASE("the schema of jobs accepts what is read, and nothing with other members") {
  const JsonSchema schema(nlohmann::json::parse(read_text(TANDEM_SOURCE_DIRECTORY "/docs/schema/job.schema.json")));
  nlohmann::json job = nlohmann::json::parse(read_text(TANDEM_SOURCE_DIRECTORY "/examples/run_shader/job.json"));
  CHECK(schema.accepts(job));
  job["launches"][0]["constants"] = {{"negate", true}, {"0", 1}};
  job["launches"][0]["push"] = {1, 2.5};
  job["launches"][0]["hit_groups"] = nlohmann::json::parse(R"([["a.rchit", "a.rahit"]])");
  job["scene"] = "box.obj";
  job["images"] = {{"picture", "rgba8:8x8"}};
  CHECK(schema.accepts(job));
  nlohmann::json without = job;
  without.erase("launches");
  CHECK_FALSE(schema.accepts(without));
  job["launches"][0]["group"] = 1;
  CHECK_FALSE(schema.accepts(job));
}

TEST_CASE("the examples of the guide run") {
  const std::filesystem::path folder = TANDEM_SOURCE_DIRECTORY "/examples/run_shader";
  const ScratchFolder results;
  for (const std::string& device : device_names()) {
    CAPTURE(device);
    const Outcome job = run_tandem("run --job job.json --device " + device, {.folder = folder});
    CHECK(job.errors == "");
    CHECK(job.exit_code == 0);
  }
  const Outcome rays = run_tandem(
      words("run camera.rgen sky.rmiss depth.rchit --scene ../../scenes/cornell_box.obj --image picture=64x64 --push "
            "position=278,273,-800 --push field_of_view=0.35 --record hit:0=1,0.5,0.25 --size 64x64 --device cpu,"
            "cpu-exact --compare --tolerance 1e-6 --save {}",
            {"picture=" + (results.path() / "a.png").string()}),
      {.folder = folder});
  CHECK(rays.errors == "");
  CHECK(rays.exit_code == 0);
}

TEST_CASE("what a shader needs is listed, and a command that would run it is proposed, which does") {
  const Scaling scaling;
  const Outcome listed = scaling.run(" --list");
  CHECK(listed.exit_code == 0);
  CHECK(contains(listed.output, "scaling.comp: compute, workgroups of 4x1x1\n"));
  CHECK(contains(listed.output, "  0:0  storage buffer  In or values\n"));
  CHECK(contains(listed.output, "  0:1  storage buffer, written  Out or result\n"));
  CHECK(contains(listed.output, "      byte 4     float[]           results, 4 bytes apart\n"));
  CHECK(contains(listed.output, "  push constants, 8 bytes\n      byte 0     float             factor\n"));
  CHECK(contains(listed.output, "      id 3       int               added, 0 by default\n"));
  const Outcome missing = scaling.run(" --buffer In=iota:4 --spec added=2");
  CHECK(missing.exit_code == 2);
  CHECK(missing.errors ==
        "tandem: the shaders need more than is given: --buffer Out, --push factor, --push last, --groups\n");
  const std::size_t command = missing.output.find("  tandem run ");
  REQUIRE(command != std::string::npos);
  const std::string line = missing.output.substr(command + 2, missing.output.find('\n', command) - command - 2);
  CHECK(line ==
        "tandem run scaling.comp --spec added=2 --buffer In=iota:4 --buffer Out=zeros:1024 --push factor=0 --push "
        "last=0 --groups 16");
  CHECK(run_in_shell(line, {.folder = scaling.folder.path()}).exit_code == 0);
}

TEST_CASE("a device says why it cannot run a shader, without running it") {
  const Scaling scaling;
  const Outcome able = scaling.run(" --check");
  CHECK(able.exit_code == 0);
  CHECK(able.output == "cpu: can run it\n");
  scaling.folder.write("nothing.spvasm",
                       "; Version: 1.3\nOpCapability Shader\nOpCapability Int64Atomics\nOpCapability Sparse"
                       "Residency\nOpMemoryModel Logical GLSL450\nOpEntryPoint GLCompute %f \"f\"\n"
                       "OpExecutionMode %f LocalSize 1 1 1\n%v = OpTypeVoid\n%t = OpTypeFunction %v\n"
                       "%f = OpFunction %v None %t\n%l = OpLabel\nOpReturn\nOpFunctionEnd\n");
  const Outcome unable = run_tandem("run nothing.spvasm --check", {.folder = scaling.folder.path()});
  CHECK(unable.exit_code == 1);
  CHECK(contains(unable.output, "cpu: cannot run it\n  nothing.spvasm: "));
  CHECK(contains(unable.output, "SparseResidency"));
}

TEST_CASE("runs are measured") {
  const Scaling scaling;
  const Outcome outcome = scaling.run(given + " --time 3");
  CHECK(outcome.exit_code == 0);
  CHECK(contains(outcome.output, "cpu: ran in "));
  CHECK(contains(outcome.output, " ms of 3 runs, "));
}

TEST_CASE("what cannot be run is one sentence that names the option or the file, and nothing is written") {
  const Scaling scaling;
  const ScratchFolder& folder = scaling.folder;
  folder.write("bad.comp", "#version 460\nvoid main() { nonsense; }\n");
  folder.write("bad.json", R"({"launches": [{"shader": "scaling.comp", "groop": 1}]})");
  folder.write("text.frag", "void main() {}");
  folder.write("words.npy", "no array");
  const std::vector<std::string> before = folder.names();
  const auto check = [&](const std::string& arguments, const std::string& sentence) {
    const Outcome outcome = run_tandem("run " + arguments + " --save result=out.csv", {.folder = folder.path()});
    CAPTURE(arguments);
    CAPTURE(outcome.errors);
    CHECK(outcome.exit_code == 2);
    CHECK(std::count(outcome.errors.begin(), outcome.errors.end(), '\n') == 1);
    CHECK(contains(outcome.errors, sentence));
  };
  const std::string all = "scaling.comp" + given;
  check("", "SHADER is required, or --job");
  check("missing.comp --list", "missing.comp");
  check("text.frag", "'text.frag' is no shader");
  check("bad.comp", "bad.comp");
  check("--job bad.json", "bad.json");
  check("--job bad.json scaling.comp", "--job: ");
  check(all + " --buffer Missing=zeros:4",
        "--buffer: 'Missing' is no binding of its kind; the shaders have 0:0 (In), 0:1 (Out)");
  check(all + " --buffer In=zeros:4", "--buffer: 'In' is given twice");
  check(all + " --push size=3", "--push: 'size' is not the name of a value; the names are factor, last");
  check(all + " --push last=-3", "--push: last: '-3' is no uint32");
  check(all + " --spec other=1", "--spec: no shader has a specialisation constant 'other'");
  check(all + " --spec added=1.5", "--spec: '1.5' is no int32");
  check(all + " --image In=8x8", "--image: 'In' is no binding of its kind");
  check(all + " --scene box.obj", "--scene: no shader uses it");
  check(all + " --record hit:0=1", "--record: 'hit:0' is no record");
  check(all + " --compare", "--compare: two devices are compared");
  check(all + " --device teapot", "teapot");
  check(all + " --save other=a.csv", "--save: there is no 'other' to save; there are In, result");
  check(all + " --save In=a.png", "--save: 'a.png' does not end in .bin");
  check(all + " --save In=missing/a.csv", "missing");
  check(all + " --groups 0", "--groups: '0' is not one to three whole numbers");
  const std::string rest = "scaling.comp --buffer result=zeros:6 --push 1,5 --size 6 --buffer In=";
  check(rest + "zeros", "--buffer: 'In' has an array without a length; say how many elements, as in In=zeros:1024");
  check(rest + "zeros:many", "--buffer: 'many' is no number of elements");
  check(rest + "random", "--buffer: random needs a seed");
  check(rest + "file.dat", "--buffer: 'file.dat' is neither zeros, iota");
  check(rest + "missing.bin", "missing.bin");
  check(rest + "words.npy", "words.npy': it is no .npy file");
  check(rest + "zeros:9999999999", "--buffer: ");
  check("scaling.comp --buffer In", "--buffer: 'In' is not of the form KEY=VALUE");
  CHECK(folder.names() == before);
}

}  // namespace
}  // namespace tandem::test
