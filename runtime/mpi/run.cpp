// SPDX-License-Identifier: MIT
//
// Runs a kernel on this rank's part of a domain: finds out which halos it needs, exchanges those that are not valid,
// computes what needs no halo meanwhile, and the rest afterwards.
#include "call_plan.hpp"

#include <algorithm>
#include <functional>
#include <optional>
#include <utility>

#include "agreement.hpp"
#include "call/box.hpp"
#include "call/check_asserts.hpp"
#include "call/check_call.hpp"
#include "call/check_ranges.hpp"
#include "call/check_written.hpp"
#include "call/placed.hpp"
#include "call_details.hpp"
#include "device/device_state.hpp"
#include "device/loop_state.hpp"
#include "device/stream_state.hpp"
#include "exchange.hpp"
#include "strips.hpp"

namespace sk {

using domain::Depth;
using mpi::HaloRequest;
using mpi::SpreadArgument;
using program::Kernel;
using program::Role;

namespace {

Depth times(const Depth& depth, std::int64_t factor) {
  Depth result = depth;
  for (std::size_t d = 0; d < result.below.size(); ++d) {
    result.below[d] *= factor;
    result.above[d] *= factor;
  }
  return result;
}

Depth sum(const Depth& a, const Depth& b) {
  Depth result = a;
  for (std::size_t d = 0; d < result.below.size(); ++d) {
    result.below[d] += b.below[d];
    result.above[d] += b.above[d];
  }
  return result;
}

/// How many elements of a halo are valid beyond those that are read around an element.
Depth left(const Depth& valid, const Depth& read) {
  Depth result;
  for (std::size_t d = 0; d < result.below.size(); ++d) {
    result.below[d] = std::max<std::int64_t>(valid.below[d] - read.below[d], 0);
    result.above[d] = std::max<std::int64_t>(valid.above[d] - read.above[d], 0);
  }
  return result;
}

Depth least(const Depth& a, const Depth& b) {
  Depth result;
  for (std::size_t d = 0; d < result.below.size(); ++d) {
    result.below[d] = std::min(a.below[d], b.below[d]);
    result.above[d] = std::min(a.above[d], b.above[d]);
  }
  return result;
}

/// Boxes of a GL device's textures that begin at multiples of this many rows take 1 to 3 % less time, and 22 % less where the
/// texels are alike, so that the GPU stores them compressed.
constexpr std::int64_t group = 4;

Depth roundedUp(const Depth& depth, std::int64_t unit) {
  Depth result = depth;
  for (std::size_t d = 0; d < result.below.size(); ++d) {
    result.below[d] = (depth.below[d] + unit - 1) / unit * unit;
    result.above[d] = (depth.above[d] + unit - 1) / unit * unit;
  }
  return result;
}

/// The depth of a stream's arrays that holds `needed`: that of all streams of the call, so that the kernel finds an element
/// at the same place in each of them, except in dimensions that are so short that a part with both halos would overlap itself.
Depth roomFor(const domain::Decomposition& parts, const Depth& needed, const Depth& common) {
  Depth room = needed;
  for (int d = 0; d < parts.whole().rank(); ++d) {
    const auto k = static_cast<std::size_t>(d);
    const std::int64_t thickest = (parts.whole()[d] + parts.split()[d] - 1) / parts.split()[d];
    if (common.below[k] + thickest + common.above[k] > parts.whole()[d]) continue;
    room.below[k] = common.below[k];
    room.above[k] = common.above[k];
  }
  return room;
}

/// A halo reaches no farther than the neighbor's own elements.
void checkThickness(const DomainState& domain, const Kernel& kernel, const program::Parameter& parameter,
                    const Depth& depth) {
  for (int d = 0; d < domain.parts.whole().rank(); ++d) {
    const auto k = static_cast<std::size_t>(d);
    const std::int64_t deepest = std::max(depth.below[k], depth.above[k]),
                       least = domain.parts.leastExtent(d);
    if (deepest <= least) continue;
    fail(Error::Kind::Shape, kernel,
         "'{}' needs a halo of {} element(s) along {}{}, but rank {} has {} of "
         "the {} there; start fewer "
         "ranks, or divide "
         "another dimension",
         parameter.name, deepest, "xyzw"[domain.parts.whole().rank() - 1 - d],
         domain.options.exchangeEvery > 1 ? " with this exchangeEvery" : "", domain.parts.thinnest(d), least,
         domain.parts.whole()[d]);
  }
}

}  // namespace

namespace mpi {

namespace {

/// Which kernel of which loaded file, and which options they are, in this process.
std::uint64_t idOf(const Kernel& kernel, std::uint64_t object, const CallOptions& options) {
  std::uint64_t id = reinterpret_cast<std::uintptr_t>(&kernel);
  const auto mix = [&](std::uint64_t number) {
    id = (id ^ number) * 0x9e3779b97f4a7c15;
    id ^= id >> 32;
  };
  mix(object);
  mix(static_cast<std::uint64_t>(options.intrinsics) << 24 |
      static_cast<std::uint64_t>(options.tables) << 16 |
      static_cast<std::uint64_t>(options.contraction) << 8 | static_cast<std::uint64_t>(options.order));
  mix(static_cast<std::uint64_t>(options.precision) << 32 |
      static_cast<std::uint64_t>(options.accumulate) << 16 | static_cast<std::uint64_t>(options.scan) << 8 |
      static_cast<std::uint64_t>(options.along.value_or(-1) + 1));
  for (int d = 0; options.over && d < options.over->shape.rank(); ++d)
    mix(static_cast<std::uint64_t>(options.over->shape[d] + 1));
  return id | 1;
}

std::uint64_t hashOf(const Kernel& kernel, const CallOptions& options) {
  Hash hash;
  hash.add(kernel.name);
  hash.add(kernel.declarations);
  hash.add(kernel.body);
  for (const program::Parameter& parameter : kernel.parameters) hash.add(parameter.name);
  hash.add(static_cast<std::int64_t>(options.precision));
  hash.add(static_cast<std::int64_t>(options.accumulate));
  hash.add(static_cast<std::int64_t>(options.scan));
  hash.add(options.along.value_or(-1));
  hash.add(static_cast<std::int64_t>(options.intrinsics));
  hash.add(static_cast<std::int64_t>(options.tables));
  hash.add(static_cast<std::int64_t>(options.contraction));
  hash.add(static_cast<std::int64_t>(options.order));
  for (int d = 0; options.over && d < options.over->shape.rank(); ++d) hash.add(options.over->shape[d]);
  return hash.value();
}

/// Whether calls of the kernel may exchange halos at all.
bool readsNeighbors(const Kernel& kernel) {
  return std::ranges::any_of(kernel.parameters, [](const program::Parameter& parameter) {
    return parameter.role == Role::Gather && !parameter.halo.empty();
  });
}

}  // namespace

Call beginCall(DomainState& domain, const Kernel& kernel, const CallOptions& options) {
  const bool isCompared = domain.agreement.ranks() > 1;
  Call call;
  domain.agreement.act(kernel.name, [&] {
    const std::uint64_t object = isCompared ? domain.rankDevice->objects.of(&kernel) : 0;
    call = domain.agreement.begin(kernel.name, idOf(kernel, object, options),
                                  [&] { return hashOf(kernel, options); });
  });
  call.add(static_cast<std::uint64_t>(domain.number));
  return call;
}

std::vector<Argument> ownArguments(std::span<const Argument> arguments) {
  std::vector<Argument> own(arguments.begin(), arguments.end());
  for (Argument& argument : own) {
    if (const DomainStreamState* const stream = domainStream(argument.region))
      argument.region = stream->placed();
  }
  return own;
}

StreamRegion ownPart(const DomainStreamState& stream) {
  StreamRegion part = stream.part(stream.domain->own);
  part.placement = {stream.domain->own.begin, stream.domain->parts.whole()};
  return part;
}

std::vector<Argument> ownParts(std::span<const Argument> arguments) {
  std::vector<Argument> own(arguments.begin(), arguments.end());
  for (Argument& argument : own) {
    if (const DomainStreamState* const stream = domainStream(argument.region))
      argument.region = ownPart(*stream);
  }
  return own;
}

void refuseRecording(DomainState& domain, const Kernel& kernel) {
  for (const DomainStreamState* stream : domain.streams) {
    if (stream->placed().stream->device->recording == nullptr) return;
    fail(kernel,
         "a call on a stream of a sk::Domain cannot be recorded, "
         "because the ranks exchange elements in it; "
         "call it "
         "outside of Device::record");
  }
}

void checkDomain(const DomainState& domain, const Kernel& kernel, std::span<const Argument> arguments,
                 const CallOptions& options) {
  const Shape given = domainOf(kernel, ownArguments(arguments), specsOf(kernel, arguments), options.over);
  if (given.rank() == 0 || given == domain.parts.whole()) return;
  fail(Error::Kind::Shape, kernel,
       "its domain has the shape {}, but its streams are divided over the ranks of a domain of shape {}; "
       "call it over that shape",
       toString(given), toString(domain.parts.whole()));
}

CallPlan::CallPlan(DomainState& domain, const Kernel& kernel, std::span<const Argument> arguments,
                   const CallOptions& options)
    : domain_(domain), kernel_(kernel), options_(options), arguments_(arguments.begin(), arguments.end()) {
  refuseRecording(domain, kernel);
  spread_ = spreadArguments(domain, kernel, arguments);
  checkDomain(domain, kernel, arguments, options);
  takeOthers();
  for (const SpreadArgument& one : spread_) reach_ = reach_.with(one.depth);
  const int every = others_.empty() ? domain.options.exchangeEvery : 1;
  further_ = times(reach_, every - 1);
  bool needsExchange = false;
  for (const SpreadArgument& one : spread_) {
    needsExchange = needsExchange || (!one.isWritten && !one.stream->valid.covers(one.depth));
    if (!isInMemory(one.stream->placed())) unit_ = group;
  }
  bool isFirst = true;
  for (const SpreadArgument& one : spread_) {
    if (one.isWritten) continue;
    const Depth depth = sum(further_, one.depth);
    if (needsExchange && !one.stream->valid.covers(depth)) {
      checkThickness(domain, kernel, kernel.parameters[one.index], depth);
      addRequest(requests_, one.stream, depth);
    }
    const Depth beyond = left(depthAfter(*one.stream), one.depth);
    beyond_ = std::exchange(isFirst, false) ? beyond : least(beyond_, beyond);
  }
  if (every == 1 || !options.box.isWhole()) beyond_ = {};
  box_ = options.box.isWhole() ? domain::grown(domain.own, domain.parts.haloOf(domain.rank, beyond_))
                               : domain::intersection(domain.own, options.box);
}

/// Halos of other domains' streams, which these exchange. What the call needs of them around a rank's own elements says nothing of
/// elements in its halo, so that such calls compute no more than their own.
void CallPlan::takeOthers() {
  for (const SpreadArgument& one : spread_) {
    if (one.stream->domain != &domain_) others_.push_back(one);
  }
  std::erase_if(spread_, [&](const SpreadArgument& one) { return one.stream->domain != &domain_; });
  for (const SpreadArgument& one : others_) {
    if (one.stream->valid.covers(one.depth)) continue;
    checkThickness(*one.stream->domain, kernel_, kernel_.parameters[one.index], one.depth);
    addRequest(otherRequests_, one.stream, one.depth);
  }
}

std::uint64_t CallPlan::hash() const {
  Hash hash;
  for (const std::vector<HaloRequest>& requests : {std::cref(requests_), std::cref(otherRequests_)}) {
    hash.add(static_cast<std::int64_t>(requests.size()));
    for (const HaloRequest& request : requests) {
      hash.add(request.stream->domain->number);
      hash.add(request.stream->element.name);
      hash.add(static_cast<std::int64_t>(request.stream->storage()));
      for (const std::int64_t depth : request.depth.below) hash.add(depth);
      for (const std::int64_t depth : request.depth.above) hash.add(depth);
    }
  }
  return hash.value();
}

std::string CallPlan::halos() const {
  std::string names;
  for (const std::vector<SpreadArgument>& arguments : {std::cref(spread_), std::cref(others_)}) {
    for (const SpreadArgument& one : arguments) {
      const auto isOfOne = [&](const HaloRequest& request) { return request.stream == one.stream; };
      if (!one.isGather ||
          (std::ranges::none_of(requests_, isOfOne) && std::ranges::none_of(otherRequests_, isOfOne)))
        continue;
      names += fmt::format("{}'{}'", names.empty() ? "" : ", ", kernel_.parameters[one.index].name);
    }
  }
  return names.empty() ? "no halo to exchange" : "halos to exchange of " + names;
}

/// Makes room for the halos that this call and the ones like it need.
void CallPlan::makeRoom() {
  for (const auto& [stream, depth] : otherRequests_) {
    const std::int64_t unit = isInMemory(stream->placed()) ? 1 : group;
    const Depth needed = depth.with(stream->allocated);
    stream->deepen(roomFor(stream->domain->parts, needed, roundedUp(needed, unit)));
  }
  if (domain_.parts.ranks() > 1) {
    Depth common;
    for (const SpreadArgument& one : spread_) {
      common = common.with(one.stream->allocated);
      if (!one.isWritten) common = common.with(sum(further_, one.depth));
    }
    common = roundedUp(common, unit_);
    for (const SpreadArgument& one : spread_)
      one.stream->deepen(roomFor(domain_.parts, one.stream->allocated, common));
  }
  for (const HaloRequest& request : requests_) request.stream->deepen(request.depth);
  for (const SpreadArgument& one : spread_) {
    if (one.isWritten) one.stream->deepen(beyond_);
  }
}

/// One message to each neighbor for all streams of a domain.
void CallPlan::prepareExchanges() {
  checkInputs();
  makeRoom();
  std::vector<HaloRequest> rest = otherRequests_;
  while (!rest.empty()) {
    DomainState& domain = *rest.front().stream->domain;
    const auto end = std::stable_partition(rest.begin(), rest.end(), [&](const HaloRequest& request) {
      return request.stream->domain == &domain;
    });
    otherExchanges_.push_back(
        std::make_unique<Exchange>(domain, std::vector<HaloRequest>(rest.begin(), end)));
    rest.erase(rest.begin(), end);
  }
  if (!requests_.empty()) exchange_.emplace(domain_, requests_);
}

bool CallPlan::isOneBox() const { return !options_.box.isWhole() || domain_.parts.ranks() == 1; }

void CallPlan::prepare() {
  prepareExchanges();
  if (isOneBox()) {
    arguments_ = ownArguments(arguments_);
  } else {
    replaceArguments();
  }
}

void CallPlan::startExchanges() {
  for (const std::unique_ptr<Exchange>& exchange : otherExchanges_) exchange->start();
  if (exchange_) exchange_->start();
  for (const std::vector<HaloRequest>& requests : {std::cref(requests_), std::cref(otherRequests_)}) {
    for (const HaloRequest& request : requests) request.stream->valid = request.depth;
  }
}

void CallPlan::finishOthers() {
  for (const std::unique_ptr<Exchange>& exchange : otherExchanges_) exchange->finish();
}

void CallPlan::addRequest(std::vector<HaloRequest>& requests, DomainStreamState* stream, const Depth& depth) {
  const auto found = std::ranges::find(requests, stream, &HaloRequest::stream);
  if (found != requests.end()) {
    found->depth = found->depth.with(depth);
  } else {
    requests.push_back({stream, depth.with(stream->valid)});
  }
}

Depth CallPlan::depthAfter(const DomainStreamState& stream) const {
  const auto found = std::ranges::find(requests_, &stream, &HaloRequest::stream);
  return found == requests_.end() ? stream.valid : found->depth;
}

/// A stream that is also read is written to a spare array, if there are several boxes: each reads what was there before.
void CallPlan::replaceArguments() {
  for (Argument& argument : arguments_) {
    if (const DomainStreamState* const stream = domainStream(argument.region))
      argument.region = stream->placed();
  }
  for (const SpreadArgument& one : spread_) {
    const bool isRead = std::ranges::any_of(
        spread_, [&](const SpreadArgument& other) { return !other.isWritten && other.stream == one.stream; });
    if (!one.isWritten || !isRead) continue;
    arguments_[one.index].region = one.stream->spare();
    swapped_.push_back(one.stream);
  }
}

/// Whether the kernel computes the same wherever its elements are: it does not ask for indices, and no end of the whole is near.
bool CallPlan::isAlikeEverywhere() const {
  if (kernel_.usesIndex || kernel_.usesExtent) return false;
  for (std::size_t i = 0; i < kernel_.parameters.size(); ++i) {
    const program::Parameter& parameter = kernel_.parameters[i];
    if (parameter.role == Role::Iterator || parameter.usesIndex || parameter.usesExtent) return false;
    if (parameter.role != Role::Gather) continue;
    const bool isSpread = std::ranges::any_of(
        spread_, [&](const SpreadArgument& one) { return one.index == i && !one.isWritten; });
    const bool isRelative =
        parameter.boundary == program::Boundary::Wrap && !parameter.usesAt && !parameter.usesSample;
    if (isSpread ? !isRelative : parameter.usesNear) return false;
  }
  return true;
}

std::vector<domain::Piece> CallPlan::piecesOf(const Box& box) const {
  std::vector<domain::Piece> pieces = domain::piecesInside(box, domain_.parts.whole());
  if (pieces.size() < 2 || !isAlikeEverywhere()) return pieces;
  const std::optional<domain::Piece> moved = domain::movedInside(box, domain_.parts.whole());
  if (moved) pieces = {*moved};
  return pieces;
}

/// Refuses what the call would refuse after the first messages, which nobody would receive then.
void CallPlan::checkInputs() const {
  for (const SpreadArgument& one : spread_) {
    if (one.isWritten) continue;
    const StreamRegion own = one.stream->part(domain_.own);
    checkNotLost(own, false, kernel_.name);
    if (unwrittenIn(own).empty() || !readsOwn(one)) continue;
    fail(kernel_,
         "'{}' reads a stream of shape {}, of which nothing has written the part of this rank; write() or "
         "fill() it first, or let a kernel write it (SK_CHECK=written)",
         kernel_.parameters[one.index].name, toString(domain_.parts.whole()));
  }
}

/// Whether the elements of the call's box, on any rank, read this rank's part of a stream.
bool CallPlan::readsOwn(const SpreadArgument& one) const {
  if (options_.box.isWhole()) return true;
  Box read = options_.box;
  for (int d = 0; d < read.begin.rank(); ++d) {
    const auto k = static_cast<std::size_t>(d);
    read.begin[d] -= one.depth.below[k];
    read.end[d] += one.depth.above[k];
    if (domain_.parts.isPeriodic(d)) continue;
    read.begin[d] = std::max<std::int64_t>(read.begin[d], 0);
    read.end[d] = std::min(read.end[d], domain_.parts.whole()[d]);
  }
  return std::ranges::any_of(domain::piecesInside(read, domain_.parts.whole()),
                             [&](const domain::Piece& piece) {
                               return !domain::isEmpty(domain::intersection(domain_.own, piece.box));
                             });
}

DeviceState& CallPlan::device() const { return *spread_.front().stream->placed().stream->device; }

/// Those of all elements of this rank, before any is computed. Elements of its halo, which it may compute, too, are those of others.
void CallPlan::evaluateAssertions() const {
  if (kernel_.assertions == nullptr || !checksAsserts()) return;
  CallOptions options = device().configuration.resolve(kernel_, options_);
  options.box = domain::intersection(domain_.own, boxOrAll(options_.box, domain_.parts.whole()));
  if (!domain::isEmpty(options.box))
    checkAssertions(device(), kernel_, arguments_, domain_.parts.whole(), options);
}

/// What this rank's own elements hold, and what the call would write to them.
void CallPlan::checkOwnRanges() const {
  if (!checksRanges()) return;
  std::vector<Argument> own = arguments_;
  for (const std::vector<SpreadArgument>& arguments : {std::cref(spread_), std::cref(others_)}) {
    for (const SpreadArgument& one : arguments) own[one.index].region = ownPart(*one.stream);
  }
  checkRangesRead(kernel_, own);
  CallOptions part = options_;
  part.box = domain::intersection(domain_.own, boxOrAll(options_.box, domain_.parts.whole()));
  if (domain::isEmpty(part.box)) return;
  checkRangesWritten({.device = device(),
                      .kernel = kernel_,
                      .arguments = arguments_,
                      .box = part.box,
                      .run = [&](std::span<const Argument> others, std::span<void* const>) {
                        sk::run(kernel_, others, part);
                      }});
}

void CallPlan::exchangeHalos() {
  startExchanges();
  finishOthers();
  if (exchange_) exchange_->finish();
}

void CallPlan::run(const Compute& compute) {
  startExchanges();
  for (const SpreadArgument& one : spread_) {
    if (one.isWritten) one.stream->valid = beyond_;
  }
  finishOthers();
  WriteScope writes, repairs;
  for (const SpreadArgument& one : spread_) {
    if (!one.isWritten || std::ranges::find(swapped_, one.stream) != swapped_.end()) continue;
    StreamState* const written = one.stream->placed().stream;
    writes.add(written);
    if (!written->isLost() || !options_.box.isWhole()) continue;
    repairs.add(written);  // all of its elements come, if not in one box
    repairs.begin();
    written->setWritten();
  }
  CallOptions part = options_;
  std::optional<AssertionsEvaluated> evaluated;
  const auto computeBox = [&](const Box& box) {
    for (const domain::Piece& piece : piecesOf(box)) {
      std::vector<Argument> moved = arguments_;
      for (Argument& argument : moved) {
        Index& origin = argument.region.placement.origin;
        for (int d = 0; d < origin.rank(); ++d) origin[d] += piece.shift[d];
      }
      part.box = piece.box;
      compute(moved, part);
      writes.begin();  // until the other boxes are there, too
    }
  };
  const auto evaluate = [&] {
    evaluateAssertions();
    checkOwnRanges();
    evaluated.emplace(device());
  };
  if (!exchange_) {
    evaluate();
    computeBox(box_);
  } else {
    const Box inner =
        domain::shrunk(domain_.own, domain_.parts.haloOf(domain_.rank, roundedUp(reach_, unit_)));
    // assertions and ranges of the border depend on the halo, and must hold before the interior is stored
    const bool overlaps = domain_.options.overlap && !isOneBox() && !domain::isEmpty(inner) &&
                          !checksAsserts() && !checksRanges();
    if (overlaps) computeBox(inner);
    exchange_->finish();
    evaluate();
    for (const Box& box : overlaps ? domain::difference(box_, inner) : std::vector{box_}) computeBox(box);
  }
  writes.commit();
  repairs.commit();
  for (DomainStreamState* stream : swapped_) stream->exchange();
}

}  // namespace mpi

void DomainState::run(const Kernel& kernel, std::span<const Argument> arguments, const CallOptions& chosen) {
  mpi::Call call = mpi::beginCall(*this, kernel, chosen);
  std::optional<mpi::CallPlan> plan;
  const mpi::Refusal refusal = mpi::caught(kernel.name, [&] {
    if (!chosen.box.isWhole()) checkBox(kernel, chosen.box, parts.whole());
    plan.emplace(*this, kernel, arguments, chosen);
    plan->prepare();
  });
  if (call.isFirst || agreement.isAlways() || (plan ? plan->hasMessages() : mpi::readsNeighbors(kernel))) {
    mpi::KernelDetails details(*this, kernel, arguments, chosen);
    call.details = &details;
    if (plan) {
      call.add(plan->hash());
      details.setPlan(*plan);
    }
    if (agreement.isAlways()) details.addTo(call);
    agreement.agree(call, refusal);
  } else if (refusal) {
    agreement.failAlone(*refusal);
  }
  agreement.act(kernel.name, [&] {
    plan->run([&](std::span<const Argument> mine, const CallOptions& part) { sk::run(kernel, mine, part); });
  });
}

}  // namespace sk
