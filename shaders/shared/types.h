// SPDX-License-Identifier: Apache-2.0
// The bridge that lets C++ and GLSL compile the same header: GLSL's names in namespace
// sward::shared. Structs that cross lie alike in C++, std140 and std430: a vec3 has a scalar after
// it that fills its 16 bytes, a vec2 lies at a multiple of 8, a struct is a multiple of 16 long.
// C++ asserts every size, tests/gl/programs_test.cpp every place.
#ifndef SWARD_SHARED_TYPES_H
#define SWARD_SHARED_TYPES_H

#ifdef __cplusplus
#include <cstdint>
#include <glm/glm.hpp>
#define SHARED_BEGIN namespace sward::shared {
#define SHARED_END }
#define SHARED_FN inline
#define SHARED_CONST constexpr
#define SHARED_OUT(type) type&
#define SHARED_INOUT(type) type&
namespace sward::shared {
using glm::ivec2;
using glm::ivec3;
using glm::ivec4;
using glm::mat4;
using glm::uvec2;
using glm::uvec4;
using glm::vec2;
using glm::vec3;
using glm::vec4;
using uint = std::uint32_t;
// GLSL built-ins that the pure functions use.
using glm::abs;
using glm::asin;
using glm::atan;
using glm::ceil;
using glm::clamp;
using glm::cos;
using glm::cross;
using glm::dot;
using glm::exp;
using glm::exp2;
using glm::floor;
using glm::fract;
using glm::inversesqrt;
using glm::length;
using glm::log;
using glm::max;
using glm::min;
using glm::mix;
using glm::normalize;
using glm::pow;
using glm::sin;
using glm::smoothstep;
using glm::sqrt;
} // namespace sward::shared
#else
#define SHARED_BEGIN
#define SHARED_END
#define SHARED_FN
#define SHARED_CONST const
#define SHARED_OUT(type) out type
#define SHARED_INOUT(type) inout type
#endif

SHARED_BEGIN
SHARED_CONST float kPi = 3.14159265358979f;
SHARED_END

#endif
