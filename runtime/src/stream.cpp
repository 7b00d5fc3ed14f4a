// SPDX-License-Identifier: MIT
//
// What streams and views do: life, regions, reading, writing.
#include "sk/stream.hpp"

#include <fmt/format.h>

#include "device_state.hpp"
#include "sink_list.hpp"
#include "sk/error.hpp"
#include "stream_state.hpp"
#include "transfer.hpp"

namespace sk {

namespace {

/// Checks a transfer of `count` elements; the stream, or null where there is nothing to transfer.
StreamState* checkTransfer(const StreamRegion& region, std::size_t count, const char* what) {
  StreamState& stream = liveStream(region, what);
  const std::int64_t size = region.shape.size();
  if (static_cast<std::size_t>(size) != count) {
    throw Error(fmt::format("{}: {} element(s) in host memory, but shape {} has {}; give exactly as many",
                            what, count, toString(region.shape), size));
  }
  return size == 0 ? nullptr : &stream;
}

}  // namespace

StreamState::StreamState(DeviceState& owner, const program::Element& type, const Shape& extents)
    : device(&owner), element(&type), shape(extents), layout(layoutOf(extents, owner.textureLimits())) {
  if (layout.texture.width > 0) {
    planes = owner.takePlanes(type, layout.texture,
                              fmt::format("a stream of {} of shape {}", type.name, toString(extents)));
  }
  owner.add(*this);
}

StreamState::~StreamState() {
  if (device != nullptr) {
    if (total_) {
      device->pool.give(std::move(total_));
    }
    device->givePlanes(planes);
    device->remove(*this);
  }
}

void StreamState::become(std::vector<Surface>& elements, const Layout& list, Surface* total) {
  std::swap(planes, elements);
  layout = list;
  if (total_) {
    device->pool.give(std::move(total_));
    total_ = {};
  }
  if (total != nullptr) {
    total_ = std::move(*total);
  } else {
    takeSize(layout.whole.extent[0]);
  }
}

void StreamState::settle() {
  if (!total_) {
    return;
  }
  const DeviceScope scope(*device);
  takeSize(readTotal(*device, total_));
  device->pool.give(std::move(total_));
  total_ = {};
}

void StreamState::takeSize(std::int32_t count) {
  shape = Shape(count);
  layout.whole.extent = {count, 1, 1, 1};
  layout.whole.stride = assemble::stridesOf(layout.whole.extent);
  layout.draws = assemble::drawnTexels(layout.whole);
}

bool isInside(const StreamRegion& region) {
  const Shape& shape = region.stream->shape;
  bool inside = region.shape.rank() == shape.rank();
  for (int d = 0; inside && d < shape.rank(); ++d) {
    inside = region.begin[d] + region.shape[d] <= shape[d];
  }
  return inside;
}

StreamState& liveStream(const StreamRegion& region, std::string_view context) {
  if (region.stream == nullptr) {
    throw Error(fmt::format("{}: the stream was moved from", context));
  }
  if (region.stream->device == nullptr) {
    throw Error(
        fmt::format("{}: the device of this stream of shape {} has been destroyed; keep the device for as "
                    "long as its streams are used",
                    context, toString(region.stream->shape)));
  }
  region.stream->settle();
  if (region.shape.rank() > 0 && !isInside(region)) {
    throw Error(fmt::format(
        "{}: a view from {} of shape {} is no longer inside its stream, to which a kernel has pushed {} "
        "element(s); make the view after the call",
        context, toString(region.begin), toString(region.shape), region.stream->shape.size()));
  }
  return *region.stream;
}

void detail::StreamDeleter::operator()(StreamState* state) const noexcept { delete state; }

StreamRegion detail::wholeRegion(StreamState* state) {
  if (state == nullptr) {
    return {};
  }
  if (state->device != nullptr) {
    state->settle();
  }
  return {state, Index::origin(state->shape.rank()), state->shape};
}

StreamRegion detail::partOf(const StreamRegion& region, const Index& begin, const Index& end) {
  if (region.stream == nullptr) {
    throw Error("domain: the stream was moved from");
  }
  const int rank = region.shape.rank();
  bool isInside = begin.rank() == rank && end.rank() == rank;
  for (int d = 0; isInside && d < rank; ++d) {
    isInside = begin[d] >= 0 && begin[d] <= end[d] && end[d] <= region.shape[d];
  }
  if (!isInside) {
    throw Error(fmt::format(
        "domain: {} (inclusive) to {} (exclusive) is no box inside shape {}; give each a position "
        "in every dimension, rows first",
        toString(begin), toString(end), toString(region.shape)));
  }
  StreamRegion part = region;
  for (int d = 0; d < rank; ++d) {
    part.begin[d] += begin[d];
    part.shape = part.shape.with(d, end[d] - begin[d]);
  }
  return part;
}

void detail::write(const StreamRegion& region, const void* elements, std::size_t count) {
  if (StreamState* stream = checkTransfer(region, count, "write")) {
    const DeviceScope scope(*stream->device);
    upload(*stream->device, *stream->element, stream->planes, placementOf(region, stream->layout),
           static_cast<const std::byte*>(elements));
  }
}

void detail::read(const StreamRegion& region, void* elements, std::size_t count) {
  if (StreamState* stream = checkTransfer(region, count, "read")) {
    const DeviceScope scope(*stream->device);
    download(*stream->device, *stream->element, stream->planes, placementOf(region, stream->layout),
             static_cast<std::byte*>(elements));
  }
}

StreamTexture detail::textureOf(StreamState* state, int plane) {
  const StreamState& stream = liveStream({state, {}, {}}, "texture");
  const auto count = static_cast<int>(stream.element->fields.size());
  if (plane < 0 || plane >= count) {
    throw Error(
        fmt::format("texture: there is no plane {}; {} has {}, from 0", plane, stream.element->name, count));
  }
  if (stream.planes.empty()) {
    return {};
  }
  const gl::Texture& texture = stream.planes[static_cast<std::size_t>(plane)].texture;
  const assemble::TextureShape& shape = texture.shape();
  return {texture.name(), texture.format().internalFormat, shape.width,
          shape.height,   stream.layout.whole.linear,      shape.layers};
}

}  // namespace sk
