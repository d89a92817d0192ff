#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "rhi/device.hpp"
#include "tests/faults/spirv_module.hpp"

namespace tandem::test {

/// One run of shaders as a faulty device may change it.
struct DispatchEdit {
  std::vector<std::byte> push_constants;
  std::array<std::uint32_t, 3> size = {1, 1, 1};  ///< workgroups of a dispatch, invocations of a trace
};

using TriangleCorners = std::array<std::array<float, 3>, 3>;

inline float longest_edge(const TriangleCorners& corners) {
  float longest = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto &a = corners[i], &b = corners[(i + 1) % 3];
    longest = std::max(longest, std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]));
  }
  return longest;
}

/// What a faulty device does otherwise than it was told. Members that are empty change nothing.
struct DeviceEdits {
  /// Changes a shader. False where there is nothing to change: the shader is then that of the device without the fault.
  std::function<bool(SpirvModule& module, rhi::ShaderStage stage)> shader;
  std::function<void(std::vector<rhi::SpecializationValue>& values)> specialization;

  std::function<void(rhi::BottomLevelDesc& desc)> bottom_level;  ///< of builds and updates
  std::function<void(std::array<float, 3>& position)> vertex;    ///< of triangles, for builds and updates alone
  /// Triangles that structures are built without; their indices must have come to the buffer by an upload.
  std::function<bool(const TriangleCorners& corners)> loses_triangle;
  std::function<void(std::array<float, 6>& box)> box;                 ///< likewise
  std::function<void(rhi::InstanceDesc& instance)> instance;          ///< likewise
  std::function<void(std::uint32_t& instance_count)> instance_count;  ///< likewise
  bool skips_bottom_level_updates = false;
  bool skips_top_level_updates = false;

  std::function<void(const rhi::Buffer& buffer, std::vector<std::byte>& bytes)> upload;
  bool skips_fills = false;  ///< and what a buffer holds before it is written is not 0
  /// `previous`: as it was asked for, none for the first.
  std::function<void(DispatchEdit& dispatch, const DispatchEdit* previous)> dispatch;
};

}  // namespace tandem::test
