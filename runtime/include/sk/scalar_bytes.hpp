// SPDX-License-Identifier: MIT
//
// The size of a component in host memory.
#pragma once

#include <cstddef>

#include "sk/program.hpp"

namespace sk::program {

constexpr std::size_t hostBytes(Scalar scalar) {
  switch (scalar) {
    case Scalar::Bool:
    case Scalar::Char:
    case Scalar::Uchar:
    case Scalar::Unorm8:
    case Scalar::Snorm8: return 1;
    case Scalar::Half:
    case Scalar::Short:
    case Scalar::Ushort:
    case Scalar::Unorm16:
    case Scalar::Snorm16: return 2;
    case Scalar::Int:
    case Scalar::Uint:
    case Scalar::Float: return 4;
    case Scalar::Double:
    case Scalar::Long:
    case Scalar::Ulong: break;
  }
  return 8;
}

/// Whether a component takes two words, and two channels of a texel.
constexpr bool is64Bit(Scalar scalar) { return hostBytes(scalar) == 8; }

}  // namespace sk::program
