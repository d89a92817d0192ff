#include "rhi/shader_reflection.hpp"

#include <algorithm>
#include <exception>
#include <optional>
#include <string>
#include <tuple>

#include <spirv_cross/spirv_cross.hpp>

#include "rhi/error.hpp"
#include "rhi/spirv/reflected.hpp"
#include "rhi/spirv_validation.hpp"

namespace tandem::rhi {
namespace {

ShaderStage stage_of(spv::ExecutionModel model, std::string_view label) {
  switch (model) {
    case spv::ExecutionModelGLCompute:
      return ShaderStage::compute;
    case spv::ExecutionModelRayGenerationKHR:
      return ShaderStage::ray_generation;
    case spv::ExecutionModelAnyHitKHR:
      return ShaderStage::any_hit;
    case spv::ExecutionModelClosestHitKHR:
      return ShaderStage::closest_hit;
    case spv::ExecutionModelMissKHR:
      return ShaderStage::miss;
    case spv::ExecutionModelIntersectionKHR:
      return ShaderStage::intersection;
    case spv::ExecutionModelCallableKHR:
      return ShaderStage::callable;
    default:
      throw Error(ErrorCode::unsupported, label,
                  "the SPIR-V entry point has execution model " + std::to_string(model) +
                      ", which is neither compute nor a ray tracing stage");
  }
}

TextureDimension dimension_of(const spirv_cross::SPIRType::ImageType& image, const std::string& name,
                              std::string_view label) {
  if (image.ms) throw Error(ErrorCode::unsupported, label, "the image " + name + " has several samples");
  switch (image.dim) {
    case spv::Dim1D:
      return image.arrayed ? TextureDimension::d1_array : TextureDimension::d1;
    case spv::Dim2D:
      return image.arrayed ? TextureDimension::d2_array : TextureDimension::d2;
    case spv::DimCube:
      return image.arrayed ? TextureDimension::cube_array : TextureDimension::cube;
    case spv::Dim3D:
      return TextureDimension::d3;
    case spv::DimBuffer:
      return TextureDimension::d1;
    default:
      throw Error(ErrorCode::unsupported, label,
                  "the image " + name + " has a dimension that a compute shader cannot have");
  }
}

ComponentKind component_of(const spirv_cross::SPIRType& type) {
  switch (type.basetype) {
    case spirv_cross::SPIRType::Int:
    case spirv_cross::SPIRType::Int64:
      return ComponentKind::sint;
    case spirv_cross::SPIRType::UInt:
    case spirv_cross::SPIRType::UInt64:
      return ComponentKind::uint;
    default:
      return ComponentKind::floating;
  }
}

std::optional<TextureFormat> format_of(spv::ImageFormat format, const std::string& name, std::string_view label) {
  switch (format) {
    case spv::ImageFormatUnknown:
      return std::nullopt;
    case spv::ImageFormatR8:
      return TextureFormat::r8_unorm;
    case spv::ImageFormatR8Snorm:
      return TextureFormat::r8_snorm;
    case spv::ImageFormatR8ui:
      return TextureFormat::r8_uint;
    case spv::ImageFormatR8i:
      return TextureFormat::r8_sint;
    case spv::ImageFormatRg8:
      return TextureFormat::rg8_unorm;
    case spv::ImageFormatRg8Snorm:
      return TextureFormat::rg8_snorm;
    case spv::ImageFormatRg8ui:
      return TextureFormat::rg8_uint;
    case spv::ImageFormatRg8i:
      return TextureFormat::rg8_sint;
    case spv::ImageFormatRgba8:
      return TextureFormat::rgba8_unorm;
    case spv::ImageFormatRgba8Snorm:
      return TextureFormat::rgba8_snorm;
    case spv::ImageFormatRgba8ui:
      return TextureFormat::rgba8_uint;
    case spv::ImageFormatRgba8i:
      return TextureFormat::rgba8_sint;
    case spv::ImageFormatR16:
      return TextureFormat::r16_unorm;
    case spv::ImageFormatR16Snorm:
      return TextureFormat::r16_snorm;
    case spv::ImageFormatR16ui:
      return TextureFormat::r16_uint;
    case spv::ImageFormatR16i:
      return TextureFormat::r16_sint;
    case spv::ImageFormatR16f:
      return TextureFormat::r16_float;
    case spv::ImageFormatRg16:
      return TextureFormat::rg16_unorm;
    case spv::ImageFormatRg16Snorm:
      return TextureFormat::rg16_snorm;
    case spv::ImageFormatRg16ui:
      return TextureFormat::rg16_uint;
    case spv::ImageFormatRg16i:
      return TextureFormat::rg16_sint;
    case spv::ImageFormatRg16f:
      return TextureFormat::rg16_float;
    case spv::ImageFormatRgba16:
      return TextureFormat::rgba16_unorm;
    case spv::ImageFormatRgba16Snorm:
      return TextureFormat::rgba16_snorm;
    case spv::ImageFormatRgba16ui:
      return TextureFormat::rgba16_uint;
    case spv::ImageFormatRgba16i:
      return TextureFormat::rgba16_sint;
    case spv::ImageFormatRgba16f:
      return TextureFormat::rgba16_float;
    case spv::ImageFormatR32ui:
      return TextureFormat::r32_uint;
    case spv::ImageFormatR32i:
      return TextureFormat::r32_sint;
    case spv::ImageFormatR32f:
      return TextureFormat::r32_float;
    case spv::ImageFormatRg32ui:
      return TextureFormat::rg32_uint;
    case spv::ImageFormatRg32i:
      return TextureFormat::rg32_sint;
    case spv::ImageFormatRg32f:
      return TextureFormat::rg32_float;
    case spv::ImageFormatRgba32ui:
      return TextureFormat::rgba32_uint;
    case spv::ImageFormatRgba32i:
      return TextureFormat::rgba32_sint;
    case spv::ImageFormatRgba32f:
      return TextureFormat::rgba32_float;
    case spv::ImageFormatR64ui:
      return TextureFormat::r64_uint;
    case spv::ImageFormatR64i:
      return TextureFormat::r64_sint;
    case spv::ImageFormatRgb10A2:
      return TextureFormat::rgb10a2_unorm;
    case spv::ImageFormatRgb10a2ui:
      return TextureFormat::rgb10a2_uint;
    case spv::ImageFormatR11fG11fB10f:
      return TextureFormat::rg11b10_float;
    default:
      throw Error(ErrorCode::unsupported, label, "the image " + name + " has an unknown format");
  }
}

class Reflector {
 public:
  Reflector(std::span<const std::uint32_t> spirv, std::string_view label)
      : compiler_(without_composite_nulls(spirv)), used_as_values_(variables_used_as_values(spirv)), label_(label) {}

