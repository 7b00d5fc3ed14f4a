// SPDX-License-Identifier: MIT
//
// How many elements a stream has in each dimension, and where one of them is. Both are written rows
// first, {height, width}, with 64-bit extents: the last one is the fastest in memory. Inside kernels
// the order is the other way round (x is the last extent); the runtime does the turning.
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

/// The position of an element, rows first: {row, column}. Any values; streams check them.
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

  /// The position `{0, 0, ...}`.
  static constexpr Index origin(int rank) {
    Index index;
    index.rank_ = rank;
    return index;
  }

 private:
  int rank_ = 0;
  std::array<std::int64_t, maxRank> values_{};
};

/// The extents of a stream, rows first: {height, width}. Rank 1 to 4 (0 only where default-made).
/// Throws sk::Error where an extent is negative or the number of elements passes 63 bits.
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

  /// The number of elements; 0 where an extent is 0 or the rank is 0.
  constexpr std::int64_t size() const {
    std::int64_t product = rank_ == 0 ? 0 : 1;
    for (int d = 0; d < rank_; ++d) {
      product *= (*this)[d];
    }
    return product;
  }

  /// The same shape with another extent in one dimension.
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

/// "{512, 512}", as messages show it.
std::string toString(const Shape& shape);
std::string toString(const Index& index);

}  // namespace sk
