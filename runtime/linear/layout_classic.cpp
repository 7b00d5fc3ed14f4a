// SPDX-License-Identifier: MIT
//
// The layouts of the first papers about linear algebra on GPUs: diagonals and points (J. Krueger and R. Westermann, "Linear algebra
// operators for GPU implementation of numerical algorithms", 2003), and rows of one length together (J. Bolz, I. Farmer, E. Grinspun and P. Schroeder, "Sparse
// matrix solvers on the GPU: conjugate gradients and multigrid", 2003).
#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <span>

#include <fmt/format.h>

#include "layout.hpp"
#include "products.sk.hpp"

namespace sk::linear {

namespace {

constexpr std::size_t mostStoredDiagonals = 4096;

/// The entries of a matrix, one diagonal after the other; 0 where it has none.
std::vector<double> entriesByDiagonal(const SparseMatrix& a, const std::vector<std::int64_t>& offsets) {
  std::vector<double> entries(offsets.size() * static_cast<std::size_t>(a.rows), 0.0);
  for (std::int64_t i = 0; i < a.rows; ++i)
    for (auto k = static_cast<std::size_t>(a.starts[static_cast<std::size_t>(i)]);
         k < static_cast<std::size_t>(a.starts[static_cast<std::size_t>(i) + 1]); ++k) {
      const std::int64_t offset = (a.column[k] - i + a.columns) % a.columns;
      const auto diagonal = std::lower_bound(offsets.begin(), offsets.end(), offset) - offsets.begin();
      entries[static_cast<std::size_t>(diagonal * a.rows + i)] = a.value[k];
    }
  return entries;
}

/// A diagonal's offset the shorter way around, so that most elements are not beyond an end.
int shorterWay(std::int64_t offset, std::int64_t rows) {
  return static_cast<int>(2 * offset > rows ? offset - rows : offset);
}

/// Diagonals i and i - n share a stream: its element at row r is the entry of column (r + i) mod n.
class DiagonalMatrix : public Matrix {
 public:
  DiagonalMatrix(sk::Device& device, const SparseMatrix& a, const std::vector<std::int64_t>& offsets,
                 const Arithmetic& arithmetic)
      : Matrix(arithmetic),
        count_(static_cast<int>(offsets.size())),
        offsets_(offsets),
        value_(device.stream<float>({count_, a.rows}, arithmetic.matrix)),
        offset_(device.stream<int>({count_})) {
    update(a);
    std::vector<int> shortest;
    for (const std::int64_t offset : offsets) shortest.push_back(shorterWay(offset, a.rows));
    offset_.write(shortest);
  }

  void update(const SparseMatrix& a) final { value_.writeReals(entriesByDiagonal(a, offsets_)); }

  sk::Shape domain() const override { return {value_.shape()[1]}; }
  void multiply(const Vector& x, Vector& y) override {
    if (value_.size() == 0) return y.fill(0.0f);
    diagonalProduct.with(options())(count_, value_, offset_, x, y);
  }
  void multiply(const Vector& x, Vector& y, Vector& xy) override {
    if (value_.size() == 0) return Matrix::multiply(x, y, xy);
    diagonalProductDot.with(foldOptions())(count_, value_, offset_, x, x, y, xy);
  }
  std::string layout() const override { return "diagonals"; }
  std::int64_t stored() const override { return value_.size(); }
  std::int64_t bytes() const override { return entryBytes() * value_.size(); }

 private:
  int count_;
  std::vector<std::int64_t> offsets_;  ///< ascending, from 0
  Vector value_;
  sk::Stream<int> offset_;
};

/// The same, with a stream for each row of that matrix: passes sum up to eight of them.
class SplitDiagonals : public Matrix {
 public:
  SplitDiagonals(sk::Device& device, const SparseMatrix& a, const std::vector<std::int64_t>& offsets,
                 const Arithmetic& arithmetic)
      : Matrix(arithmetic), rows_(a.rows), offsets_(offsets) {
    for (std::size_t k = 0; k < offsets.size(); ++k)
      values_.push_back(device.stream<float>({rows_}, arithmetic.matrix));
    update(a);
  }

  void update(const SparseMatrix& a) final {
    const std::vector<double> entries = entriesByDiagonal(a, offsets_);
    const auto rows = static_cast<std::size_t>(rows_);
    for (std::size_t k = 0; k < values_.size(); ++k)
      values_[k].writeReals(std::span(entries).subspan(k * rows, rows));
  }

