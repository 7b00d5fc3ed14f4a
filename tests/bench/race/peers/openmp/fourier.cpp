// SPDX-License-Identifier: MIT
#include <cmath>
#include <utility>
#include <vector>

#include "peers/openmp/all.hpp"

namespace race {
namespace {

struct Complex {
  float real, imaginary;
};

/// Radix 2 in Stockham's order, by which both loops of a pass go through memory in order.
class FourierOpenMp final : public Task {
 public:
  explicit FourierOpenMp(const Problem& p)
      : x_(p.floats[0]), roots_(half(p)), first_(2 * half(p)), second_(2 * half(p)) {
    const double turn = -2 * std::acos(-1.0) / static_cast<double>(p.size());
    for (std::size_t k = 0; k < roots_.size(); ++k) {
      const double angle = turn * static_cast<double>(k);
      roots_[k] = {static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle))};
    }
  }

  void run(int times) override {
    for (int i = 0; i < times; ++i) once();
  }
  std::vector<float> result() override {
    const auto* parts = reinterpret_cast<const float*>(first_.data());
    return {parts, parts + 2 * first_.size()};
  }

 private:
  static std::size_t half(const Problem& p) { return static_cast<std::size_t>(p.size() / 2); }

  void once() {
    const auto* from = reinterpret_cast<const Complex*>(x_.data());
    for (std::size_t stride = 1; stride <= roots_.size(); stride *= 2) {
      pass(stride, from, second_.data());
      std::swap(first_, second_);
      from = first_.data();
    }
  }

  /// Joins a[q], b[q] of the two halves into neighbouring runs of `stride` elements.
  void pass(std::size_t stride, const Complex* from, Complex* to) const {
    const std::size_t half = roots_.size();
#pragma omp parallel for
    for (std::size_t i = 0; i < half; i += block) {
      const std::size_t end = i + (half - i < block ? half - i : block);
      if (stride < block) {
        for (std::size_t k = i; k < end; ++k) {
          const std::size_t q = k % stride;
          butterfly(roots_[k - q], from[k], from[k + half], to[2 * (k - q) + q],
                    to[2 * (k - q) + q + stride]);
        }
      } else {
        const std::size_t first = i - i % stride;
        const Complex root = roots_[first];
#pragma omp simd
        for (std::size_t k = i; k < end; ++k) {
          butterfly(root, from[k], from[k + half], to[k + first], to[k + first + stride]);
        }
      }
    }
  }

  static void butterfly(Complex root, Complex a, Complex b, Complex& sum, Complex& turned) {
    const Complex difference = {a.real - b.real, a.imaginary - b.imaginary};
    sum = {a.real + b.real, a.imaginary + b.imaginary};
    turned = {difference.real * root.real - difference.imaginary * root.imaginary,
              difference.real * root.imaginary + difference.imaginary * root.real};
  }

  static constexpr std::size_t block = 256;
  const std::vector<float>& x_;
  std::vector<Complex> roots_, first_, second_;
};

}  // namespace

std::unique_ptr<Task> fourierOpenMp(const Problem& p) { return std::make_unique<FourierOpenMp>(p); }

}  // namespace race
