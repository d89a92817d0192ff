#include "pathtracer/scene/buffers.hpp"

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
  const auto words = tandem::shaders::path_trace();
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
    if (array.array.empty()) continue;
    elements[compiler.get_decoration(resource.id, spv::DecorationBinding)] = {
        offsets_of(compiler, compiler.get_type(array.parent_type)), compiler.type_struct_member_array_stride(block, 0)};
  }
  return elements;
}

}  // namespace

TEST_CASE("The shaders bind each buffer of a scene where the host does") {
  const std::map<std::string, std::uint32_t> expected = {{"scene_tlas", binding::scene_tlas},
                                                         {"Positions", binding::positions},
                                                         {"Normals", binding::normals},
                                                         {"Triangles", binding::triangles},
                                                         {"Materials", binding::materials},
                                                         {"Lights", binding::lights},
                                                         {"TextureCoordinates", binding::texture_coordinates},
                                                         {"Textures", binding::textures},
                                                         {"Texels", binding::texels},
                                                         {"PrimitiveLights", binding::primitive_lights},
                                                         {"Spheres", binding::spheres},
                                                         {"EnvironmentCells", binding::environment_cells},
                                                         {"Media", binding::media},
                                                         {"Render", binding::render},
                                                         {"Attributes", binding::attributes}};
  std::map<std::string, std::uint32_t> declared;
  const auto reflection = tandem::rhi::reflect(tandem::shaders::path_trace(), "path_trace.comp");
  for (const tandem::rhi::ShaderBinding& found : reflection.bindings)
    if (found.set == 0) declared[found.name] = found.binding;
  CHECK(declared == expected);
}

TEST_CASE("The push constants of the shader are DispatchConstants") {
  const spirv_cross::Compiler compiler = reflect_shader();
  const auto blocks = compiler.get_shader_resources().push_constant_buffers;
  REQUIRE(blocks.size() == 1);
  const Offsets expected = {{"tile_offset", offsetof(DispatchConstants, tile_offset)},
                            {"tile_size", offsetof(DispatchConstants, tile_size)},
                            {"first_sample", offsetof(DispatchConstants, first_sample)},
                            {"sample_count", offsetof(DispatchConstants, sample_count)}};
  CHECK(offsets_of(compiler, compiler.get_type(blocks[0].base_type_id)) == expected);
  CHECK(tandem::rhi::reflect(tandem::shaders::path_trace(), "path_trace.comp").push_constant_size ==
        sizeof(DispatchConstants));
}

TEST_CASE("The render constants of the shader are RenderConstants") {
  const spirv_cross::Compiler compiler = reflect_shader();
  const Offsets expected = {{"camera_position", offsetof(RenderConstants, camera_position)},
                            {"camera_kind", offsetof(RenderConstants, camera_kind)},
                            {"camera_right", offsetof(RenderConstants, camera_right)},
                            {"lens_radius", offsetof(RenderConstants, lens_radius)},
                            {"camera_up", offsetof(RenderConstants, camera_up)},
                            {"focus_distance", offsetof(RenderConstants, focus_distance)},
                            {"camera_forward", offsetof(RenderConstants, camera_forward)},
                            {"triangle_count", offsetof(RenderConstants, triangle_count)},
                            {"camera_motion", offsetof(RenderConstants, camera_motion)},
                            {"opaque_count", offsetof(RenderConstants, opaque_count)},
                            {"background", offsetof(RenderConstants, background)},
                            {"light_count", offsetof(RenderConstants, light_count)},
                            {"resolution", offsetof(RenderConstants, resolution)},
                            {"max_depth", offsetof(RenderConstants, max_depth)},
                            {"seed", offsetof(RenderConstants, seed)},
                            {"sampler_kind", offsetof(RenderConstants, sampler_kind)},
                            {"sampler_total", offsetof(RenderConstants, sampler_total)},
                            {"integrator", offsetof(RenderConstants, integrator)},
                            {"light_sampling", offsetof(RenderConstants, light_sampling)},
                            {"mis", offsetof(RenderConstants, mis)},
                            {"bsdf_sampling", offsetof(RenderConstants, bsdf_sampling)},
                            {"roulette", offsetof(RenderConstants, roulette)},
                            {"max_diffuse_depth", offsetof(RenderConstants, max_diffuse_depth)},
                            {"max_glossy_depth", offsetof(RenderConstants, max_glossy_depth)},
                            {"max_specular_depth", offsetof(RenderConstants, max_specular_depth)},
                            {"clamp_direct", offsetof(RenderConstants, clamp_direct)},
                            {"clamp_indirect", offsetof(RenderConstants, clamp_indirect)},
                            {"occlusion_length", offsetof(RenderConstants, occlusion_length)},
                            {"environment_texture", offsetof(RenderConstants, environment_texture)},
                            {"environment_light", offsetof(RenderConstants, environment_light)},
                            {"medium", offsetof(RenderConstants, medium)},
                            {"environment_right", offsetof(RenderConstants, environment_right)},
                            {"shutter", offsetof(RenderConstants, shutter)},
                            {"environment_up", offsetof(RenderConstants, environment_up)},
                            {"terminator_offset", offsetof(RenderConstants, terminator_offset)},
                            {"environment_forward", offsetof(RenderConstants, environment_forward)},
                            {"reserved_1", offsetof(RenderConstants, reserved_1)}};
  bool found = false;
  for (const spirv_cross::Resource& resource : compiler.get_shader_resources().storage_buffers) {
    if (compiler.get_decoration(resource.id, spv::DecorationBinding) != binding::render) continue;
    const spirv_cross::SPIRType& block = compiler.get_type(resource.base_type_id);
    CHECK(offsets_of(compiler, compiler.get_type(block.member_types[0])) == expected);
    found = true;
  }
  CHECK(found);
}

