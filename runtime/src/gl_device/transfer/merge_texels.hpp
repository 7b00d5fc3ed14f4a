// SPDX-License-Identifier: MIT
//
// Draws elements to a strided region of a packed stream. If the stride along x is 1, 2 or 4, the region has the same components of
// each texel, and a colour mask keeps the others as they are. So a texel is drawn once, and the stream stays packed.
#pragma once

#include <span>

#include "assemble/region_layout.hpp"
#include "gl_device/gl_device.hpp"
#include "sk/program.hpp"

namespace sk {

/// Whether the region of a packed stream consists of the same components of each texel, and rows at regular distances, and passes are
/// drawn. A loop that is recorded repeats no such pass.
bool mayMerge(GlDevice& device, const assemble::RegionLayout& source, const assemble::RegionLayout& target);

/// Compiles the program, so that mergeTexels() cannot fail for it.
void prepareMerge(GlDevice& device, const program::Element& element, const assemble::RegionLayout& source,
                  const assemble::RegionLayout& target);

/// Copies the elements of `source`, which lies in `from`, to `target` in `to`. Both hold scalars of type `element`.
void mergeTexels(GlDevice& device, const program::Element& element, std::span<RenderTarget> from,
                 const assemble::RegionLayout& source, RenderTarget& to,
                 const assemble::RegionLayout& target);

}  // namespace sk
