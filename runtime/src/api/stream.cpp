// SPDX-License-Identifier: MIT
//
// Implements streams and views: lifetime, regions, reading and writing.
#include "sk/stream.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "call/check_written.hpp"
#include "call/placed.hpp"
#include "device/device_state.hpp"
#include "device/loop_state.hpp"
#include "device/region.hpp"
#include "device/stream_state.hpp"
#include "results/call_scope.hpp"
#include "sk/error.hpp"
#include "sk/limits.hpp"
#include "support/checked_size.hpp"

namespace sk {

namespace {

/// Checks a transfer of `count` elements. Returns the stream, or null if there is nothing to transfer.
StreamState* checkTransfer(const StreamRegion& region, std::size_t count, bool isWritten, const char* what) {
  StreamState& stream = liveStream(region, what);
  refuseInRecording(*stream.device, what);
  checkNotLost(region, isWritten, what);
  const std::int64_t size = region.shape.size();
  if (static_cast<std::size_t>(size) != count) {
    throw Error(fmt::format("{}: {} element(s) in host memory, but shape {} has {}; give exactly as many",
                            what, count, toString(region.shape), size),
                Error::Kind::Shape);
  }
  if (!isWritten) checkWritten(region, what);
  return size == 0 ? nullptr : &stream;
}

/// Records a transfer of a region's elements in its device's trace.
class TransferScope {
 public:
  TransferScope(const StreamState& stream, std::string_view what, const StreamRegion& region)
      : traced_(stream.device->trace.get(), "transfer", what) {
    traced_.add("stream", stream.name);
    traced_.add("shape", region.shape);
    traced_.add("bytes", region.shape.size() * static_cast<std::int64_t>(stream.element->size));
  }

