// SPDX-License-Identifier: MIT
#include "native/leaf_folder.hpp"

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

}  // namespace sk
