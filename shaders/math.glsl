// Arithmetic that gives the same bits on every device: only + - * / sqrt floor and integer operations, in a written
// order, never contracted (every function is `precise`), never a built-in transcendental, dot, cross or normalize.
// Polynomials are minimax fits (Remez) with coefficients rounded to float. Error bounds are in units in the last place
// (ULP) of the exact result and hold over the stated domain; tests/shaders asserts them. The transcendental functions
// return neither a NaN nor an infinity, for any argument, nor a subnormal number, which a device may flush to zero: they
// return 0 instead.

#ifndef TANDEM_MATH
#define TANDEM_MATH

const float PI = 3.14159274;
const float INV_PI = 0.318309886;
const float HALF_PI = 1.57079637;
const float HALF_PI_LOW = -4.37113883e-08;  // HALF_PI + HALF_PI_LOW is pi / 2 to 48 bits
const float QUARTER_PI = 0.785398185;
const float INV_LN2 = 1.44269502;
const float INV_LN2_LOW = 1.92596303e-08;
const float LN2 = 0.693147182;
const float LN2_HIGH = 0.693145752;  // 15 bits: exact when multiplied by an exponent
const float LN2_LOW = 1.42860677e-06;
const float SMALLEST_NORMAL = 1.17549435e-38;
const float LARGEST_FLOAT = 3.40282347e+38;

/// What a * b lost to rounding: a * b == product + product_error exactly (Dekker 1971), for magnitudes in [2^-100,
/// 2^100].
precise float product_error(float a, float b, float product) {
  float scaled_a = 4097.0 * a;
  float a_high = scaled_a - (scaled_a - a);
  float a_low = a - a_high;
  float scaled_b = 4097.0 * b;
  float b_high = scaled_b - (scaled_b - b);
  float b_low = b - b_high;
  return ((a_high * b_high - product) + a_high * b_low + a_low * b_high) + a_low * b_low;
}

/// a / b, b not 0. Vulkan allows a device 2.5 ULP; with TANDEM_EXACT_DIVISION defined the quotient is corrected by its
/// exact remainder (Markstein 1990) and is correctly rounded whenever a, b and the quotient lie within [2^-100, 2^100].
precise float det_div(float a, float b) {
  float quotient = a / b;
#ifdef TANDEM_EXACT_DIVISION
  float magnitude = abs(quotient);
  if (magnitude > 1e-30 && magnitude < 1e30 && abs(b) > 1e-30 && abs(b) < 1e30) {
    float product = quotient * b;
    quotient += ((a - product) - product_error(quotient, b, product)) / b;
  }
#endif
  return quotient;
}

/// The square root of x >= 0. Exact in the same sense and by the same means as det_div.
precise float det_sqrt(float x) {
  float root = sqrt(x);
#ifdef TANDEM_EXACT_DIVISION
  if (x > 1e-30 && x < 1e30) {
    float product = root * root;
    root += ((x - product) - product_error(root, root, product)) / (2.0 * root);
  }
#endif
  return root;
}

/// x in [0, 1]; NaN gives 0.
float clamp_unit(float x) { return x > 0.0 ? (x < 1.0 ? x : 1.0) : 0.0; }

precise float det_dot(vec3 a, vec3 b) { return (a.x * b.x + a.y * b.y) + a.z * b.z; }

