// Images: exact fetches of texels, decoded by integer operations and filtered here, so that every device agrees. A
// texel is decoded to linear values before it is filtered.

#ifndef TANDEM_TEXTURE_IMAGE
#define TANDEM_TEXTURE_IMAGE

#include "math.glsl"
#include "scene.glsl"

/// The float that a half float is, which must be finite.
precise float half_float(uint bits) {
  uint magnitude = bits & 0x7fffu;
  // Below 2^-14 a half float has no leading bit: it is a multiple of 2^-24.
  float value = magnitude < 0x400u ? float(magnitude) * 5.96046448e-08 : uintBitsToFloat((magnitude << 13) + 0x38000000u);
  return (bits & 0x8000u) != 0 ? -value : value;
}

/// One of 256 steps from 0 to 1.
precise float unorm8(uint bits) { return float(bits & 0xffu) * 0.00392156886; }

/// One of 65536 steps from 0 to 1, within an ULP.
precise float unorm16(uint bits) { return float(bits & 0xffffu) * 1.52590219e-05; }

/// What the table at the beginning of texels says.
float srgb8(uint bits) { return uintBitsToFloat(texels[bits & 0xffu]); }

/// Linear r, g, b and alpha of a texel; row 0 is the upper one.
precise vec4 texel_at(uint texture_index, uint column, uint row) {
  uint format = textures[texture_index].format;
  uint first = textures[texture_index].first_word;
  uint texel = row * textures[texture_index].width + column;
  if (format == TEXEL_SINGLE_UNORM8) {
    texel += first;
    return vec4(unorm8(texels[texel >> 2] >> (8 * (texel & 3u))));
  }
  if (format <= TEXEL_SRGB8) {
    uint word = texels[first + texel];
    float alpha = unorm8(word >> 24);
    if (format == TEXEL_SRGB8) return vec4(srgb8(word), srgb8(word >> 8), srgb8(word >> 16), alpha);
    return vec4(unorm8(word), unorm8(word >> 8), unorm8(word >> 16), alpha);
  }
  if (format == TEXEL_FLOAT) {
    uint word = first + 4 * texel;
    return vec4(uintBitsToFloat(texels[word]), uintBitsToFloat(texels[word + 1]), uintBitsToFloat(texels[word + 2]),
                uintBitsToFloat(texels[word + 3]));
  }
  uint low = texels[first + 2 * texel];
  uint high = texels[first + 2 * texel + 1];
  if (format == TEXEL_HALF) return vec4(half_float(low), half_float(low >> 16), half_float(high), half_float(high >> 16));
  return vec4(unorm16(low), unorm16(low >> 16), unorm16(high), unorm16(high >> 16));
}

/// The coordinate in [0, 1] whose texel a coordinate means.
precise float addressed(float coordinate, uint address) {
  if (address == ADDRESS_CLAMP) return clamp_unit(coordinate);
  if (address == ADDRESS_REPEAT) return clamp_unit(coordinate - floor(coordinate));
  float half_coordinate = 0.5 * coordinate;
  float folded = 2.0 * clamp_unit(half_coordinate - floor(half_coordinate));
  return folded > 1.0 ? 2.0 - folded : folded;
}

/// Two neighbouring texels out of `count` along an axis, and the weight of the second.
struct Taps {
  uint first;
  uint second;
  float weight;
};

precise Taps image_taps(float coordinate, uint count, uint address, uint filter_mode) {
  Taps taps;
  taps.weight = 0.0;
  precise float place = addressed(coordinate, address) * float(count);
  if (filter_mode == FILTER_NEAREST) {
    uint texel = uint(place);
    taps.first = texel < count ? texel : count - 1;
    taps.second = taps.first;
    return taps;
  }
  precise float centred = place - 0.5;
  precise float whole = floor(centred);
  int texel = int(whole);
  int last = int(count) - 1;
  bool repeats = address == ADDRESS_REPEAT;
  taps.first = uint(texel >= 0 ? texel : (repeats ? last : 0));
  taps.second = uint(texel < last ? texel + 1 : (repeats ? 0 : last));
  taps.weight = centred - whole;
  return taps;
}

/// Of an image at its own coordinates; t = 0 is its lower edge.
precise vec4 image_at(uint texture_index, vec2 st) {
  uint address = textures[texture_index].address;
  uint filter_mode = textures[texture_index].filter_mode;
  uint height = textures[texture_index].height;
  Taps columns = image_taps(st.x, textures[texture_index].width, address & 0xffu, filter_mode);
  Taps rows = image_taps(st.y, height, address >> 8, filter_mode);
  // A loop, so that the code of a fetch is there twice and not four times.
  vec4 value = vec4(0.0);
  uint row_count = filter_mode == FILTER_NEAREST ? 1 : 2;
  for (uint i = 0; i < row_count; ++i) {
    uint row = height - 1 - (i == 0 ? rows.first : rows.second);
    vec4 left = texel_at(texture_index, columns.first, row);
    vec4 right = texel_at(texture_index, columns.second, row);
    // Equal texels give their own value, to the last bit.
    vec4 between = left + (right - left) * columns.weight;
    value = i == 0 ? between : value + (between - value) * rows.weight;
  }
  return value;
}

#endif
