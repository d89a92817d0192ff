// The equations that random walks solve are what they say, by quadrature.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "compare/study/fredholm_equation.hpp"
#include "tests/shaders/function_kernel.hpp"
#include "tests/support/device_test.hpp"

using namespace tandem;

TANDEM_DEVICE_TEST("e^x solves each Fredholm equation, and the scattered source is the integral of its source") {
  // The midpoint rule over cells whose border is x, so that the kink of e^-|x - t| lies between them. Its error is
  // below h^2 / 24 times the second derivative, 2e-7, as large as a float's.
  constexpr std::uint32_t cells = 1024, columns = 8;
  for (const study::FredholmEquation& equation : study::fredholm_equations) {
    CAPTURE(std::string(equation.name));
    const test::FunctionKernel kernel = {.includes = "#include \"study/fredholm.glsl\"\n",
                                         .body = R"(
    uint equation = uint(input_float(0));
    output_float(0, fredholm_kernel(equation, input_float(1), input_float(2)));
    output_float(1, fredholm_source(equation, input_float(2)));
    output_float(2, fredholm_source(equation, input_float(1)));
    output_float(3, fredholm_scattered_source(equation, input_float(1)));)",
                                         .input_count = 3,
                                         .output_count = 4};
    std::vector<float> inputs;
    for (std::uint32_t column = 0; column <= columns; ++column) {
      for (std::uint32_t cell = 0; cell < cells; ++cell) {
        inputs.push_back(static_cast<float>(equation.kernel));
        inputs.push_back(static_cast<float>(column) / columns);
        inputs.push_back((static_cast<float>(cell) + 0.5f) / cells);
      }
    }
    const std::vector<float> outputs = test::run(device, kernel, inputs);
    double norm = 0;
    for (std::size_t column = 0; column <= columns; ++column) {
      const double x = static_cast<double>(column) / columns;
      double reflected = 0, scattered = 0, magnitude = 0;
      for (std::size_t cell = 0; cell < cells; ++cell) {
        const float* const row = outputs.data() + 4 * (column * cells + cell);
        const double t = (static_cast<double>(cell) + 0.5) / cells;
        reflected += double{row[0]} * study::fredholm_solution(t) / cells;
        scattered += double{row[0]} * double{row[1]} / cells;
        magnitude += std::abs(double{row[0]}) / cells;
      }
      const float* const row = outputs.data() + 4 * column * cells;
      CHECK(std::abs(double{row[2]} + reflected - study::fredholm_solution(x)) < 1e-6);
      CHECK(std::abs(double{row[3]} - scattered) < 1e-6);
      norm = std::max(norm, magnitude);
    }
    CHECK(norm == doctest::Approx(equation.norm).epsilon(1e-5));
  }
}
