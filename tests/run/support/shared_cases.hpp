// SPDX-License-Identifier: MIT
//
// Tests functions whose text is both .sk and C++ (tests/run/shared): compares the results of a kernel
// (T x<>, T y<>, out R r<>) that calls one with the results of calling it here.
#pragma once

#include <utility>
#include <vector>

#include "support/devices.hpp"
#include "support/values.hpp"

namespace run_tests {

template <class T>
struct Samples {
  std::vector<T> x, y;
};

/// All pairs of the given values.
template <class T>
Samples<T> pairsOf(const std::vector<T>& values) {
  Samples<T> samples;
  for (const T x : values) {
    for (const T y : values) {
      samples.x.push_back(x);
      samples.y.push_back(y);
    }
  }
  return samples;
}

/// All pairs of integers in [begin, end).
inline Samples<int> pairsOf(int begin, int end) {
  std::vector<int> values;
  for (int x = begin; x < end; ++x) values.push_back(x);
  return pairsOf(values);
}

/// Checks functions at all samples on a device.
template <class R, class T>
class SharedCases {
 public:
  SharedCases(sk::Device& device, const Samples<T>& samples)
      : samples_(samples),
        x_(streamOf<T>(device, samples.x)),
        y_(streamOf<T>(device, samples.y)),
        r_(device.stream<R>({static_cast<std::int64_t>(samples.x.size())})) {}

  template <class Kernel>
  void check(const char* name, const Kernel& kernel, R (*function)(T, T),
             bool (*agree)(const R&, const R&) = isSame<R>) {
    kernel(x_, y_, r_);
    std::size_t last = 0;
    const auto results = r_.read();
    const std::string wrong = difference(
        results, results.size(),
        [&](std::size_t i) {
          const R expected = function(samples_.x[i], samples_.y[i]);
          if (!agree(results[i], expected)) last = i;
          return expected;
        },
        agree);
    INFO(name << ", last at x = " << samples_.x[last] << ", y = " << samples_.y[last]);
    CHECK(wrong == "");
  }

 private:
  const Samples<T>& samples_;
  sk::Stream<T> x_, y_;
  sk::Stream<R> r_;
};

}  // namespace run_tests
