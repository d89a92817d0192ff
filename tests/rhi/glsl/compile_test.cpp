#include "rhi/glsl/compile.hpp"

#include <doctest/doctest.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "rhi/error.hpp"
#include "tests/support/scratch_folder.hpp"

using namespace tandem;

namespace {

const char* const valid = R"(#version 460
layout(local_size_x = 4, local_size_y = 2) in;
layout(set = 1, binding = 3, std430) readonly buffer Input { uint value[]; } inputs[2];
layout(set = 0, binding = 7, std430) buffer Output { uint value[]; } result;
layout(push_constant) uniform Push { vec3 a; uint b; } push;
layout(constant_id = 5) const uint factor = 9;
void main() { result.value[gl_GlobalInvocationID.x] = inputs[push.b & 1].value[0] * factor + uint(push.a.x); }
)";

}  // namespace

TEST_CASE("a compute shader compiles and reflects as it was written") {
  const auto reflection = rhi::reflect(glsl::compile(valid, rhi::ShaderStage::compute, "valid"), "valid");
  CHECK(reflection.stage == rhi::ShaderStage::compute);
  CHECK(reflection.entry_point == "main");
  CHECK(reflection.workgroup_size == std::array<std::uint32_t, 3>{4, 2, 1});
  CHECK(reflection.push_constant_size == 16);
  REQUIRE(reflection.bindings.size() == 2);
  CHECK(reflection.bindings[0].set == 0);
  CHECK(reflection.bindings[0].binding == 7);
  CHECK(reflection.bindings[0].writable);
  CHECK(reflection.bindings[1].count == 2);
  CHECK_FALSE(reflection.bindings[1].writable);
  REQUIRE(reflection.specialization_constants.size() == 1);
  CHECK(reflection.specialization_constants[0].id == 5);
  CHECK(reflection.specialization_constants[0].default_value == 9);
}

TEST_CASE("a workgroup size given by specialisation constants reflects with its defaults") {
  const char* const source = R"(#version 460
layout(local_size_x_id = 0, local_size_y = 2) in;
layout(set = 0, binding = 0) buffer Output { uint value[]; };
void main() { value[gl_LocalInvocationIndex] = 1; })";
  const auto reflection = rhi::reflect(glsl::compile(source, rhi::ShaderStage::compute, "sized"), "sized");
  CHECK(reflection.workgroup_size == std::array<std::uint32_t, 3>{1, 2, 1});
}

TEST_CASE("an error names the shader and the line") {
  try {
    glsl::compile("#version 460\nvoid main() { undeclared = 1; }", rhi::ShaderStage::compute, "broken.comp");
    FAIL("it compiled");
  } catch (const rhi::Error& error) {
    CHECK(error.code() == rhi::ErrorCode::shader_compilation);
    CHECK(std::string(error.what()).find("broken.comp:2") != std::string::npos);
    CHECK(std::string(error.what()).find("undeclared") != std::string::npos);
  }
}

TEST_CASE("words that are no SPIR-V are an error that names the shader") {
  const std::vector<std::uint32_t> words(16, 0x12345678);
  CHECK_THROWS_WITH_AS(rhi::reflect(words, "noise"), doctest::Contains("noise"), rhi::Error);
  std::vector<std::uint32_t> truncated = glsl::compile(valid, rhi::ShaderStage::compute, "valid");
  truncated.resize(truncated.size() / 2);
  CHECK_THROWS_AS(rhi::reflect(truncated, "truncated"), rhi::Error);
}

TEST_CASE("includes are found in the folders of the options") {
  const test::ScratchFolder folder;
  std::filesystem::create_directories(folder.path() / "nested");
  folder.write("nested/a.glsl", "#include \"b.glsl\"\n");
  folder.write("nested/b.glsl", "uint answer() { return 42u; }\n");
  const std::string source =
      "#version 460\n#extension GL_GOOGLE_include_directive : require\n#include \"nested/a.glsl\"\n"
      "layout(set = 0, binding = 0) buffer Output { uint value[]; };\nvoid main() { value[0] = answer(); }\n";
  glsl::CompileOptions options;
  options.include_directories = {folder.path()};
  CHECK_FALSE(glsl::compile(source, rhi::ShaderStage::compute, "includes", options).empty());
  CHECK_THROWS_AS(glsl::compile(source, rhi::ShaderStage::compute, "includes"), rhi::Error);
}

TEST_CASE("files that are given as text are included before those on disk, and may include each other") {
  glsl::CompileOptions options;
  options.files = {{"parts/a.glsl", "#include \"b.glsl\"\n"}, {"parts/b.glsl", "const uint value = 7u;\n"}};
  const std::string source =
      "#version 460\n#include \"parts/a.glsl\"\nlayout(binding = 0) buffer B { uint x; };\n"
      "void main() { x = value; }\n";
  CHECK_FALSE(glsl::compile(source, rhi::ShaderStage::compute, "given", options).empty());
  options.files[1].text = "#include \"a.glsl\"\n";
  CHECK_THROWS_WITH_AS(glsl::compile(source, rhi::ShaderStage::compute, "given", options),
                       doctest::Contains("it may include itself"), rhi::Error);
  options.files.pop_back();
  CHECK_THROWS_AS(glsl::compile(source, rhi::ShaderStage::compute, "given", options), rhi::Error);
}

