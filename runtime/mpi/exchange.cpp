// SPDX-License-Identifier: MIT
#include "exchange.hpp"

#include <optional>

namespace sk::mpi {

Exchange::Exchange(DomainState& domain, std::vector<HaloRequest> requests)
    : domain_(domain), requests_(std::move(requests)), messages_(domain.communicator) {
  for (std::size_t k = 0; k < domain.directions.size(); ++k) addNeighbor(k);
  carrier_ = Carrier::of(domain, strips_);
  for (std::size_t i = 0; i < strips_.size(); ++i) {
    if (strips_[i].received.empty()) continue;
    const Neighbor& neighbor = neighbors_[i];
    messages_.receive(carrier_->target(strips_[i]), strips_[i].receivedBytes, neighbor.rank,
                      static_cast<int>(neighbor.opposite));
  }
  carrier_->begin();
  if (carrier_->isAtHost()) post();
}

Exchange::~Exchange() = default;

void Exchange::addNeighbor(std::size_t direction) {
  const std::optional<int> rank = domain_.parts.neighbor(domain_.rank, domain_.directions[direction]);
  if (!rank) return;
  Index back = domain_.directions[direction];
  for (int d = 0; d < back.rank(); ++d) back[d] = -back[d];
  Neighbor neighbor{.rank = *rank, .opposite = 0};
  while (!(domain_.directions[neighbor.opposite] == back)) ++neighbor.opposite;
  Strips strips{.direction = direction, .sent = {}, .received = {}};
  for (const HaloRequest& request : requests_) {
    const Box sent = domain::sentTo(domain_.own, domain_.directions[direction], request.depth);
    const Box received = domain::receivedFrom(domain_.own, domain_.directions[direction], request.depth);
    if (!domain::isEmpty(sent)) strips.sent.push_back(request.stream->part(sent));
    if (!domain::isEmpty(received)) strips.received.push_back(request.stream->part(received));
  }
  neighbors_.push_back(neighbor);
  strips_.push_back(std::move(strips));
}

/// Sends all strips, and waits until they are packed.
void Exchange::post() {
  for (std::size_t i = 0; i < strips_.size(); ++i) {
    const Strips& strips = strips_[i];
    if (strips.sent.empty()) continue;
    messages_.send(carrier_->source(strips), strips.sentBytes, neighbors_[i].rank,
                   static_cast<int>(strips.direction));
    ++domain_.statistics.messages;
    domain_.statistics.bytes += static_cast<std::int64_t>(strips.sentBytes);
  }
  ++domain_.statistics.exchanges;
}

void Exchange::finish() {
  if (!carrier_->isAtHost()) post();
  messages_.wait();
  carrier_->store();
  for (const HaloRequest& request : requests_) request.stream->valid = request.depth;
}

}  // namespace sk::mpi
