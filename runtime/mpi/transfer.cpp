// SPDX-License-Identifier: MIT
//
// Elements of a domain's stream between its ranks and the host memory of one: gather and scatter, as they are declared or in the
// precision in which they are stored.
#include <cstring>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "collect.hpp"
#include "sk/error.hpp"

namespace sk {

namespace {

/// The domain of a stream that `what` is asked of.
const DomainState& domainFor(DomainStreamState* stream, int root, std::string_view what) {
  const DomainState& domain = *liveStream(stream, what).domain;
  if (root < 0 || root >= domain.parts.ranks()) {
    throw Error(fmt::format("{}: there is no rank {}; the domain has ranks 0 to {}", what, root,
                            domain.parts.ranks() - 1));
  }
  return domain;
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
  const DomainState& domain = domainFor(stream, root, "gather");
  const StreamRegion own = stream->part(domain.own);
  const auto count = static_cast<std::size_t>(own.shape.size());
  std::vector<std::byte> bytes = hostVector<std::byte>(count * stream->element.size);
  detail::read(own, bytes.data(), count);
  mpi::collect(domain, root, stream->element.size, std::move(bytes), elements);
}

void detail::scatter(DomainStreamState* stream, int root, const void* elements, std::size_t count) {
  const DomainState& domain = domainFor(stream, root, "scatter");
  std::int64_t given = static_cast<std::int64_t>(count);
  mpi::broadcast(domain.communicator, root, &given, sizeof given);
  if (given != domain.parts.whole().size()) {
    throw Error(
        fmt::format("scatter: {} element(s) are given on rank {}, but shape {} has {}; give exactly as many",
                    given, root, toString(domain.parts.whole()), domain.parts.whole().size()),
        Error::Kind::Shape);
  }
  const std::vector<std::byte> own = mpi::distribute(domain, root, stream->element.size, elements);
  const StreamRegion target = ownRegion(stream, true);
  detail::write(target, own.data(), static_cast<std::size_t>(target.shape.size()));
}

std::vector<double> detail::gatherReals(DomainStreamState* stream, int root) {
  const DomainState& domain = domainFor(stream, root, "gatherReals");
  const std::vector<double> own = readReals(stream->part(domain.own));
  std::vector<std::byte> bytes(own.size() * sizeof(double));
  std::memcpy(bytes.data(), own.data(), bytes.size());
  const auto cells = static_cast<std::size_t>(domain::shapeOf(domain.own).size());
  const std::size_t components = own.size() / cells;
  auto all = hostVector<double>(
      domain.rank == root ? static_cast<std::size_t>(domain.parts.whole().size()) * components : 0);
  mpi::collect(domain, root, components * sizeof(double), std::move(bytes), all.data());
  return all;
}

void detail::scatterReals(DomainStreamState* stream, int root, std::span<const double> components) {
  const DomainState& domain = domainFor(stream, root, "scatterReals");
  const auto cells = static_cast<std::uint64_t>(domain.parts.whole().size());
  std::uint64_t given = components.size(), width = 0;
  for (const program::Field& field : stream->element.fields) width += static_cast<std::uint64_t>(field.width);
  mpi::broadcast(domain.communicator, root, &given, sizeof given);
  if (given != cells * width) {
    throw Error(
        fmt::format(
            "scatterReals: {} component(s) are given on rank {}, but {} elements of shape {} have {}; give "
            "exactly as many",
            given, root, cells, toString(domain.parts.whole()), cells * width),
        Error::Kind::Shape);
  }
  const std::vector<std::byte> bytes =
      mpi::distribute(domain, root, static_cast<std::size_t>(width) * sizeof(double), components.data());
  auto own = hostVector<double>(bytes.size() / sizeof(double));
  std::memcpy(own.data(), bytes.data(), bytes.size());
  writeReals(ownRegion(stream, true), own);
}

}  // namespace sk
