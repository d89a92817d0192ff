#include <doctest/doctest.h>
#include <fmt/format.h>

#include <random>
#include <string>
#include <string_view>
#include <vector>

#include "base/text_file.hpp"
#include "program/amber/script.hpp"

using namespace tandem::program;
using namespace tandem::program::amber;

namespace {

Script parsed(const std::string& text) { return parse(std::string("#!amber\n").append(text), "folder/test.amber"); }

/// The error of a script whose second line is the first of the text; "" where there is none.
std::string refusal(const std::string& text) {
  try {
    parsed(text);
  } catch (const tandem::Error& error) {
    return error.what();
  }
  return "";
}

const std::string compute_shader = R"(SHADER compute add GLSL
#version 450
layout(binding = 0) buffer Values { uint values[]; };
void main() { values[0] += 1u; }
END
)";

const std::string pipeline = R"(BUFFER values DATA_TYPE uint32 SIZE 4 SERIES_FROM 1 INC_BY 2
PIPELINE compute adding
  ATTACH add
  BIND BUFFER values AS storage DESCRIPTOR_SET 0 BINDING 0
END
)";

TEST_CASE("a script becomes a job and steps, REPEAT written out") {
  const Script script = parsed(compute_shader + pipeline +
                               "RUN adding 1 2 3\nREPEAT 2\nRUN adding 4 1 1\nEXPECT values IDX 4 EQ 3\nEND\n");
  REQUIRE(script.job.shaders.size() == 1);
  CHECK(script.job.shaders[0].name == "add");
  CHECK(script.job.shaders[0].spirv.empty());
  REQUIRE(script.sources.size() == 1);
  CHECK(script.sources[0].position.line == 2);
  REQUIRE(script.job.buffers.size() == 1);
  CHECK(script.job.buffers[0].initial.size() == 16);
  REQUIRE(script.job.commands.size() == 3);
  CHECK(std::get<Dispatch>(script.job.commands[0]).workgroup_count == std::array<std::uint32_t, 3>{1, 2, 3});
  REQUIRE(script.steps.size() == 5);
  CHECK(script.steps[4].kind == Step::Kind::expectation);
  CHECK(script.expectations.back().position.line == 15);
}

TEST_CASE("compiling fills in the SPIR-V, and errors have the line of the script") {
  Script script = parsed(compute_shader + pipeline);
  compile(script);
  CHECK(script.job.shaders[0].spirv.at(0) == 0x07230203);

  Script wrong = parsed(
      "SHADER compute add GLSL\n#version 450\nvoid main() { wrong = 1; }\nEND\n"
      "PIPELINE compute p\nATTACH add\nEND\n");
  const auto message = [](Script& each) -> std::string {
    try {
      compile(each);
    } catch (const ScriptError& error) {
      return error.what();
    }
    return "";
  };
  CHECK(message(wrong).find("test.amber:4: 'wrong'") != std::string::npos);

  Script assembly = parsed(
      "SHADER compute add SPIRV-ASM\nOpCapability Shader\nOpNonsense %1\nEND\n"
      "PIPELINE compute p\nATTACH add\nEND\n");
  CHECK(message(assembly).starts_with("folder/test.amber:4:1: the shader add is no SPIR-V assembly: "));
}

TEST_CASE("what no device of ours runs is told, not refused") {
  CHECK(parsed("PIPELINE graphics g\nnonsense").unsupported == "a graphics pipeline (line 2)");
  CHECK(parsed("SHADER compute c OPENCL-C\nkernel\nEND").unsupported == "a shader in OpenCL C (line 2)");
  CHECK(parse("[vertex shader]\n", "x.amber").unsupported == "a graphics pipeline (line 1)");
  CHECK(parse("[compute shader]\nx\n[test]\nclear\n", "x.amber").unsupported == "the command 'clear' (line 4)");
  CHECK(parsed("BUFFER picture FORMAT R8G8B8A8_UNORM FILE PNG x.png").unsupported == "data from a PNG file (line 2)");
  CHECK(parsed(compute_shader +
               "IMAGE i FORMAT R8G8B8A8_UNORM DIM_2D WIDTH 2 HEIGHT 2 SAMPLES 4\nPIPELINE compute p\nATTACH add\n"
               "BIND BUFFER i AS storage_image DESCRIPTOR_SET 0 BINDING 0\nEND")
            .unsupported == "an image with 4 samples (line 7)");
}

struct Wrong {
  const char* text;
  const char* sentence;
};

