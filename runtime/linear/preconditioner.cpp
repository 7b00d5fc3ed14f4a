// SPDX-License-Identifier: MIT
#include "preconditioner.hpp"

#include <algorithm>
#include <vector>

#include "aggregation.hpp"
#include "chebyshev.hpp"
#include "multigrid.hpp"
#include "operator.hpp"
#include "relaxation.hpp"
#include "vectors.sk.hpp"

namespace sk::linear {

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
        entries_(parts.matrix.space(parts.device).stream<float>(parts.arithmetic.vectors)),
        foldOptions_(parts.arithmetic.foldOptions()) {
    update(parts.a);
  }
  bool isUpdatable() const override { return true; }
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
  // The best entry for such a row is 0, and nothing would be left of its residual.
  checkDiagonal(parts.a, "the preconditioner 'spai0'");
  return std::make_unique<Diagonal>(parts, leastSquaresDiagonal);
}

std::unique_ptr<Preconditioner> makeChebyshev(const PreconditionerParts& parts) {
  checkDiagonal(parts.a, "the preconditioner 'chebyshev'");
  return std::make_unique<Chebyshev>(parts);
}

template <Cycle cycle>
std::unique_ptr<Preconditioner> makeGeometric(const PreconditionerParts& parts) {
  if (!parts.a.isGrid())
    throw sk::Error(
        "multigrid needs a grid, as of 'poisson:512x512'; for matrices of files take 'aggregation' or "
        "another preconditioner");
  if (parts.matrix.layout() != "stencil")
    throw sk::Error("multigrid works on grids; take the layout 'stencil', or another preconditioner");
  const MultigridSettings settings{
      .cycle = cycle,
      .before = parts.settings.before,
      .after = parts.settings.after,
      .isSymmetric = cycle == Cycle::V && parts.settings.before == parts.settings.after};
  const Space space = parts.matrix.space(parts.device);
  if (parts.a.varying != nullptr)
    return makeMultigrid(space, scaled(*parts.a.varying, parts.a.scale), parts.arithmetic, settings);
  return makeMultigrid(space, scaled(*parts.a.stencil, parts.a.scale), parts.arithmetic, settings);
}

constexpr PreconditionerKind preconditioners[] = {
    {"none", "the residual as it is", true, false, makeNone},
    {"jacobi", "division by the diagonal", true, false, makeJacobi, 1.0},
    {"spai0", "the best diagonal approximate inverse", true, false, makeSpai0, 1.0},
    {"chebyshev", "four of Chebyshev's iterations after Jacobi's scaling, for symmetric matrices", true, true,
     makeChebyshev, 3.0},
    {"sor", "a sweep of over-relaxation, by groups of rows", false, false, makeSor, 5.0, 0.5, false},
    {"ssor", "a sweep forwards and one backwards", true, false, makeSsor, 6.0, 1.0, false},
    {"ic0", "incomplete Cholesky factors on the matrix's own pattern", true, true, makeIncompleteCholesky,
     6.0, 1.0, false},
    {"ilu0", "incomplete LU factors on the matrix's own pattern", false, false, makeIncompleteLu, 6.0, 1.0,
     false},
    {"ilut", "incomplete LU factors with the largest entries of each row (Saad 1994)", false, false,
     makeThresholdLu, 6.0, 4.0, false},
    {"aggregation", "a V-cycle of algebraic multigrid by smoothed aggregation, for symmetric matrices", true,
     true, makeAggregation, 6.0, 0.8, false},
    {"multigrid", "a V-cycle of geometric multigrid, for grids", true, false, makeGeometric<Cycle::V>, 4.0,
     0.0, true, true},
    {"w-cycle", "a W-cycle of it", false, false, makeGeometric<Cycle::W>, 4.0, 0.0, true, true},
    {"f-cycle", "an F-cycle of it", false, false, makeGeometric<Cycle::F>, 4.0, 0.0, true, true},
    {"full", "full multigrid: nested iteration with F-cycles", false, false, makeGeometric<Cycle::Full>, 4.0,
     0.0, true, true},
};

}  // namespace

double HierarchyAccount::operatorComplexity() const {
  if (levels.empty() || levels[0].entries == 0) return 1.0;
  double sum = 0.0;
  for (const Level& level : levels) sum += static_cast<double>(level.entries);
  return sum / static_cast<double>(levels[0].entries);
}

void Preconditioner::update(const Operator&) {
  throw sk::Error(
      "the preconditioner cannot follow other values of the matrix; make it anew, or take 'jacobi'");
}

std::span<const PreconditionerKind> preconditionerKinds() { return preconditioners; }

}  // namespace sk::linear
