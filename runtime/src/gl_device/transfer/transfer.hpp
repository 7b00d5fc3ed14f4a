// SPDX-License-Identifier: MIT
//
// Transfers elements between host memory and a region of a stream, without a pixel buffer. A DeviceScope must
// be open.
#pragma once

#include <cstddef>
#include <span>

#include "assemble/region_layout.hpp"
#include "device/write_scope.hpp"
#include "gl_device/memory/render_target.hpp"
#include "sk/program.hpp"

namespace sk {

class GlDevice;

/// Copies all elements of a region, row-major in host memory, to its planes. Begins `writes` before they
/// change.
void upload(GlDevice& device, const program::Element& element, std::span<RenderTarget> planes,
            const assemble::RegionLayout& region, const std::byte* elements, WriteScope& writes);

/// Copies all elements of a region from its planes to host memory, row-major. Waits for the device. Throws
/// sk::Error like GlDevice::throwPendingError().
void download(GlDevice& device, const program::Element& element, std::span<RenderTarget> planes,
              const assemble::RegionLayout& region, std::byte* elements);

}  // namespace sk
