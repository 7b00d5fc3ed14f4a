// SPDX-License-Identifier: MIT
//
// What the functions of double_intrinsics.hpp are made of, each with what it needs.
#pragma once

#include <cstdint>
#include <string>

#include "assemble/assemble.hpp"

namespace sk::assemble {

/// In the order of their definitions: each needs only earlier ones.
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

/// The pieces of a set, and all that they need, behind the few functions that look at bits, which are always there.
std::string doublePieces(Pieces set, Doubles form, Barrier barrier);

}  // namespace sk::assemble
