// SPDX-License-Identifier: MIT
//
// Compares the numbers of elements with ranges.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>

#include <fmt/format.h>

#include "call/range_values.hpp"
#include "sk/narrow.hpp"
#include "sk/scalar_bytes.hpp"
#include "support/scalar_types.hpp"

namespace sk {

namespace {

using program::Field;
using program::Scalar;
using program::ValueRange;

/// The integer at which a range ends, whose double is exact, or the last one of the type if it has no end.
template <class T>
T integerEnd(double end) {
  if (end <= static_cast<double>(std::numeric_limits<T>::min())) return std::numeric_limits<T>::min();
  if (end >= static_cast<double>(std::numeric_limits<T>::max())) return std::numeric_limits<T>::max();
  return static_cast<T>(end);
}

/// An end of a range as a stream stores it.
float floatEnd(Storage storage, double end) {
  const auto single = static_cast<float>(end);
  return storage == Storage::Half ? static_cast<float>(half(single)) : single;
}

/// The double that a pair of floats keeps of a number.
double ofPair(double number) {
  const auto high = static_cast<float>(number);
  return std::isfinite(high) ? high + static_cast<double>(static_cast<float>(number - high)) : number;
}

/// The text of a number that is not in the range; nullopt if it is.
template <class T>
std::optional<std::string> textIfOutside(const ValueRange& range, Storage storage, const std::byte* bytes) {
  const T stored = componentAt<T>(bytes);
  const auto compare = [](auto value, auto low, auto high) {
    return value >= low && value <= high ? std::nullopt : std::optional(fmt::format("{}", value));
  };
  if constexpr (std::is_integral_v<T>) {
    return compare(stored, integerEnd<T>(range.low), integerEnd<T>(range.high));
  } else if constexpr (std::is_same_v<T, double>) {
    const bool isOfPairs = storage == Storage::Extended;
    return compare(stored, isOfPairs ? std::min(range.low, ofPair(range.low)) : range.low,
                   isOfPairs ? std::max(range.high, ofPair(range.high)) : range.high);
  } else if constexpr (std::is_same_v<T, float>) {
    return compare(stored, floatEnd(storage, range.low), floatEnd(storage, range.high));
  } else {  // half, or an integer that stands for a real number
    const auto end = [](double real) { return static_cast<float>(T(static_cast<float>(real))); };
    return compare(static_cast<float>(stored), end(range.low), end(range.high));
  }
}

std::optional<std::string> textIfOutside(Scalar scalar, Storage storage, const ValueRange& range,
                                         const std::byte* bytes) {
  return withScalarType(scalar, [&]<class T>(T) {
    if constexpr (std::is_same_v<T, bool>)
      return std::optional<std::string>();  // has no range
    else
      return textIfOutside<T>(range, storage, bytes);
  });
}

/// ".y", "[2]", "[0].x".
std::string componentName(const Field& field, std::size_t component) {
  const bool isVectorPart = field.part >= 0 && program::is64Bit(field.scalar);
  std::string name(field.path);
  if (field.part >= 0 && !isVectorPart) name += fmt::format("[{}]", field.part);  // a row of a matrix
  const std::size_t letter = component + (isVectorPart ? 2U * static_cast<std::size_t>(field.part) : 0);
  if (field.width > 1 || isVectorPart) name += fmt::format(".{}", "xyzw"[letter]);
  return name;
}

}  // namespace

std::optional<OutOfRange> outOfRange(const program::Element& element, Storage storage,
                                     const ValueRange& range, const double* reals) {
  for (const Field& field : element.fields) {
    for (std::size_t c = 0; c < field.width; ++c) {
      std::optional<std::string> text =
          textIfOutside<double>(range, storage, reinterpret_cast<const std::byte*>(reals++));
      if (text) return OutOfRange{componentName(field, c), std::move(*text)};
    }
  }
  return std::nullopt;
}

std::optional<OutOfRange> outOfRange(const program::Element& element, Storage storage,
                                     const ValueRange& range, const std::byte* bytes) {
  for (const Field& field : element.fields) {
    const std::size_t size = program::hostBytes(field.scalar);
    for (std::size_t c = 0; c < field.width; ++c) {
      std::optional<std::string> text =
          textIfOutside(field.scalar, storage, range, bytes + field.offset + c * size);
      if (text) return OutOfRange{componentName(field, c), std::move(*text)};
    }
  }
  return std::nullopt;
}

}  // namespace sk
