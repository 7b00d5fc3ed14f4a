// SPDX-License-Identifier: MIT
//
// Transfers elements between host memory and a region of a stream, without a pixel buffer, and the two steps of every
// transfer: rectangles of texels to and from memory, and these texels to and from elements of a region. Memory is host
// memory, or a bound pixel buffer, of which GL functions take an offset in place of an address. A DeviceScope must be open.
#pragma once

#include <cstddef>
#include <span>

#include "assemble/region_layout.hpp"
#include "device/write_scope.hpp"
#include "gl/known_devices.hpp"
#include "gl_device/gl_context.hpp"
#include "gl_device/memory/render_target.hpp"
#include "gl_device/transfer/copy_regions.hpp"
#include "sk/program.hpp"

namespace sk {

/// An offset in the bound pixel buffer, as the address that GL functions take.
inline std::byte* atOffset(std::size_t offset) { return static_cast<std::byte*>(nullptr) + offset; }

/// Writes a rectangle of texels, whose rows are numbered across layers, from texels of Format::tight.
void writeTexels(gl::BoundState& bound, RenderTarget& plane, const assemble::Rect& rect,
                 const std::byte* texels);
/// Reads such a rectangle. `transfer` must be readTransferOf(), or Format::tight if the device reads it.
void readTexels(gl::BoundState& bound, RenderTarget& plane, const assemble::Rect& rect,
                const gl::Transfer& transfer, std::byte* texels);

/// The layout in which the driver reads the texels of a plane: Format::tight, or Format::wide if it cannot.
gl::Transfer readTransferOf(GlContext& context, RenderTarget& plane);

/// One plane of the elements of a region, which are row-major in host memory.
struct PlaneOfElements {
  const program::Element& element;
  const program::Field& field;
  const gl::Format& format;  ///< of the plane
  const assemble::RegionLayout& region;

  /// Writes the elements of a rectangle to its texels (Format::tight). Those of whole rows that do not belong
  /// to the region are not changed.
  void pack(const CopyRegion& part, const std::byte* elements, std::byte* texels) const;
  /// The inverse of pack(). Writes only the bytes of the field in each element.
  void unpack(const CopyRegion& part, const std::byte* texels, std::byte* elements) const;
};

/// Whether it is faster to read the rows that contain a region than each run of its elements.
bool readsByRows(const gl::DeviceTraits& traits, const assemble::RegionLayout& region,
                 std::size_t texelBytes);
/// Whether it is faster to read these rows, change and write them than to write each run.
bool writesByRows(const gl::DeviceTraits& traits, const assemble::RegionLayout& region,
                  std::size_t texelBytes);

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
