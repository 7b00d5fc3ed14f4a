// SPDX-License-Identifier: MIT
#include "gl_device/transfer/gl_staging.hpp"

#include <algorithm>
#include <array>
#include <string_view>

#include <fmt/format.h>

#include "assemble/transfer/staging_program.hpp"
#include "device/write_scope.hpp"
#include "gl/commands.hpp"
#include "gl_device/gl_device.hpp"
#include "gl_device/gl_stream.hpp"
#include "gl_device/pass/pass.hpp"
#include "sk/scalar_bytes.hpp"
#include "support/checked_size.hpp"

namespace sk {

using assemble::RegionLayout;

namespace {

constexpr std::int32_t log2OfLanes = 2;

/// The uniforms of a box.
struct BoxNames {
  std::string_view origin, extent, first;
};
constexpr std::array<BoxNames, assemble::stagedBoxes> names{{
    {"sk_origin[0]", "sk_extent[0]", "sk_first[0]"},
    {"sk_origin[1]", "sk_extent[1]", "sk_first[1]"},
    {"sk_origin[2]", "sk_extent[2]", "sk_first[2]"},
    {"sk_origin[3]", "sk_extent[3]", "sk_first[3]"},
}};

int channelsOf(const program::Field& field) {
  return program::is64Bit(field.scalar) ? 2 * field.width : field.width;
}

std::int32_t laneBits(const RegionLayout& box) { return box.packed ? log2OfLanes : 0; }

std::int64_t stagedTexels(const RegionLayout& box) {
  const std::int32_t bits = laneBits(box);
  const std::int32_t end = (box.origin[0] + box.extent[0] - 1) >> bits;
  return std::int64_t{end - (box.origin[0] >> bits) + 1} * box.extent[1] * box.extent[2] * box.extent[3];
}

}  // namespace

GlStaging::GlStaging(GlDevice& device, Way way)
    : device_(device),
      way_(way),
      buffer_(way == Way::ToHost ? gl::StorageBuffer::Use::HostReads : gl::StorageBuffer::Use::HostWrites) {}

bool GlStaging::isPossible(const GlDevice& device) {
  return device.capabilities.hasCompute && device.capabilities.mapsStorage &&
         device.target != Target::Fragment;
}

std::size_t GlStaging::bytesOf(const StreamRegion& box) const {
  std::size_t words = 0;
  for (const program::Field& field : glStream(box).held().fields)
    words += static_cast<std::size_t>(channelsOf(field));
  return static_cast<std::size_t>(box.shape.size()) * words * sizeof(std::uint32_t);
}

std::byte* GlStaging::room(std::size_t bytes) {
  boxes_.clear();  // of an exchange that has failed before it copied them
  wait();
  const DeviceScope scope(device_);
  const auto size = static_cast<std::int64_t>(bytes);
  if (size > device_.capabilities.storageBytes || !buffer_.reserve(device_.bound(), bytes)) {
    device_.context().failForMemory(fmt::format(
        "{} of halos; divide the domain over more ranks, or exchange them more often", bytesText(size)));
  }
  return buffer_.bytes();
}

void GlStaging::copy(const StreamRegion& box, std::size_t offset) {
  GlStream& stream = glStream(box);
  const RegionLayout place = regionLayoutOf(box, stream.layout);
  const auto count = static_cast<std::size_t>(box.shape.size());
  std::size_t word = offset / 4;
  for (std::size_t i = 0; i < stream.planes.size(); ++i) {
    const program::Field& field = stream.held().fields[i];
    const int channels = channelsOf(field);
    boxes_.push_back({&stream, i, channels, place, static_cast<std::int32_t>(word)});
    word += count * static_cast<std::size_t>(channels);
  }
}

void GlStaging::flush() {
  const TraceScope traced(device_.trace.get(), "transfer", way_ == Way::ToHost ? "pack" : "unpack");
  const DeviceScope scope(device_);
  std::vector<PlaneBox> boxes =
      std::exchange(boxes_, {});  // those of a call that fails are forgotten with it
  std::ranges::stable_sort(boxes, {}, [](const PlaneBox& box) { return std::pair(box.stream, box.plane); });
  WriteScope writes;
  if (way_ == Way::ToDevice) {
    for (const PlaneBox& box : boxes) writes.add(box.stream);
    writes.begin();
  }
  const std::span<const PlaneBox> all = boxes;
  for (std::size_t begin = 0; begin < all.size();) {
    std::size_t end = begin + 1;
    while (end < all.size() && end - begin < assemble::stagedBoxes && all[end].isOfPlane(all[begin])) ++end;
    copyBoxes(all.subspan(begin, end - begin));
    begin = end;
  }
  writes.commit();
  boxes.clear();
  boxes_ = std::move(boxes);  // its memory
  gl::finishMapped(device_.bound());
  fence_ = gl::Fence::insert(device_.bound().deletions);
  if (!fence_) device_.throwPendingError();
}

/// Copies boxes of one plane.
void GlStaging::copyBoxes(std::span<const PlaneBox> boxes) {
  gl::BoundState& bound = device_.bound();
  const PlaneBox& first = boxes.front();
  const gl::Texture& texture = first.stream->planes[first.plane].texture;
  IntegerProgram& program = device_.programs().ofStaging().of(way_, texture.format(), texture.isLayered());
  bound.program(program.program().name());
  if (way_ == Way::ToHost) {
    bound.texture(0, texture.name(), texture.isLayered());
    bound.sampler(0, device_.passes().samplers().nearest());
  } else {
    bound.readWriteImage(0, texture.name(), texture.format().internalFormat);
  }
  buffer_.bind(bound);
  program.set(bound, "sk_stride", first.place.stride);
  program.set(bound, "sk_shift", first.place.linear ? first.place.shift : -1);
  program.set(bound, "sk_lane_bits", laneBits(first.place));
  program.set(bound, "sk_channels", first.channels);
  std::int64_t most = 0;
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    program.set(bound, names[i].origin, boxes[i].place.origin);
    program.set(bound, names[i].extent, boxes[i].place.extent);
    program.set(bound, names[i].first, boxes[i].firstWord);
    most = std::max(most, stagedTexels(boxes[i].place));
  }
  constexpr std::int64_t mostGroups =
      4096;  // enough for any device; each takes the texels that are left in turn
  const std::int64_t groups = (most + assemble::stagingGroup - 1) / assemble::stagingGroup;
  device_.passes().dispatch(static_cast<GLsizei>(std::min(groups, mostGroups)),
                            static_cast<GLsizei>(boxes.size()));
}

void GlStaging::wait() {
  if (!fence_) return;
  const TraceScope traced(device_.trace.get(), "wait", "halos");
  const DeviceScope scope(device_);
  gl::flush();  // what follows the copies, too, runs meanwhile
  fence_.wait();
  fence_ = {};
  device_.throwPendingError();  // a fence of a lost context is reached, too
}

std::unique_ptr<Staging> GlDevice::makeStaging(Staging::Way way) {
  if (!GlStaging::isPossible(*this)) return nullptr;
  return std::make_unique<GlStaging>(*this, way);
}

IntegerProgram& StagingPrograms::of(Staging::Way way, const gl::Format& format, bool isLayered) {
  std::unique_ptr<IntegerProgram>& known =
      programs_[static_cast<std::size_t>(way)][std::pair(format.index, isLayered)];
  if (known) return *known;
  const bool writesTexels = way == Staging::Way::ToDevice;
  known = owner_.build(
      {{}, assemble::stagingProgram(owner_.computeProfile(), writesTexels, format.name, isLayered)},
      "a program that copies halos");
  known->program().setSampler("sk_texels", 0);
  return *known;
}

}  // namespace sk
