#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "program/job/job.hpp"
#include "rhi/device.hpp"

namespace tandem::program {

/// Every reason why a device cannot run the job's shaders, as "shader: reason"; none where it can. Compiles nothing.
std::vector<std::string> refusals(rhi::Device& device, const Job& job);

/// A job on a device: everything that it names, made once, with the contents that its commands leave.
class Execution {
 public:
  /// Makes all resources and pipelines. Throws rhi::Error, which names the buffer, image, shader or pipeline; also
  /// where a pipeline's bindings lack one that its shaders use. `device` and `job` outlive the execution.
  Execution(rhi::Device& device, const Job& job);
  ~Execution();
  Execution(const Execution&) = delete;
  Execution& operator=(const Execution&) = delete;

  /// Runs the command, and waits. Throws rhi::Error.
  void run(const Command& command);
  /// Runs all commands of the job.
  void run();
  /// Runs them in one submission. Returns the milliseconds that the device needed, by its own clock where it has one.
  double timed_run();
  /// The same of these commands.
  double timed_run(std::span<const Command> commands);

  /// The bytes that a buffer has now. @param index in Job::buffers
  std::vector<std::byte> buffer(std::size_t index);
  /// All levels of an image. @param index in Job::images
  std::vector<std::byte> image(std::size_t index);
  /// Writes all bytes of a buffer, or of an image's levels.
  void set_buffer(std::size_t index, std::span<const std::byte> bytes);
  void set_image(std::size_t index, std::span<const std::byte> bytes);
  /// Puts a new buffer of these bytes, however many, in the place of one. No bytes: the old one stays.
  void replace_buffer(std::size_t index, std::span<const std::byte> bytes);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace tandem::program