TEST_CASE("files that include each other without end are refused") {
  const test::ScratchFolder folder;
  glsl::CompileOptions options;
  options.include_directories = {folder.path()};
  const auto error_of = [&](const std::string& file) -> std::string {
    const std::string source = std::string("#version 460\n#extension GL_GOOGLE_include_directive : require\n")
                                   .append("#include \"")
                                   .append(file)
                                   .append("\"\nlayout(local_size_x = 1) in;\nvoid main() {}\n");
    try {
      glsl::compile(source, rhi::ShaderStage::compute, "endless.comp", options);
    } catch (const rhi::Error& error) {
      CHECK(error.code() == rhi::ErrorCode::shader_compilation);
      return error.what();
    }
    return "no error";
  };
  const auto include = [](const std::string& file) { return std::string("#include \"").append(file).append("\"\n"); };
  const auto contains = [](const std::string& text, const char* part) { return text.find(part) != std::string::npos; };
  folder.write("self.glsl", include("self.glsl"));
  CHECK(contains(error_of("self.glsl"), "endless.comp: "));
  CHECK(contains(error_of("self.glsl"), "self.glsl: it is included by files in files, more than 64 deep"));
  folder.write("a.glsl", include("b.glsl"));
  folder.write("b.glsl", include("a.glsl"));
  CHECK(contains(error_of("a.glsl"), "more than 64 deep"));
  // Not deep, but twice as many files in each step.
  for (int i = 0; i < 20; ++i) {
    const std::string next = include(std::to_string(i + 1) + ".glsl");
    folder.write(std::to_string(i) + ".glsl", next + next);
  }
  folder.write("20.glsl", "\n");
  CHECK(contains(error_of("0.glsl"), "10000 files or 64 MiB"));
  CHECK(error_of("10.glsl") == "no error");
  // With a guard a file may include itself.
  folder.write("guarded.glsl",
               std::string("#ifndef GUARD\n#define GUARD\n").append(include("guarded.glsl")).append("#endif\n"));
  CHECK(error_of("guarded.glsl") == "no error");
  CHECK(contains(error_of("absent.glsl"), "absent.glsl"));
  REQUIRE(::mkfifo((folder.path() / "pipe.glsl").c_str(), 0600) == 0);
  CHECK(contains(error_of("pipe.glsl"), "it is a pipe"));
  std::filesystem::create_symlink("/dev/zero", folder.path() / "zero.glsl");
  CHECK(contains(error_of("zero.glsl"), "it is a device"));
}

TEST_CASE("defines come before the source") {
  const std::string source = R"(#version 460
layout(local_size_x = SIZE) in;
layout(binding = 0) buffer B { TYPE values[]; };
void main() { values[0] += TYPE(SIZE); }
)";
  const auto size_of = [&](const std::vector<glsl::Define>& defines) {
    const auto words = glsl::compile(source, rhi::ShaderStage::compute, "source", {.defines = defines});
    return rhi::reflect(words, "source").workgroup_size[0];
  };
  CHECK(size_of({{"SIZE", "7"}, {"TYPE", "float"}}) == 7);
  CHECK(size_of({{"SIZE", "(3 + 2)"}, {"TYPE", "uint"}}) == 5);
  CHECK_THROWS_WITH_AS(size_of({{"SIZE", "7"}, {"4", "float"}}), doctest::Contains("'4' cannot be defined"),
                       rhi::Error);
  CHECK_THROWS_WITH_AS(size_of({{"SIZE", "7\n#define TYPE float"}}), doctest::Contains("'SIZE' cannot be defined"),
                       rhi::Error);
}

TEST_CASE("SPIR-V is written in the version asked for") {
  using enum glsl::SpirvVersion;
  const auto version_of = [](glsl::SpirvVersion version) {
    return glsl::compile("#version 460\nvoid main() {}", rhi::ShaderStage::compute, "empty", {.spirv = version})[1];
  };
  CHECK(version_of(v1_0) == 0x00010000);
  CHECK(version_of(v1_3) == 0x00010300);
  CHECK(version_of(v1_4) == 0x00010400);
  CHECK(version_of(v1_5) == 0x00010500);
  CHECK(version_of(v1_6) == 0x00010600);
}

TEST_CASE("a file's extension names its stage") {
  CHECK(glsl::stage_of("a/b.comp") == rhi::ShaderStage::compute);
  CHECK(glsl::stage_of("b.rchit.glsl") == rhi::ShaderStage::closest_hit);
  CHECK_FALSE(glsl::stage_of("b.glsl").has_value());
  CHECK_FALSE(glsl::stage_of("b.frag").has_value());
  const test::ScratchFolder folder;
  const std::filesystem::path file = folder.path() / "shader.comp";
  std::ofstream(file) << valid;
  CHECK(rhi::reflect(glsl::compile_file(file), "file").workgroup_size[0] == 4);
  CHECK_THROWS_WITH_AS(glsl::compile_file(folder.path() / "shader.vert"), doctest::Contains("names no stage"),
                       rhi::Error);
}
