// SPDX-License-Identifier: MIT
#include "native/piece_folder.hpp"

#include <algorithm>
#include <limits>

namespace sk {

namespace {

std::int64_t mostPlaced(const StateShape& shape) {
  return std::max(leafRounds * sideOf(shape), groupOf(shape));
}

}  // namespace

LeafFolder::LeafFolder(const FoldProgram& program, std::pmr::memory_resource* memory)
    : program_(program),
      longest_(program.layout.isDirect() ? std::numeric_limits<std::int64_t>::max() : mostStaged),
      arrays_(program.layout, mostPlaced(program.shape), mostPlaced(program.shape)),
      some_(program.shape, sideOf(program.shape), memory),
      rest_(program.shape.scalars(), memory) {
  chunk_.arrays = arrays_.get();
}

void LeafFolder::moveToRow(const native::Extents& first) {
  arrays_.moveTo(first);
  std::ranges::copy(first, chunk_.first);
}

void LeafFolder::fold(StateColumns& state, std::int64_t x, std::int64_t columns, std::int64_t rounds,
                      Start start, std::int64_t step) {
  const bool areApart = program_.layout.hasGathers() && step != 1;  // gathers need adjacent lanes
  if (program_.layout.needsElementwiseCalls() || areApart) {
    foldOneByOne(state, x, columns, rounds, start, step);
    return;
  }
  // only the incomplete group of lanes at the end of a row needs to be laid out
  const std::int64_t whole = columns & -program_.fold.lanes;
  if (rounds != 1 || whole == 0 || whole == columns) {
    call(state.arrays(), x, {columns, rounds, 1}, start, step);
    return;
  }
  call(state.arrays(), x, {whole, 1, 1}, start, step);
  for (std::size_t scalar = 0; scalar < rest_.size(); ++scalar) rest_[scalar] = state.at(scalar, whole);
  call(rest_.data(), x + whole * step, {columns - whole, 1, 1}, start, step);
}

void LeafFolder::foldLeaves(StateColumns& state, std::int64_t x, std::int64_t columns, std::int64_t rounds,
                            std::int64_t leaves) {
  call(state.arrays(), x, {columns, rounds, leaves}, Start::New, 1);
}

void LeafFolder::call(void* const* state, std::int64_t x, const Division& division, Start start,
                      std::int64_t step) {
  const auto [columns, rounds, leaves] = division;
  const std::int64_t count = columns * rounds * leaves;
  const std::int64_t room = count - columns + roundUp(columns, program_.fold.lanes);
  arrays_.place(x, count, room, step);
  chunk_.first[0] = x;
  chunk_.count = count;
  chunk_.step = step;
  program_.fold.function(program_.fold.frame, &chunk_, state, columns, rounds, leaves,
                         start == Start::New ? 1 : 0);
  const bool isInPlace = count == room && step == 1 && !program_.layout.hasStridedOutputs();
  if (program_.layout.hasOutputs() && !isInPlace) arrays_.storeOutputs(x, count, room, step);
}

void LeafFolder::foldInto(StateColumns& state, std::int64_t first, std::int64_t x, std::int64_t count,
                          Start start) {
  if (count == 0) return;
  if (start == Start::Continued) some_.assign(0, state, first, count);
  fold(some_, x, count, 1, start);
  state.assign(first, some_, 0, count);
}

void LeafFolder::foldOneByOne(StateColumns& state, std::int64_t x, std::int64_t columns, std::int64_t rounds,
                              Start start, std::int64_t step) {
  StateColumns one(program_.shape, 1);
  for (std::int64_t k = 0; k < columns; ++k) {
    if (start == Start::Continued) one.assign(0, state, k, 1);
    for (std::int64_t round = 0; round < rounds; ++round) {
      call(one.arrays(), x + (k + round * columns) * step, {1, 1, 1}, round == 0 ? start : Start::Continued,
           1);
    }
    state.assign(k, one, 0, 1);
  }
}

using native::Extents;

const StateColumns& PieceFolder::fold(const Extents& block, std::int64_t piece) {
  pieces_.forEachRow(block, piece, [&](const Extents& first, std::int64_t count) {
    leaves_.moveToRow(first);
    const std::int64_t end = first[0] + count;
    if (!program_.isCommutative) return foldInOrder(first[0], count);
    for (std::int64_t x = first[0]; x < end;) {
      const std::int64_t now = std::min(end - x, leaves_.longest());
      foldColumns(x, now);
      x += now;
    }
  });
  if (program_.isCommutative) endColumns();
  if (folded_ > 0) endLeaf();
  return runs_.take();
}

// ---- in any order: consecutive elements go to consecutive columns --------------------------------

void PieceFolder::foldColumns(std::int64_t x, std::int64_t count) {
  while (count >= side_) {
    const std::int64_t leaves = wholeLeaves(count);
    if (leaves > 1) {
      foldWholeLeaves(x, leaves);
      x += leaves * leafRounds * side_;
      count -= leaves * leafRounds * side_;
      continue;
    }
    const std::int64_t rounds = std::min(count / side_, leafRounds);
    leaves_.fold(columnRuns_.next(), x, side_, rounds, Start::New);
    columnRuns_.add();
    x += rounds * side_;
    count -= rounds * side_;
  }
  if (count > 0) foldRest(x, count);
}

std::int64_t PieceFolder::wholeLeaves(std::int64_t count) const {
  if (!leaves_.foldsLeavesTogether(side_)) return 0;
  return powerUpTo(std::min({mostLeaves, columnRuns_.mostTogether(), count / (leafRounds * side_)}));
}

void PieceFolder::foldWholeLeaves(std::int64_t x, std::int64_t leaves) {
  leaves_.foldLeaves(leafColumns_, x, side_, leafRounds, leaves);
  combiner_.gather(leafColumns_, leaves * side_, side_);
  columnRuns_.next().assign(0, leafColumns_, 0, side_);
  columnRuns_.add(leaves);
}

void PieceFolder::foldRest(std::int64_t x, std::int64_t count) {
  const std::int64_t begun = std::min(count, restUsed_);
  leaves_.foldInto(rest_, 0, x, begun, Start::Continued);
  leaves_.foldInto(rest_, begun, x + begun, count - begun, Start::New);
  restUsed_ = std::max(restUsed_, count);
  if (++folded_ == leafRounds) endLeaf();
}

void PieceFolder::endColumns() {
  if (columnRuns_.isEmpty()) return;
  StateColumns& columns = columnRuns_.take();
  combiner_.combine(columns, rest_, 0, restUsed_);
  addGathered(columns, side_);
  restUsed_ = folded_ = 0;
}

void PieceFolder::addGathered(StateColumns& columns, std::int64_t count) {
  combiner_.gather(columns, count);
  runs_.next().assign(0, columns, 0, 1);
  runs_.add();
}

// ---- in order ----------------------------------------------------------------------------------

void PieceFolder::foldInOrder(std::int64_t x, std::int64_t count) {
  while (count > 0) {
    const std::int64_t together = leavesTogether(count);
    if (together > 0) {
      foldLeaves(x, together);
      x += together * leafRounds;
      count -= together * leafRounds;
      continue;
    }
    const std::int64_t now = std::min(count, leafRounds - folded_);
    leaves_.fold(runs_.next(), x, 1, now, folded_ == 0 ? Start::New : Start::Continued);
    folded_ += now;
    x += now;
    count -= now;
    if (folded_ == leafRounds) endLeaf();
  }
}

std::int64_t PieceFolder::leavesTogether(std::int64_t count) const {
  if (folded_ != 0 || !leaves_.foldsApart()) return 0;
  const std::int64_t most = std::min({group_, runs_.mostTogether(), count / leafRounds});
  return most < program_.fold.lanes ? 0 : powerUpTo(most);
}

void PieceFolder::foldLeaves(std::int64_t x, std::int64_t count) {
  for (std::int64_t round = 0; round < leafRounds; ++round) {
    leaves_.fold(leafColumns_, x + round, count, 1, round == 0 ? Start::New : Start::Continued, leafRounds);
  }
  orderedColumns_.assignReversed(leafColumns_, count);
  combiner_.gather(orderedColumns_, count);
  runs_.next().assign(0, orderedColumns_, 0, 1);
  runs_.add(count);
}

void PieceFolder::endLeaf() {
  folded_ = 0;
  if (program_.isCommutative) {
    addGathered(rest_, restUsed_);
    restUsed_ = 0;
  } else {
    runs_.add();
  }
}

}  // namespace sk
