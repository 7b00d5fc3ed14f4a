// SPDX-License-Identifier: MIT
#include "exchange.hpp"

#include <cstring>
#include <optional>

#include "device/device_state.hpp"
#include "device/stream_state.hpp"
#include "sk/future.hpp"
#include "strips.hpp"

namespace sk::mpi {

/// A box that one stream sends or receives.
struct Strip {
  StreamRegion region;
  std::size_t bytes;
  detail::TransferOwner read = {};  ///< of a device that is packing it
};

namespace {

/// Takes what a device has packed.
void take(Strip& strip, std::byte* to) {
  if (strip.read) return detail::take(std::move(strip.read), to);
  const std::vector<double> values = detail::readReals(strip.region);
  std::memcpy(to, values.data(), strip.bytes);
}

void store(const Strip& strip, const std::byte* from) {
  if (!holdsReals(strip.region))
    return detail::writeAsync(strip.region, from, static_cast<std::size_t>(strip.region.shape.size()));
  std::vector<double> values(strip.bytes / sizeof(double));
  std::memcpy(values.data(), from, strip.bytes);
  detail::writeReals(strip.region, values);
}

std::size_t bytesOf(const std::vector<Strip>& strips) {
  std::size_t bytes = 0;
  for (const Strip& strip : strips) bytes += strip.bytes;
  return bytes;
}

/// The memory of all strips if they are in memory.
std::vector<Span> spansOf(const std::vector<Strip>& strips) {
  std::vector<Span> all;
  for (const Strip& strip : strips) {
    const std::vector<Span> spans = mpi::spansOf(strip.region);
    all.insert(all.end(), spans.begin(), spans.end());
  }
  return all;
}

std::byte* roomIn(std::vector<std::byte>& buffer, std::size_t bytes) {
  if (buffer.size() < bytes) buffer.resize(bytes);
  return buffer.data();
}

}  // namespace

/// What goes to, and comes from, the neighbor in one direction.
struct Exchange::Direction {
  int rank;
  std::size_t number;  ///< in DomainState::directions
  std::size_t opposite;
  std::vector<Strip> sent, received;
  std::vector<Span> target;  ///< where to unpack what is received, if that is in memory
  bool isDirect = false;  ///< it is received where it belongs
};

Exchange::Exchange(DomainState& domain, std::vector<HaloRequest> requests)
    : domain_(domain), requests_(std::move(requests)), messages_(domain.communicator) {
  const std::size_t directions = domain.directions.size();
  for (std::size_t k = 0; k < directions; ++k) {
    const std::optional<int> rank = domain.parts.neighbor(domain.rank, domain.directions[k]);
    if (!rank) continue;
    Index back = domain.directions[k];
    for (int d = 0; d < back.rank(); ++d) back[d] = -back[d];
    Direction neighbor{.rank = *rank, .number = k, .opposite = 0, .sent = {}, .received = {}, .target = {}};
    while (!(domain.directions[neighbor.opposite] == back)) ++neighbor.opposite;
    for (const HaloRequest& request : requests_) {
      const Box sent = domain::sentTo(domain.own, domain.directions[k], request.depth);
      const Box received = domain::receivedFrom(domain.own, domain.directions[k], request.depth);
      for (const auto& [box, strips] :
           {std::pair{&sent, &neighbor.sent}, std::pair{&received, &neighbor.received}}) {
        if (domain::isEmpty(*box)) continue;
        const StreamRegion region = request.stream->part(*box);
        strips->push_back({region, mpi::bytesOf(region)});
      }
    }
    neighbors_.push_back(std::move(neighbor));
  }
  const bool isMemory = !requests_.empty() && isInMemory(requests_.front().stream->placed());
  for (Direction& neighbor : neighbors_) {
    if (neighbor.received.empty()) continue;
    if (isMemory) neighbor.target = spansOf(neighbor.received);
    neighbor.isDirect = neighbor.target.size() == 1;
    const std::size_t bytes = bytesOf(neighbor.received);
    std::byte* const to = neighbor.isDirect ? neighbor.target.front().bytes
                                            : roomIn(domain_.receiveBuffers[neighbor.number], bytes);
    messages_.receive(to, bytes, neighbor.rank, static_cast<int>(neighbor.opposite));
  }
  if (isMemory) {
    post();
    return;
  }
  for (Direction& neighbor : neighbors_) {
    for (Strip& strip : neighbor.sent) {
      if (!holdsReals(strip.region)) strip.read = detail::readAsync(strip.region);
    }
  }
}

Exchange::~Exchange() = default;

/// Sends all strips, and waits until they are packed.
void Exchange::post() {
  for (Direction& neighbor : neighbors_) {
    if (neighbor.sent.empty()) continue;
    const std::size_t bytes = bytesOf(neighbor.sent);
    const std::byte* from = nullptr;
    if (!isInMemory(neighbor.sent.front().region)) {
      std::byte* to = roomIn(domain_.sendBuffers[neighbor.number], bytes);
      from = to;
      for (Strip& strip : neighbor.sent) {
        take(strip, to);
        to += strip.bytes;
      }
    } else {
      const std::vector<Span> spans = spansOf(neighbor.sent);
      from = spans.front().bytes;
      if (spans.size() > 1) {
        std::byte* const to = roomIn(domain_.sendBuffers[neighbor.number], bytes);
        pack(spans, to);
        from = to;
      }
    }
    messages_.send(from, bytes, neighbor.rank, static_cast<int>(neighbor.number));
    ++domain_.statistics.messages;
    domain_.statistics.bytes += static_cast<std::int64_t>(bytes);
  }
  ++domain_.statistics.exchanges;
}

void Exchange::finish() {
  const bool isMemory = !requests_.empty() && isInMemory(requests_.front().stream->placed());
  if (!isMemory) post();
  messages_.wait();
  for (const Direction& neighbor : neighbors_) {
    if (neighbor.received.empty() || neighbor.isDirect) continue;
    const std::byte* from = domain_.receiveBuffers[neighbor.number].data();
    if (isMemory) {
      unpack(from, neighbor.target);
      continue;
    }
    for (const Strip& strip : neighbor.received) {
      store(strip, from);
      from += strip.bytes;
    }
  }
  for (const HaloRequest& request : requests_) request.stream->valid = request.depth;
}

}  // namespace sk::mpi
