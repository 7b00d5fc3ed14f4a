// SPDX-License-Identifier: MIT
#include "native/whole_pieces.hpp"

#include <algorithm>
#include <cstring>

#include "native/memory.hpp"

namespace sk {

namespace {

/// The memory for the columns of a piece's leaves.
constexpr std::size_t stateBytes = 16384;

}  // namespace

std::optional<WholePieces> WholePieces::of(const FoldProgram& program, const BlockPieces& pieces) {
  const SlotLayout& layout = program.layout;
  const StateShape& shape = program.shape;
  const std::int64_t side = sideOf(shape);
  const bool readsElements =
      layout.isDirect() && !layout.hasGathers() && !layout.hasOutputs() && !layout.needsElementwiseCalls();
  const bool isSmall = layout.arrays().size() <= mostArrays && shape.scalars() <= mostArrays &&
                       shape.bytes() * columns + shape.scalars() * cacheLine <= stateBytes;
  const bool areWhole = side % program.fold.lanes == 0 && columns % side == 0;
  const std::int64_t count = pieces.wholeInRow();
  if (!program.isCommutative || !readsElements || !isSmall || !areWhole || count == 0) return std::nullopt;
  return WholePieces(program, count);
}

WholePieces::WholePieces(const FoldProgram& program, std::int64_t count)
    : fold_(program.fold),
      combine_(program.combine),
      count_(count),
      side_(sideOf(program.shape)),
      arrayCount_(program.layout.arrays().size()),
      scalarCount_(program.shape.scalars()),
      first_(program.first) {
  SlotArrays row(program.layout, 0, 0);
  row.moveTo(first_);
  row.placeInside(0);
  for (std::size_t i = 0; i < arrayCount_; ++i)
    arrays_[i] = {static_cast<const std::byte*>(row.get()[i]), program.layout.arrays()[i].bytes.held};
  for (std::size_t i = 0; i < scalarCount_; ++i) scalarBytes_[i] = program.shape.bytesOf(i);
}

void WholePieces::fold(std::int64_t piece, std::byte* result) const {
  constexpr std::int64_t fetched = 2048;  // bytes of the next piece, which arrive while columns are combined
  alignas(cacheLine) std::byte memory[stateBytes];
  std::array<void*, mostArrays> arrays, state, later;
  std::byte* next = memory;
  for (std::size_t i = 0; i < scalarCount_; ++i) {
    state[i] = next;
    next += (static_cast<std::size_t>(columns) * scalarBytes_[i] + cacheLine - 1) & -cacheLine;
  }
  const std::int64_t x = first_[0] + piece * BlockPieces::most;
  for (std::size_t i = 0; i < arrayCount_; ++i)
    arrays[i] = const_cast<std::byte*>(arrays_[i].first + x * arrays_[i].bytes);
  native::Chunk chunk{.arrays = arrays.data(),
                      .first = {x, first_[1], first_[2], first_[3]},
                      .count = BlockPieces::most,
                      .step = 1,
                      .rows = 1,
                      .rowSteps = nullptr};
  fold_.function(fold_.frame, &chunk, state.data(), side_, leafRounds, columns / side_, 1);
  for (std::size_t i = 0; i < arrayCount_; ++i) {
    const auto* const end = static_cast<const std::byte*>(arrays[i]) + BlockPieces::most * arrays_[i].bytes;
    for (std::int64_t byte = 0; byte < fetched; byte += cacheLine) __builtin_prefetch(end + byte);
  }
  // neighbouring leaves first, then the columns
  for (std::int64_t half = columns / 2; half > 0; half /= 2) {
    for (std::size_t i = 0; i < scalarCount_; ++i)
      later[i] = static_cast<std::byte*>(state[i]) + static_cast<std::size_t>(half) * scalarBytes_[i];
    combine_.function(combine_.frame, state.data(), later.data(), half);
  }
  for (std::size_t i = 0; i < scalarCount_; ++i) {
    std::memcpy(result, state[i], scalarBytes_[i]);
    result += scalarBytes_[i];
  }
}

}  // namespace sk
