// SPDX-License-Identifier: MIT
//
// The passes of reductions and scans over rows of different lengths (assemble/reduce/row_program.hpp): level by level,
// each piece of a row becomes one partial result, until a row is one piece.
#include <algorithm>
#include <array>
#include <cassert>
#include <deque>
#include <optional>
#include <utility>

#include "assemble/reduce/row_program.hpp"
#include "device/rows_state.hpp"
#include "gl_device/gl_stream.hpp"
#include "gl_device/pass/reduce_passes.hpp"

namespace sk {

using assemble::ReducePass;
using assemble::RegionLayout;
using assemble::RowPass;

namespace {

Operand tableOperand(const detail::StreamOwner& table) {
  return regionOperand({.region = detail::wholeRegion(table.get())}, table.get()->shape);
}

/// The shift with which sk_texel() finds an entry: a table that is not linearised is one row of texels.
std::int32_t shiftOf(const Operand& table) {
  constexpr std::int32_t wide = 30;
  return table.regionLayout.linear ? table.regionLayout.shift : wide;
}

void useTable(ReducePass& pass, const Operand& table) {
  pass.variant.tableLayered = table.regionLayout.layered;
  pass.uniforms.push_back({"sk_rows_shift", false, {shiftOf(table)}});
}

/// Makes work groups fold the groups of pieces.
void useGroups(ReducePass& pass, const Operand& groups) {
  constexpr std::int32_t mostInRow = 1 << 15;
  const std::int32_t count = groups.regionLayout.extent[0];
  const std::int32_t width = std::min(count, mostInRow);
  pass.variant.rows = RowPass::Groups;
  pass.draws = {{0, 0, width, (count - 1) / width + 1}};
  pass.uniforms.push_back({"sk_groups_shift", false, {shiftOf(groups)}});
  pass.uniforms.push_back({"sk_group_shape", true, {width, count, 0, 0}});
}

/// The texture and layout for `count` partial results, and a pass that writes them.
RegionLayout writePartials(ReducePass& pass, std::int64_t count, const assemble::TextureLimits& limits) {
  const std::optional<assemble::TextureShape> texture = assemble::linearTexture(count, limits);
  assert(texture);
  pass.texture = *texture;
  const RegionLayout layout = assemble::linearLayout(count, *texture);
  addDomain(pass, layout, false);
  return layout;
}

void writeResult(ReducePass& pass, const RegionLayout& result) {
  pass.toResult = true;
  addDomain(pass, result, false);
}

}  // namespace

static_assert(RowPieces::groupPieces == assemble::rowGroupSize &&
              RowPieces::groupElements == assemble::rowGroupItems);

ReducePass ReducePasses::passOverRows(const RegionLayout& partials, bool ofElements) const {
  ReducePass pass{};
  pass.variant.rows = RowPass::Folds;
  pass.variant.walk = ofElements ? assemble::Walk::Index : assemble::Walk::Partials;
  pass.variant.sourceLayered = partials.layered;
  pass.uniforms = {{"sk_item_shape", true, elements_.extent}, {"sk_shift", false, {partials.shift}}};
  return pass;
}

bool ReducePasses::beginAtOneLane() const {
  std::optional<std::int32_t> lane;
  for (std::size_t i = 0; i < operands_.size(); ++i) {
    if (!isRead(i)) continue;
    const RegionLayout& input = operands_[i].regionLayout;
    const std::int32_t own = input.origin[0] % assemble::lanes;
    if (!input.packed || lane.value_or(own) != own) return false;
    lane = own;
  }
  return lane.has_value();
}

void ReducePasses::foldRows(const RowsState& rows, const RegionLayout& result,
                            std::span<RenderTarget* const> targets, const std::function<void()>& begin) {
  if (assemble::elements(elements_.extent) == 0) return writeIdentities(result, targets, begin);
  const bool mayGroupRows = device_.programs().areDispatched() && assemble::mayGroupRows(reduction_);
  PlanesLease partials(device_.memory());
  RegionLayout source;
  for (const RowsState::Level& level : rows.levels()) {
    const bool isFirst = &level == &rows.levels().front();
    const bool isLast = &level == &rows.levels().back();
    ReducePass pass = passOverRows(source, isFirst);
    std::vector<Operand> tables = {tableOperand(level.table)};
    useTable(pass, tables.front());
    if (isLast) {
      writeResult(pass, result);
    } else {
      source = writePartials(pass, level.pieces.count(), device_.textureLimits());
    }
    if (isFirst && mayGroupRows) {
      tables.push_back(tableOperand(level.groups));
      useGroups(pass, tables.back());
      pass.variant.packed = beginAtOneLane();
    }
    if (isLast) {
      prepare(pass, targets);
      begin();
      draw(pass, {.partials = partials.planes, .tables = tables}, targets);
      continue;
    }
    PlanesLease next(device_.memory());
    takeAccumulators(reduction_.fold, pass.texture, "partial results", next);
    draw(pass, {.partials = partials.planes, .tables = tables}, pointersTo(next.planes));
    std::swap(partials.planes, next.planes);
  }
}

void ReducePasses::scanRows(const RowsState& rows, const RegionLayout& result,
                            std::span<RenderTarget* const> targets, bool isExclusive,
                            const std::function<void()>& begin) {
  const std::deque<RowsState::Level>& levels = rows.levels();
  std::deque<PlanesLease> partials;
  std::vector<RegionLayout> layouts = {{}};  // of what each level reads
  for (std::size_t i = 0; i + 1 < levels.size(); ++i) {
    ReducePass pass = passOverRows(layouts.back(), i == 0);
    const std::array<Operand, 1> tables = {tableOperand(levels[i].table)};
    useTable(pass, tables.front());
    layouts.push_back(writePartials(pass, levels[i].pieces.count(), device_.textureLimits()));
    const std::span<RenderTarget> source =
        partials.empty() ? std::span<RenderTarget>() : std::span<RenderTarget>(partials.back().planes);
    PlanesLease& next = partials.emplace_back(device_.memory());
    takeAccumulators(reduction_.fold, pass.texture, "partial results", next);
    draw(pass, {.partials = source, .tables = tables}, pointersTo(next.planes));
  }
  PlanesLease carries(device_.memory());
  for (std::size_t i = levels.size(); i-- > 0;) {
    ReducePass pass = passOverRows(layouts[i], i == 0);
    const std::array<Operand, 1> tables = {tableOperand(levels[i].places)};
    useTable(pass, tables.front());
    pass.variant.rows = i == 0 && isExclusive ? RowPass::Exclusive : RowPass::Inclusive;
    pass.variant.ofDigits = ofDigits_;
    if (i + 1 < levels.size()) {
      pass.variant.carried = true;
      pass.variant.carryLayered = layouts[i + 1].layered;
      pass.uniforms.push_back({"sk_carry_shift", false, {layouts[i + 1].shift}});
    }
    if (i == 0) {
      writeResult(pass, result);
      prepare(pass, targets);
      begin();
      draw(pass, {.carries = carries.planes, .tables = tables}, targets);
      continue;
    }
    PlanesLease next(device_.memory());
    writePartials(pass, levels[i - 1].pieces.count(), device_.textureLimits());
    takeAccumulators(reduction_.fold, pass.texture, "partial results", next);
    draw(pass, {.partials = partials.back().planes, .carries = carries.planes, .tables = tables},
         pointersTo(next.planes));
    std::swap(carries.planes, next.planes);
    partials.pop_back();
  }
}

}  // namespace sk
