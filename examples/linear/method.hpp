// SPDX-License-Identifier: MIT
//
// Iterative methods on a device: from x = 0, iterations that a sk::Loop repeats without the host. What limits them, what
// comes of them, and when to begin anew is decided in solve.hpp.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string_view>

#include <sk/sk.hpp>

#include "matrix.hpp"
#include "preconditioner.hpp"
#include "state.hpp"

namespace linear {

struct Operator;

class Method {
 public:
  virtual ~Method() = default;

  /// Begins with x = 0. Iterations end when the squared residual is at most `limit`.
  void begin(std::span<const double> rightHandSide, double limit);
  /// The same with a right-hand side on the device, of the matrix' domain.
  void begin(const Vector& rightHandSide, double limit);
  /// Iterates until the state is no longer Running, and `most` times at the most. Returns how often.
  std::int64_t run(std::int64_t every, std::int64_t most);

  State state() const;
  /// Iterations that make the residual less than a hundredth smaller, after which the method has stagnated.
  virtual std::int64_t patience() const { return 500; }
  /// The squared residual that the method itself computes.
  double residualSquared() const;
  std::vector<double> solution() const { return x_.readReals(); }
  /// The solution on the device, until the next begin().
  const Vector& x() const { return x_; }

 protected:
  Method(sk::Device& device, Matrix& matrix, Preconditioner* preconditioner, const Arithmetic& arithmetic);

  Vector vector() const { return device_.stream<float>(matrix_.domain(), arithmetic_.vectors); }
  Vector sum() const { return device_.stream<float>({1}, arithmetic_.sums()); }
  /// z = M r and rz = r . z, where there is a preconditioner; z = r otherwise.
  void precondition(const Vector& r, Vector& z, Vector& rz);

  /// Computes everything that an iteration needs, from r_, with x_ = 0.
  virtual void start() = 0;
  virtual void iterate() = 0;

  sk::Device& device_;
  Matrix& matrix_;
  Preconditioner* preconditioner_;
  Arithmetic arithmetic_;
  sk::CallOptions options_, foldOptions_;
  Vector x_, r_;
  Vector rr_, limit_;
  sk::Stream<int> state_;
  sk::Stream<bool> done_;

 private:
  /// From r_.
  void startWithin(double limit);

  sk::Loop loop_;
};

struct MethodKind {
  std::string_view name;  ///< of --solver
  std::string_view does;
  bool needsSymmetry;
  std::unique_ptr<Method> (*make)(sk::Device& device, Matrix& matrix, Preconditioner* preconditioner,
                                  const Arithmetic& arithmetic);
};

std::span<const MethodKind> methodKinds();

}  // namespace linear
