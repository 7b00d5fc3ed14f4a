// SPDX-License-Identifier: MIT
#include "exchange.hpp"

#include <cstring>
#include <map>
#include <optional>
#include <utility>

#include "device/device_state.hpp"
#include "device/stream_state.hpp"
#include "sk/future.hpp"
#include "strips.hpp"

namespace sk::mpi {

namespace {

void makeRoom(std::vector<std::byte>& buffer, std::size_t bytes) {
  if (buffer.size() < bytes) buffer.resize(bytes);
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

/// Makes room for what all neighbors send and get.
void makeRoom(DomainState& domain, std::span<const Strips> strips) {
  for (const Strips& neighbor : strips) {
    makeRoom(domain.sendBuffers[neighbor.direction], neighbor.sentBytes);
    makeRoom(domain.receiveBuffers[neighbor.direction], neighbor.receivedBytes);
  }
}

/// Native devices send and receive in the streams' own memory where all that a neighbor gets is in one piece.
class MemoryCarrier final : public Carrier {
 public:
  MemoryCarrier(DomainState& domain, std::span<Strips> strips)
      : Carrier(domain, strips), sources_(domain.directions.size()), targets_(domain.directions.size()) {
    addBytes(strips, bytesOf);
    for (const Strips& neighbor : strips) {
      const std::size_t k = neighbor.direction;
      sources_[k] = memoryOf(neighbor.sent);
      targets_[k] = memoryOf(neighbor.received);
      if (sources_[k].size() > 1) makeRoom(domain.sendBuffers[k], neighbor.sentBytes);
      if (targets_[k].size() > 1) makeRoom(domain.receiveBuffers[k], neighbor.receivedBytes);
    }
  }

  bool isAtHost() const override { return true; }
  void begin() override {}
  std::byte* target(const Strips& neighbor) noexcept override {
    const std::vector<Span>& spans = targets_[neighbor.direction];
    return spans.size() == 1 ? spans.front().bytes : domain_.receiveBuffers[neighbor.direction].data();
  }
  const std::byte* source(const Strips& neighbor) override {
    const std::vector<Span>& spans = sources_[neighbor.direction];
    if (spans.size() == 1) return spans.front().bytes;
    std::byte* const to = domain_.sendBuffers[neighbor.direction].data();
    pack(spans, to);
    return to;
  }
  void store() override {
    for (std::size_t k = 0; k < targets_.size(); ++k) {
      if (targets_[k].size() > 1) unpack(domain_.receiveBuffers[k].data(), targets_[k]);
    }
  }

 private:
  std::vector<std::vector<Span>> sources_, targets_;  ///< by direction
};

/// Programs of the device pack and unpack. Messages have memory of their own: the kernel of an operating system, and network cards,
/// do not read what a graphics driver has mapped.
class StagedCarrier final : public Carrier {
 public:
  StagedCarrier(DomainState& domain, std::span<Strips> strips) : Carrier(domain, strips) {
    addBytes(strips, [&](const StreamRegion& box) { return toHost().bytesOf(box); });
    makeRoom(domain, strips);
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
  std::byte* target(const Strips& neighbor) noexcept override {
    return domain_.receiveBuffers[neighbor.direction].data();
  }
  const std::byte* source(const Strips& neighbor) override {
    toHost().wait();
    std::byte* const to = domain_.sendBuffers[neighbor.direction].data();
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
    makeRoom(domain, strips);
  }

  bool isAtHost() const override { return false; }
  void begin() override {
    for (const Strips& neighbor : strips_) {
      for (const StreamRegion& box : neighbor.sent)
        reads_[neighbor.direction].push_back(holdsReals(box) ? detail::TransferOwner{}
                                                             : detail::readAsync(box));
    }
  }
  std::byte* target(const Strips& neighbor) noexcept override {
    return domain_.receiveBuffers[neighbor.direction].data();
  }
  const std::byte* source(const Strips& neighbor) override {
    std::byte* const all = domain_.sendBuffers[neighbor.direction].data();
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

}  // namespace

std::unique_ptr<Carrier> Carrier::of(DomainState& domain, std::span<Strips> strips) {
  const StreamRegion any = domain.streams.front()->placed();
  if (isInMemory(any)) return std::make_unique<MemoryCarrier>(domain, strips);
  if (!domain.rankDevice->stagesHalos) return std::make_unique<ElementCarrier>(domain, strips);
  HaloStaging& staging = domain.staging;
  if (!staging.toHost) staging.toHost = any.stream->device->makeStaging(Staging::Way::ToHost);
  if (!staging.toDevice) staging.toDevice = any.stream->device->makeStaging(Staging::Way::ToDevice);
  return std::make_unique<StagedCarrier>(domain, strips);
}

Exchange::Exchange(DomainState& domain, const std::vector<HaloRequest>& requests)
    : domain_(domain), messages_(domain.communicator, domain.agreement.waitLimit()) {
  for (std::size_t k = 0; k < domain.directions.size(); ++k) addNeighbor(k, requests);
  carrier_ = Carrier::of(domain, strips_);
  for (const Strips& strips : strips_) {
    messages_.reserve(strips.sentBytes);
    messages_.reserve(strips.receivedBytes);
  }
  carrier_->begin();
}

Exchange::~Exchange() {
  if (progress_ == Progress::Started) sendAll();
}

/// Posts one message. A rank that cannot, even at a second attempt, is no
/// longer in step with its neighbors.
template <class Post>
void Exchange::post(Post&& post) {
  const Refusal refused = caught("an exchange of halos", post);
  if (!refused) return;
  domain_.agreement.giveUp(*refused);
  if (!failure_) failure_ = refused;
}

void Exchange::start() {
  progress_ = Progress::Started;
  for (std::size_t i = 0; i < strips_.size(); ++i) {
    if (strips_[i].received.empty()) continue;
    const Neighbor& neighbor = neighbors_[i];
    post([&] {
      messages_.receive(carrier_->target(strips_[i]), strips_[i].receivedBytes, neighbor.rank,
                        static_cast<int>(neighbor.opposite));
    });
  }
  if (carrier_->isAtHost()) sendAll();
}

void Exchange::addNeighbor(std::size_t direction, const std::vector<HaloRequest>& requests) {
  const std::optional<int> rank = domain_.parts.neighbor(domain_.rank, domain_.directions[direction]);
  if (!rank) return;
  Index back = domain_.directions[direction];
  for (int d = 0; d < back.rank(); ++d) back[d] = -back[d];
  Neighbor neighbor{.rank = *rank, .opposite = 0};
  while (!(domain_.directions[neighbor.opposite] == back)) ++neighbor.opposite;
  Strips strips{.direction = direction, .sent = {}, .received = {}};
  for (const HaloRequest& request : requests) {
    const Box sent = domain::sentTo(domain_.own, domain_.directions[direction], request.depth);
    const Box received = domain::receivedFrom(domain_.own, domain_.directions[direction], request.depth);
    if (!domain::isEmpty(sent)) strips.sent.push_back(request.stream->part(sent));
    if (!domain::isEmpty(received)) strips.received.push_back(request.stream->part(received));
  }
  neighbors_.push_back(neighbor);
  strips_.push_back(std::move(strips));
}

/// Sends all strips, and waits until they are packed; if that fails, sends that
/// there is nothing.
void Exchange::sendAll() {
  progress_ = Progress::Sent;
  for (std::size_t i = 0; i < strips_.size(); ++i) {
    const Strips& strips = strips_[i];
    if (strips.sent.empty()) continue;
    const int to = neighbors_[i].rank, tag = static_cast<int>(strips.direction);
    const std::byte* bytes = nullptr;
    if (!failure_) failure_ = caught("an exchange of halos", [&] { bytes = carrier_->source(strips); });
    if (failure_) {
      post([&] { messages_.sendNothing(strips.sentBytes, to, tag); });
      continue;
    }
    post([&] { messages_.send(bytes, strips.sentBytes, to, tag); });
    ++domain_.statistics.messages;
    domain_.statistics.bytes += static_cast<std::int64_t>(strips.sentBytes);
  }
  ++domain_.statistics.exchanges;
}

void Exchange::finish() {
  if (progress_ == Progress::Started) sendAll();
  messages_.wait();
  progress_ = Progress::Complete;
  if (failure_) throw Error(*failure_);
  carrier_->store();
}

}  // namespace sk::mpi
