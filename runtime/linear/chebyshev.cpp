// SPDX-License-Identifier: MIT
#include "chebyshev.hpp"

#include "vectors.sk.hpp"

namespace sk::linear {

ChebyshevSteps::ChebyshevSteps(sk::Device& device, Matrix& matrix, std::span<const double> inverseDiagonal,
                               const ChebyshevSettings& settings, const Arithmetic& arithmetic)
    : matrix_(matrix),
      inverse_(matrix.space(device).stream<float>(arithmetic.vectors)),
      change_(matrix.space(device).stream<float>(arithmetic.vectors)),
      product_(matrix.space(device).stream<float>(arithmetic.vectors)),
      options_(arithmetic.options()),
      steps_(settings.steps),
      middle_(0.5 * (settings.high + settings.low)),
      radius_(0.5 * (settings.high - settings.low)) {
  inverse_.writeReals(inverseDiagonal);
  change_.fill(0.0f);
}

void ChebyshevSteps::begin(const Vector& r, Vector& z) {
  chebyshevFirst.with(options_)(static_cast<float>(1.0 / middle_), inverse_, r, change_, z);
  finish(r, z);
}

void ChebyshevSteps::advance(const Vector& r, Vector& z) {
  matrix_.multiply(z, product_);
  chebyshevStep.with(options_)(0.0f, static_cast<float>(1.0 / middle_), inverse_, r, product_, change_, z,
                               change_, z);
  finish(r, z);
}

void ChebyshevSteps::finish(const Vector& r, Vector& z) {
  double rho = radius_ / middle_;
  for (int k = 1; k < steps_; ++k) {
    matrix_.multiply(z, product_);
    const double next = 1.0 / (2.0 * middle_ / radius_ - rho);
    chebyshevStep.with(options_)(static_cast<float>(next * rho), static_cast<float>(2.0 * next / radius_),
                                 inverse_, r, product_, change_, z, change_, z);
    rho = next;
  }
}

}  // namespace sk::linear