TEST_CASE("an error is one sentence with file, line and column") {
  const std::vector<Wrong> cases = {
      {"NONSENSE", "2:1: 'NONSENSE' is no command"},
      {"\n  RUN nothing 1 1 1", "3:7: there is no pipeline 'nothing'"},
      {"DEVICE_FEATURE shaderFloat65", "2:16: 'shaderFloat65' is no device feature that Amber knows"},
      {"BUFFER", "2:7: the buffer's name is expected, not the end of the script"},
      {"BUFFER b DATA_TYPE uint33 DATA 1 END", "2:20: 'uint33' is no type"},
      {"BUFFER b DATA_TYPE mat2x2<int32> DATA 1 END", "2:20: 'mat2x2<int32>' is no type"},
      {"BUFFER b DATA_TYPE uint8 SIZE 2 FILL 256", "2:38: 256 is no uint8"},
      {"BUFFER b DATA_TYPE int8 SIZE 2 FILL -129", "2:37: -129 is no int8"},
      {"BUFFER b DATA_TYPE int32 DATA\n1 2.5\nEND", "3:3: 2.5 is no int32"},
      {"BUFFER b DATA_TYPE int32 DATA\n1 2", "3:4: DATA has no END"},
      {"BUFFER b DATA_TYPE int32 DATA x END", "2:31: a number is expected, not 'x'"},
      {"BUFFER b DATA_TYPE int32 SIZE 0 FILL 1", "2:26: no items are no buffer"},
      {"BUFFER b DATA_TYPE int32 SIZE 999999999 FILL 1", "2:26: a buffer or image of more than 1 GiB is too large"},
      {"BUFFER b DATA_TYPE int32 FILL 1", "2:26: DATA, SIZE or FILE is expected, not 'FILL'"},
      {"BUFFER b DATA_TYPE int32 SIZE 1 FILL 1\nBUFFER b DATA_TYPE int32 SIZE 1 FILL 1",
       "3:8: there is a buffer 'b' already"},
      {"IMAGE i FORMAT R8_UNORM DIM_2D WIDTH 4 FILL 0", "2:7: the image i has no HEIGHT"},
      {"IMAGE i FORMAT R8_UNORM DIM_1D WIDTH 4 DATA 1 2 3 END", "2:7: the image i has 4 texels, its data 3"},
      {"IMAGE i FORMAT R8_NONSENSE DIM_1D WIDTH 4 FILL 0", "2:16: 'R8_NONSENSE' is no format"},
      {"SAMPLER s MAG_FILTER cubic", "2:22: 'cubic' is no value of MAG_FILTER"},
      {"STRUCT s\nfloat a\nfloat a\nEND", "4:7: there is a member 'a' already"},
      {"STRUCT s\nfloat a OFFSET 4\nfloat b OFFSET 4\nEND\nBUFFER b DATA_TYPE s DATA 1 2 END",
       "6:20: OFFSET 4 of b in the struct s lies in the member before it, which ends at 8"},
      {"STRUCT s\ns a\nEND", "3:1: 's' is no type"},
      {"SHADER compute c GLSL\nvoid main() {}", "2:8: SHADER has no END"},
      {"SHADER computer c GLSL\nEND", "2:8: 'computer' is no shader stage"},
      {"SHADER compute c GLSL\n  \nEND", "2:8: the shader c is empty"},
      {"SHADER compute c SPIRV-HEX\n07230203 xyz\nEND", "3:10: 'xyz' is no hexadecimal word of SPIR-V"},
      {"ACCELERATION_STRUCTURE BOTTOM_LEVEL b\nGEOMETRY TRIANGLES 1 2 3 END\nEND",
       "3:10: 3 coordinates are none of triangles: each has 9"},
      {"ACCELERATION_STRUCTURE TOP_LEVEL t\nBOTTOM_LEVEL_INSTANCE x END\nEND", "3:23: there is no bottom level 'x'"},
      {"REPEAT 2\nBUFFER b", "3:1: 'BUFFER' is no command of REPEAT"},
      {"SET ENGINE_DATA x 3", "2:17: 'x' is no setting: fence_timeout_ms"},
      {"CLEAR p", "2:1: CLEAR is of graphics pipelines"},
  };
  for (const Wrong& each : cases) {
    CAPTURE(std::string(each.text));
    CHECK(refusal(each.text) == std::string("folder/test.amber:") + each.sentence);
  }
  const std::vector<Wrong> with_pipeline = {
      {"RUN adding 1 1",
       "12:15: a number of workgroups is expected, a whole number of at most 4294967295, not the end "
       "of the script"},
      {"RUN adding 1 1 1 1", "12:18: '1' is too much after RUN"},
      {"REPEAT 999999\nRUN adding 1 1 1\nEND", "13:5: a script of more than 262144 steps is too long"},
      {"EXPECT nothing IDX 0 EQ 1", "12:8: there is no buffer or image 'nothing'"},
      {"EXPECT values IDX 0 EQ", "12:21: EXPECT has no values"},
      {"EXPECT values IDX 2 EQ 1", "12:19: IDX 2 is no multiple of the 4 bytes of an item of values"},
      {"EXPECT values IDX 12 EQ 1 2", "12:27: the value lies at byte 16 of values, which has 16"},
      {"EXPECT values IDX 0 TOLERANCE 1 NE 1", "12:33: TOLERANCE is only of EQ"},
      {"EXPECT values IDX 0 EQ -x", "12:24: a value is expected, not '-x'"},
      {"EXPECT values IDX 0 0 SIZE 1 1 EQ_RGB 0 0 0", "12:19: values is no image, so it has no rectangle of texels"},
      {"BUFFER short DATA_TYPE uint32 SIZE 2 FILL 0\nEXPECT values EQ_BUFFER short",
       "13:25: values has 16 bytes in items of 4, short has 8 in items of 4"},
      {"COPY values TO values", "12:16: values is copied to itself"},
      {"PIPELINE compute p\nATTACH add SPECIALIZE 0 AS uint32 -\nEND", "13:35: a value is expected, not '-'"},
      {"PIPELINE compute p\nBIND BUFFER values AS storage_image DESCRIPTOR_SET 0 BINDING 0\nEND",
       "13:13: values has no width and height: it is no IMAGE"},
      {"PIPELINE raytracing p\nSHADER_GROUP g add\nEND", "13:16: add is no shader of a ray tracing pipeline"},
      {"PIPELINE raytracing p\nEND\nRUN p 1 1 1", "14:5: RUN of a ray tracing pipeline has no RAYGEN"},
      {"PIPELINE compute p\nSHADER_GROUP g add\nEND", "13:1: SHADER_GROUP is of ray tracing pipelines"},
  };
  for (const Wrong& each : with_pipeline) {
    CAPTURE(std::string(each.text));
    CHECK(refusal(compute_shader + pipeline + each.text) == std::string("folder/test.amber:") + each.sentence);
  }
  CHECK_THROWS_WITH_AS(parse("BUFFER b", "x.amber"), "x.amber:1:1: the first line is not #!amber", ScriptError);
}

