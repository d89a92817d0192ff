#pragma once

#include <cstdint>
#include <string>

#include "base/error.hpp"

namespace tandem::program::amber {

/// A place in a script; lines and columns are counted from 1, columns in bytes.
struct Position {
  std::uint32_t line = 1;
  std::uint32_t column = 1;
};

/// What is wrong with a script, in one sentence: "FILE:LINE:COLUMN: why".
class ScriptError : public Error {
 public:
  ScriptError(const std::string& file, Position position, const std::string& why)
      : Error(file + ":" + std::to_string(position.line) + ":" + std::to_string(position.column) + ": " + why),
        position_(position) {}

  Position position() const noexcept { return position_; }

 private:
  Position position_;
};

}  // namespace tandem::program::amber
