#include <algorithm>

#include "tools/kernels/problems.hpp"

namespace tandem::kernels {
namespace {

Problem filter(std::uint32_t side, bool image) {
  constexpr int width = 9;
  const std::vector<float> pixels = whole_floats(std::size_t{side} * side, 255, 1);
  const std::vector<float> weights = whole_floats(width * width, 15, 2);
  Problem problem{.inputs = {{.words = words_of(pixels), .image_side = image ? side : 0}, {.words = words_of(weights)}},
                  .push_constants = {side},
                  .workgroup_count = {side / 16, side / 16, 1},
                  .floats = true};
  const int last = static_cast<int>(side) - 1;
  for (int y = 0; y <= last; ++y) {
    for (int x = 0; x <= last; ++x) {
      float sum = 0.0F;
      for (int i = 0; i < width * width; ++i) {
        const int row = std::clamp(y + i / width - width / 2, 0, last);
        const int column = std::clamp(x + i % width - width / 2, 0, last);
        sum += weights[static_cast<std::size_t>(i)] * pixels[static_cast<std::size_t>(row * (last + 1) + column)];
      }
      problem.expected.push_back(sum);
    }
  }
  return problem;
}

}  // namespace

Problem filter_buffer(Size size) { return filter(size == Size::small ? 48 : 512, false); }

// A side that is a power of two, so that coordinates are exact and each sample is a texel's centre.
Problem filter_image(Size size) { return filter(size == Size::small ? 32 : 128, true); }

Problem mandelbrot(Size size) {
  const std::uint32_t side = size == Size::small ? 64 : 512;
  const float step = 2.5F / static_cast<float>(side);
  Problem problem{.push_constants = {side, std::bit_cast<std::uint32_t>(step)},
                  .workgroup_count = {side / 16, side / 16, 1}};
  // Vulkan rounds sums and products correctly, and the shader forbids fused ones, as the project's compiler options do
  // here: the steps are the same to the last.
  for (std::uint32_t row = 0; row < side; ++row) {
    for (std::uint32_t column = 0; column < side; ++column) {
      const float cx = (static_cast<float>(column) + 0.5F) * step - 2.0F;
      const float cy = (static_cast<float>(row) + 0.5F) * step - 1.25F;
      float x = 0.0F, y = 0.0F;
      int count = 0;
      for (; count < 256 && x * x + y * y <= 4.0F; ++count) {
        const float next = x * x - y * y + cx;
        y = 2.0F * x * y + cy;
        x = next;
      }
      problem.expected.push_back(count);
    }
  }
  return problem;
}

}  // namespace tandem::kernels