  sk::Shape domain() const override { return {rows_}; }
  void multiply(const Vector& x, Vector& y) override {
    if (stored() == 0) return y.fill(0.0f);
    forEachPass([&](std::size_t first) { pass(first, x, y); });
  }
  void multiply(const Vector& x, Vector& y, Vector& xy) override {
    if (stored() == 0) return Matrix::multiply(x, y, xy);
    forEachPass([&](std::size_t first) {
      if (first + inPass < offsets_.size()) return pass(first, x, y);
      eightDiagonalsDot.with(foldOptions())(
          passFrom(first, x), before(first, y), values_[first], value(first + 1), value(first + 2),
          value(first + 3), value(first + 4), value(first + 5), value(first + 6), value(first + 7), x, y, xy);
    });
  }
  std::string layout() const override { return "diagonals"; }
  std::int64_t stored() const override { return rows_ * static_cast<std::int64_t>(offsets_.size()); }
  std::int64_t bytes() const override { return entryBytes() * stored(); }

 private:
  using Diagonal = sk::Optional<sk::ElementIn<float>>;
  static constexpr std::size_t inPass = 8;

  template <class Pass>
  void forEachPass(Pass&& pass) const {
    for (std::size_t first = 0; first < offsets_.size(); first += inPass) pass(first);
  }
  void pass(std::size_t first, const Vector& x, Vector& y) const {
    eightDiagonals.with(options())(passFrom(first, x), before(first, y), values_[first], value(first + 1),
                                   value(first + 2), value(first + 3), value(first + 4), value(first + 5),
                                   value(first + 6), value(first + 7), y);
  }

  /// What the kernels take of a pass from diagonal `first` on.
  Pass passFrom(std::size_t first, const Vector& x) const {
    std::array<int, inPass> shortest{};
    const std::size_t count = std::min(inPass, offsets_.size() - first);
    for (std::size_t k = 0; k < count; ++k) shortest[k] = shorterWay(offsets_[first + k], rows_);
    const auto& [a, b, c, d, e, f, g, h] = shortest;
    return {.count = static_cast<int>(count),
            .adds = first > 0,
            .offset = Offsets{{a, b, c, d}, {e, f, g, h}},
            .x = x};
  }
  Diagonal value(std::size_t k) const {
    return k < values_.size() ? Diagonal(values_[k]) : Diagonal(sk::none);
  }
  static Diagonal before(std::size_t first, const Vector& y) {
    return first > 0 ? Diagonal(y) : Diagonal(sk::none);
  }

  std::int64_t rows_;
  std::vector<std::int64_t> offsets_;  ///< ascending, from 0
  std::vector<Vector> values_;
};

class PointMatrix : public Matrix {
 public:
  PointMatrix(sk::Device& device, const SparseMatrix& a, const Arithmetic& arithmetic)
      : Matrix(arithmetic),
        device_(device),
        rows_(a.rows),
        columns_(a.columns),
        value_(device.stream<float>({a.entries()}, arithmetic.matrix)),
        row_(device.stream<int>({a.entries()})),
        column_(device.stream<int>({a.entries()})) {
    std::vector<int> row;
    row.reserve(a.column.size());
    for (std::int64_t i = 0; i < a.rows; ++i) {
      row.insert(row.end(), static_cast<std::size_t>(a.length(i)), static_cast<int>(i));
      starts_.push_back(static_cast<int>(a.starts[static_cast<std::size_t>(i)]));
    }
    starts_.push_back(static_cast<int>(a.entries()));
    if (!scatters(device)) groupRows();
    update(a);
    row_.write(row);
    column_.write(a.column);
  }

  void update(const SparseMatrix& a) final { value_.writeReals(a.value); }
  sk::Shape domain() const override { return {columns_}; }
  sk::Shape range() const override { return {rows_}; }
  using Matrix::multiply;
  void multiply(const Vector& x, Vector& y) override {
    if (!scatters(device_) && value_.size() != 0) {
      if (!rowsOf_) groupRows();
      rowProduct.with(foldOptions())((*rowsOf_)(value_), (*rowsOf_)(column_), x, y);
      return;
    }
    y.fill(0.0f);
    if (value_.size() != 0) pointProduct.with(options())(value_, row_, column_, x, y);
  }
  std::string layout() const override { return "points"; }
  std::int64_t stored() const override { return value_.size(); }
  std::int64_t bytes() const override { return (entryBytes() + 8) * value_.size(); }

 private:
  /// For sums that scatter outputs cannot hold: entries are in the order of their rows, and are added row by row.
  void groupRows() {
    auto starts = device_.stream<int>({rows_ + 1});
    starts.write(starts_);
    rowsOf_.emplace(starts);
  }

