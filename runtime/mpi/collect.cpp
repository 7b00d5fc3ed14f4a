// SPDX-License-Identifier: MIT
#include "collect.hpp"

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

std::vector<std::byte> bytesOf(const DomainState& domain, int rank, std::size_t size) {
  const Shape shape = domain::shapeOf(domain.parts.boxOf(rank));
  return detail::hostVector<std::byte>(static_cast<std::size_t>(shape.size()) * size);
}

}  // namespace

void collect(const DomainState& domain, int root, std::size_t size, std::vector<std::byte> own, void* all) {
  Messages messages(domain.communicator);
  if (domain.rank != root) {
    messages.send(own.data(), own.size(), root, collectTag);
    return messages.wait();
  }
  for (int rank = 0; rank < domain.parts.ranks(); ++rank) {
    std::vector<std::byte> bytes;
    if (rank == root) {
      bytes = std::move(own);
    } else {
      bytes = bytesOf(domain, rank, size);
      messages.receive(bytes.data(), bytes.size(), rank, collectTag);
      messages.wait();
    }
    forEachRowOf(domain, rank, size, [&](std::size_t whole, std::size_t part, std::size_t count) {
      std::memcpy(static_cast<std::byte*>(all) + whole, bytes.data() + part, count);
    });
  }
}

std::vector<std::byte> distribute(const DomainState& domain, int root, std::size_t size, const void* all) {
  Messages messages(domain.communicator);
  std::vector<std::byte> own = bytesOf(domain, domain.rank, size);
  if (domain.rank != root) {
    messages.receive(own.data(), own.size(), root, collectTag);
    messages.wait();
    return own;
  }
  for (int rank = 0; rank < domain.parts.ranks(); ++rank) {
    std::vector<std::byte> bytes = bytesOf(domain, rank, size);
    forEachRowOf(domain, rank, size, [&](std::size_t whole, std::size_t part, std::size_t count) {
      std::memcpy(bytes.data() + part, static_cast<const std::byte*>(all) + whole, count);
    });
    if (rank == root) {
      own = std::move(bytes);
    } else {
      messages.send(bytes.data(), bytes.size(), rank, collectTag);
      messages.wait();
    }
  }
  return own;
}

}  // namespace sk::mpi
