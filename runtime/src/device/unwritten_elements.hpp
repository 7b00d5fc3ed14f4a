// SPDX-License-Identifier: MIT
//
// The elements of a stream that nothing has written since the application created it. SK_CHECK=written keeps them for each
// stream (call/check_written.hpp).
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "device/region.hpp"

namespace sk {

class UnwrittenElements {
 public:
  /// All of a stream's elements.
  explicit UnwrittenElements(std::int64_t count)
      : unwritten_(static_cast<std::size_t>(count), true), left_(count) {}

  bool isAll() const { return left_ == static_cast<std::int64_t>(unwritten_.size()); }
  bool isEmpty() const { return left_ == 0; }

  /// From now on, writing one element counts as writing all.
  void countTogether() { areTogether_ = true; }

  /// Removes the elements of a region, because they have been written.
  void remove(const AffineRegion& region) {
    if (areTogether_) return removeAll();
    forEach(region, [&](std::int64_t, std::size_t element) { set(element, false); });
  }
  void remove(const AffineRegion& region, std::span<const std::int64_t> numbers) {
    if (areTogether_ && !numbers.empty()) return removeAll();
    forEach(region, [&, next = numbers.begin()](std::int64_t number, std::size_t element) mutable {
      if (next == numbers.end() || *next != number) return;
      set(element, false);
      ++next;
    });
  }
  /// Adds elements of a region, because others that nothing has written were copied to them. `numbers` are those of the region,
  /// row-major and in ascending order.
  void add(const AffineRegion& region, std::span<const std::int64_t> numbers) {
    if (areTogether_) return;
    forEach(region, [&, next = numbers.begin()](std::int64_t number, std::size_t element) mutable {
      if (next == numbers.end() || *next != number) return;
      set(element, true);
      ++next;
    });
  }

  /// Those in a region, as row-major numbers of the region's elements, in ascending order.
  std::vector<std::int64_t> in(const AffineRegion& region) const {
    std::vector<std::int64_t> numbers;
    forEach(region, [&](std::int64_t number, std::size_t element) {
      if (unwritten_[element]) numbers.push_back(number);
    });
    return numbers;
  }

 private:
  /// Calls visit(number, element) with the row-major number of each element in the region, and its number in the stream.
  template <class Visit>
  static void forEach(const AffineRegion& region, Visit&& visit) {
    const auto [first, stride, extent] = region;
    std::int64_t number = 0;
    for (std::int64_t w = 0; w < extent[3]; ++w)
      for (std::int64_t z = 0; z < extent[2]; ++z)
        for (std::int64_t y = 0; y < extent[1]; ++y) {
          std::int64_t element = first + w * stride[3] + z * stride[2] + y * stride[1];
          for (std::int64_t x = 0; x < extent[0]; ++x, element += stride[0])
            visit(number++, static_cast<std::size_t>(element));
        }
  }

  void set(std::size_t element, bool isUnwritten) {
    if (unwritten_[element] == isUnwritten) return;
    unwritten_[element] = isUnwritten;
    left_ += isUnwritten ? 1 : -1;
  }

  void removeAll() { left_ = 0; }

  std::vector<bool> unwritten_;
  std::int64_t left_;
  bool areTogether_ = false;
};

}  // namespace sk
