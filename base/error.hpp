#pragma once

#include <stdexcept>
#include <string>

namespace tandem {

/// Thrown for bad input: a file, an option or a scene that cannot be used. `what()` is one sentence that names it. What
/// a device refuses is an rhi::Error (docs/errors.md).
class Error : public std::runtime_error {
 public:
  explicit Error(const std::string& sentence) : std::runtime_error(sentence) {}
};

}  // namespace tandem
