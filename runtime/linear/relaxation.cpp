// SPDX-License-Identifier: MIT
#include "relaxation.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "operator.hpp"
#include "ordering.hpp"
#include "sweeps.sk.hpp"

namespace sk::linear {

namespace {

SparseMatrix scaledMatrix(const Operator& a) { return scaled(sparseOf(a), a.scale); }

enum class Part { Lower, Upper, OffDiagonal };

/// Rows in the order of an ordering on a device, without their diagonal.
struct GroupedRows {
  /// Row i is divided by divisor[i], unless there is none.
  GroupedRows(sk::Device& device, const SparseMatrix& a, const Ordering& ordering, Part part,
              const std::vector<double>& inverses, const Arithmetic& arithmetic)
      : groups(ordering.starts) {
    std::vector<int> starts{0}, columns;
    std::vector<double> values;
    for (std::int64_t i = 0; i < a.rows; ++i) {
      for (auto k = static_cast<std::size_t>(a.starts[static_cast<std::size_t>(i)]);
           k < static_cast<std::size_t>(a.starts[static_cast<std::size_t>(i) + 1]); ++k) {
        const std::int64_t j = a.column[k];
        if (j == i || (part == Part::Lower && j > i) || (part == Part::Upper && j < i)) continue;
        columns.push_back(static_cast<int>(j));
        values.push_back(a.value[k]);
      }
      starts.push_back(static_cast<int>(columns.size()));
    }
    if (columns.empty()) {  // a stream for the kernels' gathers
      columns.push_back(0);
      values.push_back(0.0);
    }
    start = device.stream<int>({static_cast<std::int64_t>(starts.size())});
    column = device.stream<int>({static_cast<std::int64_t>(columns.size())});
    value = device.stream<float>({static_cast<std::int64_t>(values.size())}, arithmetic.matrix);
    inverse = device.stream<float>({a.rows}, arithmetic.vectors);
    start.write(starts);
    column.write(columns);
    value.writeReals(values);
    inverse.writeReals(inverses);
  }

  std::int64_t count() const { return static_cast<std::int64_t>(groups.size()) - 1; }
  sk::Index begin(std::int64_t group) const { return {groups[static_cast<std::size_t>(group)]}; }
  sk::Index end(std::int64_t group) const { return {groups[static_cast<std::size_t>(group) + 1]}; }
  int first(std::int64_t group) const { return static_cast<int>(groups[static_cast<std::size_t>(group)]); }

  std::vector<std::int64_t> groups;
  sk::Stream<int> start, column;
  Vector value, inverse;
};

/// To the order of an ordering, and back.
struct Permutation {
  Permutation(sk::Device& device, const Ordering& ordering)
      : from(device.stream<int>({static_cast<std::int64_t>(ordering.order.size())})),
        back(device.stream<int>(from.shape())) {
    std::vector<int> inverse(ordering.order.size());
    for (std::size_t i = 0; i < inverse.size(); ++i)
      inverse[static_cast<std::size_t>(ordering.order[i])] = static_cast<int>(i);
    from.write(ordering.order);
    back.write(inverse);
  }
  sk::Stream<int> from, back;
};

class RowsRelaxer : public Relaxer {
 public:
  RowsRelaxer(sk::Device& device, const SparseMatrix& a, const Ordering& ordering,
              const Arithmetic& arithmetic)
      : permutation_(device, ordering),
        rows_(device, a, ordering, Part::OffDiagonal, inverses(a), arithmetic),
        b_(device.stream<float>({a.rows}, arithmetic.vectors)),
        x_(device.stream<float>({a.rows}, arithmetic.vectors)),
        part_(device.stream<float>({1}, arithmetic.sums())),
        options_(arithmetic.options()),
        foldOptions_(arithmetic.foldOptions()) {}

  void load(const Vector& b) override {
    permute.with(options_)(permutation_.from, b.reshape(b_.shape()), b_);
    x_.fill(0.0f);
  }

