// SPDX-License-Identifier: MIT
//
// Elements of a domain's stream between its ranks and the host memory of one: gather and scatter, as they are declared or in the
// precision in which they are stored.
#include <cstring>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "collect.hpp"
#include "hash.hpp"
#include "sk/error.hpp"

namespace sk {

namespace {

void checkRoot(const DomainState& domain, int root, std::string_view what) {
  if (root >= 0 && root < domain.parts.ranks()) return;
  throw Error(fmt::format("{}: there is no rank {}; the domain has ranks 0 to {}", what, root,
                          domain.parts.ranks() - 1));
}

mpi::Call callOf(std::string_view what, int root, std::size_t size) {
  mpi::Hash hash;
  hash.add(what);
  hash.add(root);
  hash.add(static_cast<std::int64_t>(size));
  return {what, hash.value()};
}

std::size_t componentsOf(const program::Element& element) {
  std::size_t components = 0;
  for (const program::Field& field : element.fields) components += static_cast<std::size_t>(field.width);
  return components;
}

}  // namespace

StreamRegion detail::regionOf(DomainStreamState* stream) {
  const DomainState& domain = *liveStream(stream, "a stream of a domain").domain;
  return {.shape = domain.parts.whole(), .distributed = stream};
}

const Box& detail::ownBox(const DomainStreamState* stream) {
  return liveStream(const_cast<DomainStreamState*>(stream), "own").domain->own;
}

void detail::readOwn(DomainStreamState* stream, OwnVisit visit, void* context) {
  const DomainStreamState& own = liveStream(stream, "read");
  visit(context, own.part(own.domain->own));
}

void detail::writeOwn(DomainStreamState* stream, OwnVisit visit, void* context) {
  DomainStreamState& own = liveStream(stream, "write");
  own.domain->agreement.act(
      "write", [&] { own.writeOwn([&](const StreamRegion& region) { visit(context, region); }); });
}

void detail::gather(DomainStreamState* stream, int root, void* (*room)(void*, std::size_t), void* context) {
  const DomainState& domain = *liveStream(stream, "gather").domain;
  const std::size_t size = stream->element.size;
  std::optional<mpi::Collection> collection;
  std::vector<std::byte> own;
  void* all = nullptr;
  domain.agreement.count();
  domain.agreement.together(callOf("gather", root, size), [&] {
    checkRoot(domain, root, "gather");
    const StreamRegion region = stream->part(domain.own);
    const auto count = static_cast<std::size_t>(region.shape.size());
    collection.emplace(domain, root, size);
    own = hostVector<std::byte>(count * size);
    read(region, own.data(), count);
    if (domain.rank == root) all = room(context, static_cast<std::size_t>(domain.parts.whole().size()));
  });
  domain.agreement.act("gather", [&] { collection->collect(std::move(own), all); });
}

void detail::scatter(DomainStreamState* stream, int root, const void* elements, std::size_t count) {
  const DomainState& domain = *liveStream(stream, "scatter").domain;
  std::optional<mpi::Collection> collection;
  domain.agreement.count();
  domain.agreement.together(callOf("scatter", root, stream->element.size), [&] {
    checkRoot(domain, root, "scatter");
    const std::int64_t size = domain.parts.whole().size();
    if (domain.rank == root && static_cast<std::int64_t>(count) != size) {
      throw Error(fmt::format("scatter: {} element(s) are given on rank {}, "
                              "but shape {} has {}; give exactly as many",
                              count, root, toString(domain.parts.whole()), size),
                  Error::Kind::Shape);
    }
    collection.emplace(domain, root, stream->element.size);
  });
  domain.agreement.act("scatter", [&] {
    const std::vector<std::byte> own = collection->distribute(elements);
    stream->writeOwn([&](const StreamRegion& target) {
      write(target, own.data(), static_cast<std::size_t>(target.shape.size()));
    });
  });
}

std::vector<double> detail::gatherReals(DomainStreamState* stream, int root) {
  const DomainState& domain = *liveStream(stream, "gatherReals").domain;
  const std::size_t components = componentsOf(stream->element), size = components * sizeof(double);
  std::optional<mpi::Collection> collection;
  std::vector<std::byte> own;
  std::vector<double> all;
  domain.agreement.count();
  domain.agreement.together(callOf("gatherReals", root, size), [&] {
    checkRoot(domain, root, "gatherReals");
    const std::vector<double> reals = readReals(stream->part(domain.own));
    collection.emplace(domain, root, size);
    own = hostVector<std::byte>(reals.size() * sizeof(double));
    std::memcpy(own.data(), reals.data(), own.size());
    if (domain.rank == root)
      all = hostVector<double>(static_cast<std::size_t>(domain.parts.whole().size()) * components);
  });
  domain.agreement.act("gatherReals", [&] { collection->collect(std::move(own), all.data()); });
  return all;
}

void detail::scatterReals(DomainStreamState* stream, int root, std::span<const double> components) {
  const DomainState& domain = *liveStream(stream, "scatterReals").domain;
  const std::size_t width = componentsOf(stream->element);
  std::optional<mpi::Collection> collection;
  domain.agreement.count();
  domain.agreement.together(callOf("scatterReals", root, width * sizeof(double)), [&] {
    checkRoot(domain, root, "scatterReals");
    const auto cells = static_cast<std::size_t>(domain.parts.whole().size());
    if (domain.rank == root && components.size() != cells * width) {
      throw Error(fmt::format("scatterReals: {} component(s) are given on rank {}, "
                              "but {} elements of shape {} have {}; give "
                              "exactly as many",
                              components.size(), root, cells, toString(domain.parts.whole()), cells * width),
                  Error::Kind::Shape);
    }
    collection.emplace(domain, root, width * sizeof(double));
  });
  domain.agreement.act("scatterReals", [&] {
    const std::vector<std::byte> bytes = collection->distribute(components.data());
    auto own = hostVector<double>(bytes.size() / sizeof(double));
    std::memcpy(own.data(), bytes.data(), bytes.size());
    stream->writeOwn([&](const StreamRegion& target) { writeReals(target, own); });
  });
}

}  // namespace sk
