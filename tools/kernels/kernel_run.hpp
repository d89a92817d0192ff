#pragma once

#include <stdexcept>

#include "rhi/device.hpp"
#include "tools/kernels/kernel.hpp"

namespace tandem::kernels {

/// A kernel gave a wrong answer; the sentence names it, the device and the first word that is wrong.
class WrongAnswer : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A kernel with its problem on a device, ready to run.
class KernelRun {
 public:
  /// Compiles the shader and fills the inputs. `problem` and the kernel must outlive the object. Throws rhi::Error,
  /// also where the device lacks what the shader needs.
  KernelRun(rhi::DeviceHandle device, const Kernel& kernel, const Problem& problem);

  /// From GLSL to a pipeline.
  double compile_milliseconds() const noexcept { return compile_milliseconds_; }

  /// Runs the kernel once over an answer that is wiped before, checks the answer, and returns the milliseconds on the
  /// device, by its timestamps where it has them. Throws WrongAnswer.
  double run();

 private:
  rhi::DeviceHandle device_;
  const Kernel& kernel_;
  const Problem& problem_;
  rhi::BufferHandle answer_;
  rhi::QueryPoolHandle timestamps_;  ///< null: the device has none
  rhi::CommandListHandle wipe_;
  rhi::CommandListHandle list_;
  double compile_milliseconds_ = 0.0;
};

}  // namespace tandem::kernels