 private:
  TraceScope traced_;
};

/// In host memory, a scalar takes at most four times its size: __float128 for a float.
void checkSize(const program::Element& type, const Shape& extents) {
  if (!checkedProduct(extents.size(), 4 * std::int64_t{type.size})) {
    throw Error(
        fmt::format("a stream of {} of shape {} is too large: its elements would take 2^61 bytes or more",
                    type.name, toString(extents)),
        Error::Kind::Memory);
  }
  for (int d = 0; d < extents.rank() && extents.size() > 0; ++d) {
    if (extents[d] > mostExtent) {
      throw Error(
          fmt::format(
              "a stream of {} of shape {} has an extent above {}, where indices end; give it rows, or "
              "divide it",
              type.name, toString(extents), mostExtent),
          Error::Kind::Shape);
    }
  }
}

}  // namespace

StreamState::StreamState(DeviceState& owner, const program::Element& type, const Shape& extents, Storage as)
    : device(&owner), element(&type), storage(as), shape(extents), next_(owner.firstStream_) {
  checkSize(type, extents);
  if (next_ != nullptr) {
    next_->previous_ = this;
  }
  owner.firstStream_ = this;
}

StreamState::~StreamState() {
  if (device != nullptr) {
    leave();
  }
}

void StreamState::leave() noexcept {
  (previous_ == nullptr ? device->firstStream_ : previous_->next_) = next_;
  if (next_ != nullptr) {
    next_->previous_ = previous_;
  }
  previous_ = next_ = nullptr;
  device = nullptr;
}

void checkExists(const StreamRegion& region, std::string_view context) {
  if (region.stream == nullptr) {
    throw Error(fmt::format("{}: there is no stream: it was default-constructed or moved from; make one by "
                            "device.stream<T>(shape)",
                            context),
                Error::Kind::Lost);
  }
  if (region.stream->device == nullptr) {
    throw Error(
        fmt::format("{}: the device of this stream of shape {} has been destroyed; keep the device for as "
                    "long as its streams are used",
                    context, toString(region.stream->shape)),
        Error::Kind::Lost);
  }
}

StreamState& liveStream(const StreamRegion& region, std::string_view context) {
  if (region.distributed != nullptr) {
    throw Error(fmt::format(
        "{}: this stream of shape {} is spread over the ranks of a sk::Domain, which run kernels and "
        "reductions on it, and nothing else; use the stream's own functions, or gather it",
        context, toString(region.shape)));
  }
  checkExists(region, context);
  region.stream->settle();
  if (region.shape.rank() > 0 && !isInside(region)) {
    const std::string from = isBox(region) ? fmt::format(" from {}", toString(region.begin)) : "";
    throw Error(
        fmt::format(
            "{}: a view{} of shape {} is no longer inside its stream, to which a kernel has pushed {} "
            "element(s); make the view after the call",
            context, from, toString(region.shape), region.stream->shape.size()),
        Error::Kind::Shape);
  }
  return *region.stream;
}

void checkElementsOf(const StreamRegion& region, bool isWritten, std::string_view context) {
  checkNotLost(region, isWritten, context);
  if (!isWritten) checkWritten(region, context);
}

void checkNotLost(const StreamRegion& region, bool isWritten, std::string_view context) {
  const StreamState& stream = *region.stream;
  if (!stream.isLost() || (isWritten && isWhole(region))) return;
  throw Error(
      fmt::format(
          "{}: the elements of this stream of shape {} are lost, since what wrote them has failed; write all "
          "of it first",
          context, toString(stream.shape)),
      Error::Kind::Lost);
}

StreamRegion detail::wholeRegion(StreamState* state) {
  if (state == nullptr) {
    return {};
  }
  if (state->device != nullptr) {
    withHostMemory("the size of a stream", [&] { state->settle(); });
  }
  return {state, Index::origin(state->shape.rank()), state->shape};
}

Shape detail::shapeOf(StreamState* state) {
  if (state == nullptr) return {};
  constexpr std::string_view what = "the shape of a stream";
  return withHostMemory(what, [&] {
    StreamState& stream = liveStream({state, {}, {}}, what);
    stream.noteCountRead();
    return stream.shape;
  });
}

void detail::write(const StreamRegion& region, const void* elements, std::size_t count) {
  withHostMemory("write", [&] {
    if (StreamState* stream = checkTransfer(region, count, true, "write")) {
      const TransferScope traced(*stream, "write", region);
      const DenseRegion dense(region, /*isRead=*/false);
      dense.get().stream->write(dense.get(), static_cast<const std::byte*>(elements));
      dense.finish();
      noteWritten(region);
    }
  });
}

void detail::read(const StreamRegion& region, void* elements, std::size_t count) {
  withHostMemory("read", [&] {
    if (StreamState* stream = checkTransfer(region, count, false, "read")) {
      const TransferScope traced(*stream, "read", region);
      const DenseRegion dense(region, /*isRead=*/true);
      dense.get().stream->read(dense.get(), static_cast<std::byte*>(elements));
      results::noteRead(dense.get(), *stream, static_cast<const std::byte*>(elements));
    }
  });
}

std::unique_ptr<TransferState> StreamState::readAsync(const StreamRegion& region) {
  auto elements = detail::hostVector<std::byte>(bytesOf(region.shape.size(), element->size));
  read(region, elements.data());
  return std::make_unique<ReadyTransfer>(std::move(elements));
}

void detail::TransferDeleter::operator()(TransferState* state) const noexcept { delete state; }

namespace {

/// With SK_RESULTS, elements are read at once.
detail::TransferOwner readRecorded(const StreamRegion& dense, const StreamState& stream) {
  auto elements = detail::hostVector<std::byte>(bytesOf(dense.shape.size(), stream.element->size));
  dense.stream->read(dense, elements.data());
  results::noteRead(dense, stream, elements.data());
  return detail::TransferOwner(new ReadyTransfer(std::move(elements)));
}

}  // namespace

detail::TransferOwner detail::readAsync(const StreamRegion& region) {
  return withHostMemory("readAsync", [&] {
    StreamState& stream = liveStream(region, "readAsync");
    refuseInRecording(*stream.device, "readAsync");
    checkElementsOf(region, false, "readAsync");
    if (region.shape.size() == 0) {
      return TransferOwner(new ReadyTransfer({}));
    }
    const TransferScope traced(stream, "readAsync", region);
    const DenseRegion dense(region, /*isRead=*/true);
    if (results::recorderOf(*stream.device) != nullptr) return readRecorded(dense.get(), stream);
    return TransferOwner(dense.get().stream->readAsync(dense.get()).release());
  });
}

void detail::writeAsync(const StreamRegion& region, const void* elements, std::size_t count) {
  withHostMemory("writeAsync", [&] {
    if (StreamState* stream = checkTransfer(region, count, true, "writeAsync")) {
      const TransferScope traced(*stream, "writeAsync", region);
      const DenseRegion dense(region, /*isRead=*/false);
      dense.get().stream->writeAsync(dense.get(), static_cast<const std::byte*>(elements));
      dense.finish();
      noteWritten(region);
    }
  });
}

namespace {

TransferState& stateOf(const detail::TransferOwner& transfer) {
  if (!transfer) {
    throw Error("the future has no elements: it was made of nothing, moved from, or asked for them before",
                Error::Kind::Lost);
  }
  return *transfer;
}

}  // namespace

bool detail::isReady(const TransferOwner& transfer) {
  return withHostMemory("readAsync", [&] { return stateOf(transfer).isReady(); });
}
void detail::wait(const TransferOwner& transfer) {
  withHostMemory("readAsync", [&] { stateOf(transfer).wait(); });
}
void detail::take(TransferOwner transfer, void* elements) {
  withHostMemory("readAsync", [&] { stateOf(transfer).take(static_cast<std::byte*>(elements)); });
}

namespace {

/// The number of floats in a region. Throws unless its elements consist of floats.
std::size_t realsIn(const StreamRegion& region, const program::Element& element, std::string_view what) {
  std::size_t components = 0;
  for (const program::Field& field : element.fields) {
    if (field.scalar != program::Scalar::Float) {
      throw Error(
          fmt::format("{}: {} is not made of floats alone; use read() and write()", what, element.name),
          Error::Kind::Type);
    }
    components += field.width;
  }
  return static_cast<std::size_t>(region.shape.size()) * components;
}

}  // namespace

void detail::writeReals(const StreamRegion& region, std::span<const double> values) {
  withHostMemory("writeReals", [&] {
    StreamState& stream = liveStream(region, "writeReals");
    refuseInRecording(*stream.device, "writeReals");
    checkNotLost(region, true, "writeReals");
    const std::size_t components = realsIn(region, *stream.element, "writeReals");
    if (values.size() != components) {
      throw Error(fmt::format("writeReals: {} numbers are given for a stream of shape {} that has {}",
                              values.size(), toString(region.shape), components),
                  Error::Kind::Shape);
    }
    if (values.empty()) return;
    const TransferScope traced(stream, "writeReals", region);
    const DenseRegion dense(region, /*isRead=*/false);
    dense.get().stream->writeReals(dense.get(), values.data());
    dense.finish();
    noteWritten(region);
  });
}

std::vector<double> detail::readReals(const StreamRegion& region) {
  return withHostMemory("readReals", [&] {
    StreamState& stream = liveStream(region, "readReals");
    refuseInRecording(*stream.device, "readReals");
    checkNotLost(region, false, "readReals");
    std::vector<double> values = detail::hostVector<double>(realsIn(region, *stream.element, "readReals"));
    checkWritten(region, "readReals");
    if (!values.empty()) {
      const TransferScope traced(stream, "readReals", region);
      const DenseRegion dense(region, /*isRead=*/true);
      dense.get().stream->readReals(dense.get(), values.data());
    }
    results::noteReals(stream, values);
    return values;
  });
}

namespace {

void runFill(const StreamRegion& region, const std::byte* element) {
  const TransferScope traced(*region.stream, "fill", region);
  region.stream->fill(region, element);
  noteWritten(region);
}

class RecordedFill final : public RecordedCall {
 public:
  RecordedFill(const StreamRegion& region, const std::byte* element)
      : region_(region), element_(element, element + region.stream->element->size) {
    region.stream->device->recording->use(region.stream);
  }

