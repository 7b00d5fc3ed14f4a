// SPDX-License-Identifier: MIT
#include "carrier.hpp"

#include <cstring>
#include <map>
#include <utility>

#include "device/device_state.hpp"
#include "device/stream_state.hpp"
#include "sk/future.hpp"
#include "strips.hpp"

namespace sk::mpi {

namespace {

std::byte* roomIn(std::vector<std::byte>& buffer, std::size_t bytes) {
  if (buffer.size() < bytes) buffer.resize(bytes);
  return buffer.data();
}

/// The memory of several boxes.
std::vector<Span> memoryOf(const std::vector<StreamRegion>& boxes) {
  std::vector<Span> all;
  for (const StreamRegion& box : boxes) {
    const std::vector<Span> spans = spansOf(box);
    all.insert(all.end(), spans.begin(), spans.end());
  }
  return all;
}

/// `sizeOf` is that of a box.
template <class SizeOf>
void addBytes(std::span<Strips> strips, SizeOf&& sizeOf) {
  for (Strips& neighbor : strips) {
    for (const StreamRegion& box : neighbor.sent) neighbor.sentBytes += sizeOf(box);
    for (const StreamRegion& box : neighbor.received) neighbor.receivedBytes += sizeOf(box);
  }
}

/// Native devices send and receive in the streams' own memory where all that a neighbor gets is in one piece.
class MemoryCarrier final : public Carrier {
 public:
  MemoryCarrier(DomainState& domain, std::span<Strips> strips) : Carrier(domain, strips) {
    addBytes(strips, bytesOf);
  }

  bool isAtHost() const override { return true; }
  void begin() override {}
  std::byte* target(const Strips& neighbor) override {
    std::vector<Span>& spans = targets_[neighbor.direction] = memoryOf(neighbor.received);
    if (spans.size() == 1) return spans.front().bytes;
    return roomIn(domain_.receiveBuffers[neighbor.direction], neighbor.receivedBytes);
  }
  const std::byte* source(const Strips& neighbor) override {
    const std::vector<Span> spans = memoryOf(neighbor.sent);
    if (spans.size() == 1) return spans.front().bytes;
    std::byte* const to = roomIn(domain_.sendBuffers[neighbor.direction], neighbor.sentBytes);
    pack(spans, to);
    return to;
  }
  void store() override {
    for (const auto& [direction, spans] : targets_) {
      if (spans.size() > 1) unpack(domain_.receiveBuffers[direction].data(), spans);
    }
  }

 private:
  std::map<std::size_t, std::vector<Span>> targets_;  ///< by direction
};

/// Programs of the device pack and unpack. Messages have memory of their own: the kernel of an operating system, and network cards,
/// do not read what a graphics driver has mapped.
class StagedCarrier final : public Carrier {
 public:
  StagedCarrier(DomainState& domain, std::span<Strips> strips) : Carrier(domain, strips) {
    addBytes(strips, [&](const StreamRegion& box) { return toHost().bytesOf(box); });
  }

  bool isAtHost() const override { return false; }
  void begin() override {
    std::size_t bytes = 0;
    for (const Strips& neighbor : strips_) bytes += neighbor.sentBytes;
    packed_ = toHost().room(bytes);
    std::size_t at = 0;
    for (const Strips& neighbor : strips_) at = copyAll(toHost(), neighbor.sent, at);
    toHost().flush();
  }
  std::byte* target(const Strips& neighbor) override {
    return roomIn(domain_.receiveBuffers[neighbor.direction], neighbor.receivedBytes);
  }
  const std::byte* source(const Strips& neighbor) override {
    toHost().wait();
    std::byte* const to = roomIn(domain_.sendBuffers[neighbor.direction], neighbor.sentBytes);
    std::memcpy(to, packed_, neighbor.sentBytes);
    packed_ += neighbor.sentBytes;
    return to;
  }
  void store() override {
    std::size_t bytes = 0;
    for (const Strips& neighbor : strips_) bytes += neighbor.receivedBytes;
    std::byte* const room = toDevice().room(bytes);
    std::size_t at = 0;
    for (const Strips& neighbor : strips_) {
      const std::size_t begin = at;
      std::memcpy(room + begin, domain_.receiveBuffers[neighbor.direction].data(), neighbor.receivedBytes);
      at = copyAll(toDevice(), neighbor.received, begin);
    }
    toDevice().flush();
  }

