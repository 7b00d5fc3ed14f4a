// SPDX-License-Identifier: MIT
//
// Preconditioners: z = M r, where M is near the inverse of the matrix and cheap to apply.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <sk/sk.hpp>

#include "matrix.hpp"

namespace sk::linear {

struct Operator;

/// The residual after a cycle that begins on a grid of a hierarchy, as a part of the one before it.
struct LevelRate {
  sk::Shape grid;
  double rate = 0.0;
};

/// The levels that a preconditioner has built from the entries of a matrix.
struct HierarchyAccount {
  struct Level {
    std::int64_t unknowns = 0;
    std::int64_t entries = 0;
    std::string layout;
  };
  std::vector<Level> levels;  ///< the matrix itself first
  double seconds = 0.0;  ///< to build them, and to copy them to the device

  /// The entries of all levels for each entry of the matrix: what a cycle costs, in products with the matrix, for each of its steps on a level.
  double operatorComplexity() const;
};

class Preconditioner {
 public:
  virtual ~Preconditioner() = default;
  /// z = M r, and rz, of one element, becomes r . z. May be recorded in a loop.
  virtual void apply(const Vector& r, Vector& z, Vector& rz) = 0;
  /// Whether update() follows other values of the matrix.
  virtual bool isUpdatable() const { return false; }
  /// Follows a matrix that has been updated, and whose values on the host are `a`; recorded loops follow, too. Throws sk::Error if the
  /// preconditioner can only be made anew.
  virtual void update(const Operator& a);
  /// Measures the rate of the cycle on each grid, the finest first, in about ten cycles each; empty for preconditioners without grids.
  virtual std::vector<LevelRate> rates() { return {}; }
  /// Null if it has built no levels.
  virtual const HierarchyAccount* hierarchy() const { return nullptr; }
};

struct PreconditionerSettings {
  double omega = 1.0;  ///< relaxation factor of sor and ssor, between 0 and 2
  /// The order of rows in sor, ssor, ic0, ilu0 and ilut: "colours" needs few calls, "levels" fewer iterations (ordering.hpp).
  std::string_view ordering = "colours";
  double drop = 1e-3;  ///< of ilut (ordering.hpp)
  int fill = 20;  ///< likewise: entries that a row of a factor keeps
  int before = 1, after = 1;  ///< sweeps of multigrid before and after the correction by the coarser grid
};

struct PreconditionerParts {
  sk::Device& device;
  Matrix& matrix;  ///< outlives the preconditioner
  const Operator& a;
  const Arithmetic& arithmetic;
  PreconditionerSettings settings;
};

struct PreconditionerKind {
  std::string_view name;  ///< of --preconditioner
  std::string_view does;
  bool isSymmetric;  ///< z = M r with a symmetric M for symmetric matrices: what conjugate gradients need
  bool needsSymmetry;  ///< of the matrix
  /// Null for none. Throws sk::Error if the matrix does not allow it.
  std::unique_ptr<Preconditioner> (*create)(const PreconditionerParts& parts);
  /// What it allocates, for estimates of memory: in vectors, those of coarse levels included, and in matrices with as many entries as the matrix.
  double vectors = 0.0, matrices = 0.0;
  bool isDivisible = true;  ///< whether it applies to vectors that are divided over ranks
  bool isCycle = false;  ///< a cycle of geometric multigrid, which solves by itself

  std::unique_ptr<Preconditioner> make(sk::Device& device, Matrix& matrix, const Operator& a,
                                       const Arithmetic& arithmetic,
                                       const PreconditionerSettings& settings = {}) const {
    return create({device, matrix, a, arithmetic, settings});
  }
};

std::span<const PreconditionerKind> preconditionerKinds();

}  // namespace sk::linear
