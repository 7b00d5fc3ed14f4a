// SPDX-License-Identifier: MIT
#include "native/padded_rows.hpp"

#include <algorithm>
#include <cstring>
#include <span>
#include <utility>

#include "native/components.hpp"
#include "native/gather_copies.hpp"
#include "native/scalars.hpp"
#include "sk/native/parallel.hpp"

namespace sk {

namespace {

constexpr std::int64_t padding = 2 * cacheLine;

/// True if the rows of some scalar's array share few sets of a cache, and do not all fit there.
bool hasConflicts(const native::Operand& from, const std::vector<std::size_t>& bytes) {
  constexpr std::int64_t halfPage = 2048;
  constexpr std::int64_t enough = 1 << 20;  // half of a core's second-level cache
  return std::ranges::any_of(bytes, [&](std::size_t size) {
    const std::int64_t pitch = from.stride[1] * static_cast<std::int64_t>(size);
    return pitch % halfPage == 0 && rowsOf(from) * pitch >= enough;
  });
}

}  // namespace

PaddedRows::PaddedRows(const program::Kernel& kernel, const native::Call& call, std::int64_t rows,
                       const ColumnPanels& panels) {
  for (std::size_t i = 0; i < std::min<std::size_t>(call.operands.size(), 64); ++i) {
    const native::Operand& from = call.operands[i];
    // the slots of neighbours lie in the stream itself
    const bool hasSlots = std::ranges::any_of(std::span(kernel.code->slots, kernel.code->slotCount),
                                              [&](const native::Slot& slot) { return slot.parameter == i; });
    if (hasSlots || (kernel.code->sharedGathers >> i & 1) == 0 || from.components.empty() || from.held ||
        panels.has(i))
      continue;
    std::vector<std::size_t> bytes;
    forEachScalar(*kernel.parameters[i].element, RealType::Float,
                  [&](std::size_t, std::size_t size, auto) { bytes.push_back(size); });
    if (!hasConflicts(from, bytes) || !paysToCopy(from, from.extent[0], call.domain, rows)) continue;
    const auto largest = static_cast<std::int64_t>(std::ranges::max(bytes));
    const std::int64_t pitch = from.extent[0] + padding / largest;
    const std::int64_t plane = pitch * from.extent[1];
    copies_.push_back({i, from, std::move(bytes), {1, pitch, plane, plane * from.extent[2]}, {}, {}});
  }
}

void PaddedRows::copyInto(CodeFrame& frame) {
  for (Copy& copy : copies_) {
    if (copy.memory.empty()) {
      for (const std::size_t bytes : copy.bytes) {
        const std::int64_t elements = copy.stride[3] * copy.from.extent[3];
        copy.memory.push_back(allocated(static_cast<std::size_t>(elements) * bytes));
        copy.arrays.push_back(copy.memory.back().get());
      }
      native::Operand to = copy.from;
      to.components = copy.arrays;
      to.first = 0;
      to.stride = copy.stride;
      frame.redirect(copy.parameter, to);
    }
    for (std::size_t scalar = 0; scalar < copy.bytes.size(); ++scalar) copyRows(copy, scalar);
  }
}

void PaddedRows::copyRows(const Copy& copy, std::size_t scalar) {
  const native::Operand& from = copy.from;
  const auto bytes = static_cast<std::int64_t>(copy.bytes[scalar]);
  const auto* const source = static_cast<const std::byte*>(from.components[scalar]);
  std::byte* const target = copy.memory[scalar].get();
  native::inParallel(rowsOf(from), from.extent[0], native::Deal::Evenly, [&](native::Range range) {
    for (std::int64_t row = range.begin; row < range.end; ++row) {
      std::memcpy(target + row * copy.stride[1] * bytes, source + firstOfRow(from, row) * bytes,
                  static_cast<std::size_t>(from.extent[0] * bytes));
    }
  });
}

}  // namespace sk
