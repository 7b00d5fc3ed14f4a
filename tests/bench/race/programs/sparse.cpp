// SPDX-License-Identifier: MIT
//
// A sparse matrix, in compressed rows of 8 to 24 entries in a band, or with lengths by a power law and columns everywhere,
// times a vector. ints: starts of rows, columns; floats: values, x.
#include "programs/sparse.sk.hpp"

#include <algorithm>
#include <cmath>

#include "constants.hpp"
#include "our_task.hpp"
#include "programs/all.hpp"

namespace race {
namespace {

constexpr std::int64_t band = 4096;  // columns

/// What both ways of computing it have in common.
class SparseTask : public OurTask {
 public:
  std::vector<float> result() override { return y_.read(); }

 protected:
  SparseTask(sk::Device& device, const Problem& p)
      : OurTask(device),
        starts_(filled<std::int32_t>({p.size() + 1}, p.ints[0])),
        columns_(filled<std::int32_t>({static_cast<std::int64_t>(p.ints[1].size())}, p.ints[1])),
        values_(filled<float>({static_cast<std::int64_t>(p.floats[0].size())}, p.floats[0])),
        x_(filled<float>({p.size()}, p.floats[1])),
        y_(device.stream<float>({p.size()})) {}

  sk::Stream<std::int32_t> starts_, columns_;
  sk::Stream<float> values_, x_, y_;
};

class Sparse final : public SparseTask {
 public:
  Sparse(sk::Device& device, const sk::CallOptions& options, const Problem& p)
      : SparseTask(device, p), sparse_(kernels::sparse.with(options)) {}

 private:
  void once() override { sparse_(starts_, columns_, values_, x_, y_); }

  kernels::SparseKernel sparse_;
};

/// The rows are prepared once, as a solver does. Sums are plain, as the peers' are.
class SparseInRows final : public SparseTask {
 public:
  SparseInRows(sk::Device& device, const sk::CallOptions& options, const Problem& p)
      : SparseTask(device, p),
        sparse_(kernels::sparseRow.with(options).with({.accumulate = sk::Accumulate::Tree})),
        rows_(starts_) {}

 private:
  void once() override { sparse_(rows_(values_), rows_(columns_), x_, y_); }

  kernels::SparseRowReduce sparse_;
  sk::Rows rows_;
};

}  // namespace

Problem sparseProblem(int log2) {
  Problem p = grid(log2);
  const std::int64_t n = p.size();
  std::vector<std::int32_t> starts = {0}, columns;
  for (const float part : numbers(n, 3)) {
    const int entries = sparseRow / 2 + static_cast<int>(part * (sparseRow + 1));
    starts.push_back(starts.back() + entries);
  }
  const std::vector<float> places = numbers(starts.back(), 4);
  const std::int64_t width = std::min(band, n);
  for (std::int64_t row = 0; row < n; ++row) {
    const std::int64_t first = std::clamp<std::int64_t>(row - width / 2, 0, n - width);
    const std::int32_t begin = starts[static_cast<std::size_t>(row)],
                       end = starts[static_cast<std::size_t>(row) + 1];
    const std::int64_t part = width / (end - begin);  // of the band, with one entry
    for (std::int32_t i = begin; i < end; ++i) {
      const auto inPart =
          static_cast<std::int64_t>(places[static_cast<std::size_t>(i)] * static_cast<float>(part));
      columns.push_back(static_cast<std::int32_t>(first + (i - begin) * part + inPart));
    }
  }
  p.floats = {numbers(starts.back(), 1), numbers(n, 2)};
  p.ints = {std::move(starts), std::move(columns)};
  return p;
}

Problem powerLawProblem(int log2) {
  Problem p = grid(log2);
  const std::int64_t n = p.size();
  std::vector<std::int32_t> starts = {0}, columns;
  for (const float part : numbers(n, 5)) {
    const auto longest = static_cast<double>(std::min<std::int64_t>(n, 1 << 16));
    const double length = 4 * std::pow(1.0 - double{part}, -1 / 1.2);
    starts.push_back(starts.back() + static_cast<std::int32_t>(std::min(length, longest)));
  }
  const std::vector<float> places = numbers(starts.back(), 4);
  for (std::size_t row = 0; row + 1 < starts.size(); ++row) {
    const std::int32_t begin = starts[row], end = starts[row + 1];
    const std::int64_t part = n / (end - begin);  // of the columns, with one entry
    for (std::int32_t i = begin; i < end; ++i) {
      const float inPart = places[static_cast<std::size_t>(i)] * static_cast<float>(part);
      columns.push_back(static_cast<std::int32_t>((i - begin) * part + static_cast<std::int64_t>(inPart)));
    }
  }
  p.floats = {numbers(starts.back(), 1), numbers(n, 2)};
  p.ints = {std::move(starts), std::move(columns)};
  return p;
}

/// Plain sums of tens of thousands of numbers in order are that far off.
Check powerLawCheck(const Problem& p) {
  Check check = sparseCheck(p);
  check.tolerance = 1e-4;
  return check;
}

Check sparseCheck(const Problem& p) {
  Check check{{}, {}, 1e-5};
  for (std::size_t row = 0; row + 1 < p.ints[0].size(); ++row) {
    double sum = 0;
    for (auto i = static_cast<std::size_t>(p.ints[0][row]); i < static_cast<std::size_t>(p.ints[0][row + 1]);
         ++i) {
      sum += double{p.floats[0][i]} * p.floats[1][static_cast<std::size_t>(p.ints[1][i])];
    }
    check.values.push_back(sum);
  }
  return check;
}

std::unique_ptr<Task> sparseOurs(sk::Device& device, const sk::CallOptions& options, const Problem& p) {
  // in software, both read elements one by one, and the kernel draws once
  if (device.isSoftware() && device.profile() != "native")
    return std::make_unique<Sparse>(device, options, p);
  return std::make_unique<SparseInRows>(device, options, p);
}

}  // namespace race
