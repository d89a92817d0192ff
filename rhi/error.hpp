#pragma once

#include <stdexcept>
#include <string>
#include <string_view>

namespace tandem::rhi {

/// What kind of thing went wrong; the text of the Error says the rest.
enum class ErrorCode {
  invalid_argument,    ///< the caller broke a rule of the interface
  unsupported,         ///< the device cannot do this, or this SPIR-V uses something it does not handle
  no_such_device,      ///< no device has the name asked for, or none qualifies
  out_of_memory,       ///< host or device memory
  shader_compilation,  ///< the shader's native code could not be made (no compiler, compiler failed)
  device_lost,         ///< the driver gave up; the device and all it made are unusable
  timeout,             ///< a launch took longer than DeviceDesc::time_limit and was stopped
  io                   ///< a file that the backend itself needs (its kernel cache) cannot be read or written
};

/// The one exception type that the rhi throws. `what()` is one sentence that names the object by its label.
class Error : public std::runtime_error {
 public:
  /// @param label the label of the object at fault, "" when there is none
  Error(ErrorCode code, std::string_view label, std::string_view why)
      : std::runtime_error(label.empty() ? std::string(why) : std::string(label) + ": " + std::string(why)),
        code_(code),
        label_(label) {}

  ErrorCode code() const noexcept { return code_; }
  const std::string& label() const noexcept { return label_; }

 private:
  ErrorCode code_;
  std::string label_;
};

}  // namespace tandem::rhi
