#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "rhi/device.hpp"

/// Functions of the shaders, called on a device for many arguments at once.
namespace tandem::test {

/// A compute shader that calls a function once for each row of its inputs. The body is GLSL and uses input_float(k),
/// input_bits(k), output_float(k, value) and output_bits(k, value) for column k of its row.
struct FunctionKernel {
  std::string includes;  ///< lines of #include, and of #define before them
  std::string body;
  std::uint32_t input_count = 1;  ///< columns
  std::uint32_t output_count = 1;
};

/// The outputs, row by row.
std::vector<std::uint32_t> run_bits(rhi::Device& device, const FunctionKernel& kernel,
                                    const std::vector<std::uint32_t>& inputs);
std::vector<float> run(rhi::Device& device, const FunctionKernel& kernel, const std::vector<float>& inputs);

/// Distance of `value` from `exact` in units in the last place of a float at `exact`.
double ulp_distance(double exact, float value);

}  // namespace tandem::test
