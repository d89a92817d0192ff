#include "tests/shaders/sampling/sampler_draws.hpp"

#include "tests/shaders/function_kernel.hpp"

namespace tandem::test {

std::vector<Bits> draw(rhi::Device& device, const Sampler& sampler, std::uint32_t total,
                       const std::vector<Draw>& draws) {
  const FunctionKernel kernel = {.includes =
                                     "#include \"sampling/halton.glsl\"\n"
                                     "#include \"sampling/sobol.glsl\"\n"
                                     "#include \"sampling/stratified.glsl\"",
                                 .body = R"(
    RandomKey key;
    key.pixel = input_bits(0);
    key.sample_index = input_bits(1);
    key.seed = input_bits(3);
    uint dimension = input_bits(2);
    uint total = input_bits(4);
    uvec4 bits = )" + sampler.call + R"(;
    output_bits(0, bits.x); output_bits(1, bits.y); output_bits(2, bits.z); output_bits(3, bits.w);)",
                                 .input_count = 5,
                                 .output_count = 4};
  std::vector<std::uint32_t> inputs;
  inputs.reserve(5 * draws.size());
  for (const Draw& draw : draws)
    inputs.insert(inputs.end(), {draw.x | draw.y << 16, draw.sample, draw.dimension, draw.seed, total});
  const std::vector<std::uint32_t> outputs = run_bits(device, kernel, inputs);
  std::vector<Bits> result;
  result.reserve(draws.size());
  for (std::size_t i = 0; i < outputs.size(); i += 4)
    result.push_back({outputs[i], outputs[i + 1], outputs[i + 2], outputs[i + 3]});
  return result;
}

std::vector<Bits> draw_samples(rhi::Device& device, const Sampler& sampler, std::uint32_t total, Draw first,
                               std::uint32_t count) {
  std::vector<Draw> draws;
  for (std::uint32_t i = 0; i < count; ++i, ++first.sample) draws.push_back(first);
  return draw(device, sampler, total, draws);
}

}  // namespace tandem::test
