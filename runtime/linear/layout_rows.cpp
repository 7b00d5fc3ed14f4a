// SPDX-License-Identifier: MIT
//
// The layouts that hold a row's entries one after the other, or all elements of a row.
#include <algorithm>
#include <limits>

#include <fmt/format.h>

#include "layout.hpp"
#include "products.sk.hpp"

namespace sk::linear {

namespace {

class RowsMatrix : public Matrix {
 public:
  RowsMatrix(sk::Device& device, const SparseMatrix& a, const Arithmetic& arithmetic)
      : Matrix(arithmetic),
        rows_(a.rows),
        columns_(a.columns),
        rowsOf_(startsOf(device, a)),
        value_(device.stream<float>({a.entries()}, arithmetic.matrix)),
        column_(device.stream<int>({a.entries()})),
        bytes_(bytesOfRows(a, entryBytes())) {
    update(a);
    column_.write(a.column);
  }

  void update(const SparseMatrix& a) final { value_.writeReals(a.value); }
  sk::Shape domain() const override { return {columns_}; }
  sk::Shape range() const override { return {rows_}; }
  using Matrix::multiply;
  void multiply(const Vector& x, Vector& y) override {
    rowProduct.with(foldOptions())(rowsOf_(value_), rowsOf_(column_), x, y);
  }
  std::string layout() const override { return "rows"; }
  std::int64_t stored() const override { return value_.size(); }
  std::int64_t bytes() const override { return bytes_; }

 private:
  static sk::Stream<int> startsOf(sk::Device& device, const SparseMatrix& a) {
    if (a.entries() > std::numeric_limits<std::int32_t>::max())
      throw sk::Error(fmt::format("the layout 'rows' holds at most 2^31 - 1 entries, not {}", a.entries()));
    auto starts = device.stream<int>({a.rows + 1});
    starts.write(std::vector<int>(a.starts.begin(), a.starts.end()));
    return starts;
  }

  std::int64_t rows_, columns_;
  sk::Rows rowsOf_;
  Vector value_;
  sk::Stream<int> column_;
  std::int64_t bytes_;
};

class DenseMatrix : public Matrix {
 public:
  DenseMatrix(sk::Device& device, const SparseMatrix& a, const Arithmetic& arithmetic)
      : Matrix(arithmetic), value_(device.stream<float>({a.rows, a.columns}, arithmetic.matrix)) {
    update(a);
  }

  void update(const SparseMatrix& a) final {
    std::vector<double> values(static_cast<std::size_t>(a.rows * a.columns), 0.0);
    for (std::int64_t i = 0; i < a.rows; ++i)
      for (auto k = static_cast<std::size_t>(a.starts[static_cast<std::size_t>(i)]);
           k < static_cast<std::size_t>(a.starts[static_cast<std::size_t>(i) + 1]); ++k)
        values[static_cast<std::size_t>(i * a.columns + a.column[k])] = a.value[k];
    value_.writeReals(values);
  }

  sk::Shape domain() const override { return {value_.shape()[1]}; }
  sk::Shape range() const override { return {value_.shape()[0]}; }
  using Matrix::multiply;
  void multiply(const Vector& x, Vector& y) override {
    const sk::Shape shape = value_.shape();
    if (shape.size() == 0) return y.fill(0.0f);
    denseProduct.with(foldOptions())(value_, x.reshape({1, shape[1]}), y.reshape({shape[0], 1}));
  }
  std::string layout() const override { return "dense"; }
  std::int64_t stored() const override { return value_.size(); }
  std::int64_t bytes() const override { return entryBytes() * value_.size(); }

 private:
  Vector value_;
};

}  // namespace

std::int64_t bytesOfRows(const SparseMatrix& a, std::int64_t entryBytes) {
  return (entryBytes + 4) * a.entries() + 4 * (a.rows + 1);
}

std::int64_t bytesOfDense(const SparseMatrix& a, std::int64_t entryBytes) {
  return entryBytes * a.rows * a.columns;
}

std::unique_ptr<Matrix> makeRows(sk::Device& device, const SparseMatrix& a, const Arithmetic& arithmetic) {
  return std::make_unique<RowsMatrix>(device, a, arithmetic);
}

std::unique_ptr<Matrix> makeDense(sk::Device& device, const SparseMatrix& a, const Arithmetic& arithmetic) {
  constexpr std::int64_t most = std::int64_t{1} << 28;
  if (a.rows * a.columns > most)
    throw sk::Error(
        fmt::format("the layout 'dense' would hold {} x {} elements; take a sparse one", a.rows, a.columns));
  return std::make_unique<DenseMatrix>(device, a, arithmetic);
}

}  // namespace sk::linear