  ShaderReflection reflect() {
    const auto entry_points = compiler_.get_entry_points_and_stages();
    if (entry_points.size() != 1)
      throw Error(ErrorCode::invalid_argument, label_,
                  "the SPIR-V module must have exactly one entry point, not " + std::to_string(entry_points.size()));
    result_.entry_point = entry_points[0].name;
    result_.stage = stage_of(entry_points[0].execution_model, label_);

    auto active = compiler_.get_active_interface_variables();
    active.insert(used_as_values_.begin(), used_as_values_.end());
    const spirv_cross::ShaderResources resources = compiler_.get_shader_resources(active);
    refuse(resources.subpass_inputs, "a subpass input");
    refuse(resources.atomic_counters, "an atomic counter");
    add(resources.uniform_buffers, BindingKind::uniform_buffer);
    add(resources.storage_buffers, BindingKind::storage_buffer);
    add(resources.acceleration_structures, BindingKind::acceleration_structure);
    add_images(resources.storage_images, BindingKind::storage_image, BindingKind::storage_texel_buffer);
    add_images(resources.sampled_images, BindingKind::combined_image_sampler, BindingKind::uniform_texel_buffer);
    add_images(resources.separate_images, BindingKind::sampled_image, BindingKind::uniform_texel_buffer);
    add(resources.separate_samplers, BindingKind::sampler);
    std::stable_sort(result_.bindings.begin(), result_.bindings.end(),
                     [](const ShaderBinding& a, const ShaderBinding& b) {
                       return std::tie(a.set, a.binding) < std::tie(b.set, b.binding);
                     });
    merge_aliases();

    for (const spirv_cross::Resource& block : resources.push_constant_buffers)
      result_.push_constant_size =
          static_cast<std::uint32_t>(compiler_.get_declared_struct_size(compiler_.get_type(block.base_type_id)));
    // SPIRV-Cross does not count a shader record among what it looks for in the code.
    const spirv_cross::ShaderResources declared = compiler_.get_shader_resources();
    for (const spirv_cross::Resource& block : declared.shader_record_buffers)
      result_.shader_record_size =
          static_cast<std::uint32_t>(compiler_.get_declared_struct_size(compiler_.get_type(block.base_type_id)));
    add_specialization_constants();
    if (result_.stage == ShaderStage::compute) add_workgroup_size();
    return std::move(result_);
  }

 private:
  void refuse(const spirv_cross::SmallVector<spirv_cross::Resource>& resources, const char* what) const {
    if (!resources.empty())
      throw Error(ErrorCode::unsupported, label_,
                  std::string("the shader declares ") + what + ", " + resources[0].name);
  }

  /// Several variables may view one binding, each with a block of its own.
  void merge_aliases() {
    std::vector<ShaderBinding> merged;
    for (ShaderBinding& each : result_.bindings) {
      if (merged.empty() || merged.back().set != each.set || merged.back().binding != each.binding) {
        merged.push_back(std::move(each));
        continue;
      }
      ShaderBinding& first = merged.back();
      if (first.kind != each.kind || first.count != each.count || first.dimension != each.dimension ||
          first.format != each.format)
        throw Error(ErrorCode::unsupported, label_,
                    "two variables of different kinds share set " + std::to_string(each.set) + " binding " +
                        std::to_string(each.binding) + ": " + first.name + " and " + each.name);
      first.writable = first.writable || each.writable;
    }
    result_.bindings = std::move(merged);
  }