TEST_CASE("comments, continued lines and strings are as Amber has them") {
  const Script script =
      parsed("# comment\nBUFFER \\\n  b DATA_TYPE \\\r\n uint32 DATA # more\n 1, 2 # END\n 0x10 END\n");
  REQUIRE(script.job.buffers.size() == 1);
  CHECK(script.job.buffers[0].initial.size() == 12);
}

TEST_CASE("data that is too large keeps its lowest bits, as the CTS has it") {
  const Script script = parsed("BUFFER b DATA_TYPE uint8 DATA 272 -1 END");
  CHECK(script.job.buffers.at(0).initial == std::vector<std::byte>{std::byte{16}, std::byte{255}});
}

TEST_CASE("an image without a size has that of the framebuffer") {
  const std::string text = compute_shader +
                           "BUFFER picture FORMAT R8G8B8A8_UNORM\nPIPELINE compute painting\n  ATTACH add\n"
                           "  BIND BUFFER picture AS storage_image DESCRIPTOR_SET 0 BINDING 0\n";
  CHECK(parsed(text + "END").job.images.at(0).desc.size == std::array<std::uint32_t, 3>{250, 250, 1});
  const Script script = parsed(text + "  FRAMEBUFFER_SIZE 8 4\nEND");
  CHECK(script.job.images.at(0).desc.size == std::array<std::uint32_t, 3>{8, 4, 1});
  CHECK(script.job.images.at(0).initial.size() == 128);
}

TEST_CASE("a word in a shader is no END unless it stands alone") {
  const Script script = parsed("SHADER compute c GLSL\nint BLEND, END_X;\nEND\nPIPELINE compute p\nATTACH c\nEND\n");
  CHECK(script.sources.at(0).text == "int BLEND, END_X;\n");
}

