// SPDX-License-Identifier: MIT
//
// Copies between a domain's stream, of which each rank holds a part, and ordinary streams that hold the whole on each rank.
#include <cstddef>
#include <limits>
#include <vector>

#include <fmt/format.h>

#include "device/device_state.hpp"
#include "device/loop_state.hpp"
#include "device/stream_state.hpp"
#include "device/write_scope.hpp"
#include "domain_state.hpp"
#include "sk/error.hpp"
#include "strips.hpp"

namespace sk {

namespace {

/// Throws sk::Error unless an ordinary stream can hold all elements of a domain's stream with their bits.
void checkWhole(DomainStreamState* given, const StreamRegion& whole, std::string_view what) {
  const DomainStreamState& stream = liveStream(given, what);
  const StreamState& state = liveStream(whole, what);
  const StreamState& own = *stream.placed().stream;
  const Shape& shape = stream.domain->parts.whole();
  if (state.device != own.device) {
    throw Error(
        fmt::format("{}: the ordinary stream is on another device than the domain's stream; create it by "
                    "domain.device().stream",
                    what));
  }
  if (whole.shape != shape) {
    throw Error(fmt::format("{}: the ordinary stream has shape {}, but the domain has {}; give it that shape",
                            what, toString(whole.shape), toString(shape)),
                Error::Kind::Shape);
  }
  if (state.storage != own.storage) {
    throw Error(
        fmt::format("{}: the ordinary stream has another sk::Storage than the domain's stream; create both "
                    "with one storage",
                    what),
        Error::Kind::Type);
  }
  refuseInRecording(*own.device, what);
}

/// The bytes of all ranks' elements, one rank after the other.
std::vector<std::byte> bytesOfAll(const DomainState& domain, const StreamRegion& own) {
  if (domain.parts.whole().size() > std::numeric_limits<int>::max()) {
    throw Error(
        fmt::format("copyTo: the domain of shape {} has more than 2^31 - 1 elements; gather its elements",
                    toString(domain.parts.whole())),
        Error::Kind::Shape);
  }
  const std::size_t size = mpi::bytesOf(own) / static_cast<std::size_t>(own.shape.size());
  auto mine = detail::hostVector<std::byte>(mpi::bytesOf(own));
  mpi::readBytes(own, mine.data());
  std::vector<int> counts, offsets;
  int end = 0;
  for (int rank = 0; rank < domain.parts.ranks(); ++rank) {
    counts.push_back(static_cast<int>(domain::shapeOf(domain.parts.boxOf(rank)).size()));
    offsets.push_back(end);
    end += counts.back();
  }
  auto all = detail::hostVector<std::byte>(static_cast<std::size_t>(end) * size);
  MPI_Datatype element = MPI_DATATYPE_NULL;
  MPI_Type_contiguous(static_cast<int>(size), MPI_BYTE, &element);
  MPI_Type_commit(&element);
  const int status = MPI_Allgatherv(mine.data(), counts[static_cast<std::size_t>(domain.rank)], element,
                                    all.data(), counts.data(), offsets.data(), element, domain.communicator);
  MPI_Type_free(&element);
  mpi::check(status, "copyTo");
  return all;
}

}  // namespace

void detail::copyOwn(DomainStreamState* from, DomainStreamState* to) {
  const DomainStreamState& source = liveStream(from, "copyTo");
  DomainStreamState& target = liveStream(to, "copyTo");
  if (source.domain != target.domain) {
    throw Error(
        "copyTo: the two streams are of different domains; create both by one sk::Domain, or copy through an "
        "ordinary stream");
  }
  target.valid = {};
  copy(source.part(source.domain->own), target.part(target.domain->own));
}

void detail::copyToWhole(DomainStreamState* stream, const StreamRegion& whole) {
  checkWhole(stream, whole, "copyTo");
  const DomainState& domain = *stream->domain;
  const StreamRegion own = stream->part(domain.own);
  if (domain.parts.ranks() == 1) return copy(own, whole);
  const std::vector<std::byte> all = bytesOfAll(domain, own);
  WriteScope writes;
  writes.add(whole.stream);
  writes.begin();
  whole.stream->setWritten();  // its elements come in parts, all of them
  const std::byte* from = all.data();
  for (int rank = 0; rank < domain.parts.ranks(); ++rank) {
    const Box box = domain.parts.boxOf(rank);
    const StreamRegion part = partOf(whole, box.begin, box.end);
    mpi::writeBytes(part, from);
    from += mpi::bytesOf(part);
  }
  writes.commit();
}

void detail::copyFromWhole(DomainStreamState* stream, const StreamRegion& whole) {
  checkWhole(stream, whole, "copyFrom");
  const Box& own = stream->domain->own;
  copy(partOf(whole, own.begin, own.end), ownRegion(stream, true));
}

}  // namespace sk
