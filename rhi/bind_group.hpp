#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "rhi/acceleration_structure.hpp"
#include "rhi/buffer.hpp"
#include "rhi/pipeline.hpp"
#include "rhi/sampler.hpp"
#include "rhi/texture.hpp"

namespace tandem::rhi {

/// A texture, or some of its levels and layers. A storage image is one level.
struct TextureView {
  TextureHandle texture = {};
  std::uint32_t first_level = 0;
  std::uint32_t level_count = 0;  ///< 0: all from first_level on; for a storage image: one
  std::uint32_t first_layer = 0;
  std::uint32_t layer_count = 0;  ///< 0: all from first_layer on
  /// What the shader sees, where it is another than the texture's: 2D textures, arrays and cubes may be seen as each
  /// other, 1D textures and their arrays too.
  std::optional<TextureDimension> dimension = {};
};

/// A texture view with the sampler that reads it: a combined image sampler.
struct SampledTexture {
  TextureView view;
  SamplerHandle sampler = {};
};

/// A buffer as texels: a samplerBuffer, textureBuffer or imageBuffer. The range holds whole texels.
struct TexelBuffer {
  BufferRange range = {};
  TextureFormat format = TextureFormat::r32_float;
};

/// What one descriptor refers to. A null AccelerationStructureHandle is a structure that no ray meets, where the
/// device has Capabilities::null_acceleration_structure. A TextureHandle is a TextureView of all of it.
using BoundResource = std::variant<BufferRange, AccelerationStructureHandle, TextureHandle, TextureView, SamplerHandle,
                                   SampledTexture, TexelBuffer>;

struct BindGroupEntry {
  std::uint32_t binding = 0;
  BoundResource resource;
  std::uint32_t array_element = 0;
};

/// The resources of one descriptor set of a pipeline: every binding that the shader uses, once. Elements of an array
/// may be left out where the device has Capabilities::partially_bound; then no invocation may use them.
struct BindGroupDesc {
  PipelineHandle pipeline;
  std::uint32_t set = 0;
  std::vector<BindGroupEntry> entries;
  std::string label;
};

/// Immutable once created; keeps its resources alive. It may be used with every pipeline whose shaders declare
/// the same bindings for this set.
class BindGroup {
 public:
  virtual ~BindGroup() = default;
  BindGroup(const BindGroup&) = delete;
  BindGroup& operator=(const BindGroup&) = delete;

  const std::string& label() const noexcept { return desc_.label; }
  const BindGroupDesc& desc() const noexcept { return desc_; }

 protected:
  explicit BindGroup(BindGroupDesc desc) : desc_(std::move(desc)) {}

 private:
  BindGroupDesc desc_;
};

using BindGroupHandle = std::shared_ptr<BindGroup>;

}  // namespace tandem::rhi
