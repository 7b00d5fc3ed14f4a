// SPDX-License-Identifier: MIT
//
// Functions that a table may stand for (program::Table): what a kernel's body means by sk_table_NAME(x). A texel of
// the table's texture has the polynomial of one interval, of which there are tableWidth to a row.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "sk/program.hpp"

namespace sk::assemble {

/// log2 of the texels of a row of a table's texture.
inline constexpr int tableShift = 10;
inline constexpr int tableWidth = 1 << tableShift;

/// Coefficients of an interval's polynomial, lowest first, in the distance from its lower end, which is 0 to 1: the
/// components of its texel.
constexpr int coefficientsOf(Interpolation interpolation) {
  return interpolation == Interpolation::Linear ? 2 : 4;
}

/// The sampler of a table, for the function of this name in the body.
std::string tableName(std::string_view function);
/// A vec3: the lower end of the range, intervals for each unit of the argument, and the number of intervals.
std::string rangeName(std::string_view function);

/// Definitions with the uniforms that they need, to stand before the body.
std::string tableDefinitions(std::span<const program::TableUse> uses, bool lookUp);

}  // namespace sk::assemble
