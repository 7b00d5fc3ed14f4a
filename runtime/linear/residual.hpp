// SPDX-License-Identifier: MIT
//
// The residual b - A x in double precision, and the x that solves have added up: on the device, where it has doubles of its own, else on the
// host. Where doubles do not give the norm to 1 %, the host computes it with twice their digits (precise.hpp). Everything is scaled by powers of two: A as on the device,
// and b so that its largest element is from 1 to 2.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <sk/sk.hpp>

#include "matrix.hpp"
#include "operator.hpp"
#include "precise.hpp"

namespace sk::linear {

class Residual {
 public:
  virtual ~Residual() = default;

  /// Follows the operator and the matrix, whose values have been updated in place.
  virtual void update() = 0;
  /// Begins with x = 0.
  virtual Norms start(std::span<const double> b) = 0;
  /// The norms of the residual for x + scale * step. Nothing changes until accept().
  virtual Norms attempt(const Vector& step, double scale) = 0;
  virtual void accept() = 0;
  /// r = scale * residual, rounded to what r is stored in.
  virtual void writeTo(Vector& r, double scale) = 0;
  virtual double largestOfSolution() const = 0;
  virtual std::vector<double> solution() = 0;
  /// Where the latest residual was computed: "device" or "host".
  virtual std::string_view place() const = 0;
};

/// `matrix` is a.scale * A on the device. If it stores every entry exactly, it serves; otherwise the device gets a second copy of the
/// matrix. Both must outlive the residual.
std::unique_ptr<Residual> makeResidual(sk::Device& device, Matrix& matrix, const Operator& a,
                                       const Arithmetic& arithmetic);

/// Whether a.scale * A is stored exactly; otherwise residuals need a second copy of the matrix, in doubles. Stencils without entries need none.
bool keepsEntries(const Operator& a, sk::Storage storage);

/// Computing and storing everything in doubles.
Arithmetic doubleArithmetic();
/// Whether the device computes in doubles of its own.
bool hasDoubles(sk::Device& device);

/// Why the matrix is not symmetric; "" if it is. The device compares u . A v with v . A u for random u and v, in doubles if it has them; only if they
/// differ by more than rounding explains, the host looks for the place. Misses differences below about 2^-45, without doubles 2^-16, of the largest row sum.
std::string asymmetryOnDevice(sk::Device& device, Matrix& matrix, const Operator& a,
                              const Arithmetic& arithmetic);

}  // namespace sk::linear
