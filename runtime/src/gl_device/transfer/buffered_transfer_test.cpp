// SPDX-License-Identifier: MIT
//
// Compares transfers through pixel buffers, and through staging memory, with direct ones.
#include "gl_device/transfer/buffered_transfer.hpp"

#include <array>
#include <cstddef>
#include <cstring>
#include <memory>
#include <random>
#include <vector>

#include <catch2/catch.hpp>

#include "gl_device/gl_device.hpp"
#include "gl_device/gl_stream.hpp"
#include "gl_device/transfer/transfer.hpp"
#include "sk/types.hpp"

using namespace sk;

namespace {

struct Mixed {
  float t;
  bool isHit;
  int2 id;
  float3 at;
};

const program::Element& mixed() {
  static constexpr std::array<program::Field, 4> fields{
      {{"t", program::Scalar::Float, 1, offsetof(Mixed, t)},
       {"isHit", program::Scalar::Bool, 1, offsetof(Mixed, isHit)},
       {"id", program::Scalar::Int, 2, offsetof(Mixed, id)},
       {"at", program::Scalar::Float, 3, offsetof(Mixed, at)}}};
  static constexpr program::Element element{"Mixed", "Mixed", sizeof(Mixed), fields};
  return element;
}

/// Random elements that read back unchanged: every byte is 0 or 1, which bools require.
std::vector<std::byte> bitsOf(const program::Element& element, std::int64_t count) {
  static std::mt19937 random(7);
  std::vector<std::byte> bytes(static_cast<std::size_t>(count) * element.size);
  for (std::byte& byte : bytes) byte = static_cast<std::byte>(random() & 1);
  return bytes;
}

/// Compares the bytes of fields, without padding.
bool areEqual(const program::Element& element, const std::vector<std::byte>& a,
              const std::vector<std::byte>& b) {
  bool equal = a.size() == b.size();
  for (std::size_t at = 0; equal && at < a.size(); at += element.size) {
    for (const program::Field& field : element.fields) {
      const std::size_t place = at + field.offset;
      equal = equal && std::memcmp(a.data() + place, b.data() + place, gl::hostBytes(field)) == 0;
    }
  }
  return equal;
}

void checkRegion(GlDevice& device, const program::Element& element, const StreamRegion& region) {
  auto& stream = static_cast<GlStream&>(*region.stream);
  const std::int64_t count = region.shape.size();
  std::vector<std::byte> given = bitsOf(element, count), found(given.size());
  INFO(element.name << " of shape " << toString(stream.shape) << ", " << toString(region.shape) << " from "
                    << toString(region.begin));
  stream.write(region, given.data());
  {
    const DeviceScope scope(device);
    const GlStream::TransferRegion what = stream.transferRegion(region);
    BufferedRead read(device);
    const std::size_t part = read.add(*what.element, stream.planes, what.place);
    const std::size_t again = read.add(*what.element, stream.planes, what.place);
    read.begin();
    WriteScope writes;
    upload(device, *what.element, stream.planes, what.place, bitsOf(element, count).data(), writes);
    writes.commit();
    read.wait();
    CHECK(read.isReady());
    read.take(again, found.data());
    CHECK(areEqual(element, given, found));
    found = std::vector<std::byte>(given.size());
    read.take(part, found.data());
  }
  CHECK(areEqual(element, given, found));
  given = bitsOf(element, count);
  {
    const DeviceScope scope(device);
    const GlStream::TransferRegion what = stream.transferRegion(region);
    WriteScope writes;
    writeBuffered(device, *what.element, stream.planes, what.place, given.data(), writes);
    writes.commit();
  }
  stream.read(region, found.data());
  CHECK(areEqual(element, given, found));
}

/// Takes a region through staging memory to a stream that lies in another way, whose other elements stay.
void checkStaged(GlDevice& device, const program::Element& element, const StreamRegion& region) {
  const std::unique_ptr<Staging> toHost = device.makeStaging(Staging::Way::ToHost),
                                 toDevice = device.makeStaging(Staging::Way::ToDevice);
  if (!toHost) return;
  INFO("staged " << element.name << " of shape " << toString(region.stream->shape) << ", "
                 << toString(region.shape) << " from " << toString(region.begin));
  const StreamRegion whole = detail::wholeRegion(region.stream);
  const std::int64_t count = whole.shape.size();
  const std::unique_ptr<StreamState> other = device.createStream(element, whole.shape, Storage::Single);
  const StreamRegion otherWhole = detail::wholeRegion(other.get());
  StreamRegion target = region;
  target.stream = other.get();
  for (const bool isUnpacked : {false, true}) {
    const std::vector<std::byte> given = bitsOf(element, count), before = bitsOf(element, count);
    std::vector<std::byte> expected(static_cast<std::size_t>(region.shape.size()) * element.size),
        found(expected), after(given.size());
    region.stream->write(whole, given.data());
    other->write(otherWhole, before.data());
    if (isUnpacked) static_cast<void>(other->texture(0));
    constexpr std::size_t offset = 16;  // something else may lie before it
    const std::size_t bytes = offset + static_cast<std::size_t>(region.shape.size()) * 64;
    const std::byte* const packed = toHost->room(bytes);
    toHost->copy(region, offset);
    toHost->flush();
    toHost->wait();
    std::memcpy(toDevice->room(bytes), packed, bytes);
    toDevice->copy(target, offset);
    toDevice->flush();
    region.stream->read(region, expected.data());
    other->read(target, found.data());
    CHECK(areEqual(element, expected, found));
    other->write(target, expected.data());
    other->read(otherWhole, after.data());
    other->write(otherWhole, before.data());
    other->write(target, expected.data());
    std::vector<std::byte> wanted(after.size());
    other->read(otherWhole, wanted.data());
    CHECK(areEqual(element, wanted, after));
  }
}

}  // namespace

TEST_CASE("what goes through buffers of the driver's is what goes directly") {
  const auto api = GENERATE(gl::Api::Gl, gl::Api::Es);
  const std::int32_t limit = GENERATE(0, 16);
  GlDevice device(gl::openContext({"", api}), {.textureLimit = limit, .barrier = {}});
  const program::Element* elements[] = {
      &ElementTraits<float>::element(),  &ElementTraits<float3>::element(),
      &ElementTraits<bool>::element(),   &ElementTraits<std::uint8_t>::element(),
      &ElementTraits<short3>::element(), &mixed()};
  for (const program::Element* element : elements) {
    for (const Shape& shape : {Shape{1}, Shape{9, 13}, Shape{40, 50}, Shape{3, 4, 5}, Shape{900}}) {
      const auto stream = device.createStream(*element, shape, Storage::Single);
      const StreamRegion whole = detail::wholeRegion(stream.get());
      checkRegion(device, *element, whole);
      Index begin = Index::origin(shape.rank()), end = begin;
      for (int d = 0; d < shape.rank(); ++d) {
        begin[d] = shape[d] / 3;
        end[d] = shape[d] - shape[d] / 4;
      }
      checkRegion(device, *element, detail::partOf(whole, begin, end));
      checkStaged(device, *element, whole);
      checkStaged(device, *element, detail::partOf(whole, begin, end));
    }
  }
}
