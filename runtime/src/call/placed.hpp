// SPDX-License-Identifier: MIT
//
// Calls with placed streams (sk/placed.hpp): which elements of the whole an argument holds, and whether these are enough.
// Must not depend on the kind of device.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "call/resolved_call.hpp"
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

}  // namespace sk
