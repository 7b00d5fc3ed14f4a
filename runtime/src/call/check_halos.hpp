// SPDX-License-Identifier: MIT
//
// SK_CHECK=halos: tests on each call whether kernels read gathers as near to their elements as their descriptors say, which
// for indices that are computed is only what [[halo]] promises. Each test runs the kernel for a line of elements, once as it
// is, and once after changing all elements that are farther from the line than the descriptor allows: results that differ
// show a read beyond. Must not depend on the kind of device.
#pragma once

#include <functional>

#include "call/resolved_call.hpp"

namespace sk {

class DeviceState;

/// Throws sk::Error if a kernel reads farther. `run` runs a call of the same kernel with other arguments and options. Tests
/// every line of the domain where a dimension has no more than 64, and otherwise 64 of them. Kernels that push or scatter are not
/// tested.
void checkHalos(DeviceState& device, const ResolvedCall& call,
                const std::function<void(const ResolvedCall&)>& run);

/// Likewise for lines of the box of a call with placed streams, once it has passed checkPlacedCall(). The gather then holds
/// what the line may read, and one element more on each side, which stands for all that is farther away.
void checkPlacedHalos(DeviceState& device, const ResolvedCall& call,
                      const std::function<void(const ResolvedCall&)>& run);

/// Changes every member of an element.
void changeBits(const program::Element& element, std::byte* bytes);

}  // namespace sk