  void sweep(float omega, Vector& rr) override {
    for (std::int64_t g = 0; g < rows_.count(); ++g) {
      const sk::Index begin = rows_.begin(g), end = rows_.end(g);
      const auto own = x_.domain(begin, end);
      relaxGroup.with(foldOptions_)(rows_.first(g), omega, rows_.start, rows_.column, rows_.value,
                                    rows_.inverse.domain(begin, end), b_.domain(begin, end), x_, own, own,
                                    g == 0 ? rr : part_);
      if (g > 0) addSquares.with(options_)(rr, part_, rr);
    }
  }

  void store(Vector& x) override { permute.with(options_)(permutation_.back, x_, x.reshape(x_.shape())); }

  static std::vector<double> inverses(const SparseMatrix& a) {
    std::vector<double> d = diagonal(a);
    for (double& v : d) v = 1.0 / v;
    return d;
  }

 private:
  Permutation permutation_;
  GroupedRows rows_;
  Vector b_, x_, part_;
  sk::CallOptions options_, foldOptions_;
};

class GridRelaxer : public Relaxer {
 public:
  GridRelaxer(sk::Device& device, Matrix& matrix, const Operator& a, const Arithmetic& arithmetic)
      : matrix_(matrix),
        inverse_(matrix.space(device).stream<float>(arithmetic.vectors)),
        b_(matrix.space(device).stream<float>(arithmetic.vectors)),
        x_(matrix.space(device).stream<float>(arithmetic.vectors)),
        q_(matrix.space(device).stream<float>(arithmetic.vectors)),
        part_(device.stream<float>({1}, arithmetic.sums())),
        options_(arithmetic.options()),
        foldOptions_(arithmetic.foldOptions()) {
    std::vector<double> inverse(a.diagonal.size());
    std::ranges::transform(a.diagonal, inverse.begin(), [&](double d) { return 1.0 / (a.scale * d); });
    inverse_.writeReals(inverse);
  }

  void load(const Vector& b) override {
    b.copyTo(b_);
    x_.fill(0.0f);
  }

  void sweep(float omega, Vector& rr) override {
    for (int colour = 0; colour < 2; ++colour) {
      matrix_.multiply(x_, q_);
      relaxColour.with(foldOptions_)(colour, omega, b_, q_, inverse_, x_, x_, colour == 0 ? rr : part_);
    }
    addSquares.with(options_)(rr, part_, rr);
  }

  void store(Vector& x) override { x_.copyTo(x); }

 private:
  Matrix& matrix_;
  Vector inverse_, b_, x_, q_, part_;
  sk::CallOptions options_, foldOptions_;
};

/// z = U^-1 L^-1 r by one call for each group. U may be missing.
class TriangularSolves : public Preconditioner {
 public:
  TriangularSolves(sk::Device& device, Permutation permutation, GroupedRows lower,
                   std::vector<GroupedRows> upper, const Arithmetic& arithmetic)
      : permutation_(std::move(permutation)),
        lower_(std::move(lower)),
        upper_(std::move(upper)),
        f_(device.stream<float>(permutation_.from.shape(), arithmetic.vectors)),
        y_(device.stream<float>(permutation_.from.shape(), arithmetic.vectors)),
        options_(arithmetic.options()),
        foldOptions_(arithmetic.foldOptions()) {}

  void apply(const Vector& r, Vector& z, Vector& rz) override {
    const sk::Shape flat = f_.shape();
    permute.with(options_)(permutation_.from, r.reshape(flat), f_);
    for (std::int64_t g = 0; g < lower_.count(); ++g) solve(lower_, g, f_, y_);
    if (upper_.empty())
      return permuteDot.with(foldOptions_)(permutation_.back, y_, r.reshape(flat), z.reshape(flat), rz);
    for (std::int64_t g = upper_[0].count() - 1; g >= 0; --g) solve(upper_[0], g, y_, f_);
    permuteDot.with(foldOptions_)(permutation_.back, f_, r.reshape(flat), z.reshape(flat), rz);
  }

