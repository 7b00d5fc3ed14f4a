// SPDX-License-Identifier: MIT
//
// What main.cpp leaves out: options, the numbers to work on, and the comparison with a plain loop in double
// precision. It never sees the kernel.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include <sk/device.hpp>

#include "support/application.hpp"

namespace examples {

class Saxpy {
 public:
  Saxpy();
  int run(int argc, char** argv, const std::function<void()>& body);

  const std::string& device() const { return app_.device(); }
  std::int64_t size() const { return size_; }
  float a() const { return a_; }
  std::span<const float> x() const { return x_; }
  std::span<const float> y() const { return y_; }

  /// Makes the call once unmeasured, so that its program is compiled, and then times it.
  void time(sk::Device& device, const std::function<void()>& call);
  void check(std::span<const float> result);

 private:
  Application app_;
  std::int64_t size_ = 1'000'000;
  float a_ = 2.5f;
  std::vector<float> x_;
  std::vector<float> y_;
};

}  // namespace examples