  ShaderBinding binding_of(const spirv_cross::Resource& resource, BindingKind kind) const {
    ShaderBinding binding;
    binding.name = resource.name;
    binding.kind = kind;
    binding.set = compiler_.get_decoration(resource.id, spv::DecorationDescriptorSet);
    binding.binding = compiler_.get_decoration(resource.id, spv::DecorationBinding);
    binding.count = descriptor_count(resource);
    return binding;
  }

  void add(const spirv_cross::SmallVector<spirv_cross::Resource>& resources, BindingKind kind) {
    for (const spirv_cross::Resource& resource : resources) {
      ShaderBinding binding = binding_of(resource, kind);
      if (kind == BindingKind::storage_buffer)
        binding.writable = !compiler_.get_buffer_block_flags(resource.id).get(spv::DecorationNonWritable);
      result_.bindings.push_back(std::move(binding));
    }
  }

  void add_images(const spirv_cross::SmallVector<spirv_cross::Resource>& resources, BindingKind kind,
                  BindingKind of_buffers) {
    for (const spirv_cross::Resource& resource : resources) {
      const spirv_cross::SPIRType::ImageType& image = compiler_.get_type(resource.base_type_id).image;
      ShaderBinding binding = binding_of(resource, image.dim == spv::DimBuffer ? of_buffers : kind);
      binding.dimension = dimension_of(image, resource.name, label_);
      binding.component = component_of(compiler_.get_type(image.type));
      binding.compares = kind == BindingKind::combined_image_sampler && image.depth;
      if (kind == BindingKind::storage_image) {
        binding.writable = !compiler_.has_decoration(resource.id, spv::DecorationNonWritable);
        binding.format = format_of(image.format, resource.name, label_);
      }
      result_.bindings.push_back(std::move(binding));
    }
  }

  std::uint32_t descriptor_count(const spirv_cross::Resource& resource) const {
    const spirv_cross::SPIRType& type = compiler_.get_type(resource.type_id);
    std::uint32_t count = 1;
    for (std::size_t i = 0; i < type.array.size(); ++i) {
      const bool is_literal = type.array_size_literal[i];
      if (!is_literal && compiler_.get_constant(type.array[i]).specialization)
        throw Error(ErrorCode::unsupported, label_,
                    "the array of descriptors " + resource.name + " has a specialisation constant as its length");
      const std::uint32_t length = is_literal ? type.array[i] : constant_value(type.array[i]);
      count *= length;
    }
    return count;
  }

  std::uint32_t constant_value(std::uint32_t id) const { return compiler_.get_constant(id).scalar(); }

  void add_specialization_constants() {
    for (const spirv_cross::SpecializationConstant& constant : compiler_.get_specialization_constants()) {
      const spirv_cross::SPIRConstant& value = compiler_.get_constant(constant.id);
      const std::uint32_t width = compiler_.get_type(value.constant_type).width;
      result_.specialization_constants.push_back({.id = constant.constant_id,
                                                  .default_value = width == 64 ? value.scalar_u64() : value.scalar(),
                                                  .name = compiler_.get_name(constant.id),
                                                  .width = width == 1 ? 32 : width});
    }
    std::sort(result_.specialization_constants.begin(), result_.specialization_constants.end(),
              [](const SpecializationConstant& a, const SpecializationConstant& b) { return a.id < b.id; });
  }

  void add_workgroup_size() {
    spirv_cross::SpecializationConstant x, y, z;
    compiler_.get_work_group_size_specialization_constants(x, y, z);
    const spirv_cross::SpecializationConstant* specialized[3] = {&x, &y, &z};
    for (std::uint32_t i = 0; i < 3; ++i) {
      const auto id = static_cast<std::uint32_t>(specialized[i]->id);
      if (id != 0) result_.workgroup_size_constant[i] = specialized[i]->constant_id;
      result_.workgroup_size[i] =
          id != 0 ? constant_value(id) : compiler_.get_execution_mode_argument(spv::ExecutionModeLocalSize, i);
    }
  }

  spirv_cross::Compiler compiler_;
  std::vector<std::uint32_t> used_as_values_;
  std::string_view label_;
  ShaderReflection result_;
};

}  // namespace

ShaderReflection reflect(std::span<const std::uint32_t> spirv, std::string_view label) {
  check_spirv(spirv, label);
  return reflect_valid(spirv, label);
}

ShaderReflection reflect_valid(std::span<const std::uint32_t> spirv, std::string_view label) {
  try {
    return Reflector(spirv, label).reflect();
  } catch (const Error&) {
    throw;
  } catch (const std::exception& error) {
    throw Error(ErrorCode::invalid_argument, label, std::string("the SPIR-V cannot be parsed: ") + error.what());
  }
}

}  // namespace tandem::rhi
