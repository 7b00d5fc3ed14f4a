// SPDX-License-Identifier: MIT
//
// The layouts that a sparse matrix may have on a device, and the choice between them.
#pragma once

#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include <sk/sk.hpp>

#include "matrix.hpp"
#include "sparse.hpp"

namespace sk::linear {

struct LayoutKind {
  std::string_view name;  ///< of --layout
  std::string_view does;
  /// Copies a matrix to the device. Throws sk::Error if the layout cannot hold it.
  std::unique_ptr<Matrix> (*make)(sk::Device& device, const SparseMatrix& a, const Arithmetic& arithmetic);
  /// Whether the automatic choice considers the layout for the matrix.
  bool (*suits)(const SparseMatrix& a);
  /// Bytes that the layout takes of a device, with entries of `entryBytes`: without copying anything. Not negative, also if the layout cannot hold the matrix.
  std::int64_t (*bytes)(const SparseMatrix& a, std::int64_t entryBytes);
  /// What a byte costs, natively and on other devices, beside one of "rows": solve --study layouts measures it (docs/linear.md).
  double native, others;
};

std::span<const LayoutKind> layoutKinds();

/// What a product is expected to cost with a layout: bytes of the matrix and of the elements of x that it reads, as if by "rows".
struct LayoutCost {
  std::string_view layout;
  double bytes = 0.0;
};

/// The layouts that suit a matrix, with their costs, the cheapest first. A model, not a trial: the choice depends on the matrix, its storage and the kind of device, and on nothing that else runs
/// on the machine.
std::vector<LayoutCost> layoutCosts(const sk::Device& device, const SparseMatrix& a,
                                    const Arithmetic& arithmetic);

/// Copies a matrix to the device in the named layout. "auto" takes the one with the least cost; `costs` receives all of them. Throws sk::Error for an unknown name,
/// with the known ones.
std::unique_ptr<Matrix> makeMatrix(sk::Device& device, const SparseMatrix& a, std::string_view layout,
                                   const Arithmetic& arithmetic, std::vector<LayoutCost>* costs = nullptr);

std::unique_ptr<Matrix> makeRows(sk::Device& device, const SparseMatrix& a, const Arithmetic& arithmetic);
std::unique_ptr<Matrix> makeSlices(sk::Device& device, const SparseMatrix& a, const Arithmetic& arithmetic);
std::unique_ptr<Matrix> makeBuckets(sk::Device& device, const SparseMatrix& a, const Arithmetic& arithmetic);
std::unique_ptr<Matrix> makeDiagonals(sk::Device& device, const SparseMatrix& a,
                                      const Arithmetic& arithmetic);
std::unique_ptr<Matrix> makePoints(sk::Device& device, const SparseMatrix& a, const Arithmetic& arithmetic);
std::unique_ptr<Matrix> makeDense(sk::Device& device, const SparseMatrix& a, const Arithmetic& arithmetic);

/// Bytes of the matrix in the named layout; for "auto", the fewest of those that suit it. Throws sk::Error for an unknown name.
std::int64_t bytesOf(const SparseMatrix& a, std::string_view layout, std::int64_t entryBytes);

std::int64_t bytesOfRows(const SparseMatrix& a, std::int64_t entryBytes);
std::int64_t bytesOfSlices(const SparseMatrix& a, std::int64_t entryBytes);
std::int64_t bytesOfBuckets(const SparseMatrix& a, std::int64_t entryBytes);
std::int64_t bytesOfDiagonals(const SparseMatrix& a, std::int64_t entryBytes);
std::int64_t bytesOfPoints(const SparseMatrix& a, std::int64_t entryBytes);
std::int64_t bytesOfDense(const SparseMatrix& a, std::int64_t entryBytes);

/// Whether all columns of a row are less than 2^15 from it, so that 16 bits hold an entry's offset from the diagonal.
bool hasNarrowOffsets(const SparseMatrix& a, std::int64_t row);

/// The offsets column - row of the entries, modulo the number of columns, ascending. Stops after `most` + 1 of them.
std::vector<std::int64_t> diagonalsOf(const SparseMatrix& a, std::size_t most);

}  // namespace sk::linear
