// SPDX-License-Identifier: MIT
//
// The table of texture formats.
#include "gl/format.hpp"

#include <array>

#include "sk/scalar_bytes.hpp"

namespace sk::gl {

namespace {

constexpr Transfer wideFloat{GL_RGBA, GL_FLOAT, 4, 4};
constexpr Transfer wideInt{GL_RGBA_INTEGER, GL_INT, 4, 4};
constexpr Transfer wideUint{GL_RGBA_INTEGER, GL_UNSIGNED_INT, 4, 4};
constexpr Transfer bytes{GL_RGBA, GL_UNSIGNED_BYTE, 4, 1};

// Each family has three rows: for 1, 2 and 4 components.
constexpr std::array<Format, formatCount> table{{
    {GL_R8UI, "R8UI", {GL_RED_INTEGER, GL_UNSIGNED_BYTE, 1, 1}, wideUint, 0},
    {GL_RG8UI, "RG8UI", {GL_RG_INTEGER, GL_UNSIGNED_BYTE, 2, 1}, wideUint, 1},
    {GL_RGBA8UI, "RGBA8UI", {GL_RGBA_INTEGER, GL_UNSIGNED_BYTE, 4, 1}, wideUint, 2},
    {GL_R32I, "R32I", {GL_RED_INTEGER, GL_INT, 1, 4}, wideInt, 3},
    {GL_RG32I, "RG32I", {GL_RG_INTEGER, GL_INT, 2, 4}, wideInt, 4},
    {GL_RGBA32I, "RGBA32I", wideInt, wideInt, 5},
    {GL_R32UI, "R32UI", {GL_RED_INTEGER, GL_UNSIGNED_INT, 1, 4}, wideUint, 6},
    {GL_RG32UI, "RG32UI", {GL_RG_INTEGER, GL_UNSIGNED_INT, 2, 4}, wideUint, 7},
    {GL_RGBA32UI, "RGBA32UI", wideUint, wideUint, 8},
    {GL_R32F, "R32F", {GL_RED, GL_FLOAT, 1, 4}, wideFloat, 9},
    {GL_RG32F, "RG32F", {GL_RG, GL_FLOAT, 2, 4}, wideFloat, 10},
    {GL_RGBA32F, "RGBA32F", wideFloat, wideFloat, 11},
    {GL_R16F, "R16F", {GL_RED, GL_HALF_FLOAT, 1, 2}, wideFloat, 12},
    {GL_RG16F, "RG16F", {GL_RG, GL_HALF_FLOAT, 2, 2}, wideFloat, 13},
    {GL_RGBA16F, "RGBA16F", {GL_RGBA, GL_HALF_FLOAT, 4, 2}, wideFloat, 14},
    {GL_R8I, "R8I", {GL_RED_INTEGER, GL_BYTE, 1, 1}, wideInt, 15},
    {GL_RG8I, "RG8I", {GL_RG_INTEGER, GL_BYTE, 2, 1}, wideInt, 16},
    {GL_RGBA8I, "RGBA8I", {GL_RGBA_INTEGER, GL_BYTE, 4, 1}, wideInt, 17},
    {GL_R16I, "R16I", {GL_RED_INTEGER, GL_SHORT, 1, 2}, wideInt, 18},
    {GL_RG16I, "RG16I", {GL_RG_INTEGER, GL_SHORT, 2, 2}, wideInt, 19},
    {GL_RGBA16I, "RGBA16I", {GL_RGBA_INTEGER, GL_SHORT, 4, 2}, wideInt, 20},
    {GL_R16UI, "R16UI", {GL_RED_INTEGER, GL_UNSIGNED_SHORT, 1, 2}, wideUint, 21},
    {GL_RG16UI, "RG16UI", {GL_RG_INTEGER, GL_UNSIGNED_SHORT, 2, 2}, wideUint, 22},
    {GL_RGBA16UI, "RGBA16UI", {GL_RGBA_INTEGER, GL_UNSIGNED_SHORT, 4, 2}, wideUint, 23},
    {GL_R8, "R8", {GL_RED, GL_UNSIGNED_BYTE, 1, 1}, bytes, 24},
    {GL_RG8, "RG8", {GL_RG, GL_UNSIGNED_BYTE, 2, 1}, bytes, 25},
    {GL_RGBA8, "RGBA8", bytes, bytes, 26},
}};

constexpr std::size_t rowOfWidth[] = {0, 1, 2, 2};
constexpr std::size_t formatsPerFamily = 3;

/// The only normalized formats that ES can render to are unsigned ones of 8 bits; the others are stored as
/// integers.
std::size_t familyOf(program::Scalar scalar) {
  switch (scalar) {
    case program::Scalar::Bool:
    case program::Scalar::Uchar: return 0;
    case program::Scalar::Int: return 1;
    case program::Scalar::Uint:
    case program::Scalar::Double:
    case program::Scalar::Long:
    case program::Scalar::Ulong: return 2;
    case program::Scalar::Float: return 3;
    case program::Scalar::Half: return 4;
    case program::Scalar::Char:
    case program::Scalar::Snorm8: return 5;
    case program::Scalar::Short:
    case program::Scalar::Snorm16: return 6;
    case program::Scalar::Ushort:
    case program::Scalar::Unorm16: return 7;
    case program::Scalar::Unorm8: break;
  }
  return 8;
}

}  // namespace

const Format& formatOf(program::Scalar scalar, int width) {
  const int channels = program::is64Bit(scalar) ? 2 * width : width;
  return table[familyOf(scalar) * formatsPerFamily + rowOfWidth[channels - 1]];
}

const Format& formatOf(const program::Field& field) { return formatOf(field.scalar, field.width); }

std::size_t hostBytes(const program::Field& field) { return field.width * program::hostBytes(field.scalar); }

std::span<const Format> formats() { return table; }

}  // namespace sk::gl
