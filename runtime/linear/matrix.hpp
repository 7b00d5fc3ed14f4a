// SPDX-License-Identifier: MIT
//
// A matrix on a device, whatever its layout, and the precisions that a solver may choose between.
#pragma once

#include <cstdint>
#include <string>

#include <sk/sk.hpp>

#include "grid_stream.hpp"

namespace sk::linear {

struct SparseMatrix;

/// On a device, or divided over ranks.
using Vector = GridStream<float>;

/// What numbers are computed in and stored as. The defaults are floats, with compensated sums.
struct Arithmetic {
  sk::Precision precision = sk::Precision::Single;
  sk::Storage matrix = sk::Storage::Single;  ///< of the entries
  sk::Storage vectors = sk::Storage::Single;
  sk::Accumulate accumulate = sk::Accumulate::Default;

  /// Options of calls without folded outputs; reductions and calls that fold take foldOptions().
  sk::CallOptions options() const { return {.precision = precision}; }
  sk::CallOptions foldOptions() const { return {.accumulate = accumulate, .precision = precision}; }
  /// Sums keep all bits that they are computed in.
  sk::Storage sums() const {
    if (precision == sk::Precision::Double) return sk::Storage::Double;
    return precision == sk::Precision::Extended ? sk::Storage::Extended : sk::Storage::Single;
  }
  /// Half the distance from 1 to the next number that vectors and computations can hold.
  double roundoff() const;
};

/// Bytes of a float in a stream.
std::int64_t bytesOf(sk::Storage storage);

class Matrix {
 public:
  virtual ~Matrix() = default;

  /// The shapes of x and y in y = A x.
  virtual sk::Shape domain() const = 0;
  virtual sk::Shape range() const { return domain(); }
  /// Where vectors of the domain are. A matrix that is divided over ranks says so; others are on `device`.
  virtual Space space(sk::Device& device) const { return {device, domain()}; }

  /// y = A x. x and y are different streams.
  virtual void multiply(const Vector& x, Vector& y) = 0;
  /// The same, and xy, of one element, becomes x . y. Only for square matrices.
  virtual void multiply(const Vector& x, Vector& y, Vector& xy);

  /// y = A x, computed in another arithmetic than the matrix was made for: its entries stay as they are stored.
  void multiplyIn(const Arithmetic& arithmetic, const Vector& x, Vector& y);

  /// Whether an iteration of conjugate gradients costs less in two passes, of which each computes A p.
  virtual bool isFused() const { return false; }
  /// p <- r + (rr / before) p, or r if before is 0, and pq, of one element, becomes p . A p.
  virtual void fusedDirection(const Vector& rr, const Vector& before, const Vector& r, Vector& p, Vector& pq);
  /// x <- x + (rr / pq) p and r <- r - (rr / pq) A p, and next, of one element, becomes r . r.
  virtual void fusedStep(const Vector& rr, const Vector& pq, const Vector& p, Vector& x, Vector& r,
                         Vector& next);

  /// Writes other values of the entries to the streams, which recorded loops follow. `a` has the entries in the places of the matrix that
  /// this one was made of. Throws sk::Error for a layout that does not come from a sparse matrix.
  virtual void update(const SparseMatrix& a);

  /// The layout's name, as --layout takes it.
  virtual std::string layout() const = 0;
  /// Bits of the offsets from the diagonal that stand for columns, "16", "32" or "16 and 32"; "" if the layout has no such offsets.
  virtual std::string offsetBits() const { return ""; }
  /// Entries that the layout stores, those that only fill included.
  virtual std::int64_t stored() const = 0;
  /// Bytes of the matrix that one product reads.
  virtual std::int64_t bytes() const = 0;

 protected:
  explicit Matrix(const Arithmetic& arithmetic)
      : vectors_(arithmetic.vectors),
        options_(arithmetic.options()),
        foldOptions_(arithmetic.foldOptions()),
        entryBytes_(bytesOf(arithmetic.matrix)) {}
  std::int64_t entryBytes() const { return entryBytes_; }
  const sk::CallOptions& options() const { return options_; }
  const sk::CallOptions& foldOptions() const { return foldOptions_; }
  /// Whether scatter outputs hold y = A x as it is computed and stored. Except natively, they hold floats.
  bool scatters(sk::Device& device) const;

 private:
  sk::Storage vectors_;
  sk::CallOptions options_, foldOptions_;
  std::int64_t entryBytes_;
};

}  // namespace sk::linear
