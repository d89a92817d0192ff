#pragma once

#include <stdexcept>
#include <string>

namespace tandem::pathtracer {

/// What the path tracer throws for bad input: a file, an option or a scene that cannot be used. `what()` is one
/// sentence that names it. What a device refuses is an rhi::Error.
class Error : public std::runtime_error {
 public:
  explicit Error(const std::string& sentence) : std::runtime_error(sentence) {}
};

}  // namespace tandem::pathtracer