 private:
  Staging& toHost() const { return *domain_.staging.toHost; }
  Staging& toDevice() const { return *domain_.staging.toDevice; }

  /// Copies boxes from `offset` on, and returns the end.
  static std::size_t copyAll(Staging& staging, const std::vector<StreamRegion>& boxes, std::size_t offset) {
    for (const StreamRegion& box : boxes) {
      staging.copy(box, offset);
      offset += staging.bytesOf(box);
    }
    return offset;
  }

  const std::byte* packed_ = nullptr;  ///< what is yet to be sent
};

/// The driver reads and writes elements.
class ElementCarrier final : public Carrier {
 public:
  ElementCarrier(DomainState& domain, std::span<Strips> strips) : Carrier(domain, strips) {
    addBytes(strips, bytesOf);
  }

  bool isAtHost() const override { return false; }
  void begin() override {
    for (const Strips& neighbor : strips_) {
      for (const StreamRegion& box : neighbor.sent)
        reads_[neighbor.direction].push_back(holdsReals(box) ? detail::TransferOwner{}
                                                             : detail::readAsync(box));
    }
  }
  std::byte* target(const Strips& neighbor) override {
    return roomIn(domain_.receiveBuffers[neighbor.direction], neighbor.receivedBytes);
  }
  const std::byte* source(const Strips& neighbor) override {
    std::byte* const all = roomIn(domain_.sendBuffers[neighbor.direction], neighbor.sentBytes);
    std::byte* to = all;
    for (std::size_t i = 0; i < neighbor.sent.size(); ++i) {
      take(neighbor.sent[i], std::move(reads_[neighbor.direction][i]), to);
      to += bytesOf(neighbor.sent[i]);
    }
    return all;
  }
  void store() override {
    for (const Strips& neighbor : strips_) {
      const std::byte* from = domain_.receiveBuffers[neighbor.direction].data();
      for (const StreamRegion& box : neighbor.received) {
        writeBytes(box, from);
        from += bytesOf(box);
      }
    }
  }

 private:
  static void take(const StreamRegion& box, detail::TransferOwner read, std::byte* to) {
    if (read) return detail::take(std::move(read), to);
    readBytes(box, to);
  }

  std::map<std::size_t, std::vector<detail::TransferOwner>> reads_;  ///< by direction
};

/// Devices of one host may differ: halos are staged where all of them can.
void chooseStaging(DomainState& domain, DeviceState& device) {
  HaloStaging& staging = domain.staging;
  if (std::exchange(staging.isChosen, true)) return;
  staging.toHost = device.makeStaging(Staging::Way::ToHost);
  staging.toDevice = device.makeStaging(Staging::Way::ToDevice);
  const int own = staging.toHost ? 1 : 0;
  int all = 0;
  check(MPI_Allreduce(&own, &all, 1, MPI_INT, MPI_MIN, domain.communicator), "an exchange of halos");
  if (all == 0) staging.toHost = nullptr;
}

}  // namespace

std::unique_ptr<Carrier> Carrier::of(DomainState& domain, std::span<Strips> strips) {
  const StreamRegion any = domain.streams.front()->placed();
  if (isInMemory(any)) return std::make_unique<MemoryCarrier>(domain, strips);
  chooseStaging(domain, *any.stream->device);
  if (domain.staging.toHost) return std::make_unique<StagedCarrier>(domain, strips);
  return std::make_unique<ElementCarrier>(domain, strips);
}

}  // namespace sk::mpi