precise vec3 det_cross(vec3 a, vec3 b) {
  return vec3(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}

precise float det_length(vec3 v) { return det_sqrt(det_dot(v, v)); }

/// The largest of |x|, |y|, |z|; a NaN component counts as 0 unless it is z.
float max_magnitude(vec3 v) {
  vec3 a = abs(v);
  float largest = a.x > a.y ? a.x : a.y;
  return largest > a.z ? largest : a.z;
}

float max_component(vec3 v) {
  float largest = v.x > v.y ? v.x : v.y;
  return largest > v.z ? largest : v.z;
}

// Below this what a path carries can no longer change a sum, but might become subnormal.
const float NEGLIGIBLE = 1e-30;

/// v, its components 0 where they are negligible, or NaN.
vec3 drop_negligible(vec3 v) {
  return vec3(v.x >= NEGLIGIBLE ? v.x : 0.0, v.y >= NEGLIGIBLE ? v.y : 0.0, v.z >= NEGLIGIBLE ? v.z : 0.0);
}

/// v at length 1 within 2 ULP, `fallback` when v has no direction: zero (or so small that a device may flush it),
/// infinite or NaN.
precise vec3 det_normalize(vec3 v, vec3 fallback) {
  precise float squared = det_dot(v, v);
  vec3 scaled = v;
  if (!(squared > 1e-30 && squared < 1e30)) {
    // The square left the range in which it is exact enough: bring the largest component to 1 first.
    float magnitude = max_magnitude(v);
    if (!(magnitude > 1e-35 && magnitude < 1e35)) return fallback;
    scaled = vec3(det_div(v.x, magnitude), det_div(v.y, magnitude), det_div(v.z, magnitude));
    squared = det_dot(scaled, scaled);
    if (!(squared > 0.5)) return fallback;
  }
  return scaled * det_div(1.0, det_sqrt(squared));
}

/// The direction in which a mirror with unit normal `normal` sends light that travels along `incident`.
precise vec3 det_reflect(vec3 incident, vec3 normal) {
  return incident - normal * (2.0 * det_dot(normal, incident));
}

/// sin(x) for |x| <= pi / 4, 1 ULP.
precise float sin_kernel(float x) {
  float z = x * x;
  return x + x * z * (-0.166666552 + z * (0.00833217613 + z * -0.000195169778));
}

/// cos(x) for |x| <= pi / 4, 1 ULP.
precise float cos_kernel(float x) {
  float z = x * x;
  float half_square = 0.5 * z;
  float leading = 1.0 - half_square;
  float lost = (1.0 - leading) - half_square;
  return leading + (lost + z * z * (0.0416666456 + z * (-0.00138873642 + z * 2.44380917e-05)));
}

/// x minus the nearest multiple of pi / 2 (Cody and Waite 1980), and that multiple modulo 4. The parts of pi / 2 have
/// 11 bits, so that their products with a multiple below 2^13 are exact.
precise float reduce_quarter_turns(float x, out uint quarter) {
  precise float multiple = floor(x * 0.636619747 + 0.5);
  quarter = uint(int(multiple)) & 3u;
  float reduced = (x - multiple * 1.5703125) - multiple * 0.000483751297;
  return (reduced - multiple * 7.54953362e-08) - multiple * 2.56334407e-12;
}

/// (sin(x), cos(x)), each within 2.5 ULP, for |x| <= 8192; (0, 1) beyond and for NaN.
precise vec2 det_sincos(float x) {
  if (!(abs(x) <= 8192.0)) return vec2(0.0, 1.0);
  uint quarter;
  float reduced = reduce_quarter_turns(x, quarter);
  float sine = sin_kernel(reduced);
  float cosine = cos_kernel(reduced);
  vec2 turned = (quarter & 1u) == 0u ? vec2(sine, cosine) : vec2(cosine, -sine);
  return (quarter & 2u) == 0u ? turned : -turned;
}

/// 2.5 ULP for |x| <= 8192, 0 beyond.
precise float det_sin(float x) { return det_sincos(x).x; }

/// 2.5 ULP for |x| <= 8192, 1 beyond.
precise float det_cos(float x) { return det_sincos(x).y; }

/// exp(x) * 2^exponent for |x| <= 0.35 and exponent in [-126, 128].
precise float scaled_exp(float x, int exponent) {
  float tail = 0.5 + x * (0.166665182 + x * (0.041666206 + x * (0.00836890843 + x * 0.00139505242)));
  float power = 1.0 + (x + x * x * tail);
  // In two steps, since 2^128 alone is not a float.
  int half_exponent = exponent >> 1;
  float first = uintBitsToFloat(uint(half_exponent + 127) << 23);
  float second = uintBitsToFloat(uint(exponent - half_exponent + 127) << 23);
  float result = power * first * second;
  return result >= SMALLEST_NORMAL ? result : 0.0;
}

/// e^x, 1.5 ULP. Saturates: 0 below -87.33654 (and for NaN), 3.4e38 from 88.72283 on.
precise float det_exp(float x) {
  if (!(x >= -87.33654)) return 0.0;
  float clamped = x < 88.72283 ? x : 88.72283;
  precise float multiple = floor(clamped * INV_LN2 + 0.5);
  float reduced = (clamped - multiple * LN2_HIGH) - multiple * LN2_LOW;
  return scaled_exp(reduced, int(multiple));
}

/// x = mantissa * 2^exponent with the mantissa in [0.707, 1.415), for a normal x > 0.
float split_exponent(float x, out int exponent) {
  uint bits = floatBitsToUint(x) - 0x3f3504f3u;  // the bits of sqrt(1/2)
  exponent = int(bits) >> 23;
  return uintBitsToFloat((bits & 0x007fffffu) + 0x3f3504f3u);
}

/// The natural logarithm, 1 ULP. x is clamped to the positive normal numbers: 0, negative numbers and NaN give
/// -87.33654.
precise float det_log(float x) {
  float clamped = x >= SMALLEST_NORMAL ? (x <= LARGEST_FLOAT ? x : LARGEST_FLOAT) : SMALLEST_NORMAL;
  int exponent;
  float f = split_exponent(clamped, exponent) - 1.0;
  // log(1 + f) = 2 s + s R(s^2) with s = f / (2 + f), and 2 s = f - f^2 / 2 + s f^2 / 2.
  float s = det_div(f, 2.0 + f);
  float z = s * s;
  float r = z * (0.666667759 + z * (0.399775058 + z * 0.298727661));
  float half_square = 0.5 * f * f;
  float k = float(exponent);
  return k * LN2_HIGH - ((half_square - (s * (half_square + r) + k * LN2_LOW)) - f);
}

/// x^y for x >= 0, 2 ULP. x^0 and 1^y are 1; x below the normal numbers, or negative, or NaN, counts as 0; results
/// beyond the float range are 0 or 3.4e38.
precise float det_pow(float x, float y) {
  if (y == 0.0 || x == 1.0) return 1.0;
  if (!(x >= SMALLEST_NORMAL)) return y > 0.0 ? 0.0 : LARGEST_FLOAT;
  int exponent;
  precise float mantissa = split_exponent(x <= LARGEST_FLOAT ? x : LARGEST_FLOAT, exponent);
  // log(mantissa) = 2 s + s R(s^2), s = (mantissa - 1) / (mantissa + 1), carried to twice the precision of a float.
  float numerator = mantissa - 1.0;
  float denominator = mantissa + 1.0;
  float denominator_low = mantissa - (denominator - 1.0);
  float s = det_div(numerator, denominator);
  float product = s * denominator;
  float remainder = ((numerator - product) - product_error(s, denominator, product)) - s * denominator_low;
  float s_low = det_div(remainder, denominator);
  float z = s * s;
  float r = z * (0.666666627 + z * (0.400003374 + z * (0.285372555 + z * 0.235832468)));
  float tail = 2.0 * s_low + s * r;
  float log_high = 2.0 * s + tail;
  float log_low = tail - (log_high - 2.0 * s);
  // log2(x) = exponent + log(mantissa) / ln 2.
  float log2_high = log_high * INV_LN2;
  float log2_low = product_error(log_high, INV_LN2, log2_high) + (log_high * INV_LN2_LOW + log_low * INV_LN2);
  float k = float(exponent);
  precise float log2_x = k + log2_high;
  precise float log2_x_low = (log2_high - (log2_x - k)) + log2_low;
  precise float power = y * log2_x;
  if (!(power < 128.0)) return LARGEST_FLOAT;
  if (power < -126.0) return 0.0;
  float power_low = product_error(y, log2_x, power) + y * log2_x_low;
  precise float multiple = floor(power + 0.5);
  return scaled_exp(((power - multiple) + power_low) * LN2, int(multiple));
}

/// asin(x) for |x| <= 0.5, 1 ULP.
precise float asin_kernel(float x) {
  float z = x * x;
  return x + x * z * (0.166667536 + z * (0.0749523267 + z * (0.045478344 + z * (0.0241409857 + z * 0.0422305539))));
}

/// The angle in [0, pi] whose cosine is x, 1.5 ULP. x is clamped to [-1, 1]; NaN gives pi.
precise float det_acos(float x) {
  if (abs(x) <= 0.5) return HALF_PI - (asin_kernel(x) - HALF_PI_LOW);
  if (x >= 1.0) return 0.0;
  if (!(x > -1.0)) return PI;
  // acos(x) = 2 asin(sqrt((1 - x) / 2)), in which 1 - |x| is exact.
  float half_angle = asin_kernel(det_sqrt(0.5 - 0.5 * abs(x)));
  return x > 0.0 ? 2.0 * half_angle : 2.0 * (HALF_PI - (half_angle - HALF_PI_LOW));
}

/// atan(x) for x in [0, 1].
precise float atan_unit(float x) {
  bool far = x > 0.414213568;  // tan(pi / 8)
  float t = far ? det_div(x - 1.0, x + 1.0) : x;
  float z = t * t;
  float tail = -0.333333164 + z * (0.199984878 + z * (-0.142438248 + z * (0.105958156 + z * -0.0608295649)));
  float angle = t + t * z * tail;
  return far ? QUARTER_PI + (angle + 0.5 * HALF_PI_LOW) : angle;
}

/// The angle in [-pi / 2, pi / 2] whose tangent is x, 2.5 ULP; NaN gives 0.
precise float det_atan(float x) {
  float magnitude = abs(x);
  if (!(magnitude >= SMALLEST_NORMAL)) return 0.0;
  float angle = magnitude > 1.0 ? HALF_PI - (atan_unit(det_div(1.0, magnitude)) - HALF_PI_LOW) : atan_unit(magnitude);
  return x < 0.0 ? -angle : angle;
}

/// The angle in [-pi, pi] of the point (x, y), counter-clockwise from the x axis, 3 ULP for magnitudes up to 1e38; 0 where
/// there is none: at the origin, and for infinity and NaN.
precise float det_atan2(float y, float x) {
  float width = abs(x);
  float height = abs(y);
  bool steep = height > width;
  float larger = steep ? height : width;
  if (!(larger >= SMALLEST_NORMAL && larger <= 1e38)) return 0.0;
  float ratio = det_div(steep ? width : height, larger);
  if (!(ratio >= SMALLEST_NORMAL)) ratio = 0.0;
  float angle = atan_unit(ratio);
  if (steep) angle = HALF_PI - (angle - HALF_PI_LOW);
  if (x < 0.0) angle = PI - (angle - 2.0 * HALF_PI_LOW);
  return y < 0.0 ? -angle : angle;
}

#endif
