// SPDX-License-Identifier: MIT
//
// Functions that tables may replace (program::Table): the meaning of sk_table_NAME(x) in a kernel's body.
// Each texel of the table's texture holds the polynomial of one interval; a row has tableWidth intervals.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "sk/program.hpp"

namespace sk::assemble {

/// log2 of the texels in a row of a table's texture.
inline constexpr int tableShift = 10;
inline constexpr int tableWidth = 1 << tableShift;

/// The number of coefficients of an interval's polynomial in the distance from its lower end, from 0 to 1.
/// They are the components of its texel, lowest first.
constexpr int coefficientsOf(Interpolation interpolation) {
  return interpolation == Interpolation::Linear ? 2 : 4;
}

/// The name of the sampler of a function's table.
std::string tableName(std::string_view function);
/// The name of a vec3: the lower end of the range, intervals per unit of the argument, and the number of
/// intervals.
std::string rangeName(std::string_view function);

/// Definitions and uniforms, which precede the body.
std::string tableDefinitions(std::span<const program::TableUse> uses, bool lookUp);

}  // namespace sk::assemble