  sk::Device& device_;
  std::int64_t rows_, columns_;
  Vector value_;
  sk::Stream<int> row_, column_;
  std::vector<int> starts_;
  std::optional<sk::Rows> rowsOf_;
};

using RowsByLength = std::map<std::int64_t, std::vector<int>>;

RowsByLength rowsByLengthOf(const SparseMatrix& a) {
  RowsByLength rows;
  for (std::int64_t i = 0; i < a.rows; ++i) rows[a.length(i)].push_back(static_cast<int>(i));
  return rows;
}

/// Rows of one length: entry k of all rows is in row k of the streams. Columns are stored as offsets from the row, in 16 bits where all of the bucket's rows allow it.
struct Bucket {
  Bucket(sk::Device& device, const SparseMatrix& a, std::vector<int> itsRows, const Arithmetic& arithmetic)
      : rows(std::move(itsRows)),
        length(static_cast<int>(a.length(rows.front()))),
        value(device.stream<float>({length, rows.size()}, arithmetic.matrix)),
        row(device.stream<int>({rows.size()})) {
    update(a);
    row.write(rows);
    if (isNarrow(a, rows))
      writeOffsets(narrow, device, a);
    else
      writeOffsets(wide, device, a);
  }

  static bool isNarrow(const SparseMatrix& a, const std::vector<int>& rows) {
    return std::ranges::all_of(rows, [&](int i) { return hasNarrowOffsets(a, i); });
  }

  void update(const SparseMatrix& a) {
    value.writeReals(transposed<double>(a, [&](std::size_t entry, int) { return a.value[entry]; }));
  }

  template <class Offset>
  void writeOffsets(sk::Stream<Offset>& offset, sk::Device& device, const SparseMatrix& a) const {
    offset = device.stream<Offset>(value.shape());
    offset.write(transposed<Offset>(
        a, [&](std::size_t entry, int i) { return static_cast<Offset>(a.column[entry] - i); }));
  }

  /// of(entry, row) of the rows' entries, entry by entry.
  template <class T, class Of>
  std::vector<T> transposed(const SparseMatrix& a, Of&& of) const {
    std::vector<T> elements(static_cast<std::size_t>(length) * rows.size());
    for (std::size_t i = 0; i < rows.size(); ++i)
      for (std::size_t k = 0; k < static_cast<std::size_t>(length); ++k)
        elements[k * rows.size() + i] =
            of(static_cast<std::size_t>(a.starts[static_cast<std::size_t>(rows[i])]) + k, rows[i]);
    return elements;
  }

  void multiply(const sk::CallOptions& options, const Vector& x, Vector& y) {
    if (narrow)
      bucketProduct.with(options)(length, value, narrow, row, x, y);
    else
      bucketProduct.with(options)(length, value, wide, row, x, y);
  }
  /// The same, one row's sum after the other.
  void multiplyInOrder(const sk::CallOptions& options, const Vector& x, sk::View<float> sums) {
    if (narrow)
      bucketSums.with(options)(length, value, narrow, row, x, sums);
    else
      bucketSums.with(options)(length, value, wide, row, x, sums);
  }

  std::vector<int> rows;
  int length;
  Vector value;
  sk::Stream<int> row;
  sk::Stream<std::int16_t> narrow;  ///< one of the two
  sk::Stream<std::int32_t> wide;
};

class BucketMatrix : public Matrix {
 public:
  BucketMatrix(sk::Device& device, const SparseMatrix& a, const RowsByLength& rowsByLength,
               const Arithmetic& arithmetic)
      : Matrix(arithmetic),
        device_(device),
        rows_(a.rows),
        columns_(a.columns),
        bytes_(bytesOfBuckets(a, bytesOf(arithmetic.matrix))) {
    for (const auto& [length, rows] : rowsByLength)
      if (length > 0) buckets_.emplace_back(device, a, rows, arithmetic);
    hasEmptyRows_ = rowsByLength.contains(0);
    if (!scatters(device)) order();
  }

