// SPDX-License-Identifier: MIT
#include "check.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include <fmt/format.h>

#include "support/stopwatch.hpp"

namespace examples {

Saxpy::Saxpy() : app_("saxpy", "r = a x + y for vectors of random numbers, on the device") {
  app_.options()
      .add_option("-n,--size", size_, "elements (default: a million)")
      ->check(CLI::Range(std::int64_t{0}, std::int64_t{1} << 28));
  app_.options().add_option("-a,--factor", a_, "the factor a (default: 2.5)");
}

int Saxpy::run(int argc, char** argv, const std::function<void()>& body) {
  return app_.run(argc, argv, [&] {
    std::mt19937 random(1);
    std::uniform_real_distribution<float> numbers(-1.0f, 1.0f);
    const auto fill = [&](std::vector<float>& v) {
      v.resize(static_cast<std::size_t>(size_));
      std::generate(v.begin(), v.end(), [&] { return numbers(random); });
    };
    fill(x_);
    fill(y_);
    body();
  });
}

void Saxpy::time(sk::Device& device, const std::function<void()>& call) {
  call();
  device.finish();
  app_.report(fmt::format("r = a x + y for {} elements", size_), device.name(), millisecondsOf(device, call));
}

void Saxpy::check(std::span<const float> result) {
  Verification verification("r against a double loop, relative to |a x| + |y|", 2 * roundoff,
                            "a rounding each for product and sum");
  for (std::size_t i = 0; i < result.size(); ++i) {
    const double product = double{a_} * double{x_[i]};
    const double y = y_[i];
    verification.compare(static_cast<std::int64_t>(i), result[i], product + y,
                         std::abs(product) + std::abs(y));
  }
  app_.verified(verification);
}

}  // namespace examples
