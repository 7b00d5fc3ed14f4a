// SPDX-License-Identifier: MIT
#include "matrix.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "vectors.sk.hpp"

namespace sk::linear {

double Arithmetic::roundoff() const {
  const auto computed = [&] {
    switch (precision) {
      case sk::Precision::Half: return 0x1p-11;
      case sk::Precision::Default:
      case sk::Precision::Single: return 0x1p-24;
      case sk::Precision::Extended: return 0x1p-44;
      case sk::Precision::Double: return 0x1p-53;
    }
    return 1.0;
  }();
  const auto stored = [&] {
    switch (vectors) {
      case sk::Storage::Half: return 0x1p-11;
      case sk::Storage::Default:
      case sk::Storage::Single: return 0x1p-24;
      case sk::Storage::Extended: return 0x1p-48;
      case sk::Storage::Double: return 0x1p-53;
    }
    return 1.0;
  }();
  return std::max(computed, stored);
}

std::int64_t bytesOf(sk::Storage storage) {
  switch (storage) {
    case sk::Storage::Half: return 2;
    case sk::Storage::Default:
    case sk::Storage::Single: return 4;
    case sk::Storage::Extended:
    case sk::Storage::Double: return 8;
  }
  return 0;
}

void Matrix::multiply(const Vector& x, Vector& y, Vector& xy) {
  multiply(x, y);
  dot.with(foldOptions())(x, y, xy);
}

void Matrix::multiplyIn(const Arithmetic& arithmetic, const Vector& x, Vector& y) {
  const sk::CallOptions options = std::exchange(options_, arithmetic.options());
  const sk::CallOptions foldOptions = std::exchange(foldOptions_, arithmetic.foldOptions());
  multiply(x, y);
  options_ = options;
  foldOptions_ = foldOptions;
}

bool Matrix::scatters(sk::Device& device) const {
  if (device.profile() == "native") return true;
  const bool isSingle =
      options_.precision == sk::Precision::Single || options_.precision == sk::Precision::Default;
  return isSingle && (vectors_ == sk::Storage::Single || vectors_ == sk::Storage::Default);
}

void Matrix::update(const SparseMatrix&) {
  throw sk::Error("a matrix in the layout '" + layout() + "' cannot take other values");
}

void Matrix::fusedDirection(const Vector&, const Vector&, const Vector&, Vector&, Vector&) {
  throw std::logic_error("this layout has no fused iterations");
}

void Matrix::fusedStep(const Vector&, const Vector&, const Vector&, Vector&, Vector&, Vector&) {
  throw std::logic_error("this layout has no fused iterations");
}

}  // namespace sk::linear
