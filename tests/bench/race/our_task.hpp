// SPDX-License-Identifier: MIT
//
// Tasks of ours: streams on a device, and once(), which calls kernels.
#pragma once

#include <vector>

#include <sk/sk.hpp>

#include "programs.hpp"

namespace race {

class OurTask : public Task {
 public:
  explicit OurTask(sk::Device& device) : device_(device) {}

  void run(int times) final {
    for (int i = 0; i < times; ++i) once();
    device_.finish();
  }

 protected:
  virtual void once() = 0;

  template <sk::ElementType T>
  sk::Stream<T> filled(const sk::Shape& shape, const std::vector<T>& values) {
    auto stream = device_.stream<T>(shape);
    stream.write(values);
    return stream;
  }
  sk::Device& device() { return device_; }

 private:
  sk::Device& device_;
};

/// Numbers, two of which are an element.
inline std::vector<sk::float2> pairsOf(const std::vector<float>& parts) {
  std::vector<sk::float2> pairs;
  for (std::size_t i = 0; i + 1 < parts.size(); i += 2) pairs.push_back({parts[i], parts[i + 1]});
  return pairs;
}

/// The other way: the numbers that elements are made of.
template <class Vector>
std::vector<float> flat(const std::vector<Vector>& elements) {
  static_assert(sizeof(Vector) % sizeof(float) == 0);
  const auto* first = reinterpret_cast<const float*>(elements.data());
  return {first, first + elements.size() * (sizeof(Vector) / sizeof(float))};
}

}  // namespace race
