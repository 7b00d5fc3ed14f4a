// SPDX-License-Identifier: MIT
#include "native/piece_folder.hpp"

namespace sk {

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
