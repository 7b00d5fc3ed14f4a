// SPDX-License-Identifier: MIT
//
// Sweeps over a matrix's rows on a device: over-relaxation, and the preconditioners that solve with triangular matrices.
#pragma once

#include <memory>
#include <string_view>

#include <sk/sk.hpp>

#include "matrix.hpp"
#include "preconditioner.hpp"

namespace sk::linear {

struct Operator;

/// Relaxes the unknowns of A x = b, colour by colour.
class Relaxer {
 public:
  virtual ~Relaxer() = default;
  /// Begins with x = 0.
  virtual void load(const Vector& b) = 0;
  /// rr, of one element, becomes the sum of the squares of what was left of each equation before its unknown was relaxed. May be recorded in a
  /// loop.
  virtual void sweep(float omega, Vector& rr) = 0;
  virtual void store(Vector& x) = 0;
};

/// `matrix` is a.scale * A, and outlives the relaxer. Grids have two colours, and compute the products of `matrix`; other matrices are stored once more.
std::unique_ptr<Relaxer> makeRelaxer(sk::Device& device, Matrix& matrix, const Operator& a,
                                     const Arithmetic& arithmetic);

/// Throws sk::Error, naming the row, if a diagonal entry is 0. `what` divides by it.
void checkDiagonal(const Operator& a, std::string_view what,
                   std::string_view instead = "the preconditioner 'none'");

/// Preconditioners of relaxation.cpp: for PreconditionerKind::make.
std::unique_ptr<Preconditioner> makeSor(const PreconditionerParts& parts);
std::unique_ptr<Preconditioner> makeSsor(const PreconditionerParts& parts);
std::unique_ptr<Preconditioner> makeIncompleteCholesky(const PreconditionerParts& parts);
std::unique_ptr<Preconditioner> makeIncompleteLu(const PreconditionerParts& parts);
std::unique_ptr<Preconditioner> makeThresholdLu(const PreconditionerParts& parts);

}  // namespace sk::linear
