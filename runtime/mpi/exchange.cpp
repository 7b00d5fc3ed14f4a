// SPDX-License-Identifier: MIT
#include "exchange.hpp"

#include <optional>

namespace sk::mpi {

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
