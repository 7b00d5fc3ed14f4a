// SPDX-License-Identifier: MIT
//
// V-cycles of smoothed aggregation on a device. Nothing in a cycle waits for the host.
#include <algorithm>
#include <chrono>
#include <cstddef>

#include <fmt/format.h>

#include "aggregation.hpp"
#include "chebyshev.hpp"
#include "layout.hpp"
#include "multigrid.sk.hpp"
#include "operator.hpp"
#include "relaxation.hpp"
#include "vectors.sk.hpp"

namespace sk::linear {

namespace {

/// Chebyshev's iterations reduce errors on this part of the eigenvalues, from the largest down; the coarse level the others.
constexpr double smoothedPart = 1.0 / 5.0;
constexpr int smoothingSteps = 2;  ///< before the correction, and after it

/// A level on the device, and the transfers to the next coarser one.
struct DeviceLevel {
  DeviceLevel(sk::Device& device, Matrix& itsMatrix, const AggregationLevel& level, bool isSolved,
              const Arithmetic& arithmetic)
      : matrix(itsMatrix), flat{level.matrix.rows} {
    if (!isSolved)
      smoother =
          std::make_unique<ChebyshevSteps>(device, matrix, level.inverseDiagonal,
                                           ChebyshevSettings{.steps = smoothingSteps,
                                                             .low = smoothedPart * level.largestEigenvalue,
                                                             .high = level.largestEigenvalue},
                                           arithmetic);
    if (level.prolongator.rows == 0) return;
    prolongator = makeMatrix(device, level.prolongator, "auto", arithmetic);
    restrictor = makeMatrix(device, level.restrictor, "auto", arithmetic);
    product = device.stream<float>(matrix.domain(), arithmetic.vectors);
    residual = device.stream<float>(flat, arithmetic.vectors);
    coarseResidual = device.stream<float>(prolongator->domain(), arithmetic.vectors);
    coarseSolution = device.stream<float>(prolongator->domain(), arithmetic.vectors);
  }

  Matrix& matrix;
  sk::Shape flat;  ///< of vectors for the transfers; grids have vectors of their own shape
  std::unique_ptr<ChebyshevSteps> smoother;  ///< null where the inverse solves
  std::unique_ptr<Matrix> prolongator, restrictor;  ///< null on the coarsest level
  Vector product, residual;  ///< of the level's shape, and flat
  Vector coarseResidual, coarseSolution;
};

class Aggregation : public Preconditioner {
 public:
  explicit Aggregation(const PreconditionerParts& parts)
      : options_(parts.arithmetic.options()), foldOptions_(parts.arithmetic.foldOptions()) {
    const auto start = std::chrono::steady_clock::now();
    const AggregationHierarchy hierarchy = aggregationHierarchy(scaled(sparseOf(parts.a), parts.a.scale));
    for (std::size_t i = 0; i < hierarchy.levels.size(); ++i) {
      const AggregationLevel& level = hierarchy.levels[i];
      if (i > 0) coarse_.push_back(makeMatrix(parts.device, level.matrix, "auto", parts.arithmetic));
      Matrix& matrix = i > 0 ? *coarse_.back() : parts.matrix;
      const bool isSolved = i + 1 == hierarchy.levels.size() && !hierarchy.coarsestInverse.empty();
      levels_.emplace_back(parts.device, matrix, level, isSolved, parts.arithmetic);
      account_.levels.push_back({level.matrix.rows, level.matrix.entries(), matrix.layout()});
    }
    if (const std::int64_t n = hierarchy.levels.back().matrix.rows; !hierarchy.coarsestInverse.empty()) {
      // The elements may be too large for halves.
      inverse_ = parts.device.stream<float>({n, n}, parts.arithmetic.sums());
      inverse_.writeReals(hierarchy.coarsestInverse);
    }
    account_.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }

  void apply(const Vector& r, Vector& z, Vector& rz) override {
    cycle(0, r, z);
    dot.with(foldOptions_)(r, z, rz);
  }

  const HierarchyAccount* hierarchy() const override { return &account_; }

 private:
  /// z becomes about A^-1 b on a level.
  void cycle(std::size_t at, const Vector& b, Vector& z) {
    DeviceLevel& level = levels_[at];
    if (!level.smoother) return solve(b, z);
    level.smoother->begin(b, z);
    if (level.prolongator) {
      level.matrix.multiply(z, level.product);
      axpy.with(options_)(-1.0f, level.product.reshape(level.flat), b.reshape(level.flat), level.residual);
      level.restrictor->multiply(level.residual, level.coarseResidual);
      cycle(at + 1, level.coarseResidual, level.coarseSolution);
      level.prolongator->multiply(level.coarseSolution, level.residual);
      axpy.with(options_)(1.0f, level.residual.reshape(z.shape()), z, z);
    }
    level.smoother->advance(b, z);
  }

  void solve(const Vector& b, Vector& z) {
    const std::int64_t n = b.size();
    if (n == 0) return;
    solveCoarsest.with(options_)(static_cast<int>(n), inverse_, b.reshape({n}), z.reshape({n}));
  }

  std::vector<std::unique_ptr<Matrix>> coarse_;  ///< matrices of all levels but the first
  std::vector<DeviceLevel> levels_;
  Vector inverse_;  ///< of the coarsest matrix; none if the coarsest level is smoothed alone
  sk::CallOptions options_, foldOptions_;
  HierarchyAccount account_;
};

}  // namespace

std::unique_ptr<Preconditioner> makeAggregation(const PreconditionerParts& parts) {
  checkDiagonal(parts.a, "the preconditioner 'aggregation'");
  const auto negative = std::ranges::find_if(parts.a.diagonal, [](double d) { return d < 0.0; });
  if (negative != parts.a.diagonal.end())
    throw sk::Error(fmt::format(
        "row {} has the diagonal entry {}, and the preconditioner 'aggregation' needs positive "
        "ones, as positive definite matrices have; take the solver 'minres' and the preconditioner 'none'",
        negative - parts.a.diagonal.begin() + 1, *negative));
  return std::make_unique<Aggregation>(parts);
}

}  // namespace sk::linear
