// SPDX-License-Identifier: MIT
#include "call/test_values.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

#include "sk/scalar_bytes.hpp"

namespace sk {

namespace {

using program::Element;
using program::Field;
using program::ScatterOp;

using TestValues = std::array<double, testValueCount>;
constexpr TestValues floatValues{0, 3.25, -7.5, 1e9, -1e9};
constexpr TestValues halfValues{0, 3.25, -7.5, 30000, -30000};
constexpr TestValues intValues{0, 1, -2, 10000, -10000};
constexpr TestValues uintValues{0, 1, 3, 10000, 20000};
constexpr TestValues charValues{0, 1, -2, 100, -100};
constexpr TestValues ucharValues{0, 1, 3, 100, 200};
constexpr TestValues boolValues{0, 1, 0, 1, 1};
constexpr std::array<std::uint16_t, testValueCount> halfBits{0x0000, 0x4280, 0xC780, 0x7753, 0xF753};

template <class T>
void put(double value, std::byte* to) {
  const T number = static_cast<T>(value);
  std::memcpy(to, &number, sizeof number);
}

/// The bytes of a scalar in host memory; those of the small types are integers.
void putScalar(program::Scalar scalar, Storage storage, int number, std::byte* to) {
  const auto i = static_cast<std::size_t>(number);
  switch (scalar) {
    case program::Scalar::Bool: return put<std::uint8_t>(boolValues[i], to);
    case program::Scalar::Int: return put<std::int32_t>(intValues[i], to);
    case program::Scalar::Uint: return put<std::uint32_t>(uintValues[i], to);
    case program::Scalar::Long: return put<std::int64_t>(intValues[i], to);
    case program::Scalar::Ulong: return put<std::uint64_t>(uintValues[i], to);
    case program::Scalar::Float:
      return put<float>((storage == Storage::Half ? halfValues : floatValues)[i], to);
    case program::Scalar::Double: return put<double>(floatValues[i], to);
    case program::Scalar::Half: std::memcpy(to, &halfBits[i], sizeof halfBits[i]); return;
    case program::Scalar::Char:
    case program::Scalar::Snorm8: return put<std::int8_t>(charValues[i], to);
    case program::Scalar::Uchar:
    case program::Scalar::Unorm8: return put<std::uint8_t>(ucharValues[i], to);
    case program::Scalar::Short:
    case program::Scalar::Snorm16: return put<std::int16_t>(intValues[i], to);
    case program::Scalar::Ushort:
    case program::Scalar::Unorm16: return put<std::uint16_t>(uintValues[i], to);
  }
}

template <class T>
void putNeutral(ScatterOp op, std::byte* to) {
  using Limits = std::numeric_limits<T>;
  T value{};
  if constexpr (std::is_floating_point_v<T>) {
    value = op == ScatterOp::Min ? Limits::infinity() : op == ScatterOp::Max ? -Limits::infinity() : T{};
  } else {
    value = op == ScatterOp::Min ? Limits::max() : op == ScatterOp::Max ? Limits::lowest() : T{};
  }
  std::memcpy(to, &value, sizeof value);
}

void putNeutral(program::Scalar scalar, ScatterOp op, std::byte* to) {
  switch (scalar) {
    case program::Scalar::Int: return putNeutral<std::int32_t>(op, to);
    case program::Scalar::Uint: return putNeutral<std::uint32_t>(op, to);
    case program::Scalar::Float: return putNeutral<float>(op, to);
    case program::Scalar::Double: return putNeutral<double>(op, to);
    case program::Scalar::Bool:
    case program::Scalar::Long:
    case program::Scalar::Ulong:
    case program::Scalar::Half:
    case program::Scalar::Char:
    case program::Scalar::Uchar:
    case program::Scalar::Short:
    case program::Scalar::Ushort:
    case program::Scalar::Unorm8:
    case program::Scalar::Snorm8:
    case program::Scalar::Unorm16:
    case program::Scalar::Snorm16:
      return putScalar(scalar, Storage::Single, 0, to);  // none of these is combined
  }
}

template <class T>
T at(const std::byte* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof value);
  return value;
}

bool isNaN(program::Scalar scalar, const std::byte* bytes) {
  if (scalar == program::Scalar::Float) return std::isnan(at<float>(bytes));
  if (scalar == program::Scalar::Double) return std::isnan(at<double>(bytes));
  return scalar == program::Scalar::Half && (at<std::uint16_t>(bytes) & 0x7FFFu) > 0x7C00u;
}

bool isZero(program::Scalar scalar, const std::byte* bytes) {
  if (scalar == program::Scalar::Float) return at<float>(bytes) == 0;
  if (scalar == program::Scalar::Double) return at<double>(bytes) == 0;
  return scalar == program::Scalar::Half && (at<std::uint16_t>(bytes) & 0x7FFFu) == 0;
}

/// Calls visit(scalar, offset) for each scalar of an element until it returns false, and returns whether it never did.
template <class Visit>
bool forAllScalars(const Element& element, const Visit& visit) {
  for (const Field& field : element.fields) {
    const std::size_t size = program::hostBytes(field.scalar);
    for (std::size_t c = 0; c < field.width; ++c) {
      if (!visit(field.scalar, field.offset + c * size)) return false;
    }
  }
  return true;
}

}  // namespace

void setTestValue(const Element& element, Storage storage, int number, std::byte* bytes) {
  forAllScalars(element, [&](program::Scalar scalar, std::size_t offset) {
    putScalar(scalar, storage, number, bytes + offset);
    return true;
  });
}

void setNeutral(const Element& element, ScatterOp op, std::byte* bytes) {
  forAllScalars(element, [&](program::Scalar scalar, std::size_t offset) {
    putNeutral(scalar, op, bytes + offset);
    return true;
  });
}

bool haveSameValues(const Element& element, const std::byte* a, const std::byte* b) {
  return forAllScalars(element, [&](program::Scalar scalar, std::size_t offset) {
    const std::byte *x = a + offset, *y = b + offset;
    return std::memcmp(x, y, program::hostBytes(scalar)) == 0 || (isZero(scalar, x) && isZero(scalar, y)) ||
           (isNaN(scalar, x) && isNaN(scalar, y));
  });
}

bool hasNaN(const Element& element, const std::byte* bytes) {
  return !forAllScalars(
      element, [&](program::Scalar scalar, std::size_t offset) { return !isNaN(scalar, bytes + offset); });
}

}  // namespace sk
