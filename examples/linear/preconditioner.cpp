// SPDX-License-Identifier: MIT
#include "preconditioner.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "aggregation.hpp"
#include "chebyshev.hpp"
#include "multigrid.hpp"
#include "multigrid_varying.hpp"
#include "operator.hpp"
#include "relaxation.hpp"
#include "vectors.sk.hpp"

namespace linear {

namespace {

/// 1 / diagonal of the matrix on the device, which is scaled.
std::vector<double> inverseDiagonal(const Operator& a) {
  std::vector<double> inverse(a.diagonal.size());
  for (std::size_t i = 0; i < inverse.size(); ++i) inverse[i] = 1.0 / (a.scale * a.diagonal[i]);
  return inverse;
}

/// The diagonal matrix M with the least ||I - M A|| in Frobenius' norm (O. Broeker and M. Grote, "Sparse approximate inverse
/// smoothers for geometric and algebraic multigrid", 2002).
std::vector<double> leastSquaresDiagonal(const Operator& a) {
  std::vector<double> entries(a.diagonal.size());
  for (std::size_t i = 0; i < entries.size(); ++i)
    entries[i] = a.rowSquares[i] > 0.0 ? a.diagonal[i] / a.rowSquares[i] / a.scale : 0.0;
  return entries;
}

class Diagonal : public Preconditioner {
 public:
  using Entries = std::vector<double> (*)(const Operator& a);

  Diagonal(const PreconditionerParts& parts, Entries entriesOf)
      : entriesOf_(entriesOf),
        entries_(parts.device.stream<float>(parts.matrix.domain(), parts.arithmetic.vectors)),
        foldOptions_(parts.arithmetic.foldOptions()) {
    update(parts.a);
  }
  void update(const Operator& a) final { entries_.writeReals(entriesOf_(a)); }
  void apply(const Vector& r, Vector& z, Vector& rz) override {
    multiplyElements.with(foldOptions_)(entries_, r, z, rz);
  }

 private:
  Entries entriesOf_;
  Vector entries_;
  sk::CallOptions foldOptions_;
};

/// Four of Chebyshev's iterations from z = 0, for eigenvalues from bound / 30 to bound.
class Chebyshev : public Preconditioner {
 public:
  explicit Chebyshev(const PreconditionerParts& parts)
      : steps_(parts.device, parts.matrix, inverseDiagonal(parts.a),
               {.steps = 4, .low = parts.a.jacobiBound / 30.0, .high = parts.a.jacobiBound},
               parts.arithmetic),
        foldOptions_(parts.arithmetic.foldOptions()) {}

  void apply(const Vector& r, Vector& z, Vector& rz) override {
    steps_.begin(r, z);
    dot.with(foldOptions_)(r, z, rz);
  }

 private:
  ChebyshevSteps steps_;
  sk::CallOptions foldOptions_;
};

std::unique_ptr<Preconditioner> makeNone(const PreconditionerParts&) { return nullptr; }

std::unique_ptr<Preconditioner> makeJacobi(const PreconditionerParts& parts) {
  checkDiagonal(parts.a, "the preconditioner 'jacobi'");
  return std::make_unique<Diagonal>(parts, inverseDiagonal);
}

std::unique_ptr<Preconditioner> makeSpai0(const PreconditionerParts& parts) {
  return std::make_unique<Diagonal>(parts, leastSquaresDiagonal);
}

std::unique_ptr<Preconditioner> makeChebyshev(const PreconditionerParts& parts) {
  checkDiagonal(parts.a, "the preconditioner 'chebyshev'");
  return std::make_unique<Chebyshev>(parts);
}

template <Cycle cycle>
std::unique_ptr<Preconditioner> makeGeometric(const PreconditionerParts& parts) {
  if (!parts.a.isGrid())
    throw std::runtime_error(
        "multigrid needs a grid, as of 'poisson:512x512'; for matrices of files take 'aggregation' or "
        "another preconditioner");
  if (parts.matrix.layout() != "stencil")
    throw std::runtime_error("multigrid works on grids; take --layout stencil, or another preconditioner");
  const MultigridSettings settings{
      .cycle = cycle,
      .before = parts.settings.before,
      .after = parts.settings.after,
      .isSymmetric = cycle == Cycle::V && parts.settings.before == parts.settings.after};
  if (parts.a.varying != nullptr)
    return makeMultigrid(parts.device, scaled(*parts.a.varying, parts.a.scale), parts.arithmetic, settings);
  return makeMultigrid(parts.device, scaled(*parts.a.stencil, parts.a.scale), parts.arithmetic, settings);
}

constexpr PreconditionerKind preconditioners[] = {
    {"none", "the residual as it is", true, false, makeNone},
    {"jacobi", "division by the diagonal", true, false, makeJacobi},
    {"spai0", "the best diagonal approximate inverse", true, false, makeSpai0},
    {"chebyshev", "four of Chebyshev's iterations after Jacobi's scaling, for symmetric matrices", true, true,
     makeChebyshev},
    {"sor", "a sweep of over-relaxation, by groups of rows", false, false, makeSor},
    {"ssor", "a sweep forwards and one backwards", true, false, makeSsor},
    {"ic0", "incomplete Cholesky factors on the matrix's own pattern", true, true, makeIncompleteCholesky},
    {"ilu0", "incomplete LU factors on the matrix's own pattern", false, false, makeIncompleteLu},
    {"aggregation", "a V-cycle of algebraic multigrid by smoothed aggregation, for symmetric matrices", true,
     true, makeAggregation},
    {"multigrid", "a V-cycle of geometric multigrid, for grids", true, false, makeGeometric<Cycle::V>},
    {"w-cycle", "a W-cycle of it", false, false, makeGeometric<Cycle::W>},
    {"f-cycle", "an F-cycle of it", false, false, makeGeometric<Cycle::F>},
    {"full", "full multigrid: nested iteration with F-cycles", false, false, makeGeometric<Cycle::Full>},
};

}  // namespace

double HierarchyAccount::operatorComplexity() const {
  if (levels.empty() || levels[0].entries == 0) return 1.0;
  double sum = 0.0;
  for (const Level& level : levels) sum += static_cast<double>(level.entries);
  return sum / static_cast<double>(levels[0].entries);
}

void Preconditioner::update(const Operator&) {
  throw std::runtime_error(
      "the preconditioner cannot follow other values of the matrix; make it anew, or take 'jacobi'");
}

std::span<const PreconditionerKind> preconditionerKinds() { return preconditioners; }

}  // namespace linear
