// SPDX-License-Identifier: MIT
//
// Elements of a domain's stream between its ranks and the host memory of one: gather and scatter.
#include <cstring>
#include <vector>

#include <fmt/format.h>

#include "domain_state.hpp"
#include "sk/error.hpp"

namespace sk {

namespace {

/// A tag that no exchange uses.
constexpr int transferTag = 1000;

void checkRoot(const DomainState& domain, int root, std::string_view what) {
  if (root >= 0 && root < domain.parts.ranks()) return;
  throw Error(fmt::format("{}: there is no rank {}; the domain has ranks 0 to {}", what, root,
                          domain.parts.ranks() - 1));
}

/// Calls visit(whole, part, bytes) for each row of a box: offsets in the bytes of all elements and of the box alone.
template <class Visit>
void forEachRow(const Shape& whole, const Box& box, std::size_t size, Visit&& visit) {
  const int rank = whole.rank();
  const auto row = static_cast<std::size_t>(box.end[rank - 1] - box.begin[rank - 1]) * size;
  Index index = box.begin;
  const auto rows = static_cast<std::size_t>(domain::shapeOf(box).size()) * size / row;
  for (std::size_t k = 0; k < rows; ++k) {
    std::int64_t number = 0;
    for (int d = 0; d < rank; ++d) number = number * whole[d] + index[d];
    visit(static_cast<std::size_t>(number) * size, k * row, row);
    for (int d = rank - 2; d >= 0 && ++index[d] == box.end[d]; --d) index[d] = box.begin[d];
  }
}

}  // namespace

StreamRegion detail::regionOf(DomainStreamState* stream) {
  const DomainState& domain = *liveStream(stream, "a stream of a domain").domain;
  return {.shape = domain.parts.whole(), .distributed = stream};
}

const Box& detail::ownBox(const DomainStreamState* stream) {
  return liveStream(const_cast<DomainStreamState*>(stream), "own").domain->own;
}

int detail::rankOf(const DomainStreamState* stream) {
  return liveStream(const_cast<DomainStreamState*>(stream), "gather").domain->rank;
}

StreamRegion detail::ownRegion(DomainStreamState* stream, bool isWritten) {
  DomainStreamState& own = liveStream(stream, isWritten ? "write" : "read");
  if (isWritten) own.valid = {};
  return own.part(own.domain->own);
}

void detail::gather(DomainStreamState* stream, int root, void* elements) {
  const DomainState& domain = *liveStream(stream, "gather").domain;
  checkRoot(domain, root, "gather");
  const std::size_t size = stream->element.size;
  const StreamRegion own = stream->part(domain.own);
  std::vector<std::byte> bytes = hostVector<std::byte>(static_cast<std::size_t>(own.shape.size()) * size);
  detail::read(own, bytes.data(), static_cast<std::size_t>(own.shape.size()));
  if (domain.rank != root) {
    mpi::Messages messages(domain.communicator);
    messages.send(bytes.data(), bytes.size(), root, transferTag);
    return messages.wait();
  }
  for (int rank = 0; rank < domain.parts.ranks(); ++rank) {
    const Box box = domain.parts.boxOf(rank);
    if (rank != root) {
      bytes = hostVector<std::byte>(static_cast<std::size_t>(domain::shapeOf(box).size()) * size);
      mpi::Messages messages(domain.communicator);
      messages.receive(bytes.data(), bytes.size(), rank, transferTag);
      messages.wait();
    }
    forEachRow(domain.parts.whole(), box, size, [&](std::size_t whole, std::size_t part, std::size_t count) {
      std::memcpy(static_cast<std::byte*>(elements) + whole, bytes.data() + part, count);
    });
  }
}

void detail::scatter(DomainStreamState* stream, int root, const void* elements, std::size_t count) {
  DomainState& domain = *liveStream(stream, "scatter").domain;
  checkRoot(domain, root, "scatter");
  std::int64_t given = static_cast<std::int64_t>(count);
  mpi::broadcast(domain.communicator, root, &given, sizeof given);
  if (given != domain.parts.whole().size()) {
    throw Error(
        fmt::format("scatter: {} element(s) are given on rank {}, but shape {} has {}; give exactly as many",
                    given, root, toString(domain.parts.whole()), domain.parts.whole().size()),
        Error::Kind::Shape);
  }
  const std::size_t size = stream->element.size;
  const auto bytesFor = [&](int rank) {
    return hostVector<std::byte>(static_cast<std::size_t>(domain::shapeOf(domain.parts.boxOf(rank)).size()) *
                                 size);
  };
  std::vector<std::byte> own = bytesFor(domain.rank);
  if (domain.rank != root) {
    mpi::Messages messages(domain.communicator);
    messages.receive(own.data(), own.size(), root, transferTag);
    messages.wait();
  } else {
    for (int rank = 0; rank < domain.parts.ranks(); ++rank) {
      std::vector<std::byte> bytes = bytesFor(rank);
      forEachRow(domain.parts.whole(), domain.parts.boxOf(rank), size,
                 [&](std::size_t whole, std::size_t part, std::size_t row) {
                   std::memcpy(bytes.data() + part, static_cast<const std::byte*>(elements) + whole, row);
                 });
      if (rank == root) {
        own = std::move(bytes);
        continue;
      }
      mpi::Messages messages(domain.communicator);
      messages.send(bytes.data(), bytes.size(), rank, transferTag);
      messages.wait();
    }
  }
  const StreamRegion target = ownRegion(stream, true);
  detail::write(target, own.data(), static_cast<std::size_t>(target.shape.size()));
}

}  // namespace sk
