// SPDX-License-Identifier: MIT
//
// The host's side of the language's vector types, and the trait that tells the runtime how an
// element type lies in memory. Vectors are tightly packed plain structs: sk::float3 takes 12 bytes,
// sk::bool2 takes 2. No arithmetic is defined on them: that is what kernels are for.
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <type_traits>

#include "sk/program.hpp"

namespace sk {

template <class T>
struct Vector2 {
  T x, y;
  friend constexpr bool operator==(const Vector2&, const Vector2&) = default;
};

template <class T>
struct Vector3 {
  T x, y, z;
  friend constexpr bool operator==(const Vector3&, const Vector3&) = default;
};

template <class T>
struct Vector4 {
  T x, y, z, w;
  friend constexpr bool operator==(const Vector4&, const Vector4&) = default;
};

using bool2 = Vector2<bool>;
using bool3 = Vector3<bool>;
using bool4 = Vector4<bool>;
using int2 = Vector2<std::int32_t>;
using int3 = Vector3<std::int32_t>;
using int4 = Vector4<std::int32_t>;
using uint2 = Vector2<std::uint32_t>;
using uint3 = Vector3<std::uint32_t>;
using uint4 = Vector4<std::uint32_t>;
using float2 = Vector2<float>;
using float3 = Vector3<float>;
using float4 = Vector4<float>;

/// Registers T as an element type: `static ... const program::Element& element()` describes its
/// layout. Scalars and vectors are registered here. The header that `skc` writes registers a struct
/// of the .sk file like this, outside of any namespace:
///
///   template <>
///   struct sk::ElementTraits<Hit> {
///     static constexpr sk::program::Field fields[] = {
///         {"t", sk::program::Scalar::Float, 1, offsetof(Hit, t)},
///         {"id", sk::program::Scalar::Int, 1, offsetof(Hit, id)}};
///     static constexpr sk::program::Element value{"Hit", "Hit", sizeof(Hit), fields};
///     static constexpr const sk::program::Element& element() { return value; }
///   };
template <class T>
struct ElementTraits;

/// What a Stream can hold: a registered type that may be copied byte by byte.
template <class T>
concept ElementType = std::is_trivially_copyable_v<T> && requires {
  { ElementTraits<T>::element() } -> std::same_as<const program::Element&>;
};

namespace detail {

template <class T>
inline constexpr program::Scalar scalarOf = program::Scalar::Float;
template <>
inline constexpr program::Scalar scalarOf<bool> = program::Scalar::Bool;
template <>
inline constexpr program::Scalar scalarOf<std::int32_t> = program::Scalar::Int;
template <>
inline constexpr program::Scalar scalarOf<std::uint32_t> = program::Scalar::Uint;

/// Spellings by program::Scalar and width - 1: in a .sk file, and in GLSL.
inline constexpr std::string_view vectorNames[4][4] = {{"bool", "bool2", "bool3", "bool4"},
                                                       {"int", "int2", "int3", "int4"},
                                                       {"uint", "uint2", "uint3", "uint4"},
                                                       {"float", "float2", "float3", "float4"}};
inline constexpr std::string_view vectorGlslNames[4][4] = {{"bool", "bvec2", "bvec3", "bvec4"},
                                                           {"int", "ivec2", "ivec3", "ivec4"},
                                                           {"uint", "uvec2", "uvec3", "uvec4"},
                                                           {"float", "vec2", "vec3", "vec4"}};

/// The traits of a scalar (Width 1) or vector T of components of type C.
template <class T, class C, std::uint8_t Width>
struct VectorElement {
  static_assert(sizeof(T) == sizeof(C) * Width, "StreamKernel: vectors are tightly packed");
  static constexpr auto row = static_cast<std::size_t>(scalarOf<C>);
  static constexpr program::Field fields[1] = {{"", scalarOf<C>, Width, 0}};
  static constexpr program::Element value{vectorNames[row][Width - 1], vectorGlslNames[row][Width - 1],
                                          sizeof(T), fields};
  static constexpr const program::Element& element() { return value; }
};

}  // namespace detail

template <>
struct ElementTraits<bool> : detail::VectorElement<bool, bool, 1> {};
template <>
struct ElementTraits<std::int32_t> : detail::VectorElement<std::int32_t, std::int32_t, 1> {};
template <>
struct ElementTraits<std::uint32_t> : detail::VectorElement<std::uint32_t, std::uint32_t, 1> {};
template <>
struct ElementTraits<float> : detail::VectorElement<float, float, 1> {};
template <class C>
struct ElementTraits<Vector2<C>> : detail::VectorElement<Vector2<C>, C, 2> {};
template <class C>
struct ElementTraits<Vector3<C>> : detail::VectorElement<Vector3<C>, C, 3> {};
template <class C>
struct ElementTraits<Vector4<C>> : detail::VectorElement<Vector4<C>, C, 4> {};

}  // namespace sk
