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

/// Reads pairs and the like as the numbers that they are made of.
template <class Vector>
std::vector<float> flat(const std::vector<Vector>& elements) {
  static_assert(sizeof(Vector) % sizeof(float) == 0);
  const auto* first = reinterpret_cast<const float*>(elements.data());
  return {first, first + elements.size() * (sizeof(Vector) / sizeof(float))};
}

}  // namespace race
