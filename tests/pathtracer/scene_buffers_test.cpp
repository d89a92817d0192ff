#include "pathtracer/scene_buffers.hpp"

#include <map>
#include <string>
#include <vector>

#include <doctest/doctest.h>
#include <spirv_cross/spirv_cross.hpp>

#include "rhi/shader_reflection.hpp"
#include "shaders/spirv.hpp"

using namespace tandem::pathtracer;

namespace {

spirv_cross::Compiler reflect_shader() {
  const auto words = tandem::shaders::path_trace_transparent();
  return spirv_cross::Compiler(std::vector<std::uint32_t>(words.begin(), words.end()));
}

using Offsets = std::map<std::string, std::size_t>;

Offsets offsets_of(const spirv_cross::Compiler& compiler, const spirv_cross::SPIRType& type) {
  Offsets offsets;
  for (std::uint32_t i = 0; i < type.member_types.size(); ++i)
    offsets[compiler.get_member_name(type.self, i)] = compiler.type_struct_member_offset(type, i);
  return offsets;
}

/// The element type of the array that is the only member of each storage buffer, by binding of set 0.
struct Element {
  Offsets offsets;
  std::size_t stride;
};

std::map<std::uint32_t, Element> storage_elements(const spirv_cross::Compiler& compiler) {
  std::map<std::uint32_t, Element> elements;
  for (const spirv_cross::Resource& resource : compiler.get_shader_resources().storage_buffers) {
    if (compiler.get_decoration(resource.id, spv::DecorationDescriptorSet) != 0) continue;
    const spirv_cross::SPIRType& block = compiler.get_type(resource.base_type_id);
    const spirv_cross::SPIRType& array = compiler.get_type(block.member_types[0]);
    elements[compiler.get_decoration(resource.id, spv::DecorationBinding)] = {
        offsets_of(compiler, compiler.get_type(array.parent_type)), compiler.type_struct_member_array_stride(block, 0)};
  }
  return elements;
}

}  // namespace

TEST_CASE("The push constants of the shader are RenderConstants") {
  const spirv_cross::Compiler compiler = reflect_shader();
  const auto blocks = compiler.get_shader_resources().push_constant_buffers;
  REQUIRE(blocks.size() == 1);
  const Offsets expected = {{"camera_position", offsetof(RenderConstants, camera_position)},
                            {"first_sample", offsetof(RenderConstants, first_sample)},
                            {"camera_right", offsetof(RenderConstants, camera_right)},
                            {"sample_count", offsetof(RenderConstants, sample_count)},
                            {"camera_up", offsetof(RenderConstants, camera_up)},
                            {"max_depth", offsetof(RenderConstants, max_depth)},
                            {"camera_forward", offsetof(RenderConstants, camera_forward)},
                            {"seed", offsetof(RenderConstants, seed)},
                            {"background", offsetof(RenderConstants, background)},
                            {"light_count", offsetof(RenderConstants, light_count)},
                            {"resolution", offsetof(RenderConstants, resolution)},
                            {"tile_offset", offsetof(RenderConstants, tile_offset)},
                            {"tile_size", offsetof(RenderConstants, tile_size)},
                            {"opaque_count", offsetof(RenderConstants, opaque_count)}};
  CHECK(offsets_of(compiler, compiler.get_type(blocks[0].base_type_id)) == expected);
  CHECK(tandem::rhi::reflect(tandem::shaders::path_trace_transparent(), "path_trace_transparent.comp")
            .push_constant_size == sizeof(RenderConstants));
}

TEST_CASE("The structures of the shader's buffers are those of the host") {
  const std::map<std::uint32_t, Element> elements = storage_elements(reflect_shader());
  REQUIRE(elements.size() == 8);
  CHECK(elements.at(1).stride == sizeof(float));
  CHECK(elements.at(2).stride == sizeof(float));
  CHECK(elements.at(3).stride == sizeof(GpuTriangle));
  CHECK(elements.at(3).offsets ==
        Offsets{{"vertices", offsetof(GpuTriangle, vertices)}, {"material", offsetof(GpuTriangle, material)}});
  CHECK(elements.at(4).stride == sizeof(GpuMaterial));
  CHECK(elements.at(4).offsets == Offsets{{"base_color", offsetof(GpuMaterial, base_color)},
                                          {"model", offsetof(GpuMaterial, model)},
                                          {"emission", offsetof(GpuMaterial, emission)},
                                          {"ior", offsetof(GpuMaterial, ior)},
                                          {"reflectance", offsetof(GpuMaterial, reflectance)},
                                          {"opacity", offsetof(GpuMaterial, opacity)},
                                          {"transmittance", offsetof(GpuMaterial, transmittance)},
                                          {"alpha_texture", offsetof(GpuMaterial, alpha_texture)}});
  CHECK(elements.at(5).stride == sizeof(GpuLight));
  CHECK(elements.at(5).offsets == Offsets{{"triangle", offsetof(GpuLight, triangle)},
                                          {"alias", offsetof(GpuLight, alias)},
                                          {"threshold", offsetof(GpuLight, threshold)},
                                          {"area_density", offsetof(GpuLight, area_density)}});
  CHECK(elements.at(6).stride == sizeof(float));
  CHECK(elements.at(7).stride == sizeof(GpuAlphaTexture));
  CHECK(elements.at(7).offsets == Offsets{{"first_texel", offsetof(GpuAlphaTexture, first_texel)},
                                          {"width", offsetof(GpuAlphaTexture, width)},
                                          {"height", offsetof(GpuAlphaTexture, height)}});
  CHECK(elements.at(8).stride == sizeof(std::uint32_t));
}
