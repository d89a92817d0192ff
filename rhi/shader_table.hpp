#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "rhi/ray_tracing_pipeline.hpp"

namespace tandem::rhi {

/// In ShaderRecord::shader: the record runs nothing (Vulkan: a shader group handle of zeros).
inline constexpr std::uint32_t no_shader = ~std::uint32_t{0};

/// One record of a shader binding table.
struct ShaderRecord {
  std::uint32_t shader = 0;     ///< position in the pipeline's list of this kind, or no_shader
  std::vector<std::byte> data;  ///< what the shader reads as its shaderRecordEXT block
};

/// The records of one kind, `stride` bytes apart, which only matters to a shader that computes with it. Record i is the
/// one that an index of i in a trace or call names.
struct ShaderRecords {
  std::vector<ShaderRecord> records;
  /// 0: the smallest that holds every record. Else a multiple of Limits::shader_record_alignment that does, at most
  /// Limits::max_shader_record_stride.
  std::uint32_t stride = 0;
};

struct ShaderTableDesc {
  RayTracingPipelineHandle pipeline;
  ShaderRecords ray_generation;  ///< at least one; TraceRaysDesc chooses
  ShaderRecords miss;
  ShaderRecords hit;  ///< record: instance's sbt_offset + sbtRecordOffset + geometry index * sbtRecordStride
  ShaderRecords callable;
  std::string label;
};

/// Which shaders the rays of a trace_rays run, and with which data. Immutable once created.
class ShaderTable {
 public:
  virtual ~ShaderTable() = default;
  ShaderTable(const ShaderTable&) = delete;
  ShaderTable& operator=(const ShaderTable&) = delete;

  const std::string& label() const noexcept { return desc_.label; }
  const ShaderTableDesc& desc() const noexcept { return desc_; }

 protected:
  explicit ShaderTable(ShaderTableDesc desc) : desc_(std::move(desc)) {}

 private:
  ShaderTableDesc desc_;
};

using ShaderTableHandle = std::shared_ptr<ShaderTable>;

}  // namespace tandem::rhi
