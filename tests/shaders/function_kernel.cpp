#include "tests/shaders/function_kernel.hpp"

#include <bit>
#include <cmath>

#include <fmt/format.h>

#include "tests/support/device_test.hpp"

namespace tandem::test {
namespace {

constexpr std::uint32_t workgroup_size = 64;

std::string source_of(const FunctionKernel& kernel) {
  return fmt::format(R"(#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = {}) in;
layout(set = 0, binding = 0, std430) readonly buffer Inputs {{ uint values[]; }} inputs;
layout(set = 0, binding = 1, std430) buffer Outputs {{ uint values[]; }} outputs;
layout(push_constant, std430) uniform Constants {{ uint row_count; }} constants;
#define input_bits(k) inputs.values[gl_GlobalInvocationID.x * {} + (k)]
#define input_float(k) uintBitsToFloat(input_bits(k))
#define output_bits(k, value) outputs.values[gl_GlobalInvocationID.x * {} + (k)] = (value)
#define output_float(k, value) output_bits(k, floatBitsToUint(value))
{}
void main() {{
  if (gl_GlobalInvocationID.x >= constants.row_count) return;
{}
}}
)",
                     workgroup_size, kernel.input_count, kernel.output_count, kernel.includes, kernel.body);
}

}  // namespace

std::vector<std::uint32_t> run_bits(rhi::Device& device, const FunctionKernel& kernel,
                                    const std::vector<std::uint32_t>& inputs) {
  const auto rows = static_cast<std::uint32_t>(inputs.size() / kernel.input_count);
  const std::size_t output_count = std::size_t{rows} * kernel.output_count;
  const rhi::ComputePipelineHandle pipeline = compute_pipeline(device, source_of(kernel), "function kernel");
  const rhi::BufferHandle input_buffer = buffer_of(device, inputs, "inputs");
  const rhi::BufferHandle output_buffer =
      buffer_of(device, std::vector<std::uint32_t>(output_count, 0xdeadbeefu), "outputs");
  const rhi::BindGroupHandle group =
      device.create_bind_group({.pipeline = pipeline,
                                .set = 0,
                                .entries = {{.binding = 0, .resource = rhi::BufferRange{input_buffer}},
                                            {.binding = 1, .resource = rhi::BufferRange{output_buffer}}},
                                .label = "function kernel"});
  rhi::CommandListHandle list = device.create_command_list("function kernel");
  list->dispatch({.pipeline = pipeline,
                  .bind_groups = {group},
                  .push_constants = std::as_bytes(std::span(&rows, 1)),
                  .workgroup_count = {(rows + workgroup_size - 1) / workgroup_size, 1, 1}});
  device.submit(list)->wait();
  return contents<std::uint32_t>(device, output_buffer, output_count);
}

std::vector<float> run(rhi::Device& device, const FunctionKernel& kernel, const std::vector<float>& inputs) {
  std::vector<std::uint32_t> bits;
  bits.reserve(inputs.size());
  for (const float input : inputs) bits.push_back(std::bit_cast<std::uint32_t>(input));
  std::vector<float> outputs;
  for (const std::uint32_t output : run_bits(device, kernel, bits)) outputs.push_back(std::bit_cast<float>(output));
  return outputs;
}

double ulp_distance(double exact, float value) {
  int exponent = 0;
  std::frexp(exact, &exponent);
  return std::abs(double{value} - exact) / std::ldexp(1.0, std::max(exponent, -125) - 24);
}

}  // namespace tandem::test