  void run() override { runFill(region_, element_.data()); }
  std::string_view name() const override { return "fill"; }

 private:
  StreamRegion region_;
  std::vector<std::byte> element_;
};

}  // namespace

void detail::fill(const StreamRegion& region, const void* element) {
  withHostMemory("fill", [&] {
    StreamState& stream = liveStream(region, "fill");
    checkNotLost(region, true, "fill");
    if (region.shape.size() == 0) return;
    const auto* const bytes = static_cast<const std::byte*>(element);
    if (LoopState* recording = stream.device->recording) {
      return recording->add(std::make_unique<RecordedFill>(region, bytes));
    }
    runFill(region, bytes);
  });
}

namespace {

/// Copies through host memory: floats as doubles, so that copies from a reference device lose nothing.
void copyByHost(const StreamRegion& givenFrom, const StreamRegion& givenTo) {
  const DenseRegion source(givenFrom, /*isRead=*/true), target(givenTo, /*isRead=*/false);
  const StreamRegion& from = source.get();
  const StreamRegion& to = target.get();
  const program::Element& element = *from.stream->element;
  const bool isOfFloats = std::ranges::all_of(
      element.fields, [](const program::Field& field) { return field.scalar == program::Scalar::Float; });
  if (isOfFloats) {
    auto values = detail::hostVector<double>(realsIn(from, element, "copyTo"));
    from.stream->readReals(from, values.data());
    to.stream->writeReals(to, values.data());
    return target.finish();
  }
  auto elements = detail::hostVector<std::byte>(bytesOf(from.shape.size(), element.size));
  from.stream->read(from, elements.data());
  to.stream->write(to, elements.data());
  target.finish();
}

void runCopy(const StreamRegion& from, const StreamRegion& to) {
  const TransferScope traced(*to.stream, "copy", to);
  checkSomeWritten(from, "copyTo");
  const std::vector<std::int64_t> unwritten = unwrittenIn(from);
  const bool isDone = from.stream->device == to.stream->device && to.stream->copyFrom(from, to);
  if (!isDone) copyByHost(from, to);
  noteCopied(to, unwritten);
}

class RecordedCopy final : public RecordedCall {
 public:
  RecordedCopy(const StreamRegion& from, const StreamRegion& to) : from_(from), to_(to) {
    LoopState& recording = *to.stream->device->recording;
    recording.use(from.stream);
    recording.use(to.stream);
  }

