// SPDX-License-Identifier: MIT
//
// Transfers texels in rectangles: directly if the elements equal their texels, else through a staging buffer
// of a few MiB. A linearised region of many short runs is transferred as the whole rows that contain it.
#include "gl_device/transfer/transfer.hpp"

#include <algorithm>
#include <vector>

#include "gl_device/gl_device.hpp"
#include "gl_device/memory/element_packing.hpp"
#include "gl_device/transfer/copy_regions.hpp"

namespace sk {

namespace {

using assemble::Rect;
using assemble::RegionLayout;
using program::Element;
using program::Field;

constexpr std::size_t stagingBytes = std::size_t{4} << 20;

/// The fixed cost of one transfer, in bytes that could be transferred in the same time (measured on llvmpipe:
/// 1 us for an upload and 15 us for a readback, at about 4 GB/s).
constexpr std::int64_t uploadCost = 4 << 10;
constexpr std::int64_t readCost = 64 << 10;

std::size_t texelsOf(const Rect& rect) {
  return static_cast<std::size_t>(rect.width) * static_cast<std::size_t>(rect.height);
}

/// Calls visit(band, first) for bands of rows of `rect`, each of which fits the staging buffer unless it is a
/// single row. `first` is the number of texels above the band.
template <class Visit>
void forEachBand(const Rect& rect, std::size_t texelBytes, Visit&& visit) {
  const std::size_t rowBytes = static_cast<std::size_t>(rect.width) * texelBytes;
  const auto rows = static_cast<std::int32_t>(std::clamp<std::size_t>(stagingBytes / rowBytes, 1, 1u << 20));
  for (std::int32_t y = 0; y < rect.height; y += rows) {
    visit(Rect{rect.x, rect.y + y, rect.width, std::min(rows, rect.height - y)},
          static_cast<std::size_t>(y) * static_cast<std::size_t>(rect.width));
  }
}

/// Transfers the texels of one plane.
class PlaneTransfer {
 public:
  /// `isBroken`, which is set before texels are written, may be null if none are.
  PlaneTransfer(GlDevice& device, const Element& element, const Field& field, RenderTarget& renderTarget,
                bool* isBroken)
      : device_(device),
        element_(element),
        field_(field),
        renderTarget_(renderTarget),
        format_(renderTarget.texture.format()),
        isBroken_(isBroken) {}

  void write(const Rect& rect, const std::byte* elements) {
    if (areTexels(element_)) {
      writeTexels(rect, elements);
      return;
    }
    forEachBand(rect, format_.texelBytes(), [&](const Rect& band, std::size_t first) {
      std::byte* texels = staging(texelsOf(band) * format_.texelBytes());
      packTexels(element_, field_, elements + first * element_.size, texelsOf(band), texels);
      writeTexels(band, texels);
    });
  }

  void read(const Rect& rect, std::byte* elements) {
    if (areTexels(element_)) {
      readTexels(rect, elements);
      return;
    }
    std::vector<std::byte> texels;
    forEachBand(rect, format_.texelBytes(), [&](const Rect& band, std::size_t first) {
      texels.resize(texelsOf(band) * format_.texelBytes());
      readTexels(band, texels.data());
      unpackTexels(element_, field_, texels.data(), texelsOf(band), elements + first * element_.size);
    });
  }

  void writeByRows(const RegionLayout& region, const std::byte* elements) {
    forEachRowRun(region, [&](std::byte* texels, std::int64_t first, std::size_t count) {
      packTexels(element_, field_, elements + static_cast<std::size_t>(first) * element_.size, count, texels);
    });
    writeTexels(rowsOf(region), rows_.data());
  }

  void readByRows(const RegionLayout& region, std::byte* elements) {
    forEachRowRun(region, [&](const std::byte* texels, std::int64_t first, std::size_t count) {
      unpackTexels(element_, field_, texels, count,
                   elements + static_cast<std::size_t>(first) * element_.size);
    });
  }

 private:
  std::byte* staging(std::size_t bytes) {
    if (device_.staging.size() < bytes) {
      device_.staging.resize(bytes);
    }
    return device_.staging.data();
  }

  /// Reads rowsOf(region) to rows_, and calls visit(texels, first, count) for each run of the region.
  template <class Visit>
  void forEachRowRun(const RegionLayout& region, Visit&& visit) {
    const Rect rows = rowsOf(region);
    rows_.resize(texelsOf(rows) * format_.texelBytes());
    readTexels(rows, rows_.data());
    const ElementRuns runs(region);
    const std::int64_t base = std::int64_t{rows.y} << region.shift;
    for (std::int64_t run = 0; run < runs.count; ++run) {
      visit(rows_.data() + static_cast<std::size_t>(runs.start(run) - base) * format_.texelBytes(),
            run * runs.length, static_cast<std::size_t>(runs.length));
    }
  }

