// SPDX-License-Identifier: MIT
//
// Matrices and vectors as Eigen's, whose direct solvers tests compare with.
#pragma once

#include <vector>

#include <Eigen/Sparse>

#include "sparse.hpp"

namespace sk::linear {

/// The first `size` rows and columns, or all.
inline Eigen::SparseMatrix<double> eigenOf(const SparseMatrix& a, std::int64_t size) {
  std::vector<Eigen::Triplet<double>> entries;
  for (std::int64_t i = 0; i < size; ++i)
    for (auto k = static_cast<std::size_t>(a.starts[static_cast<std::size_t>(i)]);
         k < static_cast<std::size_t>(a.starts[static_cast<std::size_t>(i) + 1]); ++k)
      if (a.column[k] < size) entries.emplace_back(static_cast<int>(i), a.column[k], a.value[k]);
  Eigen::SparseMatrix<double> m(size, size);
  m.setFromTriplets(entries.begin(), entries.end());
  return m;
}

inline Eigen::SparseMatrix<double> eigenOf(const SparseMatrix& a) { return eigenOf(a, a.rows); }

inline Eigen::VectorXd vectorOf(const std::vector<double>& v) {
  return Eigen::Map<const Eigen::VectorXd>(v.data(), static_cast<Eigen::Index>(v.size()));
}

}  // namespace sk::linear
