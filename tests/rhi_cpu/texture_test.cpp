#include <doctest/doctest.h>

#include <cstdint>
#include <numeric>
#include <vector>

#include "rhi/error.hpp"
#include "rhi_cpu/device.hpp"
#include "tests/support/device_test.hpp"

namespace tandem::cpu {

TEST_CASE("Texels are copied in and out, all of them, for every dimension and texel size") {
  const rhi::DeviceHandle device = create_device({}, {});
  using enum rhi::TextureDimension;
  for (const rhi::TextureDesc& desc :
       {rhi::TextureDesc{.dimension = d1, .format = rhi::TextureFormat::rgba8_unorm, .size = {7, 1, 1}, .label = "a"},
        rhi::TextureDesc{.dimension = d2, .format = rhi::TextureFormat::rgba16_float, .size = {3, 5, 1}, .label = "b"},
        rhi::TextureDesc{.dimension = d3, .format = rhi::TextureFormat::rgba32_uint, .size = {3, 5, 4}, .label = "c"},
        rhi::TextureDesc{
            .dimension = d2_array, .format = rhi::TextureFormat::r32_float, .size = {1, 2, 9}, .label = "d"}}) {
    const rhi::TextureHandle texture = device->create_texture(desc);
    const auto size = static_cast<std::size_t>(texture->size_in_bytes());
    std::vector<std::uint8_t> bytes(size + 32, 0xEE);
    std::iota(bytes.begin() + 16, bytes.end() - 16, std::uint8_t{1});
    const rhi::BufferHandle source = test::buffer_of(*device, bytes, "source");
    const rhi::BufferHandle target = test::buffer_of(*device, std::vector<std::uint8_t>(size + 32, 0xEE), "target");
    const rhi::CommandListHandle list = device->create_command_list("copies");
    list->copy_to_texture({source, 16, size}, texture);
    list->copy_from_texture(texture, {target, 16, size});
    device->submit(list);
    std::fill(bytes.end() - 16, bytes.end(), std::uint8_t{0xEE});
    CHECK(test::contents<std::uint8_t>(*device, target, size + 32) == bytes);
  }
}

TEST_CASE("A texture of another device is refused") {
  const rhi::DeviceHandle device = create_device({}, {});
  const rhi::DeviceHandle other = create_device({}, {});
  const rhi::TextureHandle foreign = other->create_texture({.label = "foreign"});
  const rhi::BufferHandle buffer = test::buffer_of(*device, std::vector<std::uint32_t>{1}, "texel");
  const rhi::CommandListHandle list = device->create_command_list("list");
  CHECK_THROWS_WITH_AS(list->copy_to_texture({buffer}, foreign), "foreign: the object belongs to another device",
                       rhi::Error);
  CHECK_THROWS_WITH_AS(list->copy_from_texture(foreign, {buffer}), "foreign: the object belongs to another device",
                       rhi::Error);
}

}  // namespace tandem::cpu