TEST_CASE("The structures of the shader's buffers are those of the host") {
  const std::map<std::uint32_t, Element> elements = storage_elements(reflect_shader());
  for (const std::uint32_t floats : {binding::positions, binding::normals, binding::texture_coordinates})
    CHECK(elements.at(floats).stride == sizeof(float));
  for (const std::uint32_t words : {binding::texels, binding::primitive_lights})
    CHECK(elements.at(words).stride == sizeof(std::uint32_t));
  CHECK(elements.at(binding::triangles).stride == sizeof(GpuTriangle));
  CHECK(elements.at(binding::triangles).offsets ==
        Offsets{{"vertices", offsetof(GpuTriangle, vertices)}, {"material", offsetof(GpuTriangle, material)}});
  CHECK(elements.at(binding::materials).stride == sizeof(GpuMaterial));
  CHECK(elements.at(binding::materials).offsets ==
        Offsets{{"base_color", offsetof(GpuMaterial, base_color)},
                {"model", offsetof(GpuMaterial, model)},
                {"emission", offsetof(GpuMaterial, emission)},
                {"ior", offsetof(GpuMaterial, ior)},
                {"reflectance", offsetof(GpuMaterial, reflectance)},
                {"opacity", offsetof(GpuMaterial, opacity)},
                {"transmittance", offsetof(GpuMaterial, transmittance)},
                {"alpha_texture", offsetof(GpuMaterial, alpha_texture)},
                {"eta", offsetof(GpuMaterial, eta)},
                {"roughness", offsetof(GpuMaterial, roughness)},
                {"absorption", offsetof(GpuMaterial, absorption)},
                {"metallic", offsetof(GpuMaterial, metallic)},
                {"exponent", offsetof(GpuMaterial, exponent)},
                {"transmission", offsetof(GpuMaterial, transmission)},
                {"specular", offsetof(GpuMaterial, specular)},
                {"normal_scale", offsetof(GpuMaterial, normal_scale)},
                {"base_color_texture", offsetof(GpuMaterial, base_color_texture)},
                {"emission_texture", offsetof(GpuMaterial, emission_texture)},
                {"reflectance_texture", offsetof(GpuMaterial, reflectance_texture)},
                {"roughness_texture", offsetof(GpuMaterial, roughness_texture)},
                {"metallic_texture", offsetof(GpuMaterial, metallic_texture)},
                {"transmission_texture", offsetof(GpuMaterial, transmission_texture)},
                {"transmittance_texture", offsetof(GpuMaterial, transmittance_texture)},
                {"specular_texture", offsetof(GpuMaterial, specular_texture)},
                {"exponent_texture", offsetof(GpuMaterial, exponent_texture)},
                {"normal_texture", offsetof(GpuMaterial, normal_texture)},
                {"bump_texture", offsetof(GpuMaterial, bump_texture)},
                {"medium", offsetof(GpuMaterial, medium)},
                {"alpha_cutoff", offsetof(GpuMaterial, alpha_cutoff)},
                {"attributes", offsetof(GpuMaterial, attributes)},
                {"reserved_1", offsetof(GpuMaterial, reserved) + 0},
                {"reserved_2", offsetof(GpuMaterial, reserved) + 4}});
  CHECK(elements.at(binding::lights).stride == sizeof(GpuLight));
  CHECK(elements.at(binding::lights).offsets == Offsets{{"primitive", offsetof(GpuLight, primitive)},
                                                        {"alias", offsetof(GpuLight, alias)},
                                                        {"threshold", offsetof(GpuLight, threshold)},
                                                        {"area_density", offsetof(GpuLight, area_density)},
                                                        {"kind", offsetof(GpuLight, kind)},
                                                        {"probability", offsetof(GpuLight, probability)},
                                                        {"cosine_inner", offsetof(GpuLight, cosine_inner)},
                                                        {"cosine_outer", offsetof(GpuLight, cosine_outer)},
                                                        {"position", offsetof(GpuLight, position)},
                                                        {"reserved_0", offsetof(GpuLight, reserved_0)},
                                                        {"direction", offsetof(GpuLight, direction)},
                                                        {"reserved_1", offsetof(GpuLight, reserved_1)},
                                                        {"radiance", offsetof(GpuLight, radiance)},
                                                        {"reserved_2", offsetof(GpuLight, reserved_2)}});
  CHECK(elements.at(binding::textures).stride == sizeof(GpuTexture));
  CHECK(elements.at(binding::textures).offsets == Offsets{{"kind", offsetof(GpuTexture, kind)},
                                                          {"format", offsetof(GpuTexture, format)},
                                                          {"first_word", offsetof(GpuTexture, first_word)},
                                                          {"address", offsetof(GpuTexture, address)},
                                                          {"width", offsetof(GpuTexture, width)},
                                                          {"height", offsetof(GpuTexture, height)},
                                                          {"filter_mode", offsetof(GpuTexture, filter)},
                                                          {"channel", offsetof(GpuTexture, channel)},
                                                          {"u_row", offsetof(GpuTexture, u_row)},
                                                          {"scale", offsetof(GpuTexture, scale)},
                                                          {"v_row", offsetof(GpuTexture, v_row)},
                                                          {"coordinates", offsetof(GpuTexture, coordinates)},
                                                          {"color_a", offsetof(GpuTexture, color_a)},
                                                          {"alpha_a", offsetof(GpuTexture, alpha_a)},
                                                          {"color_b", offsetof(GpuTexture, color_b)},
                                                          {"alpha_b", offsetof(GpuTexture, alpha_b)}});
  CHECK(elements.at(binding::attributes).stride == sizeof(GpuVertexAttributes));
  CHECK(elements.at(binding::attributes).offsets ==
        Offsets{{"tangent", offsetof(GpuVertexAttributes, tangent)},
                {"color", offsetof(GpuVertexAttributes, color)},
                {"opacity", offsetof(GpuVertexAttributes, opacity)},
                {"texture_coordinates", offsetof(GpuVertexAttributes, texture_coordinates)},
                {"reserved", offsetof(GpuVertexAttributes, reserved)}});
  CHECK(elements.at(binding::spheres).stride == sizeof(GpuSphere));
  CHECK(elements.at(binding::spheres).offsets == Offsets{{"centre", offsetof(GpuSphere, centre)},
                                                         {"radius", offsetof(GpuSphere, radius)},
                                                         {"motion", offsetof(GpuSphere, motion)},
                                                         {"material", offsetof(GpuSphere, material)}});
  CHECK(elements.at(binding::environment_cells).stride == sizeof(GpuEnvironmentCell));
  CHECK(elements.at(binding::environment_cells).offsets ==
        Offsets{{"threshold", offsetof(GpuEnvironmentCell, threshold)},
                {"alias", offsetof(GpuEnvironmentCell, alias)},
                {"density", offsetof(GpuEnvironmentCell, density)}});
  CHECK(elements.at(binding::media).stride == sizeof(GpuMedium));
  CHECK(elements.at(binding::media).offsets == Offsets{{"absorption", offsetof(GpuMedium, absorption)},
                                                       {"anisotropy", offsetof(GpuMedium, anisotropy)},
                                                       {"scattering", offsetof(GpuMedium, scattering)},
                                                       {"reserved", offsetof(GpuMedium, reserved)}});
}
