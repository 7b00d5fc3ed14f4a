// SPDX-License-Identifier: MIT
//
// The intrinsics of the language (ir/intrinsics.def) in all lanes. What has no short form in arithmetic is a function of
// skc's own library, or, where that has none for the type, of the C library, lane by lane.
#pragma once

#include <functional>
#include <optional>

#include "ir/intrinsics.hpp"
#include "native/lanes.hpp"

namespace skc::native {

struct IntrinsicArgument {
  ir::Type type;
  Parts parts;
};

/// Calls the library's function for an intrinsic of one component, if it has one.
using LibraryCall = std::function<std::optional<Part>(ir::Intrinsic, ir::Scalar, const std::vector<Part>&)>;

/// The components of a call's result.
Parts intrinsic(Lanes& lanes, ir::Intrinsic intrinsic, const std::vector<IntrinsicArgument>& arguments,
                const LibraryCall& library);

/// floor(x), in each lane.
Part floorOf(Lanes& lanes, const Part& x);
/// A whole real number as an index: NaN is 0, and the upper end is the largest int that a float holds, on every device.
Part wholeIndex(Lanes& lanes, const Part& x);

}  // namespace skc::native
