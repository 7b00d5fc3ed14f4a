// SPDX-License-Identifier: MIT
//
// sk::linear: sparse systems of linear equations A x = b on a device. A Solver is made once for a matrix, and solves for any number of right-hand
// sides; solve() does both in one call. Iterations run in the precision that one asks for; the solution is in doubles, and comes with the residual that
// it really has, in double precision, and a bound of the error of this number. docs/linear.md says how, and what each choice costs.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <sk/sk.hpp>
#include <sk/sparse_matrix.hpp>

namespace sk::linear {

/// How to solve. Names are checked when a Solver is made: an error lists those that there are.
struct Options {
  std::string solver = "cg";  ///< of solvers()
  std::string preconditioner = "jacobi";  ///< of preconditioners()
  std::string layout = "auto";  ///< of layouts()
  sk::Precision precision = sk::Precision::Single;  ///< of the iterations
  sk::Storage storage = sk::Storage::Single;  ///< of vectors on the device
  std::optional<sk::Storage> entries = {};  ///< of the matrix on the device; as `storage` if it is not given
  sk::Accumulate accumulate = sk::Accumulate::Default;  ///< of scalar products
  double tolerance = 1e-8;  ///< of ||b - A x|| / ||b||, the true residual, from 0 to 1
  std::int64_t most = 10000;  ///< iterations
  /// Mixed-precision refinement: begins anew with the residual in double precision, and adds up the solutions in double precision, until the tolerance
  /// is reached. Without it, the method runs once.
  bool refines = true;
  int restart = 30;  ///< steps after which gmres begins anew, from 1 to 1000
  double omega = 1.0;  ///< the relaxation factor of sor and ssor, between 0 and 2
  /// The order in which sor, ssor, ic0, ilu0 and ilut process rows: "colours" needs few calls, "levels" needs fewer iterations.
  std::string ordering = "colours";
  /// How unknowns are renumbered internally: "rcm" moves entries closer to the diagonal. x and b keep their order.
  std::string reorder = "none";
  /// Threshold of ilut: it drops multipliers below this value, and entries below this fraction of their row's norm.
  double drop = 1e-3;
  int fill = 20;  ///< ilut keeps at most this many entries in each row of each factor
  /// Smoothing sweeps of multigrid before and after the coarse-grid correction.
  int sweepsBefore = 1, sweepsAfter = 1;
  /// Called now and then with the iterations so far, and the residual that the method computes, as a part of ||b||.
  std::function<void(std::int64_t, double)> progress = {};
};

enum class Outcome {
  Converged,
  SingularAndCompatible,  ///< converged; any constant may be added to x. Grids drop the mean of b
  SingularAndIncompatible,  ///< no x solves the equations: rows and columns add up to 0, and b does not
  MostIterations,
  Stagnated,  ///< the residual in double precision does not become smaller any more
  NotPositiveDefinite,
  Breakdown,  ///< the method would divide by 0
  NotFinite,
};
std::string_view nameOf(Outcome outcome);

/// A residual as the method computed it, as a part of ||b||.
struct HistoryPoint {
  std::int64_t iteration = 0;
  double residual = 0.0;
};

struct Solution {
  std::vector<double> x;  ///< the best that was found, whatever the outcome
  Outcome outcome = Outcome::Stagnated;
  std::int64_t iterations = 0;
  std::int64_t restarts = 0;  ///< for what was left in double precision
  /// ||b - A x|| / ||b||, computed in double precision, or in more where that is not enough; 2-norms
  double residualTrue = 0.0;
  /// A bound of the error of residualTrue: at most a hundredth of it, unless it is close to the range's end.
  double residualError = 0.0;
  double residualRecurred = 0.0;  ///< the same, as the method computed it last
  double backwardError = 0.0;  ///< ||b - A x|| / (||A|| ||x|| + ||b||); infinity norms
  std::string_view residualPlace = "host";  ///< where the true residual was computed: "device" or "host"
  /// On singular grids, the mean of b: no x reaches a constant. It was removed, and the residual is that of the rest; x has the mean 0.
  double removedMean = 0.0;
  double seconds = 0.0;
  std::vector<HistoryPoint> history;

  /// Whether the true residual is within the tolerance.
  bool isSolved() const { return outcome == Outcome::Converged || outcome == Outcome::SingularAndCompatible; }
};

/// A matrix on a device, with all that solving needs. Move-only. The device must outlive it, and calls come from one thread at a time, as for the device.
class Solver {
 public:
  /// Copies a matrix to a device. Throws sk::Error: Shape if it is not square; Misuse for an option that is unknown or out of range, entries that are not finite,
  /// and a matrix that the solver or the preconditioner cannot take, with the entry that is why: one that is not symmetric, or whose diagonal has a 0;
  /// Memory, before anything is copied, if the device is known to have too little of it.
  Solver(sk::Device& device, SparseMatrix a, const Options& options = {});
  /// Matrices of grids, which geometric multigrid can take. Of a stencil, no entry is stored.
  Solver(sk::Device& device, const Stencil& a, const Options& options = {});
  Solver(sk::Device& device, VaryingStencil a, const Options& options = {});
  Solver(Solver&&) noexcept;
  Solver& operator=(Solver&&) noexcept;
  ~Solver();

  /// Solves A x = b, from x = 0. That there is no solution within the tolerance is an outcome, not an error. Throws sk::Error if b has another size than A
  /// or elements that are not finite.
  Solution solve(std::span<const double> b);

  /// Takes other values of the entries, which are in the same places as before: nothing is allocated on the device, and what has been recorded stays, unless
  /// the solver or the preconditioner must be made anew for them (all but none, jacobi and spai0). Throws sk::Error if `a` has its entries in other places, or the matrix is
  /// of a grid, and as the constructor does; the solver then has the old matrix, or refuses to solve until an update succeeds.
  void update(const SparseMatrix& a);

  std::int64_t unknowns() const;
  /// The layout that the device has the matrix in, which is the choice of "auto".
  std::string layout() const;
  /// Entries that the layout stores, with those that only fill; 0 for a stencil.
  std::int64_t storedEntries() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

/// Solver(device, a, options).solve(b)
Solution solve(sk::Device& device, const SparseMatrix& a, std::span<const double> b,
               const Options& options = {});
Solution solve(sk::Device& device, const Stencil& a, std::span<const double> b, const Options& options = {});

/// A name that options take, and what it stands for.
struct Named {
  std::string_view name;
  std::string_view does;
};
std::vector<Named> solvers();
std::vector<Named> preconditioners();
std::vector<Named> layouts();

}  // namespace sk::linear
