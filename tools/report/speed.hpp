#pragma once

namespace tandem::tools {

/// Millions a second; 0 where no time was measured.
inline double per_second_in_millions(double count, double milliseconds) {
  return milliseconds > 0.0 ? count / milliseconds / 1000.0 : 0.0;
}

}  // namespace tandem::tools
