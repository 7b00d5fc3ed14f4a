// SPDX-License-Identifier: MIT
//
// The extents of a stream and the index of an element. Both are written rows first, {height, width}, with
// 64-bit extents; the last dimension is contiguous in memory. Kernels use the opposite order (x is the last
// extent), and the runtime converts.
#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>

namespace sk {

inline constexpr int maxRank = 4;

namespace detail {

[[noreturn]] void throwExtentTooLarge();

template <std::integral I>
constexpr std::int64_t toExtent(I value) {
  if (!std::in_range<std::int64_t>(value)) {
    throwExtentTooLarge();
  }
  return static_cast<std::int64_t>(value);
}

}  // namespace detail

/// The index of an element, rows first: {row, column}. Any values are allowed; streams check them.
class Index {
 public:
  constexpr Index() = default;

  template <std::integral... I>
    requires(sizeof...(I) >= 1 && sizeof...(I) <= maxRank)
  constexpr Index(I... positions) : rank_(sizeof...(I)), values_{detail::toExtent(positions)...} {}

  constexpr int rank() const { return rank_; }
  constexpr std::int64_t operator[](int dimension) const {
    return values_[static_cast<std::size_t>(dimension)];
  }
  constexpr std::int64_t& operator[](int dimension) { return values_[static_cast<std::size_t>(dimension)]; }
  friend constexpr bool operator==(const Index&, const Index&) = default;

  /// The index `{0, 0, ...}`.
  static constexpr Index origin(int rank) {
    Index index;
    index.rank_ = rank;
    return index;
  }

 private:
  int rank_ = 0;
  std::array<std::int64_t, maxRank> values_{};
};

/// The extents of a stream, rows first: {height, width}. The rank is 1 to 4, or 0 if default-constructed.
/// Throws sk::Error if an extent is negative or the number of elements does not fit in 63 bits.
class Shape {
 public:
  constexpr Shape() = default;

  template <std::integral... I>
    requires(sizeof...(I) >= 1 && sizeof...(I) <= maxRank)
  constexpr Shape(I... extents) : rank_(sizeof...(I)), extents_{detail::toExtent(extents)...} {
    check();
  }

  constexpr int rank() const { return rank_; }
  constexpr std::int64_t operator[](int dimension) const {
    return extents_[static_cast<std::size_t>(dimension)];
  }
  friend constexpr bool operator==(const Shape&, const Shape&) = default;

  /// The number of elements; 0 if an extent or the rank is 0.
  constexpr std::int64_t size() const {
    std::int64_t product = rank_ == 0 ? 0 : 1;
    for (int d = 0; d < rank_; ++d) {
      product *= (*this)[d];
    }
    return product;
  }

  /// The same shape with a different extent in one dimension.
  constexpr Shape with(int dimension, std::int64_t extent) const {
    Shape shape = *this;
    shape.extents_[static_cast<std::size_t>(dimension)] = extent;
    shape.check();
    return shape;
  }

 private:
  constexpr void check() const {
    std::int64_t product = 1;
    for (int d = 0; d < rank_; ++d) {
      const std::int64_t extent = (*this)[d];
      if (extent < 0) {
        throwInvalid("an extent is negative");
      }
      if (extent > 0 && product > INT64_MAX / extent) {
        throwInvalid("the number of elements does not fit in 63 bits");
      }
      product *= extent > 0 ? extent : 1;
    }
  }
  [[noreturn]] void throwInvalid(const char* why) const;

  int rank_ = 0;
  std::array<std::int64_t, maxRank> extents_{};
};

/// Formats as in messages: "{512, 512}".
std::string toString(const Shape& shape);
std::string toString(const Index& index);

}  // namespace sk
