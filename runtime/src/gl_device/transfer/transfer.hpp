// SPDX-License-Identifier: MIT
//
// Elements between host memory and a region of a stream. A scope of the device must be open.
#pragma once

#include <cstddef>
#include <span>

#include "assemble/region_layout.hpp"
#include "gl_device/memory/render_target.hpp"
#include "sk/program.hpp"

namespace sk {

class GlDevice;

/// How a plane's texels are read: Format::tight, or, where the driver cannot, Format::wide.
gl::Transfer readTransferOf(GlDevice& device, RenderTarget& plane);

/// Whether it is cheaper to read the rows that a region lies in than each of its runs by itself.
bool readsByRows(const assemble::RegionLayout& region, std::size_t texelBytes);

/// Copies all elements of a region, row-major in host memory, to its planes. `isTorn` is set when these begin to change.
void upload(GlDevice& device, const program::Element& element, std::span<RenderTarget> planes,
            const assemble::RegionLayout& region, const std::byte* elements, bool& isTorn);

/// The other way. Waits for the device. Throws sk::Error where the driver has reported an error since
/// it was last asked.
void download(GlDevice& device, const program::Element& element, std::span<RenderTarget> planes,
              const assemble::RegionLayout& region, std::byte* elements);

}  // namespace sk
