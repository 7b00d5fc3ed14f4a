// SPDX-License-Identifier: MIT
#include "native/column_panels.hpp"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <utility>

#include "native/gather_copies.hpp"
#include "native/scalars.hpp"
#include "sk/native/parallel.hpp"

namespace sk {

using native::Range;

namespace {

/// True if skc has proved that an element reads the gather only in its own column.
bool readsOwnColumn(const program::Parameter& parameter) {
  const auto isOnX = [](const program::Reach& reach) { return reach.dimension == 0; };
  const auto isAtMostZero = [](const program::Distance& distance) {
    return distance.constant <= 0 && std::ranges::all_of(distance.perSpec, [](auto n) { return n == 0; });
  };
  return parameter.haloShapes == 0 && std::ranges::any_of(parameter.halo, isOnX) &&
         std::ranges::all_of(parameter.halo, [&](const program::Reach& reach) {
           return !isOnX(reach) || (reach.kind == program::Reach::Kind::Near && !reach.isPromised &&
                                    isAtMostZero(reach.below) && isAtMostZero(reach.above));
         });
}

/// True if copying `columns` of a gather takes little time beside what it saves. Columns that fill no panel would be read one
/// by one. Others gain where the gather is too large for the nearest caches.
bool paysInPanels(const native::Operand& from, std::int64_t bytes, const native::Extents& computed,
                  const native::Entry& entry) {
  constexpr std::int64_t mostPerBlock = 128;  // columns that take as long to copy as a few to read one by one
  constexpr std::int64_t large = 1 << 19;  // bytes
  const std::int64_t blocks = computed[1] / entry.rows;
  if (computed[0] % entry.lanes != 0 && blocks > 1 && computed[0] <= blocks * mostPerBlock) return true;
  return rowsOf(from) * from.stride[1] * bytes >= large &&
         paysToCopy(from, computed[0], computed, entry.rows);
}

}  // namespace

ColumnPanels::ColumnPanels(const program::Kernel& kernel, const native::Call& call,
                           const native::Entry* entry) {
  if (entry == nullptr) return;
  const native::Part computed = call.computed();
  width_ = entry->lanes;
  columns_ = {computed.first[0], computed.first[0] + computed.extent[0]};
  for (std::size_t i = 0; i < std::min<std::size_t>(call.operands.size(), 64); ++i) {
    const native::Operand& from = call.operands[i];
    if ((kernel.code->sharedGathers >> i & 1) == 0 || from.components.empty() || from.held) continue;
    // of a wider domain, the boundary mode says what is beyond the gather's columns
    if (!readsOwnColumn(kernel.parameters[i]) || columns_.end > from.extent[0]) continue;
    Gather gather{i, from, {}, {}, {}};
    forEachScalar(*kernel.parameters[i].element, RealType::Float,
                  [&](std::size_t, std::size_t bytes, auto) { gather.bytes.push_back(bytes); });
    const auto largest = static_cast<std::int64_t>(std::ranges::max(gather.bytes));
    if (paysInPanels(from, largest, computed.extent, *entry)) gathers_.push_back(std::move(gather));
  }
}

bool ColumnPanels::has(std::size_t parameter) const {
  return std::ranges::find(gathers_, parameter, &Gather::parameter) != gathers_.end();
}

void ColumnPanels::fill() {
  const std::int64_t panels = (columns_.end - columns_.begin + width_ - 1) / width_;
  for (Gather& gather : gathers_) {
    const std::int64_t rows = rowsOf(gather.from);
    for (std::size_t scalar = 0; scalar < gather.bytes.size(); ++scalar) {
      if (gather.memory.size() == scalar) {
        gather.memory.push_back(
            allocated(static_cast<std::size_t>(panels * rows * width_) * gather.bytes[scalar]));
        gather.arrays.push_back(gather.memory.back().get());
      }
      native::inParallel(rows, panels * width_, native::Deal::Evenly,
                         [&](Range range) { copyRows(gather, scalar, range.begin, range.end); });
    }
  }
}

void ColumnPanels::copyRows(const Gather& gather, std::size_t scalar, std::int64_t begin,
                            std::int64_t end) const {
  constexpr std::int64_t atOnce = 16;  // rows, so that a panel gets more than a few lines at a time
  const auto bytes = static_cast<std::int64_t>(gather.bytes[scalar]);
  const auto* const source = static_cast<const std::byte*>(gather.from.components[scalar]);
  std::byte* const target = gather.memory[scalar].get();
  const std::int64_t ofPanel = rowsOf(gather.from) * width_;
  for (std::int64_t first = begin; first < end; first += atOnce) {
    const std::int64_t last = std::min(first + atOnce, end);
    std::byte* panel = target;
    for (std::int64_t x = columns_.begin; x < columns_.end; x += width_, panel += ofPanel * bytes) {
      const std::int64_t columns = std::min(width_, columns_.end - x);
      for (std::int64_t row = first; row < last; ++row) {
        std::byte* const to = panel + row * width_ * bytes;
        std::memcpy(to, source + (firstOfRow(gather.from, row) + x) * bytes,
                    static_cast<std::size_t>(columns * bytes));
        if (columns < width_)
          std::memset(to + columns * bytes, 0, static_cast<std::size_t>((width_ - columns) * bytes));
      }
    }
  }
}

void ColumnPanels::moveTo(std::int64_t x, CodeFrame& frame) const {
  for (const Gather& gather : gathers_) {
    const native::Operand& from = gather.from;
    const std::int64_t plane = width_ * from.extent[1];
    const std::int64_t panel = (x - columns_.begin) / width_;
    native::Operand to = from;
    to.components = gather.arrays;
    to.first = panel * rowsOf(from) * width_ - x;
    to.stride = {1, width_, plane, plane * from.extent[2]};
    to.held = native::HeldIndices{{x, 0, 0, 0}, {x + width_, from.extent[1], from.extent[2], from.extent[3]}};
    frame.redirect(gather.parameter, to);
  }
}

}  // namespace sk
