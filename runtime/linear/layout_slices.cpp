// SPDX-License-Identifier: MIT
//
// The layout SELL-C-sigma: M. Kreutzer and others, "A unified sparse matrix data format for efficient general sparse matrix-vector
// multiplication on modern processors with wide SIMD units" (2014). Rows of similar lengths, found among `window` neighbours, share a slice, whose
// entries are stored side by side and filled to the longest row. The vectors keep their order: each row knows its slot.
#include <algorithm>
#include <limits>
#include <numeric>
#include <string>

#include <fmt/format.h>

#include "layout.hpp"
#include "products.sk.hpp"

namespace sk::linear {

namespace {

constexpr std::int64_t height = 32;
constexpr std::int64_t window = 256;

struct Slices {
  std::vector<int> slot;  ///< of each row
  std::vector<int> start;  ///< of each slice, and the end
};

Slices slicesOf(const SparseMatrix& a) {
  std::vector<std::int64_t> order(static_cast<std::size_t>(a.rows));
  std::iota(order.begin(), order.end(), 0);
  for (std::int64_t first = 0; first < a.rows; first += window)
    std::stable_sort(order.begin() + first, order.begin() + std::min(a.rows, first + window),
                     [&](std::int64_t i, std::int64_t j) { return a.length(i) > a.length(j); });
  Slices s;
  s.slot.resize(order.size());
  s.start.push_back(0);
  std::int64_t end = 0;
  for (std::int64_t first = 0; first < a.rows; first += height) {
    std::int64_t longest = 0;
    for (std::int64_t i = first; i < std::min(a.rows, first + height); ++i) {
      s.slot[static_cast<std::size_t>(order[static_cast<std::size_t>(i)])] = static_cast<int>(i);
      longest = std::max(longest, a.length(order[static_cast<std::size_t>(i)]));
    }
    end += longest * height;
    if (end > std::numeric_limits<std::int32_t>::max())
      throw sk::Error(fmt::format(
          "the layout 'slices' would hold {} entries or more; at most 2^31 - 1 can be. Try 'rows'", end));
    s.start.push_back(static_cast<int>(end));
  }
  return s;
}

/// Whether offsets of 16 bits hold all columns.
bool isNarrow(const SparseMatrix& a) {
  for (std::int64_t i = 0; i < a.rows; ++i)
    if (!hasNarrowOffsets(a, i)) return false;
  return true;
}

std::int64_t bytesOfStreams(const Slices& s, std::int64_t entryBytes, std::int64_t offsetBytes) {
  return (entryBytes + offsetBytes) * s.start.back() +
         4 * static_cast<std::int64_t>(s.slot.size() + s.start.size());
}

template <class Offset>
class SliceMatrix : public Matrix {
 public:
  SliceMatrix(sk::Device& device, const SparseMatrix& a, const Arithmetic& arithmetic)
      : Matrix(arithmetic),
        columns_(a.columns),
        slices_(slicesOf(a)),
        slot_(device.stream<int>({a.rows})),
        start_(device.stream<int>({static_cast<std::int64_t>(slices_.start.size())})),
        offset_(device.stream<Offset>({slices_.start.back()})),
        value_(device.stream<float>({slices_.start.back()}, arithmetic.matrix)) {
    // What fills a row reads its own element of x, or the last one, and multiplies it by 0.
    std::vector<Offset> offset(static_cast<std::size_t>(slices_.start.back()), 0);
    visitEntries(a, [&](std::int64_t row, std::size_t entry, std::size_t at) {
      offset[at] = static_cast<Offset>(a.column[entry] - row);
    });
    slot_.write(slices_.slot);
    start_.write(slices_.start);
    offset_.write(offset);
    update(a);
  }

  void update(const SparseMatrix& a) final {
    std::vector<double> value(static_cast<std::size_t>(value_.size()), 0.0);
    visitEntries(a, [&](std::int64_t, std::size_t entry, std::size_t at) { value[at] = a.value[entry]; });
    value_.writeReals(value);
  }
  sk::Shape domain() const override { return {columns_}; }
  sk::Shape range() const override { return slot_.shape(); }
  void multiply(const Vector& x, Vector& y) override {
    if (value_.size() == 0) return y.fill(0.0f);
    sliceProduct.with(options())(static_cast<int>(height), slot_, start_, offset_, value_, x, y);
  }
  void multiply(const Vector& x, Vector& y, Vector& xy) override {
    if (value_.size() == 0) return Matrix::multiply(x, y, xy);
    sliceProductDot.with(foldOptions())(static_cast<int>(height), slot_, start_, offset_, value_, x, x, y,
                                        xy);
  }
  std::string layout() const override { return "slices"; }
  std::int64_t stored() const override { return value_.size(); }
  std::int64_t bytes() const override { return bytesOfStreams(slices_, entryBytes(), sizeof(Offset)); }
  std::string offsetBits() const override { return std::to_string(8 * sizeof(Offset)); }

 private:
  /// Calls visit(row, entry, at) with the element of the streams that holds each entry.
  template <class Visit>
  void visitEntries(const SparseMatrix& a, Visit&& visit) const {
    for (std::int64_t i = 0; i < a.rows; ++i) {
      const std::int64_t slot = slices_.slot[static_cast<std::size_t>(i)];
      std::int64_t at = slices_.start[static_cast<std::size_t>(slot / height)] + slot % height;
      for (auto k = static_cast<std::size_t>(a.starts[static_cast<std::size_t>(i)]);
           k < static_cast<std::size_t>(a.starts[static_cast<std::size_t>(i) + 1]); ++k, at += height)
        visit(i, k, static_cast<std::size_t>(at));
    }
  }

  std::int64_t columns_;
  Slices slices_;
  sk::Stream<int> slot_, start_;
  sk::Stream<Offset> offset_;
  Vector value_;
};

}  // namespace

std::int64_t bytesOfSlices(const SparseMatrix& a, std::int64_t entryBytes) {
  return bytesOfStreams(slicesOf(a), entryBytes, isNarrow(a) ? 2 : 4);
}

std::unique_ptr<Matrix> makeSlices(sk::Device& device, const SparseMatrix& a, const Arithmetic& arithmetic) {
  if (isNarrow(a)) return std::make_unique<SliceMatrix<std::int16_t>>(device, a, arithmetic);
  return std::make_unique<SliceMatrix<std::int32_t>>(device, a, arithmetic);
}

}  // namespace sk::linear
