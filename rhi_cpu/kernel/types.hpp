#pragma once

#include <array>
#include <cstdint>

#include <glm/mat2x2.hpp>
#include <glm/mat2x3.hpp>
#include <glm/mat2x4.hpp>
#include <glm/mat3x2.hpp>
#include <glm/mat3x3.hpp>
#include <glm/mat3x4.hpp>
#include <glm/mat4x2.hpp>
#include <glm/mat4x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

/// The value types of GLSL under their GLSL names. GLM supplies storage, component access and component-wise operators;
/// every function whose result could depend on the order of its operations is our own (kernel/vector_functions.hpp).
namespace tandem::kernel {

using uint = std::uint32_t;

using vec2 = glm::vec<2, float>;
using vec3 = glm::vec<3, float>;
using vec4 = glm::vec<4, float>;
using ivec2 = glm::vec<2, std::int32_t>;
using ivec3 = glm::vec<3, std::int32_t>;
using ivec4 = glm::vec<4, std::int32_t>;
using uvec2 = glm::vec<2, std::uint32_t>;
using uvec3 = glm::vec<3, std::uint32_t>;
using uvec4 = glm::vec<4, std::uint32_t>;
using bvec2 = glm::vec<2, bool>;
using bvec3 = glm::vec<3, bool>;
using bvec4 = glm::vec<4, bool>;
using dvec2 = glm::vec<2, double>;
using dvec3 = glm::vec<3, double>;
using dvec4 = glm::vec<4, double>;

/// matCxR has C columns of R components, as in GLSL.
using mat2 = glm::mat<2, 2, float>;
using mat3 = glm::mat<3, 3, float>;
using mat4 = glm::mat<4, 4, float>;
using mat2x2 = glm::mat<2, 2, float>;
using mat2x3 = glm::mat<2, 3, float>;
using mat2x4 = glm::mat<2, 4, float>;
using mat3x2 = glm::mat<3, 2, float>;
using mat3x3 = glm::mat<3, 3, float>;
using mat3x4 = glm::mat<3, 4, float>;
using mat4x2 = glm::mat<4, 2, float>;
using mat4x3 = glm::mat<4, 3, float>;
using mat4x4 = glm::mat<4, 4, float>;

/// Vectors of components without a GLSL name of their own here, such as those of 8, 16 and 64 bits.
template <int length, typename T>
using vector = glm::vec<length, T>;
template <int columns, int rows, typename T>
using matrix = glm::mat<columns, rows, T>;

/// An array is a value, as in GLSL.
template <typename T, std::size_t size>
using Array = std::array<T, size>;

// GLM's aligned or SIMD types would change what a load of 12 bytes means.
static_assert(sizeof(vec2) == 8 && sizeof(vec3) == 12 && sizeof(vec4) == 16 && alignof(vec4) == alignof(float));
static_assert(sizeof(bvec3) == 3 && sizeof(mat4x3) == 48 && sizeof(mat3) == 36);

}  // namespace tandem::kernel
