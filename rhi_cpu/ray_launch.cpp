#include "rhi_cpu/ray_launch.hpp"

#include <algorithm>
#include <vector>

#include "rhi_cpu/launch/launch_watch.hpp"
#include "rhi_cpu/trace_ray.hpp"

namespace tandem::cpu {
namespace {

/// Neighbouring rays use the same parts of a scene, so a thread takes small squares of invocations where there are two
/// dimensions.
class Tiling {
 public:
  explicit Tiling(const std::array<std::uint32_t, 3>& size)
      : size_(size),
        tile_(size[1] > 1 ? std::array<std::uint32_t, 2>{8, 8} : std::array<std::uint32_t, 2>{64, 1}),
        columns_((std::uint64_t{size[0]} + tile_[0] - 1) / tile_[0]),
        rows_((std::uint64_t{size[1]} + tile_[1] - 1) / tile_[1]) {}

  std::uint64_t count() const { return columns_ * rows_ * size_[2]; }

  template <typename Work>
  void for_each_invocation(std::uint64_t tile, const Work& work) const {
    const auto first_x = static_cast<std::uint32_t>(tile % columns_ * tile_[0]);
    const auto first_y = static_cast<std::uint32_t>(tile / columns_ % rows_ * tile_[1]);
    const auto z = static_cast<std::uint32_t>(tile / columns_ / rows_);
    const std::uint32_t end_x = first_x + std::min(tile_[0], size_[0] - first_x);
    const std::uint32_t end_y = first_y + std::min(tile_[1], size_[1] - first_y);
    for (std::uint32_t y = first_y; y < end_y; ++y)
      for (std::uint32_t x = first_x; x < end_x; ++x) work(x, y, z);
  }

 private:
  std::array<std::uint32_t, 3> size_;
  std::array<std::uint32_t, 2> tile_;
  std::uint64_t columns_;
  std::uint64_t rows_;
};

}  // namespace

void trace_rays(const ShaderTable& table, const FirstRecords& first, std::span<const std::shared_ptr<BindGroup>> groups,
                std::span<const std::byte> push_constants, const std::array<std::uint32_t, 3>& size,
                DeviceState& device) {
  const RayTracingPipeline& pipeline = table.pipeline();
  std::vector<ResourceTable> tables;
  std::vector<BoundShader> shaders;
  for (const Kernel& kernel : pipeline.kernels()) {
    tables.push_back(resource_table(*kernel.info, groups, pipeline.label()));
    shaders.push_back({.call = kernel.info->call,
                       .resources = tables.back().resources.data(),
                       .payload_size = kernel.info->payload_size});
  }
  const GeneralRecord& record = table.ray_generation()[first.ray_generation];

  LaunchFailures failures;
  const LaunchWatch watch(device.time_limit, pipeline.label());
  const RayLaunch launch{.table = table,
                         .shaders = shaders,
                         .first = first,
                         .max_recursion_depth = pipeline.desc().max_recursion_depth,
                         .failures = failures,
                         .watch = watch.watch()};
  const Tiling tiling(size);
  device.workers.for_each_range(tiling.count(), [&](std::uint64_t begin, std::uint64_t end) {
    for (std::uint64_t tile = begin; tile < end; ++tile) {
      watch.look();
      tiling.for_each_invocation(tile, [&](std::uint32_t x, std::uint32_t y, std::uint32_t z) {
        generate_rays(launch, record, push_constants.data(), {x, y, z}, size);
      });
    }
  });
  watch.check();
  failures.check(table, pipeline.shaders());
}

}  // namespace tandem::cpu
