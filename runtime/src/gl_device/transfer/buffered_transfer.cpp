// SPDX-License-Identifier: MIT
#include "gl_device/transfer/buffered_transfer.hpp"

#include <cstring>

#include <fmt/format.h>

#include "gl_device/gl_device.hpp"
#include "gl_device/memory/element_packing.hpp"
#include "gl_device/transfer/copy_regions.hpp"
#include "gl_device/transfer/transfer.hpp"
#include "sk/error.hpp"

namespace sk {

namespace {

using assemble::Rect;
using assemble::RegionLayout;
using program::Element;
using program::Field;

/// The alignment of a block in the buffer. GL requires a multiple of the size of a channel.
constexpr std::size_t alignment = 16;

std::size_t aligned(std::size_t bytes) { return (bytes + alignment - 1) / alignment * alignment; }

std::size_t texelsOf(const Rect& rect) {
  return static_cast<std::size_t>(rect.width) * static_cast<std::size_t>(rect.height);
}

/// An offset in the bound buffer, as the address that GL functions take.
void* atOffset(std::size_t offset) { return static_cast<std::byte*>(nullptr) + offset; }

[[noreturn]] void failForMemory(GlDevice& device, std::size_t bytes) {
  device.throwIfLost();
  throw Error(fmt::format("'{}' has no memory for a transfer of {} KiB", device.name(), bytes >> 10),
              Error::Kind::Memory);
}

std::int32_t layerRows(const RenderTarget& plane) {
  return plane.texture.isLayered() ? plane.texture.shape().height : 0;
}

}  // namespace

BufferedRead::BufferedRead(GlDevice& device) : device_(device), lease_(device.transferBuffers) {}

std::size_t BufferedRead::add(const Element& element, std::span<RenderTarget> planes,
                              const RegionLayout& region) {
  parts_.push_back({&element, region, blocks_.size()});
  for (std::size_t i = 0; i < planes.size(); ++i) {
    const Field& field = element.fields[i];
    if (readsByRows(region, planes[i].texture.format().texelBytes())) {
      addBlock(planes[i], field, rowsOf(region), wholeRows);
    } else {
      forEachCopyRegion(region,
                        [&](const CopyRegion& run) { addBlock(planes[i], field, run.rect, run.first); });
    }
  }
  return parts_.size() - 1;
}

void BufferedRead::addBlock(RenderTarget& plane, const Field& field, const Rect& rect, std::int64_t first) {
  const gl::Transfer transfer = readTransferOf(device_, plane);
  blocks_.push_back({&plane, &plane.texture.format(), &field, transfer, rect, first, bytes_});
  bytes_ += aligned(texelsOf(rect) * transfer.texelBytes());
}

void BufferedRead::begin() {
  {
    const gl::BoundPixels bound(lease_.held.buffer, gl::BoundPixels::Way::Read);
    if (!bound.allocate(device_.bound.errors, bytes_)) failForMemory(device_, bytes_);
    lease_.held.bytes = bytes_;
    for (const Block& block : blocks_) readBlock(block);
  }
  device_.bound.errors.setAside();
  lease_.held.fence = gl::Fence::insert(device_.bound.deletions);
  if (!lease_.held.fence) {
    static_cast<void>(device_.bound.errors.takeNew());
    failForMemory(device_, bytes_);
  }
}

void BufferedRead::readBlock(const Block& block) {
  gl::Framebuffer& framebuffer = block.plane->framebufferIn(device_.bound);
  const std::size_t rowBytes = static_cast<std::size_t>(block.rect.width) * block.transfer.texelBytes();
  forEachLayer(block.rect, layerRows(*block.plane),
               [&](const Rect& part, std::int32_t layer, std::int32_t row) {
                 if (block.plane->texture.isLayered()) framebuffer.selectLayer(device_.bound, layer);
                 framebuffer.read(device_.bound, block.transfer, part.x, part.y, part.width, part.height,
                                  atOffset(block.offset + static_cast<std::size_t>(row) * rowBytes));
               });
}

void BufferedRead::take(std::size_t part, std::byte* elements) {
  wait();
  const gl::BoundPixels bound(lease_.held.buffer, gl::BoundPixels::Way::Read);
  device_.bound.errors.setAside();
  const std::byte* texels = bound.map(bytes_);
  if (texels == nullptr) {
    static_cast<void>(device_.bound.errors.takeNew());
    failForMemory(device_, bytes_);
  }
  const std::size_t end = part + 1 < parts_.size() ? parts_[part + 1].firstBlock : blocks_.size();
  for (std::size_t i = parts_[part].firstBlock; i < end; ++i) {
    unpack(parts_[part], blocks_[i], texels + blocks_[i].offset, elements);
  }
  if (!bound.unmap()) failForMemory(device_, bytes_);
}

void BufferedRead::unpack(const Part& part, const Block& block, const std::byte* texels,
                          std::byte* elements) {
  const Element& element = *part.element;
  const std::size_t count = texelsOf(block.rect);
  std::vector<std::byte> narrowed;
  if (!(block.transfer == block.format->tight)) {
    narrowed.resize(count * block.format->texelBytes());
    narrowTexels(*block.format, texels, count, narrowed.data());
    texels = narrowed.data();
  }
  const auto unpackRun = [&](const std::byte* from, std::int64_t first, std::size_t length) {
    std::byte* to = elements + static_cast<std::size_t>(first) * element.size;
    if (areTexels(element)) {
      std::memcpy(to, from, length * element.size);
    } else {
      unpackTexels(element, *block.field, from, length, to);
    }
  };
  if (block.first != wholeRows) {
    unpackRun(texels, block.first, count);
    return;
  }
  const ElementRuns runs(part.region);
  const std::int64_t base = std::int64_t{block.rect.y} << part.region.shift;
  for (std::int64_t run = 0; run < runs.count; ++run) {
    unpackRun(texels + static_cast<std::size_t>(runs.start(run) - base) * block.format->texelBytes(),
              run * runs.length, static_cast<std::size_t>(runs.length));
  }
}

void readToBuffer(GlDevice& device, RenderTarget& plane, const RegionLayout& region, GLuint buffer,
                  std::size_t offset) {
  const gl::Transfer transfer = plane.texture.format().tight;
  if (!(readTransferOf(device, plane) == transfer)) {
    throw Error(
        fmt::format("fillBuffer: '{}' does not read texels of {} as they are; use a stream of vectors of 4",
                    device.name(), plane.texture.format().name));
  }
  const gl::BoundPixels bound(buffer, gl::BoundPixels::Way::Read);
  const std::size_t texelBytes = transfer.texelBytes();
  const std::size_t needed =
      offset + static_cast<std::size_t>(assemble::elements(region.extent)) * texelBytes;
  if (bound.size(device.bound.errors) < needed) {
    throw Error(fmt::format(
        "fillBuffer: the buffer {} has {} bytes, but {} are needed; allocate it by glBufferData first",
        buffer, bound.size(device.bound.errors), needed));
  }
  gl::Framebuffer& framebuffer = plane.framebufferIn(device.bound);
  forEachCopyRegion(region, [&](const CopyRegion& run) {
    const std::size_t from = offset + static_cast<std::size_t>(run.first) * texelBytes;
    const std::size_t rowBytes = static_cast<std::size_t>(run.rect.width) * texelBytes;
    forEachLayer(run.rect, layerRows(plane), [&](const Rect& part, std::int32_t layer, std::int32_t row) {
      if (plane.texture.isLayered()) framebuffer.selectLayer(device.bound, layer);
      framebuffer.read(device.bound, transfer, part.x, part.y, part.width, part.height,
                       atOffset(from + static_cast<std::size_t>(row) * rowBytes));
    });
  });
}

void writeBuffered(GlDevice& device, const Element& element, std::span<RenderTarget> planes,
                   const RegionLayout& region, const std::byte* elements, bool& isBroken) {
  const auto count = static_cast<std::size_t>(assemble::elements(region.extent));
  std::size_t bytes = 0;
  for (const RenderTarget& plane : planes) bytes += aligned(count * plane.texture.format().texelBytes());
  TransferBufferLease lease(device.transferBuffers);
  const gl::BoundPixels bound(lease.held.buffer, gl::BoundPixels::Way::Write);
  gl::Errors& errors = device.bound.errors;
  std::byte* const texels = bound.allocate(errors, bytes) ? bound.map(bytes) : nullptr;
  if (texels == nullptr) {
    static_cast<void>(errors.takeNew());
    failForMemory(device, bytes);
  }
  lease.held.bytes = bytes;
  std::size_t offset = 0;
  for (std::size_t i = 0; i < planes.size(); ++i) {
    packTexels(element, element.fields[i], elements, count, texels + offset);
    offset += aligned(count * planes[i].texture.format().texelBytes());
  }
  if (!bound.unmap()) failForMemory(device, bytes);
  isBroken = true;
  offset = 0;
  for (RenderTarget& plane : planes) {
    const std::size_t texelBytes = plane.texture.format().texelBytes();
    forEachCopyRegion(region, [&](const CopyRegion& run) {
      const std::size_t from = offset + static_cast<std::size_t>(run.first) * texelBytes;
      const std::size_t rowBytes = static_cast<std::size_t>(run.rect.width) * texelBytes;
      forEachLayer(run.rect, layerRows(plane), [&](const Rect& part, std::int32_t layer, std::int32_t row) {
        plane.texture.write(device.bound, part, layer,
                            atOffset(from + static_cast<std::size_t>(row) * rowBytes));
      });
    });
    offset += aligned(count * texelBytes);
  }
}

}  // namespace sk
