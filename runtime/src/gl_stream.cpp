// SPDX-License-Identifier: MIT
#include "gl_stream.hpp"

#include <utility>

#include <fmt/format.h>

#include "assemble/planes.hpp"
#include "convert_elements.hpp"
#include "gl_device.hpp"
#include "pass.hpp"
#include "sink_list.hpp"
#include "sk/error.hpp"
#include "transfer.hpp"

namespace sk {

using assemble::Placement;

GlStream::GlStream(GlDevice& on, const program::Element& type, const Shape& extents, Storage as)
    : StreamState(on, type, extents, as) {
  if (storage != Storage::Single) {
    held_ = std::make_unique<assemble::HeldElement>(type, storage);
  }
  layout = layoutOf(extents, on.textureLimits(), canPack());
  planes = takePlanesFor(layout);
}

GlStream::~GlStream() {
  if (device == nullptr) {
    return;
  }
  if (total_) {
    owner().pool.give(std::move(total_));
  }
  owner().givePlanes(planes);
}

std::vector<Surface> GlStream::takePlanesFor(const Layout& planned) {
  if (planned.texture.width == 0) {
    return {};
  }
  const program::Element& texel =
      planned.whole.packed ? assemble::fourOf(held().fields.front().scalar) : held();
  return owner().takePlanes(texel, planned.texture,
                            fmt::format("a stream of {} of shape {}", element->name, toString(shape)));
}

void GlStream::relay(bool packed) {
  if (layout.whole.packed == packed) {
    return;
  }
  Layout wanted = layoutOf(shape, owner().textureLimits(), packed);
  std::vector<Surface> taken = takePlanesFor(wanted);
  owner().givePlanes(planes);
  planes = std::move(taken);
  layout = std::move(wanted);
}

void GlStream::unpack() {
  if (!layout.whole.packed) {
    return;
  }
  Layout wanted = layoutOf(shape, owner().textureLimits());
  PlanesLease lease(owner());
  lease.planes = takePlanesFor(wanted);
  copyRegion(owner(), held(), planes, layout.whole, lease.planes, wanted.whole);
  std::swap(planes, lease.planes);
  layout = std::move(wanted);
}

GlDevice& GlStream::owner() const { return static_cast<GlDevice&>(*device); }

void GlStream::become(std::vector<Surface>& elements, const Layout& list, Surface* total) {
  std::swap(planes, elements);
  layout = list;
  if (total_) {
    owner().pool.give(std::move(total_));
    total_ = {};
  }
  if (total != nullptr) {
    total_ = std::move(*total);
  } else {
    takeSize(layout.whole.extent[0]);
  }
}

void GlStream::settle() {
  if (!total_) {
    return;
  }
  const DeviceScope scope(owner());
  takeSize(readTotal(owner(), total_));
  owner().pool.give(std::move(total_));
  total_ = {};
}

void GlStream::takeSize(std::int32_t count) {
  shape = Shape(count);
  layout.whole.extent = {count, 1, 1, 1};
  layout.whole.stride = assemble::stridesOf(layout.whole.extent);
  layout.draws = assemble::drawnTexels(layout.whole);
}

// A region of whole texels travels as such, and others once the stream is no longer packed.
void GlStream::uploadHeld(const StreamRegion& region, const std::byte* elements) {
  const Placement place = placementOf(region, layout);
  if (place.packed && assemble::isWholeTexels(place)) {
    upload(owner(), assemble::fourOf(held().fields.front().scalar), planes, assemble::texelsOf(place),
           elements);
    return;
  }
  unpack();
  upload(owner(), held(), planes, placementOf(region, layout), elements);
}

void GlStream::downloadHeld(const StreamRegion& region, std::byte* elements) {
  const Placement place = placementOf(region, layout);
  if (place.packed && assemble::isWholeTexels(place)) {
    download(owner(), assemble::fourOf(held().fields.front().scalar), planes, assemble::texelsOf(place),
             elements);
    return;
  }
  unpack();
  download(owner(), held(), planes, placementOf(region, layout), elements);
}

void GlStream::write(const StreamRegion& region, const std::byte* elements) {
  const DeviceScope scope(owner());
  if (!held_) {
    uploadHeld(region, elements);
    return;
  }
  const auto count = static_cast<std::size_t>(region.shape.size());
  std::vector<std::byte> converted(count * held().size);
  convertElements(*element, elements, held(), converted.data(), count);
  uploadHeld(region, converted.data());
}

void GlStream::read(const StreamRegion& region, std::byte* elements) {
  const DeviceScope scope(owner());
  if (!held_) {
    downloadHeld(region, elements);
    return;
  }
  const auto count = static_cast<std::size_t>(region.shape.size());
  std::vector<std::byte> converted(count * held().size);
  downloadHeld(region, converted.data());
  convertElements(held(), converted.data(), *element, elements, count);
}

void GlStream::readReals(const StreamRegion& region, double* values) {
  const DeviceScope scope(owner());
  const auto count = static_cast<std::size_t>(region.shape.size());
  std::vector<std::byte> converted(count * held().size);
  downloadHeld(region, converted.data());
  readComponents(held(), converted.data(), count, values);
}

void GlStream::writeReals(const StreamRegion& region, const double* values) {
  const DeviceScope scope(owner());
  const auto count = static_cast<std::size_t>(region.shape.size());
  std::vector<std::byte> converted(count * held().size);
  writeComponents(held(), converted.data(), count, values);
  uploadHeld(region, converted.data());
}

StreamTexture GlStream::texture(int plane) {
  if (planes.empty()) {
    return {};
  }
  if (layout.whole.packed) {
    const DeviceScope scope(owner());
    unpack();
  }
  const gl::Texture& texture = planes[static_cast<std::size_t>(plane)].texture;
  const assemble::TextureShape& extents = texture.shape();
  return {texture.name(), texture.format().internalFormat, extents.width, extents.height, layout.whole.linear,
          extents.layers};
}

}  // namespace sk
