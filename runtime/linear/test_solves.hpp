// SPDX-License-Identifier: MIT
//
// What tests of solvers share: devices, vectors, ends of grids, and solves by name.
#pragma once

#include <cmath>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include "layout.hpp"
#include "method.hpp"
#include "preconditioner.hpp"
#include "solve.hpp"
#include "sparse.hpp"
#include "stencil.hpp"
#include "text/named.hpp"

namespace sk::linear {

/// Native code, or the profile of this name on a software renderer.
inline sk::Device deviceNamed(const std::string& name) {
  if (name == "native") return sk::Device::native();
  return sk::Device({.device = "software", .profile = name});
}

/// Native code, fragment programs and compute programs.
inline std::vector<sk::Device> testDevices() {
  std::vector<sk::Device> all;
  for (const char* name : {"native", "essl300", "glsl430"}) all.push_back(deviceNamed(name));
  return all;
}

inline constexpr Arithmetic doubles{
    .precision = sk::Precision::Double, .matrix = sk::Storage::Double, .vectors = sk::Storage::Double};
inline constexpr Ends fixedEnds{Side::Dirichlet, Side::Dirichlet}, mirrors{Side::Neumann, Side::Neumann},
    ring{Side::Periodic, Side::Periodic}, mixed{Side::Dirichlet, Side::Neumann},
    turned{Side::Neumann, Side::Dirichlet};

inline std::vector<double> randomVector(std::int64_t n, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<double> v(static_cast<std::size_t>(n));
  for (double& x : v) x = std::uniform_real_distribution<double>(-1, 1)(random);
  return v;
}

inline std::vector<double> wavy(std::int64_t n) {
  std::vector<double> x;
  for (std::int64_t i = 0; i < n; ++i) x.push_back(1.0 + 0.5 * std::sin(1.7 * static_cast<double>(i)));
  return x;
}

inline double norm(const std::vector<double>& v) {
  double sum = 0.0;
  for (const double x : v) sum += x * x;
  return std::sqrt(sum);
}

/// Entries that floats do not have, and a condition that grows as 30^n.
inline SparseMatrix hilbert(std::int64_t n) {
  std::vector<Entry> entries;
  for (std::int64_t i = 0; i < n; ++i)
    for (std::int64_t j = 0; j < n; ++j) entries.push_back({i, j, 1.0 / static_cast<double>(i + j + 1)});
  return assemble(n, n, entries);
}

/// A - shift I, which is indefinite if that is between eigenvalues.
inline SparseMatrix shifted(SparseMatrix a, double shift) {
  for (std::size_t i = 0; i + 1 < a.starts.size(); ++i)
    for (auto k = static_cast<std::size_t>(a.starts[i]); k < static_cast<std::size_t>(a.starts[i + 1]); ++k)
      if (a.column[k] == static_cast<std::int32_t>(i)) a.value[k] -= shift;
  return a;
}

struct Choice {
  std::string_view solver = "cg", preconditioner = "jacobi", layout = "slices";
  Arithmetic arithmetic = {};
  SolveSettings settings = {};
  std::string_view ordering = "colours";
  MethodSettings method = {};
};

/// Solves A x = b, where `matrix` is A as the device has it.
inline Solution solveBy(sk::Device& device, Matrix& matrix, const Operator& a, const std::vector<double>& b,
                        Choice choice) {
  const auto preconditioner = text::rowNamed(preconditionerKinds(), choice.preconditioner, "preconditioner")
                                  .make(device, matrix, a, choice.arithmetic, {.ordering = choice.ordering});
  choice.method.a = &a;
  const auto method = text::rowNamed(methodKinds(), choice.solver, "solver")
                          .make(device, matrix, preconditioner.get(), choice.arithmetic, choice.method);
  return solve(*method, a, b, choice.arithmetic, choice.settings);
}

inline Solution solveWith(sk::Device& device, const SparseMatrix& a, const std::vector<double>& b,
                          const Choice& choice) {
  const Operator o = operatorOf(a);
  return solveBy(device, *makeMatrix(device, scaled(a, o.scale), choice.layout, choice.arithmetic), o, b,
                 choice);
}

}  // namespace sk::linear
