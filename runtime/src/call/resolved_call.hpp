// SPDX-License-Identifier: MIT
//
// The call of a kernel or a reduction after its arguments have been checked: what every later step needs, computed once.
// Reductions to values are reductions to streams with one block, whose results go to host memory.
//
// Chooses the variant of a kernel or a reduction for the precision of a call, and rounds the results of a
// reduction in doubles to floats. Only devices with GLSL programs use variants; native code computes in any
// real type.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <vector>

#include "assemble/condition.hpp"
#include "device/stream_state.hpp"
#include "device/write_scope.hpp"
#include "sk/call.hpp"
#include "sk/device.hpp"
#include "sk/program.hpp"
#include "sk/shape.hpp"

namespace sk {

struct ResolvedCall {
  const program::Kernel& kernel;
  std::span<const Argument> arguments;
  CallOptions options;
  assemble::SpecValues specs;
  Shape domain;
  const program::Plan* plan;  ///< its passes; null if one pass is enough
  /// The domain is a part of a whole, of which the kernel speaks: the index there of its first element, and the whole.
  Placement place = {};

  /// The same call of a variant of the kernel, which has the same parameters in another precision.
  ResolvedCall of(const program::Kernel& variant, const DeviceLimits& limits) const;
};

/// Whether a call writes the stream of a parameter.
inline bool isWritten(program::Role role) {
  using program::Role;
  return role == Role::Output || role == Role::Scatter || role == Role::VariableOutput ||
         role == Role::Accumulator;
}

/// The variant of a kernel for these values of its Spec parameters, or the kernel itself.
const program::Kernel& unrolledVariant(const program::Kernel& kernel, const assemble::SpecValues& specs);

/// `arguments` must have been checked, or be correct by construction.
ResolvedCall resolveCall(const program::Kernel& kernel, std::span<const Argument> arguments,
                         const DeviceLimits& limits, const CallOptions& options = {});

/// The 32 bits of a Spec parameter's value, as assemble::SpecValues holds them.
std::uint32_t specBits(const program::Parameter& parameter, const void* value);

/// The values of the Spec parameters. Ignores all other arguments, which may be missing. Throws sk::Error if a value is
/// missing.
assemble::SpecValues specsOf(const program::Kernel& kernel, std::span<const Argument> arguments);

/// The shape of a kernel's domain: the shape of its outputs or, if it has only variable and scatter outputs, the given
/// one or that of its inputs that are not broadcast and of iterators that have a shape. Its rank is 0 if nothing says it.
Shape domainOf(const program::Kernel& kernel, std::span<const Argument> arguments,
               const assemble::SpecValues& specs, const std::optional<GivenDomain>& given);

/// The plan for running a kernel with these values of its Spec parameters on a device with these limits; null if one
/// pass is enough, or if no plan fits the limits.
const program::Plan* planFor(const program::Kernel& kernel, const assemble::SpecValues& specs,
                             const DeviceLimits& limits);

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

/// Whether floats are computed as doubles or as pairs of floats.
constexpr bool isWide(const CallOptions& options) {
  return options.precision == Precision::Extended || options.precision == Precision::Double ||
         (options.precision != Precision::Half && options.accumulate == Accumulate::Extended);
}

/// Whether they are computed as pairs of floats even if the device has doubles.
constexpr bool isExtended(const CallOptions& options) {
  return isWide(options) && options.precision != Precision::Double;
}

/// Whether the call needs another variant than the one that computes in floats.
constexpr bool needsPrecisionVariant(const CallOptions& options) {
  return isWide(options) || options.precision == Precision::Half;
}

/// The kernel's variant for a call; the kernel itself for floats, or if it has no floats. Throws sk::Error if
/// there is none.
const program::Kernel& precisionVariant(const program::Kernel& kernel, const CallOptions& options);

/// The reduction's variant in half; the reduction itself if it has no floats. Throws sk::Error if there is
/// none.
const program::Reduction& halfVariant(const program::Reduction& reduction);

/// Throws sk::Error if a call requests tables in a precision other than float.
void checkTables(const program::Kernel& kernel, const CallOptions& options);

/// Throws sk::Error if a call of a kernel or a reduce requests what only a scan can do.
void refuseScanOptions(const program::Kernel& kernel, const CallOptions& options);

/// Reduces with the variant that the options select. Throws sk::Error if there is none.
void reduceInPrecision(const ResolvedReduction& call);

/// Reduces with a variant that has the same parameters, but for the accumulators, which are converted in the end.
void reduceWide(const ResolvedReduction& call, const program::WideReduction& wide);

}  // namespace sk
