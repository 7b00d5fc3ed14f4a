// SPDX-License-Identifier: MIT
#include "programs.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "constants.hpp"
#include "programs/all.hpp"

namespace race {
namespace {

/// Of so many operations and bytes for each element.
template <int operations, int bytes>
Work each(double n) {
  return {operations * n, bytes * n};
}

/// The columns of a grid of n elements.
double columnsOf(double n) { return std::exp2(std::ceil(std::log2(n) / 2)); }

Work gemvWork(double n) { return {2 * n, 4 * n}; }
Work gemmWork(double n) { return {2 * n * columnsOf(n), 4 * (2 * n + columnsOf(n) * columnsOf(n))}; }
/// Comparisons, of the best that sort by these.
Work sortWork(double n) { return {n * std::log2(n), 8 * n}; }
Work sortPairsWork(double n) { return {n * std::log2(n), 16 * n}; }
Work bodiesWork(double n) { return {20 * n * n, 28 * n}; }
/// Conjugate gradients in two passes, without a stored matrix.
Work gradientsWork(double n) {
  const double steps = gradientSteps(n);
  return {23 * n * steps, 32 * n * steps, steps};
}
Work fourierWork(double n) { return {5 * n * std::log2(n), 16 * n}; }

}  // namespace

const std::vector<Program>& programs() {
  static const std::vector<Program> table = {
      {"saxpy", "floats", {12, 16, 20, 24}, {22, 26, 28}, each<2, 12>, saxpyProblem, saxpyCheck, saxpyOurs},
      {"sum",
       "floats",
       {12, 16, 20, 24},
       {22, 26, 28},
       each<1, 4>,
       sumProblem,
       sumCheck,
       sumOurs,
       "compensated",
       compensatedSumOurs},
      {"compensated sum",
       "floats",
       {12, 16, 20, 24},
       {},
       each<1, 4>,
       sumProblem,
       compensatedSumCheck,
       compensatedSumOurs},
      {"dot", "floats", {12, 16, 20, 24}, {}, each<2, 8>, dotProblem, dotCheck, dotOurs},
      {"folded output",
       "floats",
       {12, 16, 20, 24},
       {},
       each<4, 12>,
       residualProblem,
       residualCheck,
       residualOurs,
       "in two calls",
       residualInTwoCalls},
      {"5-point stencil",
       "floats",
       {12, 16, 20, 24},
       {22, 26, 28},
       each<6, 8>,
       stencilProblem,
       heatCheck,
       heatOurs},
      {"9-point stencil",
       "floats",
       {12, 16, 20, 24},
       {},
       each<11, 8>,
       stencilProblem,
       binomialCheck,
       binomialOurs},
      // Operations depend on the picture.
      {"mandelbrot",
       "pixels",
       {12, 16, 20},
       {},
       each<0, 4>,
       grid,
       mandelbrotCheck,
       mandelbrotOurs,
       nullptr,
       nullptr,
       true},
      {"sgemv", "elements", {12, 16, 20, 24}, {}, gemvWork, gemvProblem, gemvCheck, gemvOurs},
      {"sgemm",
       "elements",
       {12, 16, 20},
       {},
       gemmWork,
       gemmProblem,
       gemmCheck,
       gemmOurs,
       nullptr,
       nullptr,
       true},
      {"prefix scan", "ints", {12, 16, 20, 24}, {}, each<1, 8>, scanProblem, scanCheck, scanOurs},
      {"compaction",
       "floats",
       {12, 16, 20, 24},
       {},
       each<1, 6>,
       compactionProblem,
       compactionCheck,
       compactionOurs},
      {"sort", "floats", {12, 16, 20, 24}, {}, sortWork, sortProblem, sortCheck, sortOurs},
      {"sort of pairs",
       "floats",
       {12, 16, 20, 24},
       {},
       sortPairsWork,
       sortProblem,
       sortPairsCheck,
       sortPairsOurs},
      {"n-body",
       "bodies",
       {10, 12, 14},
       {},
       bodiesWork,
       bodiesProblem,
       bodiesCheck,
       bodiesOurs,
       nullptr,
       nullptr,
       true},
      {"fft", "complex numbers", {12, 16, 20}, {}, fourierWork, fourierProblem, fourierCheck, fourierOurs},
      {"gray-scott",
       "elements",
       {12, 16, 20},
       {},
       each<24 * reactionSteps, 16 * reactionSteps>,
       reactionProblem,
       reactionCheck,
       reactionOurs},
      {"boiling step", "cells", {16, 20, 24}, {}, each<36, 8>, boilingProblem, boilingCheck, boilingOurs},
      {"convection step",
       "cells",
       {16, 20, 24},
       {},
       each<80, 32>,
       convectionProblem,
       convectionCheck,
       convectionOurs},
      {"reaction step",
       "cells",
       {16, 20, 24},
       {},
       each<24, 16>,
       reactionStepProblem,
       reactionStepCheck,
       reactionStepOurs},
      {"cloth step",
       "points",
       {16, 20, 24},
       {},
       each<20 + 12 * 22 * clothRounds + 40, 56>,
       clothProblem,
       clothCheck,
       clothOurs},
      {"sparse matrix",
       "rows",
       {12, 16, 20},
       {},
       each<2 * sparseRow, 8 * sparseRow + 12>,
       sparseProblem,
       sparseCheck,
       sparseOurs},
      {"power-law matrix",
       "rows",
       {20},
       {},
       each<2 * powerLawRow, 8 * powerLawRow + 12>,
       powerLawProblem,
       powerLawCheck,
       sparseOurs},
      {"5-point matrix", "rows", {24}, {}, each<10, 28>, diagonalsProblem, sparseCheck, diagonalsOurs},
      {"conjugate gradients",
       "unknowns",
       {16, 24},
       {},
       gradientsWork,
       gradientsProblem,
       gradientsCheck,
       gradientsOurs},
      {"full multigrid on a cube", "unknowns", {21}, {}, each<0, 8>, nestedProblem, nestedCheck, nestedOurs},
      {"multigrid-CG, 150^3",
       "unknowns (rounded up)",
       {22},
       {},
       each<0, 8>,
       cycledProblem,
       cycledCheck,
       cycledOurs},
      {"rays: interior, primary",
       "rays",
       {20},
       {},
       each<1, 48>,
       hallPrimaryProblem,
       hallCheck,
       hallOurs,
       "other nodes",
       hallOtherOurs},
      {"rays: interior, diffuse",
       "rays",
       {20},
       {},
       each<1, 48>,
       hallDiffuseProblem,
       hallCheck,
       hallOurs,
       "other nodes",
       hallOtherOurs},
      {"rays: organic mesh, primary",
       "rays",
       {20},
       {},
       each<1, 48>,
       meshPrimaryProblem,
       meshCheck,
       meshOurs,
       "other nodes",
       meshOtherOurs},
      {"rays: organic mesh, diffuse",
       "rays",
       {20},
       {},
       each<1, 48>,
       meshDiffuseProblem,
       meshCheck,
       meshOurs,
       "other nodes",
       meshOtherOurs},
  };
  return table;
}

Problem grid(int log2) {
  Problem p;
  p.rows = std::int64_t{1} << (log2 / 2);
  p.columns = std::int64_t{1} << (log2 - log2 / 2);
  return p;
}

std::vector<float> numbers(std::int64_t n, std::uint32_t seed, float low, float high) {
  std::vector<float> values(static_cast<std::size_t>(n));
  std::uint64_t state = seed * 0x9e3779b97f4a7c15u + 1;
  for (float& value : values) {
    // Numerical Recipes' linear congruences; the upper 24 bits are the fraction
    state = state * 6364136223846793005u + 1442695040888963407u;
    value = low + (high - low) * (static_cast<float>(state >> 40) * 0x1p-24f);
  }
  return values;
}

std::vector<std::int64_t> somePlaces(std::int64_t n, std::int64_t most) {
  if (n <= most) {
    std::vector<std::int64_t> all(static_cast<std::size_t>(n));
    std::iota(all.begin(), all.end(), 0);
    return all;
  }
  std::vector<std::int64_t> some;
  for (std::int64_t i = 0; i < most; ++i) {
    // an even spread; multiples of n / most alone would all be in few columns of a grid
    some.push_back(std::min(i * (n / most) + i % (n / most), n - 1));
  }
  some.back() = n - 1;
  return some;
}

}  // namespace race
