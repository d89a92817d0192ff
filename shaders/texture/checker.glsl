// A board of squares in two colours.

#ifndef TANDEM_TEXTURE_CHECKER
#define TANDEM_TEXTURE_CHECKER

#include "math.glsl"

/// Whether a point lies in a square of the second colour. Squares have side 1; the first colour's is at (0, 0) to
/// (1, 1).
bool is_second_square(vec2 point) {
  precise float sum = floor(point.x) + floor(point.y);
  precise float pairs = 0.5 * sum;
  return pairs != floor(pairs);
}

#endif
