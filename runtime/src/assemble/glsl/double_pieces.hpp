// SPDX-License-Identifier: MIT
//
// The building blocks of the functions in double_intrinsics.hpp, with their dependencies.
#pragma once

#include <cstdint>
#include <string>

#include "assemble/assemble.hpp"

namespace sk::assemble {

/// In order of definition: each needs only earlier ones.
enum class Piece : std::uint8_t {
  ExpTail,
  ExpReduced,
  LogTail,
  Log,
  LogPlus,
  Power,
  ReduceLarge,
  Wave,
  Angle,
};
using Pieces = std::uint32_t;
template <class... P>
constexpr Pieces pieces(P... all) {
  return (Pieces{0} | ... | (Pieces{1} << static_cast<unsigned>(all)));
}

/// The pieces of a set and their dependencies, after the few functions that use bits, which are always
/// included.
std::string doublePieces(Pieces set, Doubles form, Barrier barrier);

}  // namespace sk::assemble
