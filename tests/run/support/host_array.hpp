// SPDX-License-Identifier: MIT
//
// An array with a shape in host memory: the counterpart of a stream, in row-major order.
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "sk/sk.hpp"

namespace run_tests {

/// A position, rows first; dimensions beyond the rank are 0.
using Position = std::array<std::int64_t, 4>;

/// The position of element i, row-major.
inline Position positionOf(const sk::Shape& shape, std::size_t i) {
  Position position{};
  auto rest = static_cast<std::int64_t>(i);
  for (int d = shape.rank() - 1; d >= 0; --d) {
    position[static_cast<std::size_t>(d)] = rest % shape[d];
    rest /= shape[d];
  }
  return position;
}

/// The position in the stream of a position in a view that starts at `begin`.
inline Position inside(const sk::Index& begin, Position position) {
  for (int d = 0; d < begin.rank(); ++d) position[static_cast<std::size_t>(d)] += begin[d];
  return position;
}

template <class T>
class HostArray {
 public:
  template <class Make>
  HostArray(const sk::Shape& shape, const Make& make) : shape_(shape) {
    for (std::size_t i = 0; i < static_cast<std::size_t>(shape.size()); ++i) elements_.push_back(make(i));
  }

  T& operator[](const Position& position) { return elements_[number(position)]; }
  const T& operator[](const Position& position) const { return elements_[number(position)]; }
  /// The element at a position of a larger array; this array is broadcast in dimensions of extent 1.
  const T& repeated(Position position) const {
    for (int d = 0; d < shape_.rank(); ++d) {
      auto& p = position[static_cast<std::size_t>(d)];
      p = std::min(p, shape_[d] - 1);
    }
    return (*this)[position];
  }
  const std::vector<T>& elements() const { return elements_; }
  const sk::Shape& shape() const { return shape_; }

  sk::Stream<T> on(sk::Device& device) const {
    sk::Stream<T> stream = device.stream<T>(shape_);
    stream.write(elements_);
    return stream;
  }

 private:
  std::size_t number(const Position& position) const {
    std::int64_t n = 0;
    for (int d = 0; d < shape_.rank(); ++d) n = n * shape_[d] + position[static_cast<std::size_t>(d)];
    return static_cast<std::size_t>(n);
  }

  sk::Shape shape_;
  std::vector<T> elements_;
};

}  // namespace run_tests
