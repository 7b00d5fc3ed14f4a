// SPDX-License-Identifier: MIT
//
// Host versions of the language's vector and matrix types, and the trait that describes an element type's
// layout to the runtime. Vectors are tightly packed structs: sk::float3 takes 12 bytes, sk::bool2 takes 2.
// Matrices are stored row by row. They have no arithmetic: kernels compute.
#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <type_traits>

#include "sk/narrow.hpp"
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

/// A square matrix of floats: `m[i]` is row i and `m[i][j]` is its element in column j, as in kernels.
template <class Row, std::size_t Size>
struct Matrix {
  Row rows[Size];
  constexpr Row& operator[](std::size_t i) { return rows[i]; }
  constexpr const Row& operator[](std::size_t i) const { return rows[i]; }
  friend constexpr bool operator==(const Matrix&, const Matrix&) = default;
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
using double2 = Vector2<double>;
using double3 = Vector3<double>;
using double4 = Vector4<double>;
using long2 = Vector2<std::int64_t>;
using long3 = Vector3<std::int64_t>;
using long4 = Vector4<std::int64_t>;
using ulong2 = Vector2<std::uint64_t>;
using ulong3 = Vector3<std::uint64_t>;
using ulong4 = Vector4<std::uint64_t>;
using half2 = Vector2<half>;
using half3 = Vector3<half>;
using half4 = Vector4<half>;
using char2 = Vector2<std::int8_t>;
using char3 = Vector3<std::int8_t>;
using char4 = Vector4<std::int8_t>;
using uchar2 = Vector2<std::uint8_t>;
using uchar3 = Vector3<std::uint8_t>;
using uchar4 = Vector4<std::uint8_t>;
using short2 = Vector2<std::int16_t>;
using short3 = Vector3<std::int16_t>;
using short4 = Vector4<std::int16_t>;
using ushort2 = Vector2<std::uint16_t>;
using ushort3 = Vector3<std::uint16_t>;
using ushort4 = Vector4<std::uint16_t>;
using unorm8x2 = Vector2<unorm8>;
using unorm8x3 = Vector3<unorm8>;
using unorm8x4 = Vector4<unorm8>;
using snorm8x2 = Vector2<snorm8>;
using snorm8x3 = Vector3<snorm8>;
using snorm8x4 = Vector4<snorm8>;
using unorm16x2 = Vector2<unorm16>;
using unorm16x3 = Vector3<unorm16>;
using unorm16x4 = Vector4<unorm16>;
using snorm16x2 = Vector2<snorm16>;
using snorm16x3 = Vector3<snorm16>;
using snorm16x4 = Vector4<snorm16>;
using float2x2 = Matrix<float2, 2>;
using float3x3 = Matrix<float3, 3>;
using float4x4 = Matrix<float4, 4>;

/// Registers T as an element type: `static ... const program::Element& element()` describes its layout. This
/// header registers scalars and vectors. The header that `skc` generates registers a struct of the .sk file
/// like this, outside of any namespace:
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

/// An element type of a Stream: registered and trivially copyable.
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
template <>
inline constexpr program::Scalar scalarOf<double> = program::Scalar::Double;
template <>
inline constexpr program::Scalar scalarOf<std::int64_t> = program::Scalar::Long;
template <>
inline constexpr program::Scalar scalarOf<std::uint64_t> = program::Scalar::Ulong;
template <>
inline constexpr program::Scalar scalarOf<half> = program::Scalar::Half;
template <>
inline constexpr program::Scalar scalarOf<std::int8_t> = program::Scalar::Char;
template <>
inline constexpr program::Scalar scalarOf<std::uint8_t> = program::Scalar::Uchar;
template <>
inline constexpr program::Scalar scalarOf<std::int16_t> = program::Scalar::Short;
template <>
inline constexpr program::Scalar scalarOf<std::uint16_t> = program::Scalar::Ushort;
template <>
inline constexpr program::Scalar scalarOf<unorm8> = program::Scalar::Unorm8;
template <>
inline constexpr program::Scalar scalarOf<snorm8> = program::Scalar::Snorm8;
template <>
inline constexpr program::Scalar scalarOf<unorm16> = program::Scalar::Unorm16;
template <>
inline constexpr program::Scalar scalarOf<snorm16> = program::Scalar::Snorm16;

/// The spellings of a component type, by width - 1, in .sk files and in GLSL.
struct Spellings {
  std::string_view names[4];
  const std::string_view* glsl;
};
inline constexpr std::string_view boolGlsl[] = {"bool", "bvec2", "bvec3", "bvec4"};
inline constexpr std::string_view intGlsl[] = {"int", "ivec2", "ivec3", "ivec4"};
inline constexpr std::string_view uintGlsl[] = {"uint", "uvec2", "uvec3", "uvec4"};
inline constexpr std::string_view floatGlsl[] = {"float", "vec2", "vec3", "vec4"};
inline constexpr std::string_view doubleGlsl[] = {"sk_double", "sk_double2", "sk_double3", "sk_double4"};

inline constexpr std::string_view longGlsl[] = {"sk_long", "sk_long2", "sk_long3", "sk_long4"};
inline constexpr std::string_view ulongGlsl[] = {"sk_ulong", "sk_ulong2", "sk_ulong3", "sk_ulong4"};

/// Indexed by program::Scalar.
inline constexpr Spellings spellings[] = {
    {{"bool", "bool2", "bool3", "bool4"}, boolGlsl},
    {{"int", "int2", "int3", "int4"}, intGlsl},
    {{"uint", "uint2", "uint3", "uint4"}, uintGlsl},
    {{"float", "float2", "float3", "float4"}, floatGlsl},
    {{"double", "double2", "double3", "double4"}, doubleGlsl},
    {{"long", "long2", "long3", "long4"}, longGlsl},
    {{"ulong", "ulong2", "ulong3", "ulong4"}, ulongGlsl},
    {{"half", "half2", "half3", "half4"}, floatGlsl},
    {{"char", "char2", "char3", "char4"}, intGlsl},
    {{"uchar", "uchar2", "uchar3", "uchar4"}, intGlsl},
    {{"short", "short2", "short3", "short4"}, intGlsl},
    {{"ushort", "ushort2", "ushort3", "ushort4"}, intGlsl},
    {{"unorm8", "unorm8x2", "unorm8x3", "unorm8x4"}, floatGlsl},
    {{"snorm8", "snorm8x2", "snorm8x3", "snorm8x4"}, floatGlsl},
    {{"unorm16", "unorm16x2", "unorm16x3", "unorm16x4"}, floatGlsl},
    {{"snorm16", "snorm16x2", "snorm16x3", "snorm16x4"}, floatGlsl},
};

/// The traits of a scalar (Width 1) or vector T with components of type C.
template <class T, class C, std::uint8_t Width>
struct VectorElement {
  static_assert(sizeof(T) == sizeof(C) * Width, "StreamKernel: vectors are tightly packed");
  static constexpr const Spellings& spelling = spellings[static_cast<std::size_t>(scalarOf<C>)];
  static constexpr program::Field fields[1] = {{"", scalarOf<C>, Width, 0}};
  static constexpr program::Element value{spelling.names[Width - 1], spelling.glsl[Width - 1], sizeof(T),
                                          fields};
  static constexpr const program::Element& element() { return value; }
};

/// Divides a value into `Count` consecutive fields.
template <std::size_t Count>
constexpr std::array<program::Field, Count> partsOf(program::Scalar scalar, std::size_t width,
                                                    std::size_t bytes) {
  std::array<program::Field, Count> parts{};
  for (std::size_t i = 0; i < Count; ++i) {
    parts[i] = {"", scalar, static_cast<std::uint8_t>(width), static_cast<std::uint32_t>(i * bytes),
                static_cast<std::int8_t>(i)};
  }
  return parts;
}

/// A vector of three or four components of 64 bits has one field for the first two and one for the rest.
template <class T, class C, std::uint8_t Width>
struct WideVectorElement {
  static_assert(sizeof(C) == 8 && sizeof(T) == sizeof(C) * Width, "StreamKernel: vectors are tightly packed");
  static constexpr const Spellings& spelling = spellings[static_cast<std::size_t>(scalarOf<C>)];
  static constexpr program::Field fields[2] = {{"", scalarOf<C>, 2, 0, 0},
                                               {"", scalarOf<C>, Width - 2, 16, 1}};
  static constexpr program::Element value{spelling.names[Width - 1], spelling.glsl[Width - 1], sizeof(T),
                                          fields};
  static constexpr const program::Element& element() { return value; }
};

inline constexpr std::string_view matrixNames[] = {"float2x2", "float3x3", "float4x4"};
inline constexpr std::string_view matrixGlsl[] = {"mat2", "mat3", "mat4"};

/// A matrix has a field for each row.
template <class T, std::uint8_t Size>
struct MatrixElement {
  static_assert(sizeof(T) == sizeof(float) * Size * Size, "StreamKernel: matrices are tightly packed");
  static constexpr auto fields = partsOf<Size>(program::Scalar::Float, Size, sizeof(float) * Size);
  static constexpr program::Element value{matrixNames[Size - 2], matrixGlsl[Size - 2], sizeof(T), fields};
  static constexpr const program::Element& element() { return value; }
};

}  // namespace detail

/// The traits of scalars.
template <class C>
  requires(detail::scalarOf<C> != program::Scalar::Float || std::is_same_v<C, float>)
struct ElementTraits<C> : detail::VectorElement<C, C, 1> {};
template <class C>
struct ElementTraits<Vector2<C>> : detail::VectorElement<Vector2<C>, C, 2> {};
template <class C>
struct ElementTraits<Vector3<C>> : detail::VectorElement<Vector3<C>, C, 3> {};
template <class C>
struct ElementTraits<Vector4<C>> : detail::VectorElement<Vector4<C>, C, 4> {};
template <class C>
  requires(sizeof(C) == 8)
struct ElementTraits<Vector3<C>> : detail::WideVectorElement<Vector3<C>, C, 3> {};
template <class C>
  requires(sizeof(C) == 8)
struct ElementTraits<Vector4<C>> : detail::WideVectorElement<Vector4<C>, C, 4> {};
template <>
struct ElementTraits<float2x2> : detail::MatrixElement<float2x2, 2> {};
template <>
struct ElementTraits<float3x3> : detail::MatrixElement<float3x3, 3> {};
template <>
struct ElementTraits<float4x4> : detail::MatrixElement<float4x4, 4> {};

}  // namespace sk