  void update(const SparseMatrix& a) final {
    for (Bucket& b : buckets_) b.update(a);
  }
  sk::Shape domain() const override { return {columns_}; }
  sk::Shape range() const override { return {rows_}; }
  using Matrix::multiply;
  void multiply(const Vector& x, Vector& y) override {
    if (!scatters(device_) && !buckets_.empty()) return multiplyInOrder(x, y);
    if (hasEmptyRows_ || buckets_.empty()) y.fill(0.0f);
    for (Bucket& b : buckets_) b.multiply(options(), x, y);
  }
  std::string layout() const override { return "buckets"; }
  std::int64_t stored() const override {
    std::int64_t sum = 0;
    for (const Bucket& b : buckets_) sum += b.value.size();
    return sum;
  }
  std::int64_t bytes() const override { return bytes_; }
  std::string offsetBits() const override {
    const auto isNarrow = [](const Bucket& b) { return static_cast<bool>(b.narrow); };
    if (std::ranges::all_of(buckets_, isNarrow)) return "16";
    return std::ranges::none_of(buckets_, isNarrow) ? "32" : "16 and 32";
  }

 private:
  /// For sums that scatter outputs cannot hold: they go to a stream in the order of the buckets, from which rows take them.
  void order() {
    std::vector<int> place(static_cast<std::size_t>(rows_), -1);
    int next = 0;
    for (const Bucket& b : buckets_)
      for (const int row : b.rows) place[static_cast<std::size_t>(row)] = next++;
    place_ = device_.stream<int>({rows_});
    place_.write(place);
    sums_ = device_.stream<float>({next}, sk::Storage::Double);
  }
  void multiplyInOrder(const Vector& x, Vector& y) {
    if (!sums_) order();
    std::int64_t first = 0;
    for (Bucket& b : buckets_) {
      const auto last = first + static_cast<std::int64_t>(b.rows.size());
      b.multiplyInOrder(options(), x, sums_.domain({first}, {last}));
      first = last;
    }
    takeSums.with(options())(place_, sums_, y);
  }

  sk::Device& device_;
  std::int64_t rows_, columns_, bytes_;
  std::vector<Bucket> buckets_;
  bool hasEmptyRows_ = false;
  sk::Stream<int> place_;  ///< of a row's sum, or -1
  sk::Stream<float> sums_;
};

}  // namespace

std::int64_t bytesOfDiagonals(const SparseMatrix& a, std::int64_t entryBytes) {
  return entryBytes * a.rows * static_cast<std::int64_t>(diagonalsOf(a, mostStoredDiagonals).size());
}

std::int64_t bytesOfPoints(const SparseMatrix& a, std::int64_t entryBytes) {
  return (entryBytes + 8) * a.entries();
}

std::int64_t bytesOfBuckets(const SparseMatrix& a, std::int64_t entryBytes) {
  std::int64_t sum = 0;
  for (const auto& [length, rows] : rowsByLengthOf(a))
    if (length > 0)
      sum += static_cast<std::int64_t>(rows.size()) *
             (length * (entryBytes + (Bucket::isNarrow(a, rows) ? 2 : 4)) + 4);
  return sum;
}

std::unique_ptr<Matrix> makeDiagonals(sk::Device& device, const SparseMatrix& a,
                                      const Arithmetic& arithmetic) {
  if (a.rows != a.columns)
    throw sk::Error(
        fmt::format("the layout 'diagonals' takes square matrices; this one has {} x {}", a.rows, a.columns));
  constexpr std::int64_t mostValues = std::int64_t{1} << 28;
  const std::vector<std::int64_t> offsets = diagonalsOf(a, mostStoredDiagonals);
  if (offsets.size() > mostStoredDiagonals || static_cast<std::int64_t>(offsets.size()) * a.rows > mostValues)
    throw sk::Error("the matrix has too many diagonals for the layout 'diagonals'; take 'rows' or 'slices'");
  // Natively, the loop over one stream takes a third of the time; GPUs take half of the time for several.
  if (device.profile() == "native") return std::make_unique<DiagonalMatrix>(device, a, offsets, arithmetic);
  return std::make_unique<SplitDiagonals>(device, a, offsets, arithmetic);
}

std::unique_ptr<Matrix> makePoints(sk::Device& device, const SparseMatrix& a, const Arithmetic& arithmetic) {
  return std::make_unique<PointMatrix>(device, a, arithmetic);
}

std::unique_ptr<Matrix> makeBuckets(sk::Device& device, const SparseMatrix& a, const Arithmetic& arithmetic) {
  constexpr std::size_t most = 256;  // each is a call, and a program
  const RowsByLength rowsByLength = rowsByLengthOf(a);
  if (rowsByLength.size() > most)
    throw sk::Error(fmt::format(
        "the rows have {} different lengths, and the layout 'buckets' takes {}; take 'rows' or 'slices'",
        rowsByLength.size(), most));
  return std::make_unique<BucketMatrix>(device, a, rowsByLength, arithmetic);
}

}  // namespace sk::linear