  std::int32_t layerRows() const {
    return renderTarget_.texture.isLayered() ? renderTarget_.texture.shape().height : 0;
  }
  std::size_t bytesOfRows(const Rect& rect, std::int32_t rows) const {
    return static_cast<std::size_t>(rect.width) * static_cast<std::size_t>(rows) * format_.texelBytes();
  }

  void writeTexels(const Rect& rect, const std::byte* texels) {
    *isBroken_ = true;
    forEachLayer(rect, layerRows(), [&](const Rect& part, std::int32_t layer, std::int32_t first) {
      renderTarget_.texture.write(device_.bound, part, layer, texels + bytesOfRows(rect, first));
    });
  }

  void readTexels(const Rect& rect, std::byte* texels) {
    gl::Framebuffer& framebuffer = renderTarget_.framebufferIn(device_.bound);
    forEachLayer(rect, layerRows(), [&](const Rect& part, std::int32_t layer, std::int32_t first) {
      if (renderTarget_.texture.isLayered()) {
        framebuffer.selectLayer(device_.bound, layer);
      }
      readAttached(part, texels + bytesOfRows(rect, first));
    });
  }

  void readAttached(const Rect& rect, std::byte* texels) {
    if (readsTight()) {
      renderTarget_.framebuffer.read(device_.bound, format_.tight, rect.x, rect.y, rect.width, rect.height,
                                     texels);
      return;
    }
    forEachBand(rect, format_.wide.texelBytes(), [&](const Rect& band, std::size_t first) {
      std::byte* wide = staging(texelsOf(band) * format_.wide.texelBytes());
      renderTarget_.framebuffer.read(device_.bound, format_.wide, band.x, band.y, band.width, band.height,
                                     wide);
      narrowTexels(format_, wide, texelsOf(band), texels + first * format_.texelBytes());
    });
  }

  bool readsTight() const { return readTransferOf(device_, renderTarget_) == format_.tight; }

  GlDevice& device_;
  const Element& element_;
  const Field& field_;
  RenderTarget& renderTarget_;
  const gl::Format& format_;
  bool* isBroken_;
  std::vector<std::byte> rows_;
};

/// Whether transferring the rows that contain a region `times` times is cheaper than transferring each run.
/// `cost`: the fixed cost of one transfer.
bool goesByRows(const RegionLayout& region, std::size_t texelBytes, std::int64_t cost, std::int64_t times) {
  if (!region.linear) {
    return false;
  }
  const ElementRuns runs(region);
  const auto rowBytes = static_cast<std::int64_t>(texelsOf(rowsOf(region)) * texelBytes);
  const auto runBytes = runs.length * static_cast<std::int64_t>(texelBytes);
  return runs.count > 1 && times * (rowBytes + cost) < runs.count * (runBytes + cost);
}

}  // namespace

/// GL reads every format as Format::tight. ES guarantees Format::wide and one more, of the driver's choice.
gl::Transfer readTransferOf(GlDevice& device, RenderTarget& plane) {
  const gl::Format& format = plane.texture.format();
  const bool readsTight = device.capabilities.api == gl::Api::Gl || format.tight == format.wide ||
                          plane.framebufferIn(device.bound).readsOnEs(device.bound, format.tight);
  return readsTight ? format.tight : format.wide;
}

bool readsByRows(const RegionLayout& region, std::size_t texelBytes) {
  return goesByRows(region, texelBytes, readCost, 1);
}

void upload(GlDevice& device, const Element& element, std::span<RenderTarget> planes,
            const RegionLayout& region, const std::byte* elements, bool& isBroken) {
  for (std::size_t i = 0; i < planes.size(); ++i) {
    PlaneTransfer plane(device, element, element.fields[i], planes[i], &isBroken);
    if (goesByRows(region, planes[i].texture.format().texelBytes(), uploadCost, 2)) {
      plane.writeByRows(region, elements);
    } else {
      forEachCopyRegion(region, [&](const CopyRegion& run) {
        plane.write(run.rect, elements + static_cast<std::size_t>(run.first) * element.size);
      });
    }
  }
}

void download(GlDevice& device, const Element& element, std::span<RenderTarget> planes,
              const RegionLayout& region, std::byte* elements) {
  for (std::size_t i = 0; i < planes.size(); ++i) {
    PlaneTransfer plane(device, element, element.fields[i], planes[i], nullptr);
    if (readsByRows(region, planes[i].texture.format().texelBytes())) {
      plane.readByRows(region, elements);
    } else {
      forEachCopyRegion(region, [&](const CopyRegion& run) {
        plane.read(run.rect, elements + static_cast<std::size_t>(run.first) * element.size);
      });
    }
  }
  device.throwPendingError();
}

}  // namespace sk
