// SPDX-License-Identifier: MIT
//
// The table of texture formats.
#include "gl/format.hpp"

#include <array>

namespace sk::gl {

namespace {

constexpr Transfer wideFloat{GL_RGBA, GL_FLOAT, 4, 4};
constexpr Transfer wideInt{GL_RGBA_INTEGER, GL_INT, 4, 4};
constexpr Transfer wideUint{GL_RGBA_INTEGER, GL_UNSIGNED_INT, 4, 4};

// Four rows a scalar would have the row of width 3 twice: rowOfWidth skips it.
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
}};

constexpr std::size_t rowOfWidth[] = {0, 1, 2, 2};
constexpr std::size_t formatsPerScalar = 3;

}  // namespace

const Format& formatOf(program::Scalar scalar, int width) {
  return table[static_cast<std::size_t>(scalar) * formatsPerScalar + rowOfWidth[width - 1]];
}

const Format& formatOf(const program::Field& field) { return formatOf(field.scalar, field.width); }

std::span<const Format> formats() { return table; }

}  // namespace sk::gl
