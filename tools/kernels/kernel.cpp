#include "tools/kernels/kernel.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "base/error.hpp"
#include "tools/kernels/problems.hpp"
#include "tools/kernels/source.hpp"

namespace tandem::kernels {
namespace {

constexpr Kernel all[] = {
    {"matrix-product", "product of 256x256 floats by tiles of 16x16 in shared memory", matrix_product},
    {"subgroup-reduction", "sums of 512 x 4096 floats by subgroups", subgroup_reduction},
    {"prefix-sum", "prefix sums of 512 x 512 numbers in shared memory", prefix_sum},
    {"bitonic-sort", "sorts 256 x 512 keys in shared memory", bitonic_sort},
    {"fft", "512 transforms of 1024 points in shared memory, radix 4", fft},
    {"filter-buffer", "9x9 filter over a buffer of 512x512 pixels", filter_buffer},
    {"filter-image", "9x9 filter over a sampled image of 128x128 texels", filter_image},
    {"n-body", "accelerations of 4096 bodies by tiles in shared memory", n_body},
    {"mandelbrot", "512x512 points, up to 256 steps", mandelbrot},
};

std::string names() {
  std::vector<std::string_view> list;
  for (const Kernel& kernel : all) list.emplace_back(kernel.name);
  return fmt::format("{}", fmt::join(list, ", "));
}

}  // namespace

std::string_view Kernel::source() const {
  std::string stem = name;
  std::ranges::replace(stem, '-', '_');
  const std::span<const Source> texts = sources();
  return std::ranges::find(texts, stem, &Source::stem)->text;
}

std::span<const Kernel> kernels() { return all; }

std::vector<Kernel> named_kernels(const std::string& list) {
  if (list.empty()) return {std::begin(all), std::end(all)};
  std::vector<Kernel> chosen;
  for (std::size_t begin = 0; begin <= list.size();) {
    const std::size_t end = std::min(list.find(',', begin), list.size());
    const std::string name = list.substr(begin, end - begin);
    begin = end + 1;
    const auto same = [&](const Kernel& kernel) { return kernel.name == name; };
    const auto* const found = std::ranges::find_if(all, same);
    if (found == std::end(all)) throw Error(fmt::format("'{}' is not a kernel; the kernels are {}", name, names()));
    if (std::ranges::any_of(chosen, same)) throw Error(fmt::format("the kernel '{}' is named twice", name));
    chosen.push_back(*found);
  }
  return chosen;
}

}  // namespace tandem::kernels