TEST_CASE("SPIRV-HEX is words or bytes") {
  const auto words = [](const std::string& text) {
    Script script =
        parsed(std::string("SHADER compute c SPIRV-HEX\n").append(text) + "\nEND\nPIPELINE compute p\nATTACH c\nEND\n");
    compile(script);
    return script.job.shaders.at(0).spirv;
  };
  CHECK(words("07230203 00010000") == std::vector<std::uint32_t>{0x07230203, 0x00010000});
  CHECK(words("0x03, 0x02, 0x23, 0x07") == std::vector<std::uint32_t>{0x07230203});
}

TEST_CASE("VkScript becomes the same job and steps") {
  const std::string text = R"(# comment
[require]
shaderInt64

[compute shader]
#version 450
void main() {}

[test]
ssbo 1:2 subdata vec3 16 4 5 6
ssbo 1:2 subdata vec3 0 1 2 3
ssbo 0 8
uniform ubo 3 int 4 -7
uniform uint 4 9
compute entrypoint main
compute 2 3 4
tolerance 0.5 1%
probe ssbo vec3 1:2 0 ~= 1 2 3 4 5 6
probe ssbo uint 0 4 >= 1
)";
  const Script script = parse(text, "x.amber");
  CHECK(script.unsupported == "");
  CHECK(script.requirements.at(0).name == "shaderInt64");
  CHECK(script.sources.at(0).text == "#version 450\nvoid main() {}\n\n");
  REQUIRE(script.job.buffers.size() == 4);
  CHECK(script.job.buffers[0].initial.size() == 32);
  CHECK(script.job.buffers[1].initial.size() == 32);  // 8 of the type that is probed
  CHECK(script.job.buffers[2].initial.size() == 8);
  const Pipeline& pipeline = script.job.pipelines.at(0);
  CHECK(pipeline.push_constants.size() == 8);
  REQUIRE(pipeline.bindings.size() == 3);
  CHECK(pipeline.bindings[0].set == 1);
  CHECK(pipeline.bindings[0].binding == 2);
  CHECK(pipeline.bindings[1].set == 0);
  CHECK(std::get<Dispatch>(script.job.commands.at(0)).workgroup_count == std::array<std::uint32_t, 3>{2, 3, 4});
  REQUIRE(script.expectations.size() == 2);
  CHECK(std::get<ValuesExpectation>(script.expectations[0].what).tolerances.size() == 2);
  CHECK(script.expectations[1].position.line == 19);

  const auto error = [](const std::string& command) -> std::string {
    try {
      parse(std::string("[compute shader]\nvoid main() {}\n[test]\n").append(command), "x.amber");
    } catch (const ScriptError& wrong) {
      return wrong.what();
    }
    return "";
  };
  CHECK(error("ssbo x 3") == "x.amber:4:6: a binding is expected, not 'x'");
  CHECK(error("ssbo 0:x 3") == "x.amber:4:7: ':x' is no binding");
  CHECK(error("ssbo 0 subdata ivec5 0 1") == "x.amber:4:16: 'ivec5' is no type");
  CHECK(error("ssbo 0 subdata int8_t 0 300") == "x.amber:4:25: 300 is no int8");
  CHECK(error("probe ssbo int 0 0 = 1") == "x.amber:4:20: '=' is no comparison");
  CHECK(error("compute 1 1") ==
        "x.amber:4:12: a number of workgroups is expected, a whole number of at most "
        "4294967295, not the end of the script");
}

TEST_CASE("a mutated script is parsed or refused in one sentence") {
  std::mt19937 random(7);
  const auto below = [&](std::size_t count) { return static_cast<std::size_t>(random() % count); };
  for (const char* name : {"types", "struct", "image", "repeat", "ray_query", "ray_pipeline"}) {
    const std::string original =
        tandem::read_text(fmt::format("{}/tests/program/amber/{}.amber", TANDEM_SOURCE_DIRECTORY, name));
    for (int i = 0; i < 300; ++i) {
      std::string text = original;
      for (std::size_t edits = 1 + below(4); edits > 0 && text.size() > 20; --edits) {
        const std::size_t at = 8 + below(text.size() - 8);
        switch (below(5)) {
          case 0:
            text.erase(at, 1 + below(20));
            break;
          case 1:
            text[at] = static_cast<char>(random() % 256);
            break;
          case 2:
            text.insert(at, text.substr(8 + below(text.size() - 8), below(40)));
            break;
          case 3:
            text.insert(at, std::to_string(random()));
            break;
          default:
            text.resize(at + 1);
            break;
        }
      }
      CAPTURE(text);
      try {
        parse(text, "mutated.amber");
      } catch (const ScriptError& error) {
        CHECK(std::string_view(error.what()).find('\n') == std::string_view::npos);
      }
    }
  }
}

}  // namespace
