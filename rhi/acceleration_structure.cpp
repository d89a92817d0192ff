#include "rhi/acceleration_structure.hpp"

#include <cstring>

namespace tandem::rhi {

std::uint32_t component_size_of(VertexFormat format) { return format == VertexFormat::float3 ? 4 : 2; }

std::uint32_t size_of(VertexFormat format) { return 3 * component_size_of(format); }

InstanceDesc make_instance(const AccelerationStructure& bottom_level, const std::array<float, 12>& object_to_world) {
  InstanceDesc instance{};
  static_assert(sizeof(instance.object_to_world) == sizeof(object_to_world));
  std::memcpy(instance.object_to_world, object_to_world.data(), sizeof(object_to_world));
  instance.mask = 0xFF;
  instance.blas_address = bottom_level.device_address();
  return instance;
}

}  // namespace tandem::rhi
