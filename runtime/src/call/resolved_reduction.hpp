// SPDX-License-Identifier: MIT
//
// A reduction after its arguments have been checked: what every later step needs, computed once. Reductions
// to values are reductions to streams with one block, whose results go to host memory.
#pragma once

#include <cstddef>
#include <deque>
#include <optional>
#include <span>
#include <vector>

#include "device/stream_state.hpp"
#include "device/write_scope.hpp"
#include "sk/call.hpp"
#include "sk/program.hpp"
#include "sk/shape.hpp"

namespace sk {

class DeviceState;
class RowsState;

/// How a scan folds the blocks of a reduction: it keeps the accumulators after, or before, each element.
struct ScanOrder {
  std::optional<int> along;  ///< the dimension whose lines are the blocks; by default, there is one block
  bool isExclusive = false;
};

/// A box of a whole, of which a reduction that folds it speaks: of the whole's indices and extents.
struct FoldedBox {
  Box box = {};
  Shape whole = {};

  /// False if a reduction folds a whole, or never asks where an element is.
  bool isPlaced() const { return whole.rank() != 0; }
};

/// A scan is a reduction to streams of the shape of the domain. The outputs of a fold that has some are written if their
/// arguments have streams; without these, they have only shapes.
struct ResolvedReduction {
  DeviceState& device;
  const program::Reduction& reduction;
  std::span<const Argument> arguments;  ///< in a reduction to values, those of accumulators are empty
  Shape domain;  ///< the common shape of the inputs, or of the box of them that is folded
  Shape blocks;  ///< the number of blocks in each dimension of the domain
  std::span<void* const> values = {};  ///< one destination per accumulator; empty if the results are streams
  CallOptions options = {};
  std::optional<ScanOrder> scan = {};
  const RowsState* rows = nullptr;  ///< each row of the domain, which is one-dimensional, is a block; or null
  /// If placed, inputs and outputs are regions of the box, placed in the whole. There are no scans and no rows.
  FoldedBox placed = {};

  bool isToValues() const { return !values.empty(); }
  /// The shape of which the fold speaks.
  const Shape& seenDomain() const { return placed.isPlaced() ? placed.whole : domain; }
  /// The shape of stream results, which may have fewer dimensions than `blocks`.
  const Shape& shapeOfResults() const;
  /// The same elements, folded by another reduction.
  ResolvedReduction of(const program::Reduction& other, std::span<const Argument> otherArguments,
                       std::span<void* const> otherValues) const;
};

/// Whether a call folds the terms of an exact sum to digits (sk/exact_digits.hpp): only such a reduction has no exact
/// variant of its own in an exact call.
inline bool foldsDigits(const ResolvedReduction& call) {
  return call.options.accumulate == Accumulate::Exact && call.reduction.exact.empty() &&
         !call.reduction.seeded;
}

/// Whether the reduction stores elements to other outputs than its accumulators.
inline bool storesBeside(const ResolvedReduction& call) {
  for (std::size_t i = 0; i < call.arguments.size(); ++i) {
    const bool isOutput = call.reduction.fold.parameters[i].role == program::Role::Output;
    if (isOutput && call.arguments[i].region.stream != nullptr) return true;
  }
  return false;
}

/// Adds the arguments of a role.
inline void addArguments(WriteScope& writes, const ResolvedReduction& call, program::Role role) {
  for (std::size_t i = 0; i < call.arguments.size(); ++i) {
    if (call.reduction.fold.parameters[i].role == role) writes.add(call.arguments[i].region.stream);
  }
}

/// Adds the streams of a reduction's results, and its other outputs.
inline void addResults(WriteScope& writes, const ResolvedReduction& call) {
  addArguments(writes, call, program::Role::Accumulator);
  addArguments(writes, call, program::Role::Output);
}

/// Temporaries for accumulators that are not results, in host memory or in streams like the results.
class TemporaryResults {
 public:
  explicit TemporaryResults(const ResolvedReduction& call) : call_(call) {}

  /// Allocates an accumulator and returns its argument.
  Argument add(const program::Element& element);

  std::vector<Argument> arguments;
  std::vector<void*> values;  ///< empty if they are streams

 private:
  const ResolvedReduction& call_;
  std::deque<std::vector<std::byte>> bytes_;
  std::vector<detail::StreamOwner> streams_;
};

}  // namespace sk
