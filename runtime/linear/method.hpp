// SPDX-License-Identifier: MIT
//
// Iterative methods on a device: from x = 0, iterations that a sk::Loop repeats without the host. solve.hpp decides what limits them, what
// came of them, and when they begin anew.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include <sk/sk.hpp>

#include "matrix.hpp"
#include "preconditioner.hpp"
#include "state.hpp"

namespace sk::linear {

struct Operator;

class Method {
 public:
  virtual ~Method() = default;

  /// Begins with x = 0. Iterations end when the squared residual is at most `limit`.
  void begin(std::span<const double> rightHandSide, double limit);
  /// The same with a right-hand side on the device, of the matrix' domain.
  void begin(const Vector& rightHandSide, double limit);
  /// The same for a right-hand side that has been written to rightHandSide().
  void begin(double limit);
  Vector& rightHandSide() { return r_; }
  /// Iterates until the state is no longer Running, and `most` times at the most. Returns how often.
  std::int64_t run(std::int64_t every, std::int64_t most);
  /// The same, but returns after about `every` iterations: after a whole cycle, if the method has such.
  virtual std::int64_t advance(std::int64_t every, std::int64_t most);

  State state() const;
  /// Iterations that make the residual less than a hundredth smaller, after which the method has stagnated.
  virtual std::int64_t patience() const { return 500; }
  /// Runs in a row that may leave x no better before the solver gives up: more than one if each run starts differently.
  virtual int attempts() const { return 1; }
  /// The squared residual that the method itself computes.
  double residualSquared() const;
  /// What the iterations so far have come to, on the device.
  virtual const Vector& x() { return x_; }
  /// Copies x, to which restore() goes back: for methods whose residual rises by the way, and may not come down again.
  void keep();
  void restore() { kept_.copyTo(x_); }
  std::vector<double> solution() { return x().readReals(); }

  sk::Device& device() const { return device_; }
  Matrix& matrix() const { return matrix_; }

 protected:
  Method(sk::Device& device, Matrix& matrix, Preconditioner* preconditioner, const Arithmetic& arithmetic);

  Vector vector() const { return matrix_.space(device_).stream<float>(arithmetic_.vectors); }
  Vector sum() const { return device_.stream<float>({1}, arithmetic_.sums()); }
  /// z = M r and rz = r . z, where there is a preconditioner; z = r otherwise.
  void precondition(const Vector& r, Vector& z, Vector& rz);

  /// Computes everything that an iteration needs, from r_, with x_ = 0.
  virtual void start() = 0;
  virtual void iterate() = 0;
  /// Whether calls must run at once: they exchange elements between ranks, which no loop records.
  bool isDivided() const { return r_.isDivided(); }
  /// Whether something happens between two calls of advance().
  virtual bool hasCycles() const { return false; }

  sk::Device& device_;
  Matrix& matrix_;
  Preconditioner* preconditioner_;
  Arithmetic arithmetic_;
  sk::CallOptions options_, foldOptions_;
  Vector x_, r_, kept_;
  Vector rr_, limit_;
  sk::Stream<int> state_;
  sk::Stream<bool> done_;

 private:
  std::int64_t repeat(std::int64_t every, std::int64_t most);
  std::int64_t repeatAtOnce(std::int64_t most);

  sk::Loop loop_;
};

/// What some methods need besides a matrix.
struct MethodSettings {
  int restart = 30;  ///< steps after which gmres begins anew
  double omega = 1.0;  ///< relaxation factor of sor, between 0 and 2
  const Operator* a = nullptr;  ///< the matrix on the host, for sor; must outlive the method's construction
};

struct MethodParts {
  sk::Device& device;
  Matrix& matrix;
  Preconditioner* preconditioner;  ///< null for none
  const Arithmetic& arithmetic;
  MethodSettings settings;
};

struct MethodKind {
  std::string_view name;  ///< of --solver
  std::string_view does;
  bool needsSymmetry;
  int vectors;  ///< that it allocates with a preconditioner, for estimates of memory
  std::unique_ptr<Method> (*create)(const MethodParts& parts);
  bool hasBasis = false;  ///< allocates one more vector for each step of --restart
  bool isUpdatable =
      true;  ///< whether recorded iterations follow other values of the matrix; else it holds numbers of its own

  std::unique_ptr<Method> make(sk::Device& device, Matrix& matrix, Preconditioner* preconditioner,
                               const Arithmetic& arithmetic, const MethodSettings& settings = {}) const {
    return create({device, matrix, preconditioner, arithmetic, settings});
  }
};

std::span<const MethodKind> methodKinds();

std::unique_ptr<Method> makeGradients(const MethodParts& parts);
std::unique_ptr<Method> makePipelinedGradients(const MethodParts& parts);
std::unique_ptr<Method> makeMinimalResiduals(const MethodParts& parts);
std::unique_ptr<Method> makeGeneralizedMinimalResiduals(const MethodParts& parts);
std::unique_ptr<Method> makeBiconjugateGradients(const MethodParts& parts);
std::unique_ptr<Method> makeStationary(const MethodParts& parts);
/// Throws sk::Error if a diagonal entry is 0 or omega is not between 0 and 2.
std::unique_ptr<Method> makeRelaxation(const MethodParts& parts);
std::unique_ptr<Method> makeChebyshevIteration(const MethodParts& parts);

}  // namespace sk::linear
