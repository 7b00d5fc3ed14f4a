// SPDX-License-Identifier: MIT
//
// The C++ type of a component of an element in host memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>

#include "sk/narrow.hpp"
#include "sk/program.hpp"

namespace sk {

/// Calls use(T()), where T is the type of the component, and returns what it returns.
template <class Use>
auto withScalarType(program::Scalar scalar, Use&& use) {
  using program::Scalar;
  switch (scalar) {
    case Scalar::Float: return use(float());
    case Scalar::Double: return use(double());
    case Scalar::Half: return use(half());
    case Scalar::Unorm8: return use(unorm8());
    case Scalar::Snorm8: return use(snorm8());
    case Scalar::Unorm16: return use(unorm16());
    case Scalar::Snorm16: return use(snorm16());
    case Scalar::Int: return use(std::int32_t());
    case Scalar::Uint: return use(std::uint32_t());
    case Scalar::Long: return use(std::int64_t());
    case Scalar::Ulong: return use(std::uint64_t());
    case Scalar::Char: return use(std::int8_t());
    case Scalar::Uchar: return use(std::uint8_t());
    case Scalar::Short: return use(std::int16_t());
    case Scalar::Ushort: return use(std::uint16_t());
    case Scalar::Bool: break;
  }
  return use(bool());
}

/// A component with this address, which need not be aligned.
template <class T>
T componentAt(const std::byte* place) {
  T value;
  std::memcpy(&value, place, sizeof value);
  return value;
}

/// As a double; integers beyond 2^53 are rounded.
inline double numberAt(const std::byte* place, program::Scalar scalar) {
  return withScalarType(scalar, [&]<class T>(T) {
    if constexpr (std::is_arithmetic_v<T>) {
      return static_cast<double>(componentAt<T>(place));
    } else {
      return static_cast<double>(static_cast<float>(componentAt<T>(place)));
    }
  });
}

}  // namespace sk