 private:
  void solve(GroupedRows& rows, std::int64_t group, Vector& b, Vector& x) {
    const sk::Index begin = rows.begin(group), end = rows.end(group);
    solveGroup.with(options_)(rows.first(group), rows.start, rows.column, rows.value,
                              rows.inverse.domain(begin, end), b.domain(begin, end), x, x.domain(begin, end));
  }

  Permutation permutation_;
  GroupedRows lower_;
  std::vector<GroupedRows> upper_;
  Vector f_, y_;
  sk::CallOptions options_, foldOptions_;
};

/// (D / omega + L)^-1, and with an upper part M^-1 = (2 - omega) / omega (D / omega + U)^-1 D (D / omega + L)^-1.
std::unique_ptr<Preconditioner> makeRelaxing(const PreconditionerParts& parts, bool isSymmetric) {
  const double omega = parts.settings.omega;
  if (!(omega > 0.0 && omega < 2.0))
    throw sk::Error(fmt::format("the relaxation factor {} is not between 0 and 2", omega));
  checkDiagonal(parts.a, isSymmetric ? "the preconditioner 'ssor'" : "the preconditioner 'sor'");
  const SparseMatrix a = scaledMatrix(parts.a);
  const Ordering ordering = orderingNamed(parts.settings.ordering, a);
  SparseMatrix p = permuted(a, ordering.order);
  const std::vector<double> d = diagonal(p);
  std::vector<double> inverse(d.size());
  std::ranges::transform(d, inverse.begin(), [&](double v) { return omega / v; });
  GroupedRows lower(parts.device, p, ordering, Part::Lower, inverse, parts.arithmetic);
  std::vector<GroupedRows> upper;
  if (isSymmetric) {
    // The factor between the two solves, by which the rows of the second are divided instead.
    const double factor = (2.0 - omega) / omega;
    for (std::size_t i = 0; i < d.size(); ++i)
      for (auto k = static_cast<std::size_t>(p.starts[i]); k < static_cast<std::size_t>(p.starts[i + 1]); ++k)
        p.value[k] /= factor * d[i];
    upper.emplace_back(parts.device, p, ordering, Part::Upper, std::vector<double>(d.size(), 2.0 - omega),
                       parts.arithmetic);
  }
  return std::make_unique<TriangularSolves>(parts.device, Permutation(parts.device, ordering),
                                            std::move(lower), std::move(upper), parts.arithmetic);
}

/// With L below the diagonal of the factors, whose own is 1, and U. They are in the order.
std::unique_ptr<Preconditioner> makeSolves(const PreconditionerParts& parts, const SparseMatrix& factors,
                                           const Ordering& ordering) {
  GroupedRows lower(parts.device, factors, ordering, Part::Lower,
                    std::vector<double>(static_cast<std::size_t>(factors.rows), 1.0), parts.arithmetic);
  std::vector<GroupedRows> upper;
  upper.emplace_back(parts.device, factors, ordering, Part::Upper, RowsRelaxer::inverses(factors),
                     parts.arithmetic);
  return std::make_unique<TriangularSolves>(parts.device, Permutation(parts.device, ordering),
                                            std::move(lower), std::move(upper), parts.arithmetic);
}

std::unique_ptr<Preconditioner> makeIncomplete(const PreconditionerParts& parts, bool isCholesky) {
  const SparseMatrix a = scaledMatrix(parts.a);
  const Ordering ordering = orderingNamed(parts.settings.ordering, a);
  const SparseMatrix p = permuted(a, ordering.order);
  SparseMatrix factors = p;
  std::int64_t failed = factorise(factors, isCholesky);
  if (failed >= 0 && !isCholesky)
    throw sk::Error(
        fmt::format("the preconditioner 'ilu0' has a pivot of 0 in row {}; take the preconditioner 'none'",
                    parts.a.numberOf(ordering.order[static_cast<std::size_t>(failed)])));
  // T. Manteuffel, "An incomplete factorization technique for positive definite linear systems" (1980): a larger diagonal has pivots above 0.
  for (double shift = 1e-3; failed >= 0; shift *= 4.0) {
    if (shift > 1.0)
      throw sk::Error(fmt::format(
          "the preconditioner 'ic0' has no positive pivot in row {}, even with a diagonal of twice the size: "
          "the matrix is not positive definite; take the solver 'minres' and the preconditioner 'none'",
          parts.a.numberOf(ordering.order[static_cast<std::size_t>(failed)])));
    factors = p;
    for (std::size_t i = 0; i < static_cast<std::size_t>(p.rows); ++i)
      for (auto k = static_cast<std::size_t>(p.starts[i]); k < static_cast<std::size_t>(p.starts[i + 1]); ++k)
        if (p.column[k] == static_cast<std::int32_t>(i)) factors.value[k] *= 1.0 + shift;
    failed = factorise(factors, true);
  }
  return makeSolves(parts, factors, ordering);
}

/// Rows depend on others by the fill, too: groups of rows that a device computes at once are the levels of the factors themselves.
std::unique_ptr<Preconditioner> makeByThreshold(const PreconditionerParts& parts) {
  const PreconditionerSettings& settings = parts.settings;
  if (!(settings.drop >= 0.0 && settings.drop < 1.0))
    throw sk::Error(fmt::format("the drop tolerance {} is not from 0 to below 1", settings.drop));
  if (settings.fill < 0) throw sk::Error(fmt::format("the fill {} is below 0", settings.fill));
  const SparseMatrix a = scaledMatrix(parts.a);
  const Ordering first = orderingNamed(settings.ordering, a);
  SparseMatrix factors;
  const std::int64_t failed =
      factoriseByThreshold(permuted(a, first.order), {.drop = settings.drop, .fill = settings.fill}, factors);
  if (failed >= 0)
    throw sk::Error(
        fmt::format("the preconditioner 'ilut' has a pivot of 0 in row {}; take the preconditioner 'none'",
                    parts.a.numberOf(first.order[static_cast<std::size_t>(failed)])));
  Ordering ordering = levels(factors);
  factors = permuted(factors, ordering.order);
  for (std::int32_t& row : ordering.order) row = first.order[static_cast<std::size_t>(row)];
  return makeSolves(parts, factors, ordering);
}

}  // namespace

std::unique_ptr<Relaxer> makeRelaxer(sk::Device& device, Matrix& matrix, const Operator& a,
                                     const Arithmetic& arithmetic) {
  // Colours of grids are independent only without entries for corners.
  if (matrix.layout() == "stencil" &&
      (a.varying == nullptr || a.varying->count() == 2 * a.varying->grid.rank() + 1))
    return std::make_unique<GridRelaxer>(device, matrix, a, arithmetic);
  if (matrix.space(device).isDivided())
    throw sk::Error(
        "on several processes, the solver 'sor' takes grids without entries for corners, whose elements have "
        "two "
        "colours; take another solver, or one process");
  const SparseMatrix scaledA = scaledMatrix(a);
  const Ordering ordering = colours(scaledA);
  return std::make_unique<RowsRelaxer>(device, permuted(scaledA, ordering.order), ordering, arithmetic);
}

void checkDiagonal(const Operator& a, std::string_view what, std::string_view instead) {
  const auto zero = std::ranges::find(a.diagonal, 0.0);
  if (zero != a.diagonal.end())
    throw sk::Error(fmt::format("row {} has no diagonal entry, or 0, and {} divides by it; take {}",
                                a.numberOf(zero - a.diagonal.begin()), what, instead));
}

std::unique_ptr<Preconditioner> makeSor(const PreconditionerParts& parts) {
  return makeRelaxing(parts, false);
}
std::unique_ptr<Preconditioner> makeSsor(const PreconditionerParts& parts) {
  return makeRelaxing(parts, true);
}
std::unique_ptr<Preconditioner> makeIncompleteCholesky(const PreconditionerParts& parts) {
  return makeIncomplete(parts, true);
}
std::unique_ptr<Preconditioner> makeThresholdLu(const PreconditionerParts& parts) {
  return makeByThreshold(parts);
}
std::unique_ptr<Preconditioner> makeIncompleteLu(const PreconditionerParts& parts) {
  return makeIncomplete(parts, false);
}

}  // namespace sk::linear
