// SPDX-License-Identifier: MIT
//
// Elements of a domain's stream in the precision in which they are stored: DomainStream::gatherReals and scatterReals.
#include <algorithm>
#include <cstring>

#include <fmt/format.h>

#include "collect.hpp"
#include "sk/error.hpp"

namespace sk {

namespace {

const DomainState& domainFor(DomainStreamState* stream, int root, std::string_view what) {
  const DomainState& domain = *liveStream(stream, what).domain;
  if (root < 0 || root >= domain.parts.ranks()) {
    throw Error(fmt::format("{}: there is no rank {}; the domain has ranks 0 to {}", what, root,
                            domain.parts.ranks() - 1));
  }
  return domain;
}

}  // namespace

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
