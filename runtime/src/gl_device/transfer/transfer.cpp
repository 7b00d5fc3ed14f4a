// SPDX-License-Identifier: MIT
//
// Elements that equal their texels are transferred as they are, others through a staging buffer of a few MiB.

#include "gl_device/transfer/transfer.hpp"

#include <algorithm>
#include <vector>

#include "gl_device/gl_device.hpp"
#include "gl_device/memory/element_packing.hpp"
#include "support/checked_size.hpp"

namespace sk {

namespace {

using assemble::Rect;
using assemble::RegionLayout;

/// Whether transferring the rows that contain a region `times` times is cheaper than transferring each run.
/// `cost`: the fixed cost of one transfer, in bytes.
bool goesByRows(const RegionLayout& region, std::size_t texelBytes, std::int64_t cost, std::int64_t times) {
  if (!region.linear) return false;
  const ElementRuns runs(region);
  if (runs.count == 1) return false;
  const CopyRegion rows{rowsOf(region), CopyRegion::wholeRows};
  const auto rowBytes = static_cast<std::int64_t>(rows.texels() * texelBytes);
  const auto runBytes = runs.length * static_cast<std::int64_t>(texelBytes);
  return times * (rowBytes + cost) < runs.count * (runBytes + cost);
}

/// Calls visit(part, layer, bytes) for the parts of a rectangle that lie in one layer each; `bytes` are those
/// of the rows above.
template <class Visit>
void forEachLayerOf(const RenderTarget& plane, const Rect& rect, std::size_t texelBytes, Visit&& visit) {
  const std::size_t rowBytes = static_cast<std::size_t>(rect.width) * texelBytes;
  const std::int32_t layerRows = plane.texture.isLayered() ? plane.texture.size().height : 0;
  forEachLayer(rect, layerRows, [&](const Rect& part, std::int32_t layer, std::int32_t row) {
    visit(part, layer, static_cast<std::size_t>(row) * rowBytes);
  });
}

/// Calls visit(texel, element, count) for the runs of elements whose texels are consecutive in a rectangle.
template <class Visit>
void forEachRun(const RegionLayout& region, const CopyRegion& part, Visit&& visit) {
  if (part.first != CopyRegion::wholeRows) {
    visit(std::size_t{0}, static_cast<std::size_t>(part.first), part.texels());
    return;
  }
  const ElementRuns runs(region);
  const std::int64_t base = std::int64_t{part.rect.y} << region.shift;
  for (std::int64_t run = 0; run < runs.count; ++run) {
    visit(static_cast<std::size_t>(runs.start(run) - base), static_cast<std::size_t>(run * runs.length),
          static_cast<std::size_t>(runs.length));
  }
}

}  // namespace

void writeTexels(gl::BoundState& bound, RenderTarget& plane, const Rect& rect, const std::byte* texels) {
  const std::size_t texelBytes = plane.texture.format().texelBytes();
  forEachLayerOf(plane, rect, texelBytes, [&](const Rect& part, std::int32_t layer, std::size_t above) {
    plane.texture.write(bound, {part.x, part.y, part.width, part.height}, layer, texels + above);
  });
}

void readTexels(gl::BoundState& bound, RenderTarget& plane, const Rect& rect, const gl::Transfer& transfer,
                std::byte* texels) {
  gl::Framebuffer& framebuffer = plane.framebufferIn(bound);
  forEachLayerOf(plane, rect, transfer.texelBytes(),
                 [&](const Rect& part, std::int32_t layer, std::size_t above) {
                   if (plane.texture.isLayered()) framebuffer.selectLayer(bound, layer);
                   framebuffer.read(bound, transfer, part.x, part.y, part.width, part.height, texels + above);
                 });
}

/// GL reads every format as Format::tight. ES guarantees Format::wide and one more, of the driver's choice.
gl::Transfer readTransferOf(GlContext& context, RenderTarget& plane) {
  const gl::Format& format = plane.texture.format();
  const bool readsTight = context.capabilities().api == gl::Api::Gl || format.tight == format.wide ||
                          plane.framebufferIn(context.bound()).readsOnEs(context.bound(), format.tight);
  return readsTight ? format.tight : format.wide;
}

void PlaneOfElements::pack(const CopyRegion& part, const std::byte* elements, std::byte* texels) const {
  const std::size_t texelBytes = format.texelBytes();
  forEachRun(region, part, [&](std::size_t texel, std::size_t first, std::size_t count) {
    packTexels(element, field, elements + first * element.size, count, texels + texel * texelBytes);
  });
}

void PlaneOfElements::unpack(const CopyRegion& part, const std::byte* texels, std::byte* elements) const {
  const std::size_t texelBytes = format.texelBytes();
  forEachRun(region, part, [&](std::size_t texel, std::size_t first, std::size_t count) {
    unpackTexels(element, field, texels + texel * texelBytes, count, elements + first * element.size);
  });
}

bool readsByRows(const gl::DeviceTraits& traits, const RegionLayout& region, std::size_t texelBytes) {
  return goesByRows(region, texelBytes, traits.readBytes, 1);
}

bool writesByRows(const gl::DeviceTraits& traits, const RegionLayout& region, std::size_t texelBytes) {
  return goesByRows(region, texelBytes, traits.uploadBytes, 2);
}

namespace {

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
      resizeChecked(texels, part.texels() * texelBytes);
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