  void run() override { runCopy(from_, to_); }
  std::string_view name() const override { return "copyTo"; }

 private:
  StreamRegion from_;
  StreamRegion to_;
};

}  // namespace

void detail::copy(const StreamRegion& from, const StreamRegion& to) {
  withHostMemory("copyTo", [&] {
    StreamState& source = liveStream(from, "copyTo");
    StreamState& target = liveStream(to, "copyTo");
    if (from.shape != to.shape) {
      throw Error(
          fmt::format("copyTo: the source has shape {}, the target {}; copy between equal shapes, such "
                      "as a part of one, domain(begin, end)",
                      toString(from.shape), toString(to.shape)),
          Error::Kind::Shape);
    }
    checkNotLost(from, false, "copyTo");
    checkNotLost(to, true, "copyTo");
    if (from.shape.size() == 0) return;
    if (source.device != target.device) {
      refuseInRecording(*source.device, "copyTo another device");
      refuseInRecording(*target.device, "copyTo from another device");
    }
    if (LoopState* recording = target.device->recording) {
      return recording->add(std::make_unique<RecordedCopy>(from, to));
    }
    runCopy(from, to);
  });
}

namespace {

void checkPlane(const StreamState& stream, int plane, std::string_view what) {
  const auto count = static_cast<int>(stream.element->fields.size());
  if (plane < 0 || plane >= count) {
    throw Error(
        fmt::format("{}: there is no plane {}; {} has {}, from 0", what, plane, stream.element->name, count));
  }
}

}  // namespace

StreamTexture detail::textureOf(StreamState* state, int plane) {
  return withHostMemory("texture", [&] {
    StreamState& stream = liveStream({state, {}, {}}, "texture");
    refuseInRecording(*stream.device, "texture");
    checkNotLost({state, {}, {}}, false, "texture");
    checkPlane(stream, plane, "texture");
    const StreamTexture texture = stream.texture(plane);
    results::noteHandedOut(stream, "texture");
    noteAllWritten(stream);  // the application may draw to it
    return texture;
  });
}

void detail::fillBuffer(StreamState* state, std::uint32_t buffer, std::int64_t byteOffset, int plane) {
  withHostMemory("fillBuffer", [&] {
    StreamState& stream = liveStream({state, {}, {}}, "fillBuffer");
    refuseInRecording(*stream.device, "fillBuffer");
    checkElementsOf(wholeRegion(state), false, "fillBuffer");
    checkPlane(stream, plane, "fillBuffer");
    if (byteOffset < 0 || byteOffset % 4 != 0) {
      throw Error(fmt::format("fillBuffer: the offset is {}; give a multiple of 4, and not a negative one",
                              byteOffset));
    }
    if (stream.shape.size() == 0) return;
    const TraceScope traced(stream.device->trace.get(), "transfer", "fillBuffer");
    traced.add("stream", stream.name);
    stream.fillBuffer(buffer, byteOffset, plane);
    results::noteHandedOut(stream, "fillBuffer");
  });
}

}  // namespace sk
