// SPDX-License-Identifier: MIT
//
// Elements of a domain's stream between its ranks and the host memory of one: the bytes of any elements, and gather and
// scatter, which take them as they are declared or in the precision in which they are stored.

#include "collect.hpp"

#include <algorithm>
#include <cstring>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "agreement.hpp"
#include "call_details.hpp"
#include "sk/error.hpp"

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

std::size_t bytesOfRank(const DomainState& domain, int rank, std::size_t size) {
  return static_cast<std::size_t>(domain::shapeOf(domain.parts.boxOf(rank)).size()) * size;
}

}  // namespace

Collection::Collection(const DomainState& domain, int root, std::size_t size)
    : domain_(domain),
      root_(root),
      size_(size),
      own_(detail::hostVector<std::byte>(bytesOfRank(domain, domain.rank, size))),
      messages_(domain.communicator, domain.agreement.waitLimit()) {
  std::size_t largest = own_.size();
  if (domain.rank == root) {
    for (int rank = 0; rank < domain.parts.ranks(); ++rank)
      largest = std::max(largest, bytesOfRank(domain, rank, size));
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
      messages_.receive(part_.data(), bytesOfRank(domain_, rank, size_), rank, collectTag);
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
      messages_.send(to.data(), bytesOfRank(domain_, rank, size_), rank, collectTag);
      messages_.wait();
    });
    if (lost && !failure) failure = lost;
  }
  if (failure) throw Error(*failure);
  return std::move(own_);
}

}  // namespace sk::mpi

namespace sk {

namespace {

void checkRoot(const DomainState& domain, int root, std::string_view what) {
  if (root >= 0 && root < domain.parts.ranks()) return;
  throw Error(fmt::format("{}: there is no rank {}; the domain has ranks 0 to {}", what, root,
                          domain.parts.ranks() - 1));
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

void detail::writeOwn(DomainStreamState* stream, OwnWrite kind, OwnVisit visit, void* context) {
  const std::string_view what = kind == OwnWrite::Elements ? "write" : "fill";
  DomainStreamState& own = liveStream(stream, what);
  mpi::Agreement& agreement = own.domain->agreement;
  const auto write = [&] { own.writeOwn([&](const StreamRegion& region) { visit(context, region); }); };
  agreement.count();
  if (kind == OwnWrite::Value && !agreement.isAlways()) return agreement.act(what, write);
  agreement.together(mpi::StreamCall(what, own).call(), write);
}

void detail::gather(DomainStreamState* stream, int root, void* (*room)(void*, std::size_t), void* context) {
  const DomainState& domain = *liveStream(stream, "gather").domain;
  const std::size_t size = stream->element.size;
  std::optional<mpi::Collection> collection;
  std::vector<std::byte> own;
  void* all = nullptr;
  domain.agreement.count();
  domain.agreement.together(mpi::StreamCall("gather", *stream).with("root", root).call(), [&] {
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
  domain.agreement.together(mpi::StreamCall("scatter", *stream).with("root", root).call(), [&] {
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
  domain.agreement.together(mpi::StreamCall("gatherReals", *stream).with("root", root).call(), [&] {
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
  domain.agreement.together(mpi::StreamCall("scatterReals", *stream).with("root", root).call(), [&] {
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
