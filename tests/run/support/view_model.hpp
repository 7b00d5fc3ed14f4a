// SPDX-License-Identifier: MIT
//
// The elements of views as numbers of their streams, found by trying every element.
#pragma once

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <vector>

#include "sk/sk.hpp"

namespace run_tests {

using Numbers = std::vector<std::int64_t>;

/// The elements of a view as numbers of its stream.
struct Model {
  sk::Shape shape;
  Numbers numbers;

  explicit Model(const sk::Shape& all) : shape(all), numbers(static_cast<std::size_t>(all.size())) {
    std::iota(numbers.begin(), numbers.end(), 0);
  }

  Model strided(const sk::Index& steps, const sk::Index& offsets) const {
    Model result = *this;
    result.numbers.clear();
    for (int d = 0; d < shape.rank(); ++d) {
      result.shape = result.shape.with(d, (shape[d] - offsets[d] + steps[d] - 1) / steps[d]);
    }
    for (std::int64_t n = 0; n < shape.size(); ++n) {
      std::int64_t rest = n;
      bool isIn = true;
      for (int d = shape.rank() - 1; d >= 0; --d) {
        const std::int64_t i = rest % shape[d] - offsets[d];
        isIn = isIn && i >= 0 && i % steps[d] == 0;
        rest /= shape[d];
      }
      if (isIn) result.numbers.push_back(numbers[static_cast<std::size_t>(n)]);
    }
    return result;
  }

  template <class T>
  std::vector<T> of(const std::vector<T>& stream) const {
    std::vector<T> result;
    for (const std::int64_t n : numbers) result.push_back(stream[static_cast<std::size_t>(n)]);
    return result;
  }
  template <class T>
  void put(const std::vector<T>& elements, std::vector<T>& stream) const {
    for (std::size_t i = 0; i < numbers.size(); ++i)
      stream[static_cast<std::size_t>(numbers[i])] = elements[i];
  }
};

inline std::vector<int> counted(std::int64_t count, int first = 1) {
  std::vector<int> values(static_cast<std::size_t>(count));
  std::iota(values.begin(), values.end(), first);
  return values;
}

template <class T, class F>
std::vector<T> mapped(std::vector<T> values, const F& f) {
  for (T& value : values) value = f(value);
  return values;
}

/// The element nearest to an index.
inline int at(const std::vector<int>& values, const sk::Shape& shape, std::int64_t y, std::int64_t x) {
  y = std::clamp<std::int64_t>(y, 0, shape[0] - 1);
  x = std::clamp<std::int64_t>(x, 0, shape[1] - 1);
  return values[static_cast<std::size_t>(y * shape[1] + x)];
}

}  // namespace run_tests
