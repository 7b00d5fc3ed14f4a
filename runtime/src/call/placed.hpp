// SPDX-License-Identifier: MIT
//
// Calls with placed streams (sk/placed.hpp): which elements of the whole an argument holds, and whether these are enough.
// Must not depend on the kind of device.
//
// Regions that a device cannot use as they lie in their streams: strided views and other shapes. A temporary stream of
// the region's shape takes its place. Elements that are read are copied to it before, and those that are written are
// copied from it afterwards, so that a call reads everything as it was, and elements between those of a region keep
// their values.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "call/resolved_call.hpp"
#include "device/stream_state.hpp"
#include "sk/call.hpp"
#include "sk/options.hpp"
#include "sk/program.hpp"

namespace sk {

/// Whether an argument is a part of a larger whole.
bool hasPlaced(std::span<const Argument> arguments);

/// The box itself, or all of the domain.
Box boxOrAll(const Box& box, const Shape& domain);

/// The elements that a placed region holds, as a box of the whole. It may reach beyond the ends of the whole.
Box heldBox(const StreamRegion& region);

/// The region of a box of the whole, which is not placed. Throws sk::Error if the region does not hold all of it.
StreamRegion partOfWhole(const program::Kernel& kernel, const program::Parameter& parameter,
                         const StreamRegion& region, const Box& box);

/// Throws sk::Error if outputs, inputs and gathers do not hold what a kernel needs to compute the box (which is not
/// empty), or if it cannot run with placed streams. The arguments have passed checkCall(). `mostCounted` is the largest
/// number of elements that the device counts (DeviceLimits::elements).
void checkPlacedCall(const ResolvedCall& call, const Box& box, std::int64_t mostCounted);

/// A call without placed arguments that computes the same.
struct LocalCall {
  std::vector<Argument> arguments;
  Shape domain;
  Box box;  ///< what it writes of the domain
  Placement place = {};  ///< of the domain, if the kernel asks where its elements are
};

/// The call over what its arguments hold, which must all begin at one index and have one shape. Nullopt unless that is the
/// same: the kernel does not ask where its elements are, and boundary modes do nothing, or the same, at the ends of what
/// gathers hold. The call has passed checkPlacedCall().
std::optional<LocalCall> localCall(const ResolvedCall& call, const Box& box);

/// Whether a placed gather may be read like a stream that is not placed, for the elements of a box of the whole: only near
/// the element, at offsets that skc knows, and boundary modes do nothing, or the same, at the ends of what it holds.
/// `call.domain` is the whole.
bool isReadAsHeld(const ResolvedCall& call, std::size_t gather, const Box& box);

/// The call over what its outputs hold, or over the box alone, for devices whose domain is a region of a stream.
/// Arguments stay placed, and the domain is.
LocalCall partCall(const ResolvedCall& call, const Box& box);

/// A region, or the temporary stream in its place.
class DenseRegion {
 public:
  /// For transfers between a region and host memory. `isRead`: copies the elements first.
  DenseRegion(const StreamRegion& region, bool isRead);
  const StreamRegion& get() const { return region_; }
  /// Copies the elements to the region if they are in a temporary stream.
  void finish() const;

 private:
  StreamRegion given_, region_;
  std::unique_ptr<StreamState> stream_;
};

/// The checked arguments of a call, with temporary streams in place of some.
class DenseArguments {
 public:
  DenseArguments(const program::Kernel& kernel, std::span<const Argument> arguments);

  /// True if the call can use all arguments as they are.
  bool areAsGiven() const { return temporaries_.empty(); }
  std::span<const Argument> get() const {
    return areAsGiven() ? given_ : std::span<const Argument>(arguments_);
  }
  /// Copies what the call has written to the arguments that were given.
  void finish() const;

 private:
  struct Temporary {
    std::size_t argument;
    std::unique_ptr<StreamState> stream;
    bool isWritten;
  };
  void replace(std::size_t argument, bool isRead, bool isWritten);

  std::span<const Argument> given_;
  std::vector<Argument> arguments_;
  std::vector<Temporary> temporaries_;
};

/// Whether any argument of a checked call needs a temporary stream.
bool needsDenseArguments(const program::Kernel& kernel, std::span<const Argument> arguments);

}  // namespace sk
