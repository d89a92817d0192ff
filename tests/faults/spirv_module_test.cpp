#include "tests/faults/spirv_module.hpp"

#include <doctest/doctest.h>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <spirv-tools/libspirv.hpp>

#include "rhi/glsl/compile.hpp"
#include "tests/support/device_test.hpp"

using namespace tandem;
using namespace tandem::test;

namespace {

const char* const shader = R"(#version 460
layout(local_size_x = 1) in;
layout(set = 0, binding = 0, std430) buffer Values { float values[]; };
precise float product(float a, float b) { return a * b; }
precise float sum(float a, float b) { return a + b; }
void main() {
  values[0] = product(values[0], 3.0);
  values[1] = sum(values[1], 0.25);
}
)";

std::vector<std::uint32_t> compiled() {
  return glsl::compile(shader, rhi::ShaderStage::compute, "editor test",
                       {.include_directories = {}, .debug_info = true});
}

/// What spirv-val says of the module; "" when it is valid.
std::string validation_of(const std::vector<std::uint32_t>& words) {
  spvtools::SpirvTools tools(SPV_ENV_VULKAN_1_2);
  std::string said;
  tools.SetMessageConsumer([&](spv_message_level_t, const char*, const spv_position_t&, const char* message) {
    said += std::string(message) + "\n";
  });
  return tools.Validate(words) ? "" : said + "invalid";
}

/// What the module makes of the values 5 and 7.
std::vector<float> results_of(rhi::Device& device, const std::vector<std::uint32_t>& words) {
  const rhi::BufferHandle buffer = buffer_of(device, std::vector<float>{5, 7}, "values");
  const rhi::ComputePipelineHandle pipeline = device.create_compute_pipeline(
      {.shader = device.create_shader_module({words, "edited"}), .specialization = {}, .label = "edited"});
  const rhi::BindGroupHandle group =
      device.create_bind_group({.pipeline = pipeline,
                                .set = 0,
                                .entries = {{.binding = 0, .resource = rhi::BufferRange{buffer}, .array_element = 0}},
                                .label = "values"});
  const rhi::CommandListHandle list = device.create_command_list("edited");
  list->dispatch({.pipeline = pipeline, .bind_groups = {group}});
  device.submit(list)->wait();
  return contents<float>(device, buffer, 2);
}

}  // namespace

TANDEM_DEVICE_TEST("A module that was taken apart and put together does what it did") {
  const std::vector<std::uint32_t> words = SpirvModule(compiled()).words();
  CHECK(validation_of(words) == "");
  CHECK(results_of(device, words) == std::vector<float>{15, 7.25f});
}

TANDEM_DEVICE_TEST("An edit of one function changes what its instructions give, and no other function") {
  SpirvModule module(compiled());
  CHECK(module.edit_function("product", [](Instruction instruction, CodeWriter& code) {
    if (instruction.opcode != spv::OpFMul) return code.put(instruction);
    code.put_changed(instruction, [&](std::uint32_t result) {
      return code.value(spv::OpFAdd, instruction.type(), {result, code.module().constant(100.0f)});
    });
  }));
  const std::vector<std::uint32_t> words = module.words();
  CHECK(validation_of(words) == "");
  CHECK(results_of(device, words) == std::vector<float>{115, 7.25f});
}

TANDEM_DEVICE_TEST("An edit may use double precision and GLSL.std.450 where the shader did not") {
  SpirvModule module(compiled());
  module.edit_functions([](Instruction instruction, CodeWriter& code) {
    if (instruction.opcode != spv::OpFAdd) return code.put(instruction);
    code.put_changed(instruction, [&](std::uint32_t result) {
      const std::uint32_t wide = code.value(spv::OpFConvert, code.module().float_type(64), {result});
      const std::uint32_t squared = code.value(spv::OpFMul, code.module().float_type(64), {wide, wide});
      const std::uint32_t narrow = code.value(spv::OpFConvert, code.module().float_type(), {squared});
      return code.extended(GLSLstd450Floor, code.module().float_type(), {narrow});
    });
  });
  const std::vector<std::uint32_t> words = module.words();
  CHECK(validation_of(words) == "");
  CHECK(results_of(device, words) == std::vector<float>{15, 52});
}

TEST_CASE("A function that the module does not have is not edited") {
  SpirvModule module(compiled());
  CHECK_FALSE(module.edit_function("prod", [](Instruction, CodeWriter&) { FAIL("edited"); }));
}

TEST_CASE("A constant that is there is not declared again, and a new one once") {
  SpirvModule module(compiled());
  const std::uint32_t three = module.constant(3.0f);
  const std::size_t size = module.words().size();
  CHECK(module.type_of(three) == module.float_type());
  CHECK(module.words().size() == size);
  CHECK(module.constant(4.0f) == module.constant(4.0f));
  CHECK(module.words().size() == size + 4);  // OpConstant: its first word, type, result, value
}

TEST_CASE("Words that are no SPIR-V are refused") {
  CHECK_THROWS_AS(SpirvModule(std::vector<std::uint32_t>{1, 2, 3}), rhi::Error);
  std::vector<std::uint32_t> cut = compiled();
  cut.pop_back();  // OpFunctionEnd
  CHECK_THROWS_AS(SpirvModule{cut}, rhi::Error);
  cut.pop_back();  // the operand of OpReturnValue
  CHECK_THROWS_AS(SpirvModule{cut}, rhi::Error);
}
