// SPDX-License-Identifier: MIT
#include "direct.hpp"

#include <cmath>
#include <limits>
#include <optional>

#include <fmt/format.h>
#include <Eigen/OrderingMethods>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseLU>
#include <sk/error.hpp>

#include "support/stopwatch.hpp"
#include "text/memory.hpp"

namespace linear {

namespace {

using Columns = Eigen::SparseMatrix<double>;

/// By columns.
Columns eigenOf(const SparseMatrix& a) {
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(a.value.size());
  for (std::size_t i = 0; i < static_cast<std::size_t>(a.rows); ++i)
    for (auto k = static_cast<std::size_t>(a.starts[i]); k < static_cast<std::size_t>(a.starts[i + 1]); ++k)
      entries.emplace_back(static_cast<int>(i), a.column[k], a.value[k]);
  Columns m(a.rows, a.columns);
  m.setFromTriplets(entries.begin(), entries.end());
  return m;
}

/// Entries below the diagonal of Cholesky's factor of a symmetric matrix, of which `upper` has the part above the diagonal: along the elimination tree (T. Davis, "Direct methods for sparse linear systems",
/// 2006, section 4.2), without storing them.
double entriesOfFactor(const Columns& upper) {
  const auto n = static_cast<std::size_t>(upper.cols());
  std::vector<int> parent(n, -1), seenBy(n, -1);
  double count = 0.0;
  for (int k = 0; k < upper.cols(); ++k) {
    seenBy[static_cast<std::size_t>(k)] = k;
    for (Columns::InnerIterator it(upper, k); it; ++it)
      for (int i = static_cast<int>(it.index()); i < k && seenBy[static_cast<std::size_t>(i)] != k;
           i = parent[static_cast<std::size_t>(i)]) {
        if (parent[static_cast<std::size_t>(i)] < 0) parent[static_cast<std::size_t>(i)] = k;
        seenBy[static_cast<std::size_t>(i)] = k;
        ++count;
      }
  }
  return count;
}

void requireMemory(std::int64_t unknowns, double entries, double bytesPerEntry) {
  sk::text::requireMemory(
      fmt::format("a factorisation of {} unknowns, with up to {:.3g} entries,", unknowns, entries),
      bytesPerEntry * entries);
}

/// nullopt where a pivot is 0.
std::optional<Eigen::VectorXd> solveByCholesky(const Columns& a, const Eigen::VectorXd& b,
                                               std::int64_t& entries) {
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> back;
  Columns whole = a.selfadjointView<Eigen::Lower>(), upper(a.rows(), a.cols());
  Eigen::AMDOrdering<int>()(whole, back);
  upper.selfadjointView<Eigen::Upper>() = a.selfadjointView<Eigen::Lower>().twistedBy(back.inverse());
  const double count = entriesOfFactor(upper) + static_cast<double>(a.rows());
  requireMemory(a.rows(), count, 12.0);
  entries = static_cast<std::int64_t>(count);
  const Eigen::SimplicialLDLT<Columns> factors(a);
  if (factors.info() != Eigen::Success) return std::nullopt;
  const Eigen::VectorXd x = factors.solve(b);
  return x.allFinite() ? std::optional(x) : std::nullopt;
}

/// Whatever rows are exchanged, L and U fit in twice Cholesky's factor of A^T A in the same order of columns (A. George and E. Ng, "An implementation of Gaussian elimination with partial pivoting for sparse systems", 1985).
Eigen::VectorXd solveByLu(const Columns& a, const Eigen::VectorXd& b, std::int64_t& entries) {
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> order;
  Columns compressed = a;
  compressed.makeCompressed();
  std::vector<double> lengths(static_cast<std::size_t>(a.rows()), 0.0);
  for (int k = 0; k < a.cols(); ++k)
    for (Columns::InnerIterator it(a, k); it; ++it) ++lengths[static_cast<std::size_t>(it.row())];
  double product = 0.0;
  for (const double length : lengths) product += length * length;
  requireMemory(a.rows(), product, 16.0);
  Eigen::COLAMDOrdering<int>()(compressed, order);
  Columns permuted = (compressed * order.inverse()).cwiseAbs();
  const Columns upper = Columns(permuted.transpose() * permuted).triangularView<Eigen::Upper>();
  requireMemory(a.rows(), 2.0 * (entriesOfFactor(upper) + static_cast<double>(a.rows())), 16.0);
  Eigen::SparseLU<Columns> factors;
  factors.compute(compressed);
  if (factors.info() == Eigen::Success) {
    entries = factors.nnzL() + factors.nnzU();
    const Eigen::VectorXd x = factors.solve(b);
    if (x.allFinite()) return x;
  }
  throw sk::Error(
      "the matrix is singular, so that it has no factors to solve with; leave out --direct and --judge");
}

}  // namespace

DirectSolution solveDirectly(const Operator& a, std::span<const double> b) {
  if (static_cast<std::int64_t>(b.size()) != a.size)
    throw sk::Error(
        fmt::format("the right-hand side has {} elements, and the matrix {} rows", b.size(), a.size),
        sk::Error::Kind::Shape);
  const examples::Stopwatch watch;
  DirectSolution solution;
  if (a.size == 0) return solution;
  if (a.hasConstantKernel)
    throw sk::Error("the matrix is singular, for its rows add up to 0; leave out --direct and --judge");
  const Columns m = eigenOf(sparseOf(a));
  const Eigen::VectorXd right =
      Eigen::Map<const Eigen::VectorXd>(b.data(), static_cast<Eigen::Index>(b.size()));
  std::optional<Eigen::VectorXd> x;
  if (findAsymmetry(a).empty()) x = solveByCholesky(m, right, solution.entries);
  solution.factors = x ? "L D L^T" : "L U";
  if (!x) x = solveByLu(m, right, solution.entries);
  solution.x.assign(x->begin(), x->end());
  solution.seconds = watch.milliseconds() / 1000.0;
  return solution;
}

}  // namespace linear
