#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "rhi/acceleration_structure.hpp"
#include "rhi/buffer.hpp"
#include "rhi/pipeline.hpp"
#include "rhi/texture.hpp"

namespace tandem::rhi {

/// What one descriptor refers to: a buffer range, a built top level, or a texture. A null AccelerationStructureHandle
/// is a structure that no ray meets, where the device has Capabilities::null_acceleration_structure.
using BoundResource = std::variant<BufferRange, AccelerationStructureHandle, TextureHandle>;

struct BindGroupEntry {
  std::uint32_t binding = 0;
  BoundResource resource;
  std::uint32_t array_element = 0;
};

/// The resources of one descriptor set of a pipeline: every element of every binding that the shader uses, once.
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
