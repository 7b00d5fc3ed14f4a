// SPDX-License-Identifier: MIT
//
// Copies between a domain's stream, of which each rank holds a part, and ordinary streams that hold the whole on each rank.
#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "agreement.hpp"
#include "call/check_written.hpp"
#include "call_details.hpp"
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
        fmt::format("{}: the ordinary stream is on another device than "
                    "the domain's stream; create it by "
                    "domain.device().stream",
                    what));
  }
  if (whole.shape != shape) {
    throw Error(fmt::format("{}: the ordinary stream has shape {}, but the "
                            "domain has {}; give it that shape",
                            what, toString(whole.shape), toString(shape)),
                Error::Kind::Shape);
  }
  if (state.storage != own.storage) {
    throw Error(fmt::format("{}: the ordinary stream has another sk::Storage "
                            "than the domain's stream; create both "
                            "with one storage",
                            what),
                Error::Kind::Type);
  }
  refuseInRecording(*own.device, what);
}

/// The bytes of all ranks' elements, one rank after the other.
class AllBytes {
 public:
  /// Reads this rank's elements, and allocates what is needed for all.
  AllBytes(const DomainState& domain, const StreamRegion& own)
      : domain_(domain), element_("copyTo", [&](MPI_Datatype* type) {
          const std::size_t size = mpi::bytesOf(own) / static_cast<std::size_t>(own.shape.size());
          return MPI_Type_contiguous(static_cast<int>(size), MPI_BYTE, type);
        }) {
    if (domain.parts.whole().size() > std::numeric_limits<int>::max()) {
      throw Error(fmt::format("copyTo: the domain of shape {} has more than "
                              "2^31 - 1 elements; gather its elements",
                              toString(domain.parts.whole())),
                  Error::Kind::Shape);
    }
    const std::size_t size = mpi::bytesOf(own) / static_cast<std::size_t>(own.shape.size());
    mine_ = detail::hostVector<std::byte>(mpi::bytesOf(own));
    mpi::readBytes(own, mine_.data());
    int end = 0;
    for (int rank = 0; rank < domain.parts.ranks(); ++rank) {
      counts_.push_back(static_cast<int>(domain::shapeOf(domain.parts.boxOf(rank)).size()));
      offsets_.push_back(end);
      end += counts_.back();
    }
    all_ = detail::hostVector<std::byte>(static_cast<std::size_t>(end) * size);
  }

  /// Collective.
  const std::byte* receive() {
    mpi::check(MPI_Allgatherv(mine_.data(), counts_[static_cast<std::size_t>(domain_.rank)], element_,
                              all_.data(), counts_.data(), offsets_.data(), element_, domain_.communicator),
               "copyTo");
    return all_.data();
  }

 private:
  const DomainState& domain_;
  mpi::Datatype element_;
  std::vector<std::byte> mine_, all_;
  std::vector<int> counts_, offsets_;
};

}  // namespace

void detail::copyOwn(DomainStreamState* from, DomainStreamState* given) {
  const DomainStreamState& source = liveStream(from, "copyTo");
  DomainStreamState& target = liveStream(given, "copyTo");
  mpi::Agreement& agreement = target.domain->agreement;
  const auto copyAll = [&] {
    if (source.domain != target.domain) {
      throw Error(
          "copyTo: the two streams are of different domains; create "
          "both by one sk::Domain, or copy through an "
          "ordinary stream");
    }
    target.writeOwn([&](const StreamRegion& to) { copy(source.part(source.domain->own), to); });
  };
  agreement.count();
  if (!agreement.isAlways()) return agreement.act("copyTo", copyAll);
  agreement.together(mpi::StreamCall("copyTo", source).with("target stream", target.number).call(), copyAll);
}

void detail::copyToWhole(DomainStreamState* stream, const StreamRegion& whole) {
  const DomainState& domain = *liveStream(stream, "copyTo").domain;
  if (domain.parts.ranks() == 1) {
    checkWhole(stream, whole, "copyTo");
    return copy(stream->part(domain.own), whole);
  }
  std::optional<AllBytes> bytes;
  domain.agreement.count();
  domain.agreement.together(mpi::StreamCall("copyTo", *stream).with("target", "an ordinary stream").call(),
                            [&] {
                              checkWhole(stream, whole, "copyTo");
                              checkElementsOf(stream->part(domain.own), false, "copyTo");
                              bytes.emplace(domain, stream->part(domain.own));
                            });
  domain.agreement.act("copyTo", [&] {
    const std::byte* from = bytes->receive();
    WriteScope writes;
    writes.add(whole.stream);
    writes.begin();
    whole.stream->setWritten();  // its elements come in parts, all of them
    for (int rank = 0; rank < domain.parts.ranks(); ++rank) {
      const Box box = domain.parts.boxOf(rank);
      const StreamRegion part = partOf(whole, box.begin, box.end);
      mpi::writeBytes(part, from);
      from += mpi::bytesOf(part);
    }
    writes.commit();
    noteWritten(whole);
  });
}

void detail::copyFromWhole(DomainStreamState* stream, const StreamRegion& whole) {
  mpi::Agreement& agreement = liveStream(stream, "copyFrom").domain->agreement;
  const auto copyAll = [&] {
    checkWhole(stream, whole, "copyFrom");
    const Box& own = stream->domain->own;
    stream->writeOwn([&](const StreamRegion& to) { copy(partOf(whole, own.begin, own.end), to); });
  };
  agreement.count();
  if (!agreement.isAlways()) return agreement.act("copyFrom", copyAll);
  agreement.together(mpi::StreamCall("copyFrom", *stream).call(), copyAll);
}

}  // namespace sk
