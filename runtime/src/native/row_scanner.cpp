// SPDX-License-Identifier: MIT
#include "native/row_scanner.hpp"

#include <algorithm>
#include <limits>

namespace sk {

namespace {

std::int64_t longestCall(const SlotLayout& layout, bool areRows) {
  if (layout.needsElementwiseCalls()) return 1;
  const bool isInPlace = layout.isDirect() && !layout.hasGathers() && areRows;
  return isInPlace ? std::numeric_limits<std::int64_t>::max() : mostStaged;
}

}  // namespace

RowScanner::RowScanner(const ScanProgram& program, const FoldResults& results)
    : program_(program),
      results_(results),
      areRows_(program.storesFloats || results.areRows()),
      longest_(longestCall(program.fold.layout, areRows_)),
      arrays_(program.fold.layout, mostStaged, mostStaged),
      scratch_(program.fold.shape, areRows_ ? 0 : mostStaged),
      rows_(program.fold.shape.scalars()) {
  chunk_.arrays = arrays_.get();
  chunk_.step = 1;
  if (program.combinesRuns) runs_.emplace(program, 1);
}

void RowScanner::scan(StateColumns& state, native::Extents first, std::int64_t count, Start start) {
  arrays_.moveTo(first);
  for (const std::int64_t end = first[0] + count; first[0] < end; start = Start::Continued) {
    const std::int64_t now = std::min({end - first[0], longest_, runs_ ? runs_->left() : longest_});
    arrays_.place(first[0], now, now);
    for (std::size_t scalar = 0; scalar < rows_.size(); ++scalar)
      rows_[scalar] = areRows_ ? results_.at(scalar, first) : scratch_.at(scalar, 0);
    std::ranges::copy(first, chunk_.first);
    chunk_.count = now;
    program_.scan.function(program_.scan.frame, &chunk_, state.arrays(), rows_.data(),
                           start == Start::New ? 1 : 0, program_.isExclusive ? 1 : 0);
    if (runs_) runs_->add(now, state, 1);
    if (!areRows_) results_.store(first, scratch_, now);
    first[0] += now;
  }
}

}  // namespace sk
