// SPDX-License-Identifier: MIT
#include "collect.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

namespace sk::mpi {

namespace {

/// A tag that no exchange uses.
constexpr int collectTag = 1001;

/// Calls visit(whole, part, bytes) for each row of a rank's box: offsets in the bytes of all elements and in those of the box.
template <class Visit>
void forEachRowOf(const DomainState& domain, int rank, std::size_t size, Visit&& visit) {
  const Shape& whole = domain.parts.whole();
  const Box box = domain.parts.boxOf(rank);
  const int last = whole.rank() - 1;
  const std::int64_t row = box.end[last] - box.begin[last];
  const std::int64_t rows = domain::shapeOf(box).size() / row;
  Index index = box.begin;
  for (std::int64_t k = 0; k < rows; ++k) {
    std::int64_t number = 0;
    for (int d = 0; d <= last; ++d) number = number * whole[d] + index[d];
    visit(static_cast<std::size_t>(number) * size, static_cast<std::size_t>(k * row) * size,
          static_cast<std::size_t>(row) * size);
    for (int d = last - 1; d >= 0 && ++index[d] == box.end[d]; --d) index[d] = box.begin[d];
  }
}

std::size_t bytesOf(const DomainState& domain, int rank, std::size_t size) {
  return static_cast<std::size_t>(domain::shapeOf(domain.parts.boxOf(rank)).size()) * size;
}

}  // namespace

Collection::Collection(const DomainState& domain, int root, std::size_t size)
    : domain_(domain),
      root_(root),
      size_(size),
      own_(detail::hostVector<std::byte>(bytesOf(domain, domain.rank, size))),
      messages_(domain.communicator, domain.agreement.waitLimit()) {
  std::size_t largest = own_.size();
  if (domain.rank == root) {
    for (int rank = 0; rank < domain.parts.ranks(); ++rank)
      largest = std::max(largest, bytesOf(domain, rank, size));
    part_ = detail::hostVector<std::byte>(largest);
  }
  messages_.reserve(largest);
}

void Collection::collect(std::vector<std::byte> own, void* all) {
  if (domain_.rank != root_) {
    messages_.send(own.data(), own.size(), root_, collectTag);
    return messages_.wait();
  }
  Refusal failure;  // of one message: those of the others are received, too
  for (int rank = 0; rank < domain_.parts.ranks(); ++rank) {
    const Refusal lost = caught("gather", [&] {
      if (rank == root_) return;
      messages_.receive(part_.data(), bytesOf(domain_, rank, size_), rank, collectTag);
      messages_.wait();
    });
    if (lost && !failure) failure = lost;
    const std::vector<std::byte>& from = rank == root_ ? own : part_;
    forEachRowOf(domain_, rank, size_, [&](std::size_t whole, std::size_t part, std::size_t count) {
      std::memcpy(static_cast<std::byte*>(all) + whole, from.data() + part, count);
    });
  }
  if (failure) throw Error(*failure);
}

std::vector<std::byte> Collection::distribute(const void* all) {
  if (domain_.rank != root_) {
    messages_.receive(own_.data(), own_.size(), root_, collectTag);
    messages_.wait();
    return std::move(own_);
  }
  Refusal failure;
  for (int rank = 0; rank < domain_.parts.ranks(); ++rank) {
    std::vector<std::byte>& to = rank == root_ ? own_ : part_;
    forEachRowOf(domain_, rank, size_, [&](std::size_t whole, std::size_t part, std::size_t count) {
      std::memcpy(to.data() + part, static_cast<const std::byte*>(all) + whole, count);
    });
    if (rank == root_) continue;
    const Refusal lost = caught("scatter", [&] {
      messages_.send(to.data(), bytesOf(domain_, rank, size_), rank, collectTag);
      messages_.wait();
    });
    if (lost && !failure) failure = lost;
  }
  if (failure) throw Error(*failure);
  return std::move(own_);
}

}  // namespace sk::mpi
