// SPDX-License-Identifier: MIT
//
// Elements that equal their texels are transferred as they are, others through a staging buffer of a few MiB.
#include "gl_device/transfer/transfer.hpp"

#include <algorithm>
#include <vector>

#include "gl_device/gl_device.hpp"
#include "gl_device/memory/element_packing.hpp"
#include "gl_device/transfer/texels.hpp"

namespace sk {

namespace {

using assemble::RegionLayout;
using program::Element;

constexpr std::size_t stagingBytes = std::size_t{4} << 20;

using StagingBuffer = KeptScratch<std::byte>::Lease;

/// Calls visit(band) for bands of rows, each of which fits the staging buffer unless it is a single row.
template <class Visit>
void forEachBand(const CopyRegion& whole, std::size_t texelBytes, Visit&& visit) {
  const assemble::Rect& rect = whole.rect;
  const std::size_t rowBytes = static_cast<std::size_t>(rect.width) * texelBytes;
  const auto rows = static_cast<std::int32_t>(std::clamp<std::size_t>(stagingBytes / rowBytes, 1, 1u << 20));
  for (std::int32_t y = 0; y < rect.height; y += rows) {
    visit(CopyRegion{{rect.x, rect.y + y, rect.width, std::min(rows, rect.height - y)},
                     whole.first + std::int64_t{y} * rect.width});
  }
}

/// Reads a rectangle as Format::tight, whatever the driver reads.
void readTight(GlDevice& device, StagingBuffer& staging, RenderTarget& plane, const CopyRegion& part,
               std::byte* texels) {
  const gl::Format& format = plane.texture.format();
  const gl::Transfer transfer = readTransferOf(device.context(), plane);
  if (transfer == format.tight) {
    readTexels(device.bound(), plane, part.rect, transfer, texels);
    return;
  }
  forEachBand({part.rect, 0}, transfer.texelBytes(), [&](const CopyRegion& band) {
    std::byte* wide = staging.room(band.texels() * transfer.texelBytes());
    readTexels(device.bound(), plane, band.rect, transfer, wide);
    narrowTexels(format, wide, band.texels(),
                 texels + static_cast<std::size_t>(band.first) * format.texelBytes());
  });
}

}  // namespace

void upload(GlDevice& device, const Element& element, std::span<RenderTarget> planes,
            const RegionLayout& region, const std::byte* elements, WriteScope& writes) {
  StagingBuffer staging(device.memory().staging());
  for (std::size_t i = 0; i < planes.size(); ++i) {
    const PlaneOfElements plane{element, element.fields[i], planes[i].texture.format(), region};
    const std::size_t texelBytes = plane.format.texelBytes();
    const auto write = [&](const CopyRegion& part, const std::byte* texels) {
      writes.begin();
      writeTexels(device.bound(), planes[i], part.rect, texels);
    };
    forEachCopyRegion(region, writesByRows(device.traits, region, texelBytes), [&](const CopyRegion& part) {
      if (part.first == CopyRegion::wholeRows) {
        std::vector<std::byte> rows(part.texels() * texelBytes);
        readTight(device, staging, planes[i], part, rows.data());
        plane.pack(part, elements, rows.data());
        write(part, rows.data());
      } else if (areTexels(element)) {
        write(part, elements + static_cast<std::size_t>(part.first) * element.size);
      } else {
        forEachBand(part, texelBytes, [&](const CopyRegion& band) {
          std::byte* texels = staging.room(band.texels() * texelBytes);
          plane.pack(band, elements, texels);
          write(band, texels);
        });
      }
    });
  }
}

void download(GlDevice& device, const Element& element, std::span<RenderTarget> planes,
              const RegionLayout& region, std::byte* elements) {
  StagingBuffer staging(device.memory().staging());
  std::vector<std::byte> texels;
  for (std::size_t i = 0; i < planes.size(); ++i) {
    const PlaneOfElements plane{element, element.fields[i], planes[i].texture.format(), region};
    const std::size_t texelBytes = plane.format.texelBytes();
    const auto readPart = [&](const CopyRegion& part) {
      texels.resize(part.texels() * texelBytes);
      readTight(device, staging, planes[i], part, texels.data());
      plane.unpack(part, texels.data(), elements);
    };
    forEachCopyRegion(region, readsByRows(device.traits, region, texelBytes), [&](const CopyRegion& part) {
      if (part.first == CopyRegion::wholeRows) {
        readPart(part);
      } else if (areTexels(element)) {
        readTight(device, staging, planes[i], part,
                  elements + static_cast<std::size_t>(part.first) * element.size);
      } else {
        forEachBand(part, texelBytes, readPart);
      }
    });
  }
  device.throwPendingError();
}

}  // namespace sk
